/* tiled_render.h: a picture too large for the memory, rendered tile by tile straight into its files.
 *
 * A tile is rendered with a margin, in which the denoiser finds the pixels that it looks at; what it makes of the margin is
 * dropped. Beyond the margin it sees nothing, so that a denoised picture is not to the last bit that of one piece; one
 * that is not denoised is.
 */
#ifndef SESSION_TILED_RENDER_H
#define SESSION_TILED_RENDER_H

#include "pipeline/render.h"
#include "session/output.h"

struct tiled_render {
    const struct scene *scene;
    const char *scene_path;
    const struct scene_options *scene_options;
    struct render_settings *settings; /* with `tile` */
    const struct render_callbacks *callbacks;
    struct statistics *statistics;
    const char *const *paths; /* of the files */
    size_t path_count;
    const struct output_options *output;
};

/* Sides of tiles are multiples of this. */
#define TILE_STEP 64

/* Sets the settings' crop to the largest tile of a picture, with its margin. PS_ERROR_INVALID where a strategy goes by all of the
 * picture. */
ps_result tiled_render_prepare(struct render_settings *settings, size_t width, size_t height,
                               struct error *error);

/* Renders and writes. When cancelled, or where a tile fails, the files hold those that were done, and are black elsewhere; where
 * they cannot be written, there are none. */
ps_result tiled_render_run(const struct tiled_render *job, struct error *error);

#endif
