/* chromaticities.c: from a picture's primaries to those of Rec.709 with white D65, in which psplat
 * computes.
 *
 * Through CIE XYZ, with Bradford's adaptation of white (Lam 1985), as SMPTE RP 177 derives matrices
 * from chromaticities. What lies outside of Rec.709's gamut gets negative components, which stay.
 */
#include "image/raster_decode.h"

#include <math.h>
#include <string.h>

#define SAME 2e-4f /* files round to four digits */
#define LARGEST 1e37

static const struct chromaticities rec709 = {
    {0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, {0.3127f, 0.3290f}};

struct matrix {
    double m[3][3];
};

static struct matrix multiply(const struct matrix *a, const struct matrix *b)
{
    struct matrix product = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                product.m[i][j] += a->m[i][k] * b->m[k][j];
    return product;
}

static void apply(const struct matrix *a, const double v[3], double image[3])
{
    for (int i = 0; i < 3; i++)
        image[i] = a->m[i][0] * v[0] + a->m[i][1] * v[1] + a->m[i][2] * v[2];
}

/* Of one that has no inverse, what is not finite. */
static struct matrix invert(const struct matrix *a)
{
    struct matrix inverse;
    double determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int r = (j + 1) % 3, s = (j + 2) % 3, u = (i + 1) % 3, v = (i + 2) % 3;
            inverse.m[i][j] = a->m[r][u] * a->m[s][v] - a->m[r][v] * a->m[s][u];
        }
    for (int k = 0; k < 3; k++)
        determinant += a->m[0][k] * inverse.m[k][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse.m[i][j] /= determinant;
    return inverse;
}

/* Of luminance 1. */
static void xyz_of(const float xy[2], double xyz[3])
{
    xyz[0] = (double)xy[0] / (double)xy[1];
    xyz[1] = 1;
    xyz[2] = (1 - (double)xy[0] - (double)xy[1]) / (double)xy[1];
}

static struct matrix to_xyz(const struct chromaticities *c)
{
    const float *const primaries[3] = {c->red, c->green, c->blue};
    struct matrix columns;
    double white[3], weights[3];
    for (int k = 0; k < 3; k++) {
        double xyz[3];
        xyz_of(primaries[k], xyz);
        for (int i = 0; i < 3; i++)
            columns.m[i][k] = xyz[i];
    }
    xyz_of(c->white, white);
    struct matrix inverse = invert(&columns);
    apply(&inverse, white, weights);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            columns.m[i][k] *= weights[k];
    return columns;
}

static struct matrix adaptation(const float from[2], const float to[2])
{
    static const struct matrix bradford = {
        {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    struct matrix scaled = bradford, inverse = invert(&bradford);
    double xyz[3], cones[3], wanted[3];
    xyz_of(from, xyz);
    apply(&bradford, xyz, cones);
    xyz_of(to, xyz);
    apply(&bradford, xyz, wanted);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            scaled.m[i][k] *= wanted[i] / cones[i];
    return multiply(&inverse, &scaled);
}

static bool is_rec709(const struct chromaticities *c)
{
    float given[8], expected[8];
    memcpy(given, c, sizeof given);
    memcpy(expected, &rec709, sizeof expected);
    for (int i = 0; i < 8; i++)
        if (!(fabsf(given[i] - expected[i]) <= SAME))
            return false;
    return true;
}

static bool is_finite(const struct matrix *a)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(a->m[i][k]) < 1e3))
                return false;
    return true;
}

void chromaticities_to_rec709(const struct chromaticities *from, float *const planes[3],
                              size_t pixels)
{
    if (is_rec709(from))
        return;
    struct matrix into_xyz = to_xyz(from), out_of_xyz = to_xyz(&rec709);
    struct matrix adapted = adaptation(from->white, rec709.white);
    struct matrix all = multiply(&adapted, &into_xyz);
    out_of_xyz = invert(&out_of_xyz);
    all = multiply(&out_of_xyz, &all);
    if (!is_finite(&all))
        return;
    for (size_t i = 0; i < pixels; i++) {
        const double before[3] = {(double)planes[0][i], (double)planes[1][i], (double)planes[2][i]};
        double after[3];
        apply(&all, before, after);
        for (int k = 0; k < 3; k++)
            planes[k][i] = (float)fmax(-LARGEST, fmin(after[k], LARGEST));
    }
}
