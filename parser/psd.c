/* psd.c: the steps from a text to a scene description: YAML, files, names, formulas, tables. */
#include "parser/psd.h"

#include "parser/language/definitions.h"
#include "parser/language/include.h"
#include "parser/language/override.h"
#include "parser/sections/sections.h"
#include <string.h>

/* What a reading is for: a description, or a list of parameters where `each` is set. */
struct purpose {
    const struct psd_options *options;
    void (*each)(void *user, const struct psd_parameter *parameter);
    void *user;
};

static ps_result expand_and_read(struct reader *reader, const struct purpose *purpose,
                                 struct budget budget, const struct node *root)
{
    const struct psd_options *options = purpose->options;
    struct assignments given = {0};
    struct scope scope = {.reader = reader};
    struct expansion expansion = {
        .reader = reader, .scope = &scope, .budget = {.most = budget.most}};
    if (purpose->each) {
        definitions_list(&expansion, root, purpose->each, purpose->user);
        return PS_OK;
    }
    if (!assignments_read(reader, "--param", options->parameters, options->parameter_count, &given))
        return PS_ERROR_INVALID;
    definitions_read(&expansion, root, &given);
    root = expand_root(&expansion, root);
    if (expansion.stopped)
        return PS_ERROR_INVALID;
    scene_read(reader, root);
    return PS_OK;
}

static ps_result read_tree(struct reader *reader, const struct purpose *purpose,
                           const struct main_text *text)
{
    const struct psd_options *options = purpose->options;
    struct budget budget = {.most = options->most_values ? options->most_values : MOST_NODES};
    struct assignments sets = {0};
    const struct node *root = NULL;
    ps_result result = include_read(reader, options->files, &budget, text, &root);
    if (result != PS_OK)
        return result;
    if (!assignments_read(reader, "--set", options->sets, options->set_count, &sets))
        return PS_ERROR_INVALID;
    root = override_tree(reader, &sets, &budget, root);
    return expand_and_read(reader, purpose, budget, root);
}

static void report_memory(struct diagnostics *sink, const char *name)
{
    struct origin origin = {.file = name};
    diagnostics_report(sink, SEVERITY_ERROR, &origin, 0, "out of memory while reading the scene");
}

/* The name that origins refer to, the path, and the limits on what the scene may name. */
static void prepare(struct reader *reader, const char *name, const struct psd_options *options)
{
    reader->description->path = reader_copy(reader, name);
    reader->file = reader_add_file(reader, name);
    if (options->folder)
        reader->description->folder = reader_copy(reader, options->folder);
    if (options->cache)
        reader->description->cache = reader_copy(reader, options->cache);
    reader->description->texture_memory = options->texture_memory;
    reader->description->memory_limit = options->memory_limit;
    reader->allow_plugin_paths = options->allow_plugin_paths;
    reader->ahead = options->ahead;
}

static ps_result read_scene(const char *name, const struct main_text *text,
                            const struct purpose *purpose, struct diagnostics *sink,
                            struct scene_description *description)
{
    static const struct psd_options no_options = {0};
    struct purpose full = *purpose;
    size_t errors_before = diagnostics_error_count(sink);
    ps_result result = PS_OK;
    struct arena arena = {0};
    *description = (struct scene_description){0};
    struct reader reader = {.sink = sink, .description = description, .arena = &arena};
    if (!full.options)
        full.options = &no_options;
    prepare(&reader, name, full.options);
    if (!reader.out_of_memory)
        result = read_tree(&reader, &full, text);
    arena_release(&arena);
    if (reader.out_of_memory)
        result = PS_ERROR_MEMORY;
    if (result == PS_OK && diagnostics_error_count(sink) > errors_before)
        result = PS_ERROR_INVALID;
    if (result == PS_ERROR_MEMORY)
        report_memory(sink, name);
    if (result != PS_OK)
        scene_description_release(description);
    return result;
}

static ps_result read_file(const char *path, const struct purpose *purpose,
                           struct diagnostics *sink, struct scene_description *description)
{
    const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
    struct error error;
    struct file_text file = {0};
    *description = (struct scene_description){0};
    ps_result result = file_read(path, &file, &error);
    if (result == PS_OK) {
        const struct main_text text = {file.bytes, file.length, file.device, file.serial};
        result = read_scene(name, &text, purpose, sink, description);
    } else {
        struct origin origin = {.file = name};
        diagnostics_report(sink, SEVERITY_ERROR, &origin, 0, "%s", error.text);
    }
    file_release(&file);
    return result;
}

ps_result psd_read_text_with(const char *name, const char *text, size_t length,
                             const struct psd_options *options, struct diagnostics *sink,
                             struct scene_description *description)
{
    const struct main_text main_text = {.text = text, .length = length};
    const struct purpose purpose = {.options = options};
    return read_scene(name, &main_text, &purpose, sink, description);
}

ps_result psd_read_text(const char *name, const char *text, size_t length, struct diagnostics *sink,
                        struct scene_description *description)
{
    return psd_read_text_with(name, text, length, NULL, sink, description);
}

ps_result psd_read_file_with(const char *path, const struct psd_options *options,
                             struct diagnostics *sink, struct scene_description *description)
{
    const struct purpose purpose = {.options = options};
    return read_file(path, &purpose, sink, description);
}

ps_result psd_read_file(const char *path, struct diagnostics *sink,
                        struct scene_description *description)
{
    return psd_read_file_with(path, NULL, sink, description);
}

ps_result psd_list_parameters(const char *path, const struct psd_options *options,
                              struct diagnostics *sink,
                              void (*each)(void *user, const struct psd_parameter *parameter),
                              void *user)
{
    const struct purpose purpose = {options, each, user};
    struct scene_description description;
    ps_result result = read_file(path, &purpose, sink, &description);
    scene_description_release(&description);
    return result;
}
