/* render.c: an example: renders a scene by psplat's library, shows how far it is, and writes two pictures.
 *
 *     cc -o render render.c $(pkg-config --cflags --libs psplat)
 *     ./render scene.psd picture [OPTION=VALUE...]      # as size=640x360, plugin=estimator=pathtrace
 */
#include <psplat/psplat.h>

#include <signal.h>
#include <stdio.h>
#include <string.h>

/* Control-C stops the render, whose picture is written as far as it is. */
static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

static int was_stopped(void *user)
{
    (void)user;
    return stopped;
}

static void show_progress(void *user, const psplat_progress *progress)
{
    (void)user;
    fprintf(stderr, "\r%3.0f %% %-24s", 100.0 * progress->fraction, progress->stage);
}

static void show_message(void *user, int kind, const char *message)
{
    (void)user;
    fprintf(stderr, "\r%s%s\n", kind == PSPLAT_REMARK ? "note: " : "", message);
}

static ps_result set_options(psplat_scene *scene, char **words, int count, psplat_error *error)
{
    ps_result result = PS_OK;
    for (int i = 0; i < count && result == PS_OK; i++) {
        char *value = strchr(words[i], '=');
        if (value)
            *value++ = '\0';
        result = psplat_scene_set(scene, words[i], value, error);
    }
    return result;
}

/* NAME.exr with all layers, NAME.png to look at. */
static ps_result write_picture(const psplat_picture *picture, const char *name, psplat_error *error)
{
    static const char *const suffixes[2] = {".exr", ".png"};
    ps_result result = PS_OK;
    for (int i = 0; i < 2 && result == PS_OK; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s%s", name, suffixes[i]);
        result = psplat_picture_write(picture, path, error);
    }
    return result;
}

int main(int argc, char **argv)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks, .progress = show_progress, .cancelled = was_stopped};
    psplat_picture *picture = NULL;
    psplat_error error = {.message = "usage: render SCENE.psd PICTURE [OPTION=VALUE...]"};
    psplat_scene *scene = psplat_scene_create();
    ps_result result = scene && argc >= 3 ? PS_OK : PS_ERROR_INVALID;
    if (result == PS_OK) {
        signal(SIGINT, stop);
        psplat_scene_listen(scene, show_message, NULL);
        result = set_options(scene, argv + 3, argc - 3, &error);
    }
    if (result == PS_OK)
        result = psplat_scene_load(scene, argv[1], &error);
    if (result == PS_OK)
        result = psplat_render(scene, &callbacks, &picture, &error);
    if (picture && (result == PS_OK || result == PS_CANCELLED)) {
        fprintf(stderr, "\r%zux%zu pixels, %zu channels\n", psplat_picture_width(picture),
                psplat_picture_height(picture), psplat_picture_channel_count(picture));
        result = write_picture(picture, argv[2], &error);
    }
    if (result != PS_OK)
        fprintf(stderr, "%s\n", error.message);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
    return result == PS_OK ? 0 : 1;
}
