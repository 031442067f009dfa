/* backdrop.h: the scene in dim grey, for things to be drawn over. */
#ifndef DEBUG_BACKDROP_H
#define DEBUG_BACKDROP_H

#include "debug/canvas.h"
#include "render/state.h"

/* Fills the canvas's upper left corner: albedo under a light at the camera, so that what has no
 * direct light is seen too, and a little direct light, brighter by `exposure` stops. */
void backdrop_draw(const struct render *render, double exposure, struct canvas *canvas);

#endif
