/* camera.h: pbrt's camera and film as psplat's.
 *
 * pbrt's coordinates are left-handed, psplat's right-handed: the same numbers give a mirrored
 * picture. So the world's z axis is mirrored, unless the scene's own camera transform mirrors
 * already, as that of scenes made by right-handed programs does (`Scale -1 1 1` before the camera).
 * importer.mirror is the factor on z.
 */
#ifndef PBRT_CAMERA_H
#define PBRT_CAMERA_H

#include "pbrt/importer.h"

/* Once all before WorldBegin is read: sets importer.mirror. */
void camera_settle(struct importer *importer);

/* Writes the sections camera and image. */
void camera_write(struct importer *importer);

#endif
