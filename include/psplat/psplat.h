/* psplat.h: renders scenes, from C or from any language that calls C: what the command `psplat
 * render` does (psplat(1)), as functions. Link with what `pkg-config --cflags --libs psplat` says;
 * libpsplat(3) is the manual.
 *
 *     psplat_error error;
 *     psplat_picture *picture = NULL;
 *     psplat_scene *scene = psplat_scene_create();
 *     if (scene && psplat_scene_set(scene, "size", "640x360", &error) == PS_OK &&
 *         psplat_scene_load(scene, "room.psd", &error) == PS_OK &&
 *         psplat_render(scene, NULL, &picture, &error) == PS_OK)
 *         psplat_picture_write(picture, "room.exr", &error);
 *     psplat_picture_destroy(picture);
 *     psplat_scene_destroy(scene);
 *
 * Results: PS_OK is 0; after any other a psplat_error says why. No function exits, prints, or
 * changes the working folder, the locale or signal handlers. Mesh files are read in a child
 * process, made by fork().
 *
 * Threads: the library has no state but in the handles. A handle may be passed between threads.
 * Functions that take it const may run in several threads at once, all others need it alone. So
 * several threads render at once, different scenes or the same; each render starts threads of its
 * own. While one runs, Embree limits oneTBB to one thread in the whole process: a program's own
 * work with oneTBB is slower meanwhile.
 *
 * Texts are UTF-8, end in NUL, and are copied where they are kept. Texts and samples that are
 * returned stay valid until the handle that they come from is destroyed.
 */
#ifndef PSPLAT_PSPLAT_H
#define PSPLAT_PSPLAT_H

#include <psplat/result.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Why a function failed: written by that function alone, and only if it fails. The caller's, with
 * nothing to free. Wherever one is taken, NULL will do. */
typedef struct psplat_error {
    ps_result result;
    int32_t line, column; /* the first problem's place in `file`, from 1; 0 where it has none */
    int32_t has_place;   /* 1: the message begins with a place, which may be in an option's value */
    char file[1024];     /* "": no place in a file is to blame, but an option, say */
    char message[32768]; /* what the command would print, as far as there is room: all problems */
} psplat_error;

/* The version of the library: "1.2.3". */
const char *psplat_version(void);

/* --- scenes: options first, then a file or a text
 * --------------------------------------------------- */

typedef struct psplat_scene psplat_scene;

/* NULL when out of memory. */
psplat_scene *psplat_scene_create(void);
void psplat_scene_destroy(psplat_scene *scene); /* NULL is nothing */

/* Gives an option of `psplat render` a value, by its long name without dashes:
 *
 *     param, set, plugin, output     add to those given before
 *     camera, restrict, cache, texture-memory, allow-scene-plugins, size, quality, bounces, passes,
 *     seed, threads, isa, batch, crop, tile, direct, direct-resolution, exposure, memory-limit,
 *     layers, compression, preview, time, error, checkpoint, checkpoint-every, resume, mpi,
 *     write-every, stats
 *                                    the last counts
 *
 * Values are those of the command line; NULL for allow-scene-plugins, preview, resume and mpi,
 * which take none. What was loaded is released: options come before loading. PS_ERROR_INVALID:
 * there is no such option, or no such value; PS_ERROR_IO: no such folder; what is loaded stays
 * then. Names that the scene or a strategy must know, such as those of cameras and parameters, and
 * whether options go together, are looked at when it is loaded. */
#define PSPLAT_COMPRESSIONS "zip, zips, rle, none" /* values of `compression` */
ps_result psplat_scene_set(psplat_scene *scene, const char *option, const char *value,
                           psplat_error *error);

/* Sets the function that receives warnings and remarks (such as the name of a written file), one
 * for each call, while scenes are loaded and rendered. Calls come from any thread, of one render
 * not two at once. NULL: nobody, as from the start. */
#define PSPLAT_REMARK 0
#define PSPLAT_WARNING 1
#define PSPLAT_WARNING_WITH_PLACE 2 /* begins with its place in a text, and shows that in lines */
typedef void (*psplat_listener)(void *user, int kind, const char *message);
void psplat_scene_listen(psplat_scene *scene, psplat_listener listener, void *user);

/* Reads a scene (psd(5)), or a mesh file, which is a scene by itself as it is for the command:
 * "lamp.glb". Checks its text, files, strategies, their parameters, and memory. What strategies
 * object to as they start, such as a parameter that does not suit the scene, psplat_render tells
 * before its first pass. Builds what traces rays through the scene, which its renders share. The
 * scene takes the place of what was loaded before; where that fails, nothing is loaded. "-" is
 * standard input. */
ps_result psplat_scene_load(psplat_scene *scene, const char *path, psplat_error *error);

/* Whether a file of that name is a mesh file, by its end. It need not be there. */
int psplat_scene_is_model(const char *path);

/* psplat_scene_load for a scene's text of `length` bytes. `name` stands for its file, which need
 * not be there, in messages, and files that the text names are looked for beside that:
 * "/home/ann/models/lamp.psd". NULL: "<text>". */
ps_result psplat_scene_load_text(psplat_scene *scene, const char *text, size_t length,
                                 const char *name, psplat_error *error);

/* --- renders
 * ----------------------------------------------------------------------------------------- */

typedef struct psplat_picture psplat_picture;
typedef struct psplat_rendering psplat_rendering; /* under way; the library's */

/* How far a render is. Later versions may add to its end. `error` is that of the indirect light,
 * relative, by estimate; it is known where the option `error` asks for it, after the first pass,
 * and negative elsewhere. */
typedef struct psplat_progress {
    const char *stage; /* what is being done */
    double fraction;   /* of the render, 0..1 */
    double error;
    uint32_t passes; /* that are done */
} psplat_progress;

/* What a render calls, each NULL or a function; zero all that you don't use. They may use other
 * handles as they like, but must not change the scene that is being rendered. They run in the
 * floating-point environment that processes start with, whatever the caller's is, and leave it as
 * it was. */
typedef struct psplat_callbacks {
    size_t size; /* sizeof(psplat_callbacks) */
    void *user;

    /* By the thread that called psplat_render. */
    void (*progress)(void *user, const psplat_progress *progress);

    /* Whether to stop: asked often, by any thread, and by several at once. */
    int (*cancelled)(void *user);

    /* Between passes, when so many are done and another follows; not where processes share them. By
     * the thread that called psplat_render. */
    void (*pass)(void *user, psplat_rendering *rendering, uint32_t passes);

    /* A tile that is done, with all passes, where the option `tile` is given: its upper left pixel
     * is (x, y) of the picture. In rows from the top, each from the left. The tile becomes yours,
     * to be destroyed. By the thread that called psplat_render. */
    void (*tile)(void *user, psplat_picture *tile, size_t x, size_t y);

    /* A picture to show on the way: of few pixels, scaled up, within a second, then of the passes
     * so far, each half second, but for no more than a fifth of the time. Not of tiles. It becomes
     * yours, to be destroyed. By the thread that called psplat_render. */
    void (*show)(void *user, psplat_picture *picture);

    /* Between passes: whether the files of the options `output` and `checkpoint` are to be written
     * as they are then. By the thread that called psplat_render. */
    int (*write_now)(void *user);
} psplat_callbacks;

/* Renders what is loaded. `callbacks`: NULL, or borrowed until it returns. *picture becomes the
 * caller's, to be destroyed, or NULL; `picture`: NULL where nobody waits for it. PS_CANCELLED: the
 * picture holds the passes that were complete; it is NULL where there is nothing to show. Where a
 * pass or a stage at the end fails, the picture is made without it, if there is something to show.
 * The same scene, options, version and instruction set give the same picture, bit for bit, and that
 * of the command.
 *
 * Files that options name are written as the command writes them: `output` at the end, and on the
 * way by `write-every`; the film by `checkpoint`; `stats`. When cancelled, what is done by then is
 * written to them, denoised as well, which no further call for cancelling shortens. All that can be
 * written is; what can't is the failure.
 *
 * With the option `tile` the picture is made tile by tile, in the memory of one, so that it may
 * have any size. Tiles go into the files, and to the callback `tile`; one of both is needed, and
 * *picture is NULL. Passes are made in each tile, so that `pass` is not called. When cancelled, the
 * last tile holds what was done by then.
 *
 * With the option `mpi`, the processes that mpirun started share the passes. Each loads and
 * renders, in the same order; the first of them reads the scene, writes files, calls back and gets
 * the picture. What another one leaves to the first to tell is PS_CANCELLED with no message. Each
 * has to destroy its scene, for which the others wait. A process does all this with one scene,
 * once. */
ps_result psplat_render(const psplat_scene *scene, const psplat_callbacks *callbacks,
                        psplat_picture **picture, psplat_error *error);

/* A picture to look at while a better one is made: what psplat_render shows, in about so many
 * pixels (or all, where those are fewer), by one pass of draft quality. 10,000 pixels take some
 * tenths of a second. Callbacks as of psplat_render, of which `progress` and `cancelled` are
 * called. Where it fails or is cancelled, there is no picture. */
ps_result psplat_preview(const psplat_scene *scene, size_t pixels,
                         const psplat_callbacks *callbacks, psplat_picture **picture,
                         psplat_error *error);

/* The picture of the passes so far, likewise; from the callback `pass` alone. */
ps_result psplat_rendering_picture(psplat_rendering *rendering, psplat_picture **picture,
                                   psplat_error *error);

/* --- what lights a pixel
 * ------------------------------------------------------------------------------ */

#define PSPLAT_SOURCE_PROJECTED 1u /* before the camera: x and y are set */
#define PSPLAT_SOURCE_SEEN 2u      /* and nothing hides it from there */

typedef struct psplat_pixel_source {
    float position[3];   /* of the photon, in the scene */
    float irradiance[3]; /* that it brings, W/m^2 */
    float x, y;          /* where it is in the picture, in pixels, or beside the picture */
    unsigned flags;      /* PSPLAT_SOURCE_... */
    unsigned bounce;     /* surfaces that scattered its light */
} psplat_pixel_source;

typedef struct psplat_pixel_light {
    float position[3];   /* of what the pixel sees */
    float irradiance[3]; /* the sum, W/m^2 */
    size_t photon_count; /* of the pass */
    size_t source_count;
    const psplat_pixel_source *sources; /* the brightest first */
} psplat_pixel_light;

/* The photons of the first pass whose splats light a pixel, as `psplat debug pixel` has them
 * (psplat-debug(1)). *light becomes the caller's, to be destroyed, or NULL. PS_ERROR_INVALID: the
 * pixel sees no surface, too. Callbacks as of psplat_render, of which `progress` and `cancelled`
 * are called. */
ps_result psplat_pixel_light_find(const psplat_scene *scene, unsigned x, unsigned y,
                                  const psplat_callbacks *callbacks, psplat_pixel_light **light,
                                  psplat_error *error);
void psplat_pixel_light_destroy(psplat_pixel_light *light); /* NULL is nothing */

/* --- pictures
 * ---------------------------------------------------------------------------------------- */

void psplat_picture_destroy(psplat_picture *picture); /* NULL is nothing */

size_t psplat_picture_width(const psplat_picture *picture);
size_t psplat_picture_height(const psplat_picture *picture);

/* Channels by their index: the picture's own, "R", "G" and "B" (radiance, linear Rec.709); those of
 * the layers that the option `layers` says, such as "indirect.R" or "Z" (psplat(1) lists them with
 * their units); and "display.R", "display.G", "display.B": what a display shows, 0..1, linear. NULL
 * beyond the last. */
size_t psplat_picture_channel_count(const psplat_picture *picture);
const char *psplat_picture_channel_name(const psplat_picture *picture, size_t index);

/* Its samples, row by row from the top, width * height; NULL where there is no such channel. */
const float *psplat_picture_channel(const psplat_picture *picture, const char *name);

/* What the picture says of how it was made, such as "psplat.seed"; psplat(1) lists them. NULL: it
 * has none such. */
const char *psplat_picture_attribute(const psplat_picture *picture, const char *name);

/* Writes an OpenEXR or PNG file, by the name's end (.exr, .png), as the command does: the former
 * has the layers that the option `layers` says, the latter what a display shows. The file appears
 * whole or not at all, and replaces any of that name, also one that the scene read. */
ps_result psplat_picture_write(const psplat_picture *picture, const char *path,
                               psplat_error *error);

#ifdef __cplusplus
}
#endif

#endif
