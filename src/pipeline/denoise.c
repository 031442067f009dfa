/* denoise.c: indirect light and the noisy parts of direct light, through the denoiser. */
#include "pipeline/denoise.h"

#include "base/clock.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void copy_rgb(const struct render *render, struct rgb_planes from, struct rgb_planes to)
{
    size_t bytes = pixels_of(render) * sizeof(float);
    memcpy(to.r, from.r, bytes);
    memcpy(to.g, from.g, bytes);
    memcpy(to.b, from.b, bytes);
}

void mend_rgb(struct render *render, struct rgb_planes planes, uint64_t *refused)
{
    size_t pixels = pixels_of(render);
    *refused +=
        mend_plane(planes.r, pixels) + mend_plane(planes.g, pixels) + mend_plane(planes.b, pixels);
}

/* What is denoised: the indirect light, or a part of the direct light. */
struct part {
    int first; /* plane of the film, FILM_REFLECTED_R or FILM_HARD_R; negative: indirect */
    struct rgb_planes light, copy;
    struct halves halves;
    const float *variance; /* see ps_image_view */
    float *estimate;       /* NULL: none is made */
};

static ps_image_view image_of(const struct render *render, const struct part *part)
{
    const struct halves *halves = &part->halves;
    const struct film *film = &render->film;
    float *const *planes = film->planes;
    return (ps_image_view){
        .size = sizeof(ps_image_view),
        .width = (uint32_t)film->width,
        .height = (uint32_t)film->height,
        .passes = film->passes,
        .r = part->light.r,
        .g = part->light.g,
        .b = part->light.b,
        .albedo_r = planes[FILM_ALBEDO_R],
        .albedo_g = planes[FILM_ALBEDO_G],
        .albedo_b = planes[FILM_ALBEDO_B],
        .normal_x = planes[FILM_NORMAL_X],
        .normal_y = planes[FILM_NORMAL_Y],
        .normal_z = planes[FILM_NORMAL_Z],
        .position_x = planes[FILM_POSITION_X],
        .position_y = planes[FILM_POSITION_Y],
        .position_z = planes[FILM_POSITION_Z],
        .depth = planes[FILM_DEPTH],
        .weight = planes[FILM_WEIGHT],
        .coverage = planes[FILM_COVERAGE],
        .object = film->object,
        .material = film->material,
        .even_r = halves->even.r,
        .even_g = halves->even.g,
        .even_b = halves->even.b,
        .odd_r = halves->odd.r,
        .odd_g = halves->odd.g,
        .odd_b = halves->odd.b,
        .gloss = planes[FILM_GLOSS],
        .error = part->estimate,
        .odd_share = halves->odd_share,
        .edge_samples = render->settings->aa_samples,
        .variance = part->variance,
    };
}

/* Where a pixel saw a surface in a part of its samples only, its light is the mean over all of
 * them, but its albedo and normal are those of the surface. A denoiser compares pixels by these, so
 * it gets the light of that part alone: of what is visible (`of_part`), or back to the mean. Of
 * gloss that is all: whether a path goes on to a surface or to the sky is a matter of chance there,
 * and so is a share of FILM_COVERAGE. */
static void scale_light(const struct film *film, bool of_part, float *light)
{
    const float *visible = film->planes[FILM_VISIBLE];
    for (size_t i = 0; light && i < film->width * film->height; i++) {
        float share = visible[i] / (float)film->passes;
        if (share > 0.0f && share < 1.0f)
            light[i] *= of_part ? 1.0f / share : share;
    }
}

/* The same for all that the denoiser is given; `estimate`, which it makes, is in the units of the
 * light. */
static void scale_all(const struct film *film, bool of_part, struct rgb_planes light,
                      const struct halves *halves, float *estimate)
{
    float *const planes[] = {light.r,        light.g,        light.b,       halves->even.r,
                             halves->even.g, halves->even.b, halves->odd.r, halves->odd.g,
                             halves->odd.b,  estimate};
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++)
        scale_light(film, of_part, planes[i]);
}

/* Three planes from `first` on: FILM_REFLECTED_R, or FILM_HARD_R. */
static struct rgb_planes planes_of(const struct film *film, int first)
{
    return (struct rgb_planes){film->planes[first], film->planes[first + 1],
                               film->planes[first + 2]};
}

/* What the odd share leaves of a mean. */
static void mean_of_rest(const float *mean, const float *odd_mean, float odd_share, size_t pixels,
                         float *rest)
{
    for (size_t i = 0; i < pixels; i++)
        rest[i] = fmaxf((mean[i] - odd_share * odd_mean[i]) / (1.0f - odd_share), 0.0f);
}

/* Half of the direct light, and how much of it that is; NULL where there is none. Where the film
 * has the odd passes, halves of each pass do not tell all of the noise. */
static const struct film *half_of_direct(const struct film *film, float *share)
{
    const struct film *odd = film->odd;
    bool has_odd = odd && odd->planes[FILM_REFLECTED_R] && odd->passes > 0;
    if (has_odd && odd->passes < film->passes) {
        *share = (float)odd->passes / (float)film->passes;
        return odd;
    }
    *share = 0.5f;
    return film->half;
}

static struct halves halves_of_direct(const struct film *film, int first, float *even)
{
    size_t pixels = film->width * film->height;
    float share;
    const struct film *half = half_of_direct(film, &share);
    for (int c = 0; c < 3; c++)
        mean_of_rest(film->planes[first + c], half->planes[first + c], share, pixels,
                     even + (size_t)c * pixels);
    return (struct halves){
        .even = planes_at(even, pixels), .odd = planes_of(half, first), .odd_share = share};
}

static bool denoises_direct(const struct render *render)
{
    float share;
    const struct film *film = &render->film;
    uint32_t flags = strategy_in(render, PS_DENOISER)->type->table.denoiser.flags;
    return flags & PS_DENOISER_DIRECT && film->planes[FILM_REFLECTED_R] &&
           half_of_direct(film, &share);
}

/* Sums of no light are zeros. */
static bool is_black(struct rgb_planes light, size_t n)
{
    bool black = true;
    for (size_t i = 0; i < n && black; i++)
        black = light.r[i] == 0.0f && light.g[i] == 0.0f && light.b[i] == 0.0f;
    return black;
}

static void replace(float *restrict sum, const float *restrict old, const float *restrict new,
                    size_t n)
{
    for (size_t i = 0; i < n; i++)
        sum[i] = fmaxf(sum[i] - old[i], 0.0f) + new[i];
}

enum { MOST_PARTS = 3 };
_Static_assert(MOST_PARTS <= PS_DENOISER_IMAGES, "all parts at once");

/* A denoiser weighs pixels once for all images that it has at a time, and needs room for all. */
#define MOST_ROOM 0x1p29 /* bytes that it may cost */

/* Of so many parts, how many at a time: one, where memory is short. The picture does not depend on
 * it. */
static size_t parts_at_once(const struct render *render, size_t count)
{
    const ps_denoiser_vtable *table = &strategy_in(render, PS_DENOISER)->type->table.denoiser;
    double pixels = (double)pixels_of(render), own = 6.0 * sizeof(float);
    double room = (double)(count - 1) * pixels * ((double)table->image_bytes + own);
    double all = room + pixels * ((double)table->pixel_bytes + own);
    bool together = table->filter_all && room <= MOST_ROOM && memory_allows(render->settings, all);
    return together ? count : 1;
}

static ps_result filter(const struct render *render, const struct part *parts, size_t count)
{
    const struct strategy *strategy = strategy_in(render, PS_DENOISER);
    const ps_denoiser_vtable *table = &strategy->type->table.denoiser;
    ps_image_view views[MOST_PARTS];
    for (size_t i = 0; i < count; i++)
        views[i] = image_of(render, &parts[i]);
    return count == 1 ? table->filter(strategy->state, strategy->host, views)
                      : table->filter_all(strategy->state, strategy->host, views, (uint32_t)count);
}

/* Together; where that fails, they stay as they are. */
static ps_result denoise_together(struct render *render, struct part *parts, size_t count,
                                  struct error *error)
{
    struct film *film = &render->film;
    double start = clock_seconds();
    for (size_t i = 0; i < count; i++) {
        copy_rgb(render, parts[i].light, parts[i].copy);
        scale_all(film, true, parts[i].light, &parts[i].halves, NULL);
    }
    ps_result result = filter(render, parts, count);
    for (size_t i = 0; i < count; i++)
        scale_all(film, false, parts[i].light, &parts[i].halves, parts[i].estimate);
    statistics_add_seconds(render->statistics, "denoise", clock_seconds() - start);
    result = render_judge(render, PS_DENOISER, result, error);
    for (size_t i = 0; i < count; i++) {
        if (result == PS_OK)
            mend_rgb(render, parts[i].light, &render->refused.pixels[2]);
        else
            copy_rgb(render, parts[i].copy, parts[i].light);
    }
    return result == PS_OK ? PS_OK
                           : leave_out(render, PS_DENOISER, result, "is not denoised", error);
}

/* The direct light has the part's in place of what it had. */
static void replace_direct(struct render *render, const struct part *part)
{
    struct film *film = &render->film;
    size_t pixels = pixels_of(render);
    replace(film->planes[FILM_DIRECT_R], part->copy.r, part->light.r, pixels);
    replace(film->planes[FILM_DIRECT_G], part->copy.g, part->light.g, pixels);
    replace(film->planes[FILM_DIRECT_B], part->copy.b, part->light.b, pixels);
}

/* Some parts, which are together in memory; `room` is for six planes of each. */
static ps_result denoise_some(struct render *render, struct part *parts, size_t count, float *room,
                              struct error *error)
{
    size_t pixels = pixels_of(render);
    for (size_t i = 0; i < count; i++, room += 6 * pixels) {
        parts[i].copy = planes_at(room, pixels);
        if (parts[i].first >= 0)
            parts[i].halves = halves_of_direct(&render->film, parts[i].first, room + 3 * pixels);
    }
    ps_result result = denoise_together(render, parts, count, error);
    for (size_t i = 0; i < count && result == PS_OK; i++)
        if (parts[i].first >= 0)
            replace_direct(render, &parts[i]);
    return result;
}

/* Of the direct light, what surfaces reflect, where the film has it apart. Noise of broad lights
 * would hide the edges of hard shadows, so light that casts them is smoothed by itself. */
static size_t add_direct_parts(const struct render *render, struct part *parts, size_t count)
{
    static const int firsts[] = {FILM_REFLECTED_R, FILM_HARD_R};
    const struct film *film = &render->film;
    for (size_t i = 0; i < 2 && denoises_direct(render); i++) {
        if (!film->planes[firsts[i]])
            continue;
        struct rgb_planes light = planes_of(film, firsts[i]);
        if (!is_black(light, pixels_of(render)))
            parts[count++] = (struct part){.first = firsts[i], .light = light};
    }
    return count;
}

/* What was splatted is smooth already, and what noise it has is not independent from pixel to
 * pixel, as denoisers suppose (plugins/denoiser/regression.c). In one pass it is kept from them;
 * several tell the noise of both. The normalization may have scaled the light. */
static bool keeps_splats_apart(const struct film *film)
{
    return film->passes == 1 && film->planes[FILM_SPLATTED_R];
}

static void take_splats_out(const struct film *film, struct rgb_planes light)
{
    float *const planes[3] = {light.r, light.g, light.b};
    for (int c = 0; c < 3 && keeps_splats_apart(film); c++) {
        float *splatted = film->planes[FILM_SPLATTED_R + c];
        const float *all = film->planes[FILM_COLOR_R + c];
        for (size_t i = 0; i < film->width * film->height; i++) {
            splatted[i] *= all[i] > 0.0f ? planes[c][i] / all[i] : 0.0f;
            planes[c][i] = fmaxf(planes[c][i] - splatted[i], 0.0f);
        }
    }
}

static void put_splats_back(const struct film *film, struct rgb_planes light)
{
    float *const planes[3] = {light.r, light.g, light.b};
    for (int c = 0; c < 3 && keeps_splats_apart(film); c++)
        for (size_t i = 0; i < film->width * film->height; i++)
            planes[c][i] += film->planes[FILM_SPLATTED_R + c][i];
}

ps_result denoise_film(struct render *render, struct rgb_planes indirect,
                       const struct halves *halves, float *estimate, struct error *error)
{
    struct part parts[MOST_PARTS] = {{
        .first = -1,
        .light = indirect,
        .halves = *halves,
        .variance = render->film.passes == 1 ? render->film.planes[FILM_VARIANCE] : NULL,
        .estimate = estimate,
    }};
    if (!strategy_in(render, PS_DENOISER)->type->table.denoiser.filter)
        return PS_OK;
    size_t count = add_direct_parts(render, parts, 1);
    size_t at_once = parts_at_once(render, count), plane = pixels_of(render) * sizeof(float);
    float *room = malloc(at_once * 6 * plane + 1);
    ps_result result = PS_OK;
    if (!room)
        return leave_out(render, PS_DENOISER, error_memory(error, 6 * plane, "the denoiser"),
                         "is not denoised", error);
    take_splats_out(&render->film, indirect);
    for (size_t i = 0; i < count && result == PS_OK; i += at_once)
        result = denoise_some(render, parts + i, at_once, room, error);
    put_splats_back(&render->film, indirect);
    free(room);
    return result;
}
