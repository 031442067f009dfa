/* plane_fit.c: see plane_fit.h. Loops take a run of LANES pixels at a time, with weights of zero
 * where they go too far, and keep as many sums, so that a compiler makes vectors of them without
 * changing the order of any sum. What pixels count by geometry is found once for all parts. */
#include "plane_fit.h"
#include "weights.h"

#include <string.h>

#define MARGIN REGRESSION_MARGIN
#define RIDGE 1e-3f /* of the slopes, of the fit's weight */
#define ROOM 0.2f   /* D over R, in pixels' sizes */

static void set_tangent_plane(const struct regression_light *light, size_t at, float slack,
                              struct regression_fit *fit)
{
    const struct regression *to = light->on;
    float width = (float)light->bandwidth * to->size[at], scale = 1.0f / width;
    float distance = slack * (to->distance > 0.0f ? to->distance : ROOM * width);
    ps_vec3 u, v, n = {to->normal[0][at], to->normal[1][at], to->normal[2][at]};
    ps_frame(n, &u, &v);
    const float us[3] = {u.x * scale, u.y * scale, u.z * scale};
    const float vs[3] = {v.x * scale, v.y * scale, v.z * scale};
    for (int i = 0; i < 3; i++) {
        fit->normal[i] = to->normal[i][at];
        fit->position[i] = to->position[i][at];
        fit->u[i] = us[i];
        fit->v[i] = vs[i];
    }
    fit->height_scale = 1.0f / (distance * distance);
    fit->bend_scale = ps_max(to->bend_scale / slack,
                             1.0f); /* normals of no surface, which are 0, have no weight */
    fit->gloss = to->gloss[at];
}

enum { W, WU, WV, WUU, WUV, WVV, MOMENTS };

struct sums {
    _Alignas(64) float moments[REGRESSION_IMAGES][MOMENTS][LANES]; /* of each part */
    float values[REGRESSION_MOST][3][LANES];                       /* w E, w u E, w v E */
};

/* Pixels of a run, the first of which is dx to the right of the centre and dy below it: their
 * weights by geometry, and their places in the tangent plane. */
struct pixels {
    _Alignas(64) float w[LANES], u[LANES], v[LANES];
    size_t at; /* in a plane */
    int dx, dy;
};

static PS_INLINED void add_to_part(const struct regression_light *light,
                                   const struct pixels *pixels, const struct regression_part *part,
                                   float moments[MOMENTS][LANES], struct sums *sums)
{
    _Alignas(64) float w[LANES], wu[LANES], wv[LANES];
    const float *u = pixels->u, *v = pixels->v;
    float y = (float)pixels->dy, xx = part->window.xx;
    float xy = 2.0f * part->window.xy * y, yy = part->window.yy * y * y;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float x = (float)(pixels->dx + i), near = above_zero(1.0f - (x * (xx * x + xy) + yy));
        w[i] = pixels->w[i] * near * near;
        wu[i] = w[i] * u[i];
        wv[i] = w[i] * v[i];
    }
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        moments[W][i] += w[i];
        moments[WU][i] += wu[i];
        moments[WV][i] += wv[i];
        moments[WUU][i] += wu[i] * u[i];
        moments[WUV][i] += wu[i] * v[i];
        moments[WVV][i] += wv[i] * v[i];
    }
    for (int c = part->first; c < part->end; c++) {
        const float *restrict value = light->values[c] + pixels->at;
#pragma omp simd
        for (int i = 0; i < LANES; i++) {
            sums->values[c][0][i] += w[i] * value[i];
            sums->values[c][1][i] += wu[i] * value[i];
            sums->values[c][2][i] += wv[i] * value[i];
        }
    }
}

static float total(const float lanes[LANES])
{
    float sum = 0.0f;
    for (int i = 0; i < LANES; i++)
        sum += lanes[i];
    return sum;
}

/* The normal equations, by Cholesky's decomposition. The ridge pulls slopes to 0 where all pixels
 * lie on a line. */
static void solve(const struct regression_part *part, float moments[MOMENTS][LANES],
                  const struct sums *sums, struct regression_fit *fit)
{
    float m[MOMENTS];
    for (int i = 0; i < MOMENTS; i++)
        m[i] = total(moments[i]);
    fit->weight = m[W];
    float ridge = RIDGE * m[W] + 0.02f; /* a weight of 0.02 pixels at least */
    float l00 = 1.0f / sqrtf(m[W]), l10 = m[WU] * l00, l20 = m[WV] * l00;
    float l11 = 1.0f / sqrtf(ps_max(m[WUU] + ridge - l10 * l10, 1e-20f));
    float l21 = (m[WUV] - l20 * l10) * l11;
    float l22 = 1.0f / sqrtf(ps_max(m[WVV] + ridge - l20 * l20 - l21 * l21, 1e-20f));
    for (int c = part->first; c < part->end; c++) {
        float r0 = total(sums->values[c][0]) * l00;
        float r1 = (total(sums->values[c][1]) - l10 * r0) * l11;
        float r2 = (total(sums->values[c][2]) - l20 * r0 - l21 * r1) * l22;
        float *plane = fit->plane[c];
        plane[2] = r2 * l22;
        plane[1] = (r1 - l21 * plane[2]) * l11;
        plane[0] = (r0 - l10 * plane[1] - l20 * plane[2]) * l00;
    }
}

/* The pixels of a row that any part's window reaches, away from the centre; false: none. */
static bool row_of_windows(const struct regression_parts *parts, int dy, int *first, int *last)
{
    *first = MARGIN;
    *last = -MARGIN;
    for (int i = 0; i < parts->count; i++) {
        int from, to;
        if (!regression_window_row(&parts->of[i].window, dy, &from, &to))
            continue;
        *first = smaller(*first, from);
        *last = larger(*last, to);
    }
    return *first <= *last;
}

static PS_INLINED void add_row(const struct regression_light *light,
                               const struct regression_fit *fit,
                               const struct regression_parts *parts, int dy, struct sums *sums)
{
    struct pixels pixels = {.dy = dy};
    int first, last;
    if (fit->y + dy < 0 || fit->y + dy >= (int)light->on->height ||
        !row_of_windows(parts, dy, &first, &last))
        return;
    int left = regression_start_of_run(fit->x + first);
    size_t run = regression_run(light->on, left, fit->y + dy);
    for (pixels.dx = left - fit->x; pixels.dx <= last; pixels.dx += LANES, run++) {
        if (!take_pixels(light->on, fit, run, pixels.w, pixels.u, pixels.v))
            continue;
        pixels.at = run * light->on->runs_apart;
        for (int i = 0; i < parts->count; i++)
            add_to_part(light, &pixels, &parts->of[i], sums->moments[i], sums);
    }
}

PS_EVERY_ISA static void add_rows(const struct regression_light *light,
                                  const struct regression_fit *fit,
                                  const struct regression_parts *parts, struct sums *sums)
{
    int rows = 0;
    for (int i = 0; i < parts->count; i++)
        rows = larger(rows, regression_window_rows(&parts->of[i].window));
    for (int dy = -rows; dy <= rows; dy++)
        add_row(light, fit, parts, dy, sums);
}

void regression_make_fit(const struct regression_light *light, const struct regression_parts *parts,
                         int x, int y, float slack, float (*plane)[3], struct regression_fit *fit)
{
    int first = parts->of[0].first, end = parts->of[parts->count - 1].end;
    struct sums sums;
    *fit = (struct regression_fit){
        .plane = plane, .x = x, .y = y, .valid = regression_shows_surface(light->on, x, y)};
    if (!fit->valid)
        return;
    memset(sums.moments[0], 0, (size_t)parts->count * sizeof sums.moments[0]);
    memset(sums.values[first], 0, (size_t)(end - first) * sizeof sums.values[0]);
    set_tangent_plane(light, regression_at(light->on, x, y), slack, fit);
    add_rows(light, fit, parts, &sums);
    for (int i = 0; i < parts->count; i++)
        solve(&parts->of[i], sums.moments[i], &sums, fit);
}
