/* display.h: helps tone maps that work pixel by pixel. */
#ifndef PSPLAT_DISPLAY_H
#define PSPLAT_DISPLAY_H

#include <psplat/strategy.h>

/* A curve whose upper part bends towards 1 as film does, after the exponential map of Ferschin,
 * Tastl and Purgathofer 1994: f(x) = x up to the shoulder a, and 1 - (1 - a) exp(-(x - a) / (1 -
 * a)) beyond: value a and slope 1 on both sides of a. 0 <= a < 1. */
static inline double ps_shoulder(double x, double a)
{
    return x > a ? 1.0 - (1.0 - a) * exp((a - x) / (1.0 - a)) : x;
}

/* Brings one pixel into the range of a display. */
typedef void (*ps_map_pixel)(const void *state, float rgb[3]);

struct ps_mapped_picture {
    const void *state;
    const ps_display_view *picture;
    ps_map_pixel map;
};

static inline void ps_map_row(void *user, uint64_t row, uint32_t worker)
{
    const struct ps_mapped_picture *mapped = (const struct ps_mapped_picture *)user;
    const ps_display_view *picture = mapped->picture;
    size_t first = row * picture->width;
    (void)worker;
    for (size_t i = first; i < first + picture->width; i++) {
        float rgb[3] = {picture->r[i], picture->g[i], picture->b[i]};
        mapped->map(mapped->state, rgb);
        picture->r[i] = rgb[0];
        picture->g[i] = rgb[1];
        picture->b[i] = rgb[2];
    }
}

/* Maps all pixels of a picture: the body of ps_tonemap_vtable.map. */
static inline ps_result ps_map_pixels(const void *state, const ps_host *host,
                                      const ps_display_view *picture, ps_map_pixel map)
{
    struct ps_mapped_picture mapped = {state, picture, map};
    host->parallel_for(host, picture->height, ps_map_row, &mapped);
    return PS_OK;
}

#endif
