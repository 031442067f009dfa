/* command_render.c: psplat render: a scene becomes a picture, by psplat.h as any other program
 * makes one. */
#include "cli/default_path.h"
#include "cli/option_rows.h"
#include "cli/progress.h"
#include "cli/viewer.h"

#include "base/path.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct option options[] = {
    OUTPUT_OPTIONS,
    RENDER_OPTIONS,
    {0, "crop", "X,Y,W,H", "render this part of the picture alone, in pixels"},
    {0, "tile", "SIDE", "render tiles of so many pixels a side, one by one, in little memory"},
    {0, "preview", NULL, "a quick look: small, few light paths, coarse shadows"},
    {0, "passes", "N|A:B",
     "number of passes, which smooth edges and lessen noise; or those from A to before B"},
    {0, "time", "TIME", "render passes until TIME is used up: 90, 90s, 10m, 2h"},
    {0, "error", "PERCENT",
     "render passes until the estimated error of indirect light is at most this"},
    {0, "write-every", "TIME", "write the picture so far after the first pass, then so often"},
    {0, "checkpoint", "FILE.exr", "keep the film in FILE, to resume, merge or resolve"},
    {0, "checkpoint-every", "TIME", "interval between checkpoints; default: 60s"},
    {0, "resume", NULL, "go on with the film of --checkpoint, where there is one"},
    {0, "mpi", NULL, "share the passes with the other processes that mpirun started"},
    PROGRESS_OPTION,
    VIEWER_OPTION,
    {0, "memory-limit", "SIZE", "refuse to use more memory, as 500M or 8G; default: the machine's"},
    {0, "stats", "FILE.json", "write what each stage took in time and memory"},
};

struct render_command {
    psplat_scene *scene;
    const char *path;                      /* of the scene */
    const char *passes, *layers, *display; /* what was given, or NULL */
    bool has_output, has_checkpoint, has_tile, quiet;
    enum progress_mode progress_mode;
    struct progress progress;
    bool has_progress; /* some was told, as only one process does of those that share a render */
    struct tev_address address;
    struct viewer *viewer; /* NULL: none */
};

/* --- the command line
 * --------------------------------------------------------------------------------- */

static bool set(struct render_command *command, const char *option, const char *value)
{
    psplat_error error;
    if (psplat_scene_set(command->scene, option, value, &error) == PS_OK)
        return true;
    print_failure(&error);
    return false;
}

static bool take_option(struct render_command *command, const struct argument *argument)
{
    const char *name = argument->option->name, *value = argument->value;
    if (strcmp(name, "quiet") == 0)
        return command->quiet = true;
    if (strcmp(name, "progress") == 0)
        return progress_parse_mode(value, &command->progress_mode);
    if (strcmp(name, "display") == 0)
        return viewer_parse(command->display = value, &command->address);
    if (strcmp(name, "passes") == 0)
        command->passes = value;
    else if (strcmp(name, "layers") == 0)
        command->layers = value;
    command->has_output |= strcmp(name, "output") == 0;
    command->has_checkpoint |= strcmp(name, "checkpoint") == 0;
    command->has_tile |= strcmp(name, "tile") == 0;
    return set(command, name, value);
}

static bool take_arguments(struct render_command *command, const struct argument *arguments,
                           size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!take_option(command, &arguments[i]))
                return false;
        } else if (command->path) {
            fprintf(stderr, "psplat: error: one scene at a time: '%s' after '%s'\n",
                    arguments[i].value, command->path);
            return false;
        } else {
            command->path = arguments[i].value;
        }
    }
    if (!command->path)
        print_error("which scene? Try 'psplat --help'.");
    else if (command->has_tile && command->display)
        print_error("--tile does not go with --display");
    return command->path && !(command->has_tile && command->display);
}

static bool add_default_output(struct render_command *command, const char *suffix)
{
    char *path = default_path(command->path, suffix);
    bool good = path && set(command, "output", path);
    free(path);
    return good;
}

/* Part of the passes makes no picture that anybody waits for, unless it is named. */
static bool choose_outputs(struct render_command *command)
{
    if (command->has_output)
        return true;
    if (!command->passes || !strchr(command->passes, ':'))
        return add_default_output(command, ".exr") && add_default_output(command, ".png");
    if (!command->has_checkpoint)
        print_error("--passes A:B: where to? Name the film with --checkpoint, or a picture with "
                    "--output.");
    return command->has_checkpoint;
}

/* --- signals
 * ------------------------------------------------------------------------------------------ */

/* A signal handler can reach nothing else: the only variables of the program that are not constant.
 * The first is the number of the signal. */
static volatile sig_atomic_t interrupted, write_now;

static void handle_signals(void (*handler)(int signal_number))
{
    struct sigaction action = {.sa_handler = handler};
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* The next signal, whichever of the two it is, ends the process. Only what is safe in a handler:
 * write() is, and there is nobody to tell if it fails. */
static void interrupt(int signal_number)
{
    static const char message[] = "\npsplat: interrupted: finishing this batch, then writing the "
                                  "picture without what is left; a second signal ends at once\n";
    handle_signals(SIG_DFL);
    interrupted = signal_number;
    ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
    (void)written;
}

static void ask_for_picture(int signal_number)
{
    (void)signal_number;
    write_now = 1;
}

/* --- what the render tells and asks
 * ------------------------------------------------------------------- */

static void show_message(void *user, int kind, const char *message)
{
    struct render_command *command = user;
    if (kind == PSPLAT_REMARK && command->quiet)
        return;
    progress_clear(&command->progress);
    if (kind == PSPLAT_REMARK)
        fprintf(stderr, "psplat: %s\n", message);
    else if (kind == PSPLAT_WARNING)
        print_warning(message);
    else
        fprintf(stderr, "%s\n", message);
}

static void show_progress(void *user, const psplat_progress *progress)
{
    struct render_command *command = user;
    command->has_progress = true;
    command->progress.passes = progress->passes;
    command->progress.error = progress->error;
    progress_update(&command->progress, progress->stage, progress->fraction);
}

static int was_interrupted(void *user)
{
    (void)user;
    return interrupted != 0;
}

static int was_asked_for_picture(void *user)
{
    bool asked = write_now != 0;
    (void)user;
    write_now = 0;
    return asked;
}

static void show_picture(void *user, psplat_picture *picture)
{
    const struct render_command *command = user;
    viewer_show(command->viewer, picture, false);
}

/* --- the render
 * --------------------------------------------------------------------------------------- */

static ps_result render(struct render_command *command, psplat_error *error)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks,
        .user = command,
        .progress = show_progress,
        .cancelled = was_interrupted,
        .show = command->viewer ? show_picture : NULL,
        .write_now = was_asked_for_picture,
    };
    psplat_picture *picture = NULL;
    handle_signals(interrupt);
    signal(SIGUSR1, ask_for_picture);
    ps_result result =
        psplat_render(command->scene, &callbacks, command->viewer ? &picture : NULL, error);
    progress_clear(&command->progress);
    if (picture)
        viewer_show(command->viewer, picture, true);
    return result;
}

/* With the viewer beside it. */
static ps_result render_and_show(struct render_command *command, psplat_error *error)
{
    if (!command->display)
        return render(command, error);
    bool has_display = command->layers && strstr(command->layers, "display");
    command->viewer = viewer_create(&command->address, path_name(command->path), has_display);
    if (!command->viewer) {
        error->message[0] = '\0'; /* it was printed */
        return PS_ERROR_MEMORY;
    }
    ps_result result = render(command, error);
    viewer_destroy(command->viewer);
    return result;
}

/* What has a place is the user's to mend, also where it is a file that can't be read. Where another
 * process tells what became of the job, this one has no message. */
static int status_of_render(ps_result result, const psplat_error *error)
{
    if (result != PS_CANCELLED)
        return error->has_place ? STATUS_USAGE : status_of(result);
    if (!error->message[0])
        return STATUS_OK;
    return interrupted ? STATUS_SIGNAL + interrupted : STATUS_FAILED;
}

static int load_and_render(struct render_command *command)
{
    psplat_error error;
    progress_start(&command->progress, command->progress_mode, command->quiet);
    psplat_scene_listen(command->scene, show_message, command);
    ps_result result = psplat_scene_load(command->scene, command->path, &error);
    if (result == PS_OK)
        result = render_and_show(command, &error);
    if (result != PS_OK)
        print_failure(&error);
    if (command->has_progress)
        progress_end(&command->progress);
    return result == PS_OK ? STATUS_OK : status_of_render(result, &error);
}

static int run(const struct argument *arguments, size_t count)
{
    struct render_command command = {.scene = psplat_scene_create()};
    int status = STATUS_USAGE;
    if (!command.scene) {
        print_error("out of memory");
        return STATUS_FAILED;
    }
    if (take_arguments(&command, arguments, count) && choose_outputs(&command))
        status = load_and_render(&command);
    psplat_scene_destroy(command.scene);
    return status;
}

const struct command command_render = {
    .name = "render",
    .operands = "SCENE.psd|MODEL",
    .summary = "renders a scene, or a lone model; the command when none is named",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
