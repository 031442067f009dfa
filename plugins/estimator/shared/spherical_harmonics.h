/* spherical_harmonics.h: functions on the sphere by their four coefficients of orders 0 and 1
 * (real, orthonormal).
 *
 *     f(w) = c_0 Y_0 + (c_1, c_2, c_3).w Y_1,   Y_0 = 1 / (2 sqrt(pi)),   Y_1 = sqrt(3 / (4 pi))
 *
 * Ramamoorthi and Hanrahan 2001, "An efficient representation for irradiance environment maps";
 * Sloan 2008, "Stupid spherical harmonics tricks". Four coefficients hold a direction and how
 * narrow the function is around it, up to 1/4 + cos/2 for a clamped cosine, and nothing finer; they
 * may be negative opposite to it.
 */
#ifndef PSPLAT_ESTIMATOR_SPHERICAL_HARMONICS_H
#define PSPLAT_ESTIMATOR_SPHERICAL_HARMONICS_H

#include <psplat/math.h>

#define SH_Y0 0.28209479f
#define SH_Y1 0.48860251f

struct sh {
    float c[4]; /* of order 0, and of order 1 along x, y, z */
};

/* The integral of f over the sphere. */
static inline float sh_integral(const struct sh *f)
{
    return f->c[0] / SH_Y0;
}

/* max(0, axis.w), projected: its integral is pi. */
static inline struct sh sh_clamped_cosine(ps_vec3 axis)
{
    const float order0 = 0.88622693f, order1 = 1.02332671f; /* sqrt(pi) / 2, sqrt(pi / 3) */
    return (struct sh){{order0, order1 * axis.x, order1 * axis.y, order1 * axis.z}};
}

/* The integral of the product of two functions. */
static inline float sh_dot(const struct sh *f, const struct sh *g)
{
    return f->c[0] * g->c[0] + f->c[1] * g->c[1] + f->c[2] * g->c[2] + f->c[3] * g->c[3];
}

static inline void sh_add_scaled(struct sh *sum, float s, const struct sh *f)
{
    for (int i = 0; i < 4; i++)
        sum->c[i] += s * f->c[i];
}

/* One function for each channel. */
struct sh_rgb {
    struct sh r, g, b;
};

static inline void sh_rgb_add_scaled(struct sh_rgb *sum, ps_rgb s, const struct sh *f)
{
    sh_add_scaled(&sum->r, s.r, f);
    sh_add_scaled(&sum->g, s.g, f);
    sh_add_scaled(&sum->b, s.b, f);
}

static inline ps_rgb sh_rgb_dot(const struct sh_rgb *f, const struct sh *g)
{
    return (ps_rgb){sh_dot(&f->r, g), sh_dot(&f->g, g), sh_dot(&f->b, g)};
}

#endif
