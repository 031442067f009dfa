/* command_import.c: psplat import: makes a .psd scene of a scene of another renderer: pbrt,
 * POV-Ray. */
#include "base/input_file.h"
#include "base/text.h"
#include "cli/command.h"
#include "pbrt/pbrt.h"
#include "pov/pov.h"
#include "tools/option_parse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_LIBRARY, OPTION_OUTPUT, OPTION_PBRT, OPTION_RESTRICT };

#define MOST_LIBRARIES 32

static const struct option options[] = {
    [OPTION_LIBRARY] = {0, "library", "DIR",
                        "of POV-Ray: where #include looks too; may be repeated"},
    [OPTION_OUTPUT] = {'o', "output", "FILE.psd", "default: the scene's name with .psd"},
    [OPTION_PBRT] = {0, "pbrt", "3|4", "of pbrt: the scene's version; default: as its words tell"},
    [OPTION_RESTRICT] = {0, "restrict", "DIR", "refuse files outside of DIR to the scene"},
};

struct request {
    const char *scene, *output, *folder, *libraries[MOST_LIBRARIES];
    size_t library_count;
    double version;
};

static bool is_pov(const char *scene)
{
    return text_has_suffix(scene, ".pov") || text_has_suffix(scene, ".POV");
}

static bool parse_arguments(const struct argument *arguments, size_t count, struct request *request)
{
    size_t scenes = 0;
    for (size_t i = 0; i < count; i++) {
        const struct argument *argument = &arguments[i];
        if (!argument->option) {
            request->scene = argument->value;
            scenes++;
        } else if (argument->option == &options[OPTION_OUTPUT]) {
            request->output = argument->value;
        } else if (argument->option == &options[OPTION_LIBRARY]) {
            if (request->library_count == MOST_LIBRARIES) {
                fprintf(stderr, "psplat: error: --library: at most %d\n", MOST_LIBRARIES);
                return false;
            }
            request->libraries[request->library_count++] = argument->value;
        } else if (argument->option == &options[OPTION_RESTRICT]) {
            request->folder = argument->value;
        } else if (!parse_whole_number("pbrt", argument->value, 3, 4, &request->version)) {
            return false;
        }
    }
    if (scenes != 1) {
        print_error("import: expected one scene. Try 'psplat import --help'.");
        return false;
    }
    if (request->output && !text_has_suffix(request->output, ".psd")) {
        fprintf(stderr, "psplat: error: --output: expected FILE.psd, got '%s'\n", request->output);
        return false;
    }
    return true;
}

/* The scene's path with .psd for .pbrt or .pov; the caller frees it. */
static char *default_output(const char *scene)
{
    size_t length = strlen(scene);
    if (text_has_suffix(scene, ".pbrt") || is_pov(scene))
        length -= strlen(strrchr(scene, '.'));
    char *path = malloc(length + sizeof ".psd");
    if (path)
        snprintf(path, length + sizeof ".psd", "%.*s.psd", (int)length, scene);
    return path;
}

static ps_result convert(const struct request *request, const char *output, const char *folder,
                         struct diagnostics *sink, struct error *error)
{
    const struct pbrt_options pbrt = {.version = (int)request->version, .folder = folder};
    const struct pov_options pov = {.folder = folder,
                                    .libraries = request->libraries,
                                    .library_count = request->library_count,
                                    .system = POV_SYSTEM_INCLUDE};
    return is_pov(request->scene) ? pov_import(request->scene, output, &pov, sink, error)
                                  : pbrt_import(request->scene, output, &pbrt, sink, error);
}

static int import(const struct request *request, const char *output, const char *folder)
{
    struct diagnostics *sink = diagnostics_create_for(WARNINGS_KEPT);
    struct error error = {.text = ""};
    if (!sink) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    ps_result result = convert(request, output, folder, sink, &error);
    diagnostics_print(sink, stderr);
    diagnostics_destroy(sink);
    if (result != PS_OK && error.text[0])
        print_error(error.text);
    return status_of(result);
}

static int run(const struct argument *arguments, size_t count)
{
    struct request request = {0};
    struct error error;
    if (!parse_arguments(arguments, count, &request))
        return STATUS_USAGE;
    char *folder = request.folder ? input_folder_resolve(request.folder, &error) : NULL;
    if (request.folder && !folder) {
        print_error(error.text);
        return STATUS_USAGE;
    }
    char *output = request.output ? strdup(request.output) : default_output(request.scene);
    int status = STATUS_FAILED;
    if (output)
        status = import(&request, output, folder);
    else
        print_error("out of memory");
    free(output);
    free(folder);
    return status;
}

const struct command command_import = {
    .name = "import",
    .operands = "SCENE.pbrt|SCENE.pov",
    .summary = "makes a scene of one of pbrt or POV-Ray",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
