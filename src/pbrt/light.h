/* light.h: pbrt's lights as psplat's. */
#ifndef PBRT_LIGHT_H
#define PBRT_LIGHT_H

#include "pbrt/texture.h"

/* Adds what a LightSource statement says. */
void light_add(struct importer *importer, const struct statement *statement);

/* Adds an infinite light with a picture, times the colour, or of the statement's illuminance
 * (sky.c). */
void light_add_sky(struct importer *importer, const struct statement *statement, const char *file,
                   const double rgb[3]);

/* The mean of a picture's luminance; 1 where it can't be read, which is reported, or is black. */
double light_picture_luminance(struct importer *importer, const struct statement *statement,
                               const char *file);

/* The radiance of an AreaLightSource statement on a shape of that area in the scene; below 0: not
 * known. */
struct pattern light_emission(struct importer *importer, const struct statement *statement,
                              double area);

/* Reads the colour of a light, NAME and `scale`, and where there is a `total`, such as "power",
 * scales its luminance to it: `per_unit` is what a light of 1 has of it. */
void light_color(struct importer *importer, const struct statement *statement, const char *name,
                 const char *total, double per_unit, double rgb[3]);

#endif
