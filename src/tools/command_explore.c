/* command_explore.c: psplat explore: a scene in a browser. */
#include "base/input_file.h"
#include "cli/command.h"
#include "explore/explore.h"
#include "explore/explorer.h"
#include "tools/option_parse.h"
#include "tools/render_arguments.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct option options[] = {
    {0, "port", "N", "listen on this port of 127.0.0.1; default: any that is free"},
    {0, "no-browser", NULL, "print the address, and don't open it"},
    {0, "passes", "N", "passes of a picture; default: 64"},
    RENDER_OPTIONS,
    {0, "memory-limit", "SIZE", "refuse to use more memory, as 500M or 8G; default: the machine's"},
};

static bool take_number(const struct argument *argument, double minimum, double maximum,
                        double *number)
{
    return parse_whole_number(argument->option->name, argument->value, minimum, maximum, number);
}

/* What is said of the picture belongs to the first view; what the program may do, to all. */
static bool take_render_option(struct explore_request *request, const struct argument *argument)
{
    const char *name = argument->option->name;
    bool added = option_list_add(option_is_of_view(name) ? &request->options : &request->fixed,
                                 name, argument->value);
    if (!added)
        print_error("out of memory");
    return added;
}

static bool take_option(struct explore_request *request, const struct argument *argument)
{
    double number;
    if (argument_is(argument, "quiet"))
        return true;
    if (argument_is(argument, "no-browser")) {
        request->opens_browser = false;
        return true;
    }
    if (argument_is(argument, "port")) {
        bool good = take_number(argument, 1, 65535, &number);
        request->port = good ? (uint16_t)number : 0;
        return good;
    }
    if (argument_is(argument, "passes")) {
        bool good = take_number(argument, 1, MOST_VIEW_PASSES, &number);
        request->passes = good ? (uint32_t)number : 0;
        return good;
    }
    return take_render_option(request, argument);
}

static bool take_arguments(struct explore_request *request, const struct argument *arguments,
                           size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!take_option(request, &arguments[i]))
                return false;
        } else if (request->path) {
            fprintf(stderr, "psplat: error: explore: one scene at a time: '%s' after '%s'\n",
                    arguments[i].value, request->path);
            return false;
        } else {
            request->path = arguments[i].value;
        }
    }
    if (!request->path)
        print_error("explore: which scene? Try 'psplat explore --help'.");
    return request->path != NULL;
}

/* Standard input can be read once. */
static bool check_scene(const char *path)
{
    struct input_file file;
    struct error error;
    if (input_file_open(path, NULL, &file, &error) != PS_OK) {
        fprintf(stderr, "psplat: error: %s: %s\n", path, error.text);
        return false;
    }
    close(file.descriptor);
    return true;
}

static int run(const struct argument *arguments, size_t count)
{
    struct explore_request request = {.opens_browser = true, .passes = DEFAULT_VIEW_PASSES};
    psplat_error error;
    int status = STATUS_USAGE;
    if (take_arguments(&request, arguments, count)) {
        status = STATUS_FAILED;
        if (check_scene(request.path)) {
            ps_result result = explore(&request, &error);
            if (result != PS_OK)
                print_failure(&error);
            status = status_of(result);
        }
    }
    explore_request_release(&request);
    return status;
}

const struct command command_explore = {
    .name = "explore",
    .operands = "SCENE.psd|MODEL",
    .summary = "shows a scene in a browser, to try strategies and parameters",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
