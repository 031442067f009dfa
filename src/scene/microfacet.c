#include "scene/microfacet.h"

#include "scene/fresnel.h"

#include <assert.h>

#define QUADRATURE 24 /* points in each of two dimensions */

static float square(float x)
{
    return x * x;
}

static float alpha_of(float roughness)
{
    return square(ps_max(roughness, MICROFACET_SMOOTHEST));
}

/* Smith's Lambda. */
static float shadowing(float alpha, ps_vec3 w)
{
    float cosine2 = square(w.z);
    float tangent2 = (1.0f - cosine2) / ps_max(cosine2, 1e-12f);
    return 0.5f * (sqrtf(1.0f + square(alpha) * ps_max(tangent2, 0.0f)) - 1.0f);
}

static float distribution(float alpha, ps_vec3 half)
{
    float denominator = square(half.z) * (square(alpha) - 1.0f) + 1.0f;
    return square(alpha) / (PS_PI * square(denominator));
}

static ps_vec3 half_way(ps_vec3 out, ps_vec3 in)
{
    return ps_normalize(ps_add(out, in));
}

/* Heitz 2018, listing 1: a point of the disc that the facets seen from `out` project to. */
ps_vec3 microfacet_sample(float roughness, ps_vec3 out, float u1, float u2)
{
    float alpha = alpha_of(roughness);
    ps_vec3 stretched = ps_normalize((ps_vec3){alpha * out.x, alpha * out.y, out.z});
    float radius = sqrtf(u1), phi = 2.0f * PS_PI * u2;
    float s = 0.5f * (1.0f + stretched.z);
    ps_vec3 side = {-stretched.y, stretched.x, 0.0f};
    float length = ps_length(side);
    ps_vec3 u = length > 1e-6f ? ps_scale(side, 1.0f / length) : (ps_vec3){1, 0, 0};
    ps_vec3 v = ps_cross(stretched, u);
    float x = radius * cosf(phi);
    float y = (1.0f - s) * sqrtf(ps_max(1.0f - x * x, 0.0f)) + s * radius * sinf(phi);
    float z = sqrtf(ps_max(1.0f - x * x - y * y, 0.0f));
    ps_vec3 facet = ps_add_scaled(ps_add_scaled(ps_scale(u, x), y, v), z, stretched);
    facet = ps_normalize((ps_vec3){alpha * facet.x, alpha * facet.y, ps_max(facet.z, 1e-6f)});
    return ps_normalize(ps_add_scaled(ps_scale(out, -1.0f), 2.0f * ps_dot(out, facet), facet));
}

float microfacet_pdf(float roughness, ps_vec3 out, ps_vec3 in)
{
    if (!(out.z > 0.0f && in.z > 0.0f))
        return 0.0f;
    float alpha = alpha_of(roughness);
    return distribution(alpha, half_way(out, in)) / (4.0f * out.z * (1.0f + shadowing(alpha, out)));
}

ps_rgb microfacet_weight(float roughness, ps_rgb f0, ps_vec3 out, ps_vec3 in)
{
    if (!(out.z > 0.0f && in.z > 0.0f))
        return (ps_rgb){0, 0, 0};
    float alpha = alpha_of(roughness);
    float seen = 1.0f + shadowing(alpha, out);
    ps_rgb fresnel = fresnel_schlick(f0, ps_dot(in, half_way(out, in)));
    return ps_rgb_scale(fresnel, seen / (seen + shadowing(alpha, in)));
}

ps_rgb microfacet_reflect(float roughness, ps_rgb f0, ps_vec3 out, ps_vec3 in)
{
    return ps_rgb_scale(microfacet_weight(roughness, f0, out, in),
                        microfacet_pdf(roughness, out, in));
}

/* Means over directions of incidence of the shares that F0 and its complement weigh. The first
 * number is 1 - (1 - t)^2, which puts more points to the steepest facets, whose light is lost. */
static void integrate(float roughness, float cosine, float *scale, float *bias)
{
    ps_vec3 out = {sqrtf(ps_max(1.0f - square(cosine), 0.0f)), 0.0f, cosine};
    *scale = *bias = 0.0f;
    for (int i = 0; i < QUADRATURE * QUADRATURE; i++) {
        int row = i / QUADRATURE, column = i % QUADRATURE;
        float rest = 1.0f - ((float)column + 0.5f) / QUADRATURE;
        float u2 = ((float)row + 0.5f) / QUADRATURE;
        float density = 2.0f * rest / (QUADRATURE * QUADRATURE);
        ps_vec3 in = microfacet_sample(roughness, out, 1.0f - square(rest), u2);
        float share = density * microfacet_weight(roughness, (ps_rgb){1, 1, 1}, out, in).r;
        float rise = share > 0.0f ? fresnel_rise(ps_dot(in, half_way(out, in))) : 0.0f;
        *scale += share * (1.0f - rise);
        *bias += share * rise;
    }
}

/* Rows and columns are where this many steps of equal length divide 0..1. */
static float grid_value(int i)
{
    return (float)i / (MICROFACET_TABLE_SIZE - 1);
}

/* The first of the two rows that a roughness lies between. */
static int row_of(float roughness)
{
    const float last = MICROFACET_TABLE_SIZE - 1;
    return (int)ps_min(ps_min(ps_max(roughness, 0.0f), 1.0f) * last, last - 1.0f);
}

void microfacet_tabulate(struct microfacet_table *table, float least, float most)
{
    for (int row = row_of(least); row <= row_of(most) + 1; row++) {
        if (table->is_known[row])
            continue;
        for (int column = 0; column < MICROFACET_TABLE_SIZE; column++)
            integrate(grid_value(row), ps_max(grid_value(column), 1e-3f),
                      &table->scale[row][column], &table->bias[row][column]);
        table->is_known[row] = true;
    }
}

/* A place in the table: a cell, and where in it. */
struct place {
    int row, column;
    float y, x;
};

static struct place place_of(const struct microfacet_table *table, float roughness, float cosine)
{
    const float last = MICROFACET_TABLE_SIZE - 1;
    float y = ps_min(ps_max(roughness, 0.0f), 1.0f) * last;
    float x = ps_min(ps_max(cosine, 0.0f), 1.0f) * last;
    int row = row_of(roughness), column = (int)ps_min(x, last - 1.0f);
    assert(table->is_known[row] && table->is_known[row + 1]);
    (void)table;
    return (struct place){row, column, y - (float)row, x - (float)column};
}

static float interpolate(const float table[MICROFACET_TABLE_SIZE][MICROFACET_TABLE_SIZE],
                         const struct place *at)
{
    const float *low = &table[at->row][at->column], *high = &table[at->row + 1][at->column];
    return (1.0f - at->y) * ((1.0f - at->x) * low[0] + at->x * low[1]) +
           at->y * ((1.0f - at->x) * high[0] + at->x * high[1]);
}

/* `single`: albedo of the single-bounce model where F0 is 1. */
static ps_rgb compensate(ps_rgb f0, float single)
{
    float lost = (1.0f - single) / ps_max(single, 1e-3f);
    return (ps_rgb){1.0f + f0.r * lost, 1.0f + f0.g * lost, 1.0f + f0.b * lost};
}

ps_rgb microfacet_compensation(const struct microfacet_table *table, ps_rgb f0, float roughness,
                               float eye)
{
    struct place at = place_of(table, roughness, eye);
    return compensate(f0, interpolate(table->scale, &at) + interpolate(table->bias, &at));
}

ps_rgb microfacet_albedo(const struct microfacet_table *table, ps_rgb f0, float roughness,
                         float out)
{
    struct place at = place_of(table, roughness, out);
    float scale = interpolate(table->scale, &at), bias = interpolate(table->bias, &at);
    ps_rgb single = {f0.r * scale + bias, f0.g * scale + bias, f0.b * scale + bias};
    return ps_rgb_multiply(single, compensate(f0, scale + bias));
}
