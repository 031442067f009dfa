/* ambient_occlusion.h: ambient light, less by what the picture shows near each point: the
 * estimators in screen space.
 *
 *     E(p) = irradiance * A(p)          W/m^2
 *
 * A, the visibility in 0..1, is the estimator's own. Where nothing is near it is 1, and the picture
 * that of the estimator `ambient`. No ray is traced: what the picture does not show does not
 * occlude.
 */
#ifndef PSPLAT_ESTIMATOR_AMBIENT_OCCLUSION_H
#define PSPLAT_ESTIMATOR_AMBIENT_OCCLUSION_H

#include <psplat/plugin.h>

/* Rows of the parameters `irradiance`, a ps_rgb, and `radius`, a ps_number_or_choice. */
#define AMBIENT_OCCLUSION_IRRADIANCE(state)                                                        \
    PS_COLOR(state, irradiance, "1", 0, INFINITY, "W/m^2",                                         \
             "indirect irradiance of a surface that nothing occludes")
#define AMBIENT_OCCLUSION_RADIUS(state)                                                            \
    PS_NUMBER_OR(state, radius, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN,                            \
                 ambient_occlusion_radius_choices, "scene units",                                  \
                 "how far things occlude; auto: 20 % of the scene's radius")

static const char *const ambient_occlusion_radius_choices[] = {"auto", NULL};

/* What the parameter says, in scene units. */
float ambient_occlusion_radius(const ps_host *host, ps_number_or_choice radius);

/* The picture of a pass: what its pixels see. */
struct screen {
    const ps_host *host;
    uint32_t width, height;
    uint32_t *places; /* for each pixel, row-major: tile * PS_TILE_PIXELS + lane; owned */
};

/* What a pixel sees. */
struct screen_point {
    ps_vec3 position, normal;
    float depth;
};

/* What lies at a place in the picture, in pixels; 0 outside of it, and where a pixel sees nothing.
 * Any thread. */
int screen_look(const struct screen *screen, float x, float y, struct screen_point *point);

/* What a length at a point covers of the picture, in pixels; 0 if the pixel has no neighbour. The
 * camera is not asked: of the offset to a neighbour's point, the part along the view is the
 * difference in depth, the rest is a pixel's width. Any thread. */
float screen_extent(const struct screen *screen, const struct screen_point *point, uint32_t x,
                    uint32_t y, float length);

/* The visibility of the point that pixel (x, y) sees. Any thread. */
typedef float (*screen_visibility)(const void *user, const struct screen *screen,
                                   const struct screen_point *point, uint32_t x, uint32_t y,
                                   const float numbers[4]);

/* Lights all pixels. In accumulate. */
ps_result ambient_occlusion_light(const ps_host *host, const ps_pass *pass, ps_rgb irradiance,
                                  screen_visibility visibility, const void *user);

#endif
