/* command_new.c: psplat new: a scene to begin with. */
#include "base/output_file.h"
#include "cli/command.h"
#include "model/model.h"
#include "model/model_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct option options[] = {
    {0, "from", "MODEL", "write the scene that shows this mesh file"},
};

static ps_result write_text(const char *path, const char *text, struct error *error)
{
    struct output_file file;
    ps_result result = output_file_open_new(&file, path, error);
    if (result != PS_OK)
        return result;
    result = output_file_write(&file, 0, text, strlen(text), error);
    if (result == PS_OK)
        return output_file_commit(&file, error);
    output_file_discard(&file);
    return result;
}

static ps_result first_scene(char **text, struct error *error)
{
    size_t length = 0;
    FILE *stream = open_memstream(text, &length);
    for (size_t i = 0; stream && model_first_scene[i]; i++)
        fprintf(stream, "%s\n", model_first_scene[i]);
    if (stream && fclose(stream) == 0)
        return PS_OK;
    return error_memory(error, 4096, "a scene");
}

static int write_scene(const char *path, const char *model)
{
    struct error error;
    char *text = NULL;
    struct mesh_ahead content = {.is_there = false};
    ps_result result =
        model ? model_scene_make(&(struct model_file){.path = model}, path, &text, &content, &error)
              : first_scene(&text, &error);
    mesh_ahead_release(&content);
    if (result == PS_OK)
        result = write_text(path, text, &error);
    free(text);
    if (result != PS_OK)
        print_error(error.text);
    else
        fprintf(stderr, "psplat: wrote %s\n", path);
    return status_of(result);
}

static bool check_name(const char *path)
{
    size_t length = path ? strlen(path) : 0;
    if (!path)
        print_error("new: which file? Try 'psplat new --help'.");
    else if (length <= 4 || strcmp(path + length - 4, ".psd") != 0)
        fprintf(stderr, "psplat: error: new: '%s' does not end in .psd\n", path);
    return path && length > 4 && strcmp(path + length - 4, ".psd") == 0;
}

static int run(const struct argument *arguments, size_t count)
{
    const char *path = NULL, *model = NULL;
    for (size_t i = 0; i < count; i++) {
        if (argument_is(&arguments[i], "from")) {
            model = arguments[i].value;
        } else if (path) {
            fprintf(stderr, "psplat: error: new: one scene at a time: '%s' after '%s'\n",
                    arguments[i].value, path);
            return STATUS_USAGE;
        } else {
            path = arguments[i].value;
        }
    }
    return check_name(path) ? write_scene(path, model) : STATUS_USAGE;
}

const struct command command_new = {
    .name = "new",
    .operands = "NAME.psd",
    .summary = "writes a first scene, or one around a model",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
