/* psd.c: the steps from a text to a scene description: encoding, YAML, tables. */
#include "parser/psd.h"

#include "parser/document.h"
#include "parser/encoding.h"
#include "parser/file.h"
#include "parser/reader.h"
#include "parser/scene.h"
#include <stdlib.h>
#include <string.h>

/* The names that origins refer to, and the path. */
static void set_names(struct reader *reader, const char *name)
{
    struct scene_description *description = reader->description;
    description->path = reader_copy(reader, name);
    description->files = reader_allocate(reader, 1, sizeof *description->files);
    if (!description->files)
        return;
    description->file_count = 1;
    description->files[0] = reader_copy(reader, name);
    reader->file = description->files[0];
}

static ps_result read_tree(struct reader *reader, const char *text, size_t length)
{
    struct document document = {0};
    ps_result result = encoding_check(reader->file, text, length, reader->sink);
    if (result == PS_OK)
        result = document_read(reader->file, text, length, reader->sink, &document);
    if (result == PS_OK) {
        reader->arena = &document.arena;
        scene_read(reader, document.root);
    }
    document_release(&document);
    return result;
}

static void report_memory(struct diagnostics *sink, const char *name)
{
    struct origin origin = {.file = name};
    diagnostics_report(sink, SEVERITY_ERROR, &origin, 0, "out of memory while reading the scene");
}

ps_result psd_read_text(const char *name, const char *text, size_t length, struct diagnostics *sink,
                        struct scene_description *description)
{
    size_t errors_before = diagnostics_error_count(sink);
    ps_result result = PS_OK;
    *description = (struct scene_description){0};
    struct reader reader = {.sink = sink, .description = description};
    set_names(&reader, name);
    if (!diagnostics_add_source(sink, name, text, length))
        reader.out_of_memory = true;
    if (!reader.out_of_memory)
        result = read_tree(&reader, text, length);
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

ps_result psd_read_file(const char *path, struct diagnostics *sink,
                        struct scene_description *description)
{
    const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
    struct error error;
    struct file_text file = {0};
    *description = (struct scene_description){0};
    ps_result result = file_read(path, &file, &error);
    if (result == PS_OK) {
        result = psd_read_text(name, file.bytes, file.length, sink, description);
    } else {
        struct origin origin = {.file = name};
        diagnostics_report(sink, SEVERITY_ERROR, &origin, 0, "%s", error.text);
    }
    file_release(&file);
    return result;
}
