#include "film/film_sum.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static float *plane_of(const struct film *film, int plane)
{
    if (plane < FILM_SUM_OF_ODD)
        return film->planes[plane];
    if (plane < FILM_SUM_OF_HALF)
        return film->odd ? film->odd->planes[plane - FILM_SUM_OF_ODD] : NULL;
    return film->half ? film->half->planes[plane - FILM_SUM_OF_HALF] : NULL;
}

static ps_result copy_ids(const uint32_t *from, size_t count, uint32_t **ids, struct error *error)
{
    if (!from)
        return PS_OK;
    *ids = malloc(count * sizeof **ids);
    if (!*ids)
        return error_memory(error, count * sizeof **ids, "ids of pixels");
    memcpy(*ids, from, count * sizeof **ids);
    return PS_OK;
}

ps_result film_sum_create(const struct film *film, struct film_sum *sum, struct error *error)
{
    size_t pixels = film->width * film->height;
    *sum = (struct film_sum){.width = film->width, .height = film->height, .window = film->window};
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++) {
        bool wanted = plane == FILM_SUM_OF_SQUARES || plane_of(film, plane);
        if (wanted && !exact_plane_create(pixels, &sum->planes[plane]))
            return error_memory(error, pixels * sizeof(double), "sums of passes");
    }
    ps_result result = copy_ids(film->object, pixels, &sum->object, error);
    return result == PS_OK ? copy_ids(film->material, pixels, &sum->material, error) : result;
}

/* Makes the part of a film whose planes are those of the sum from `first` on, where it has any. */
static ps_result create_part(const struct film_sum *sum, int first, struct film **part,
                             struct error *error)
{
    bool any = false;
    struct film planes = {.width = sum->width,
                          .height = sum->height,
                          .window = sum->window,
                          .is_half = first == FILM_SUM_OF_HALF};
    for (int plane = 0; plane < FILM_PLANES; plane++)
        any |= planes.has[plane] = sum->planes[first + plane].high != NULL;
    if (!any)
        return PS_OK;
    *part = malloc(sizeof **part);
    if (!*part)
        return error_memory(error, sizeof **part, "half the film");
    **part = planes;
    return PS_OK;
}

ps_result film_sum_create_film(const struct film_sum *sum, struct film *film, struct error *error)
{
    size_t pixels = sum->width * sum->height;
    *film = (struct film){.width = sum->width, .height = sum->height, .window = sum->window};
    for (int plane = 0; plane < FILM_PLANES; plane++)
        film->has[plane] = sum->planes[plane].high != NULL;
    ps_result result = create_part(sum, FILM_SUM_OF_ODD, &film->odd, error);
    if (result == PS_OK)
        result = create_part(sum, FILM_SUM_OF_HALF, &film->half, error);
    if (result == PS_OK)
        result = film_begin_pass(film, 0, error);
    if (result == PS_OK)
        result = copy_ids(sum->object, pixels, &film->object, error);
    if (result == PS_OK)
        result = copy_ids(sum->material, pixels, &film->material, error);
    return result;
}

void film_sum_release(struct film_sum *sum)
{
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        exact_plane_release(&sum->planes[plane]);
    free(sum->object);
    free(sum->material);
    pass_set_release(&sum->passes);
    *sum = (struct film_sum){.width = 0};
}

void film_sum_clear(struct film_sum *sum)
{
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        exact_plane_clear(&sum->planes[plane]);
    sum->passes.count = 0;
}

size_t film_sum_bytes(const struct film_sum *sum)
{
    size_t bytes = sum->object ? 2 * sum->width * sum->height * sizeof *sum->object : 0;
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        bytes += exact_plane_bytes(&sum->planes[plane]);
    return bytes;
}

/* Planes are shared out among workers. */
struct plane_work {
    struct film_sum *sum; /* that changes */
    const struct film *film;
    const struct film_sum *other; /* that is read */
    _Atomic(bool) out_of_memory;
};

static bool add_squares(struct exact_plane *squares, const struct film *film)
{
    const float *r = film->planes[FILM_COLOR_R], *g = film->planes[FILM_COLOR_G],
                *b = film->planes[FILM_COLOR_B];
    float *values = malloc(squares->size * sizeof *values);
    for (size_t i = 0; values && i < squares->size; i++)
        values[i] = r[i] * r[i] + g[i] * g[i] + b[i] * b[i];
    bool added = values && exact_plane_add(squares, values);
    free(values);
    return added;
}

static void add_plane(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    struct plane_work *work = user;
    struct exact_plane *sums = &work->sum->planes[index];
    const struct film *film = work->film;
    bool added = true;
    if (!sums->high)
        return;
    if (index == FILM_SUM_OF_SQUARES)
        added = add_squares(sums, film);
    else if (index < FILM_SUM_OF_ODD || index >= FILM_SUM_OF_HALF || film->odd->passes > 0)
        added = exact_plane_add(sums, plane_of(film, (int)index));
    if (!added)
        atomic_store(&work->out_of_memory, true);
}

static void merge_plane(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    struct plane_work *work = user;
    struct exact_plane *sums = &work->sum->planes[index];
    if (sums->high && !exact_plane_merge(sums, &work->other->planes[index]))
        atomic_store(&work->out_of_memory, true);
}

static void round_plane(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct plane_work *work = user;
    const struct exact_plane *sums = &work->other->planes[index];
    if (index != FILM_SUM_OF_SQUARES && sums->high)
        exact_plane_round(sums, plane_of(work->film, (int)index));
}

/* What was added to some planes and not to others is no sum of passes. */
static ps_result over_planes(struct plane_work *work, parallel_body body, struct workers *workers,
                             struct error *error)
{
    parallel_for(workers, FILM_SUM_PLANES, body, work);
    if (!atomic_load(&work->out_of_memory))
        return PS_OK;
    work->sum->passes.count = 0;
    return error_memory(error, work->sum->width * work->sum->height * sizeof(double),
                        "sums of passes");
}

bool film_sum_fits(const struct film_sum *sum, const struct film *film)
{
    bool fits = sum->width == film->width && sum->height == film->height &&
                picture_window_same(sum->window, film->window);
    for (int plane = 0; plane < FILM_SUM_OF_SQUARES; plane++)
        fits &= !sum->planes[plane].high == !plane_of(film, plane);
    return fits && sum->planes[FILM_SUM_OF_SQUARES].high;
}

ps_result film_sum_add(struct film_sum *sum, const struct film *film, struct workers *workers,
                       struct error *error)
{
    struct plane_work work = {.sum = sum, .film = film};
    assert(film->passes == 1 && !pass_set_has(&sum->passes, film->number));
    ps_result result = pass_set_add(&sum->passes, film->number, film->number + 1, error);
    return result == PS_OK ? over_planes(&work, add_plane, workers, error) : result;
}

bool film_sum_has_planes_of(const struct film_sum *a, const struct film_sum *b)
{
    bool alike = !a->object == !b->object;
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        alike &= !a->planes[plane].high == !b->planes[plane].high;
    return alike;
}

bool film_sum_is_alike(const struct film_sum *a, const struct film_sum *b)
{
    return a->width == b->width && a->height == b->height &&
           picture_window_same(a->window, b->window) && film_sum_has_planes_of(a, b);
}

ps_result film_sum_merge(struct film_sum *sum, const struct film_sum *other,
                         struct workers *workers, struct error *error)
{
    struct plane_work work = {.sum = sum, .other = other};
    ps_result result = pass_set_add_all(&sum->passes, &other->passes, error);
    return result == PS_OK ? over_planes(&work, merge_plane, workers, error) : result;
}

void film_sum_round(const struct film_sum *sum, struct film *film, struct workers *workers)
{
    struct plane_work work = {.other = sum, .film = film};
    parallel_for(workers, FILM_SUM_PLANES, round_plane, &work);
    film->passes = pass_set_size(&sum->passes);
    if (film->odd)
        film->odd->passes = pass_set_odd_size(&sum->passes);
    if (film->half)
        film->half->passes = film->passes;
}
