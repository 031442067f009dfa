/* pigment.h: colours and numbers that vary over a surface.
 *
 * A pigment is made once from its description and looked up at hits. Images are looked up by the
 * surface's (u, v), procedural kinds by the point, in the space that the description's placement
 * leads to; that is the space of the file or group that the object stands in, so a caller who has
 * points of a placed group takes them back first.
 *
 * Checker: cube (i, j, k) of side 1, from (i, j, k) to (i+1, j+1, k+1), has colors[0] where i+j+k
 * is even. Cubes start PATTERN_OFFSET early: a surface that lies in a plane between two cubes, up
 * to rounding, belongs to the upper ones as a whole.
 *
 * Gradient: (1 - t) colors[0] + t colors[1] with t the fractional part of the distance along the
 * axis; a surface in the plane where it starts over has colors[0], with the same tolerance.
 *
 * Noise: the same with t = (1 + f) / 2, clamped to 0..1, and f the fractal noise of noise.h.
 *
 * Turbulence displaces the point, before it is looked up, by that many times a vector of fractal
 * noise with TURBULENCE_OCTAVES octaves.
 */
#ifndef SCENE_PIGMENT_H
#define SCENE_PIGMENT_H

#include "scene/description.h"
#include "scene/texture.h"
#include <math.h>

/* Instead of the point where patterns are looked up, a surface may give what its mesh holds for
 * each vertex (material.h): the colour, or the second texture coordinates in x and y. */

#define PATTERN_OFFSET 0x1p-10f /* of a cube, or of the gradient's length */
#define TURBULENCE_OCTAVES 6

/* Plain data; may be copied. */
struct pigment {
    enum pigment_kind kind;
    ps_rgb colors[2];
    const struct texture *texture;       /* borrowed; image */
    int32_t channel;                     /* enum texture_channel; image */
    float scale[2], cross[2], offset[2]; /* u goes to scale * u + cross * v + offset; image */
    float log_scale; /* binary logarithm of the mean factor on lengths, of these or of to_pattern */
    bool second_uv;  /* image: by the point's x and y rather than by u and v */
    bool complement; /* image */
    bool vertex_colors;       /* times the point as a colour */
    bool bounded;             /* kept within 0..1, as reflectances are; image, vertex_colors */
    struct affine to_pattern; /* from the space of the points */
    ps_vec3 axis;             /* unit, or 0: all is colors[0]; gradient */
    int32_t octaves;          /* noise */
    float turbulence;
};

/* `textures` must outlive the pigment. The placement should have an inverse: where it has none the
 * whole surface has the colour of the pattern's origin. Octaves are kept within 1 and
 * NOISE_OCTAVES_LIMIT. */
struct pigment pigment_create(const struct pigment_description *description,
                              const struct texture *textures);

static inline bool pigment_is_constant(const struct pigment *pigment)
{
    return pigment->kind == PIGMENT_COLOR && !pigment->vertex_colors;
}

/* pigment_filter for kinds that vary. */
ps_rgb pigment_vary(const struct pigment *pigment, ps_vec3 point, const float uv[2],
                    float log_width);

/* pigment_color, images and noise as their mean over what a ray cone covers (ray_cone.h);
 * log_width: the binary logarithm of its width, for images by the surface's (u, v), for patterns by
 * points; -INFINITY for a point. */
static inline ps_rgb pigment_filter(const struct pigment *pigment, ps_vec3 point, const float uv[2],
                                    float log_width)
{
    return pigment_is_constant(pigment) ? pigment->colors[0]
                                        : pigment_vary(pigment, point, uv, log_width);
}

/* The colour at a point with the surface's (u, v), which may be 0, 0 where it has none. A channel
 * of an image gives grey. Any numbers are safe; any thread. */
static inline ps_rgb pigment_color(const struct pigment *pigment, ps_vec3 point, const float uv[2])
{
    return pigment_filter(pigment, point, uv, -INFINITY);
}

static inline float pigment_mean(ps_rgb color)
{
    return (color.r + color.g + color.b) * (1.0f / 3.0f);
}

/* The mean of the colour's parts, which for one channel of an image is that channel. */
static inline float pigment_number(const struct pigment *pigment, ps_vec3 point, const float uv[2])
{
    return pigment_mean(pigment_color(pigment, point, uv));
}

/* How pigment_number changes with the point, per unit of length: of procedural kinds; 0 for colours
 * and images. Of noise by its derivatives; of the others by central differences over about 1/50 of
 * the pattern's unit: the steps of a checker so get slopes of that width. */
ps_vec3 pigment_gradient(const struct pigment *pigment, ps_vec3 point);

/* Where an image is looked up: by the surface's (u, v), or the point where the pigment has it
 * so. */
void pigment_place(const struct pigment *pigment, ps_vec3 point, const float uv[2], float place[2]);

/* The derivatives of the position by an image's coordinates, from those by the surface's; 0 where
 * these do not tell. */
void pigment_tangents(const struct pigment *pigment, ps_vec3 *by_u, ps_vec3 *by_v);

/* How pigment_number changes with u and v: of images; 0 for the other kinds. By central differences
 * of half a texel to both sides, which makes the slopes continuous where bilinear interpolation
 * makes the values so; of half the cone's width, where that is wider. */
void pigment_uv_gradient(const struct pigment *pigment, const float uv[2], float log_width,
                         float gradient[2]);

#endif
