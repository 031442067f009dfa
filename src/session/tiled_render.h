/* tiled_render.h: a picture rendered tile by tile, in the memory of one.
 *
 * A tile is rendered with a margin, in which the denoiser finds the pixels that it looks at; what
 * it makes of the margin is dropped. Beyond the margin it sees nothing, so that a denoised picture
 * is not to the last bit that of one piece; one that is not denoised is.
 */
#ifndef SESSION_TILED_RENDER_H
#define SESSION_TILED_RENDER_H

#include "pipeline/render.h"

struct tiled_render {
    const struct scene *scene;
    struct render_settings *settings; /* with `tile` */
    const struct render_callbacks *callbacks;
    struct statistics *statistics;
    /* Is given each tile, in rows from the top, each from the left: where it lies in the picture,
     * and a part of the picture that holds it (image.window), of which it may take the channels.
     * The settings have no crop then. A failure ends the render. */
    ps_result (*take)(void *user, struct rectangle tile, struct image *part, struct error *error);
    void *user;
};

/* Sides of tiles are multiples of this. */
#define TILE_STEP 64

/* Sets the settings' crop to the largest tile of a picture, with its margin. PS_ERROR_INVALID where
 * a strategy goes by all of the picture. */
ps_result tiled_render_prepare(struct render_settings *settings, size_t width, size_t height,
                               struct error *error);

/* Renders. When cancelled, or where a tile fails, what there is of that tile is handed over, and no
 * other. */
ps_result tiled_render_run(const struct tiled_render *job, struct error *error);

#endif
