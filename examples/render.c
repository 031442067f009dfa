/* render.c: an example: renders a scene by psplat's library, shows how far it is, and writes
 * NAME.exr and NAME.png.
 *
 *     cc -o render render.c $(pkg-config --cflags --libs psplat)
 *     ./render scene.psd NAME [OPTION=VALUE...]
 *
 * An option is size=640x360, time=10s, plugin=estimator=pathtrace and so on.
 */
#include <psplat/psplat.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static volatile sig_atomic_t stopped; /* by Control-C: the picture so far is written */

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

int main(int argc, char **argv)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks, .progress = show_progress, .cancelled = was_stopped};
    psplat_error error = {.message = "usage: render SCENE.psd NAME [OPTION=VALUE...]"};
    psplat_picture *picture = NULL;
    psplat_scene *scene = psplat_scene_create();
    ps_result result = scene && argc >= 3 ? PS_OK : PS_ERROR_INVALID;
    if (scene)
        psplat_scene_listen(scene, show_message, NULL);
    for (int i = 3; i < argc && result == PS_OK; i++) {
        char *value = strchr(argv[i], '=');
        if (value)
            *value++ = '\0';
        result = psplat_scene_set(scene, argv[i], value, &error);
    }
    for (int i = 0; i < 2 && result == PS_OK; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s%s", argv[2], i == 0 ? ".exr" : ".png");
        result = psplat_scene_set(scene, "output", path, &error);
    }
    if (result == PS_OK)
        result = psplat_scene_load(scene, argv[1], &error);
    signal(SIGINT, stop);
    if (result == PS_OK)
        result = psplat_render(scene, &callbacks, &picture, &error);
    if (picture)
        fprintf(stderr, "\r%zux%zu pixels, %zu channels\n", psplat_picture_width(picture),
                psplat_picture_height(picture), psplat_picture_channel_count(picture));
    if (result != PS_OK)
        fprintf(stderr, "%s\n", error.message);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
    return result == PS_OK ? 0 : 1;
}
