/* film.c: the planes of a film, and their means over passes; film_add.c adds to them. */
#include "film/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Touched by one thread, now: when several threads touch new pages at once, they wait for each
 * other in the operating system, several times as long. */
static float *plane_create(size_t width, size_t height)
{
    size_t bytes = (width * height * sizeof(float) + 63) / 64 * 64;
    float *plane = aligned_alloc(64, bytes); /* compilers make calloc of malloc and memset */
    if (plane)
        memset(plane, 0, bytes);
    return plane;
}

static bool is_of_surfaces(int plane)
{
    return plane >= FILM_ALBEDO_R && plane <= FILM_VISIBLE;
}

static bool is_of_light(int plane)
{
    return plane < FILM_ON_REQUEST && !is_of_surfaces(plane);
}

ps_result film_add_plane(struct film *film, enum film_plane plane, struct error *error)
{
    film->has[plane] = true;
    film->planes[plane] = plane_create(film->width, film->height);
    return film->planes[plane]
               ? PS_OK
               : error_memory(error, film->width * film->height * sizeof(float), "the film");
}

static ps_result add_planes(struct film *film, bool (*wanted)(int plane), struct error *error)
{
    ps_result result = PS_OK;
    for (int plane = 0; plane < FILM_PLANES && result == PS_OK; plane++)
        if (wanted(plane))
            result = film_add_plane(film, (enum film_plane)plane, error);
    return result;
}

ps_result film_create(size_t width, size_t height, bool surfaces, struct film *film,
                      struct error *error)
{
    *film = (struct film){.width = width, .height = height, .window = {0, 0, width, height}};
    ps_result result = add_planes(film, is_of_light, error);
    if (result == PS_OK && surfaces)
        result = add_planes(film, is_of_surfaces, error);
    if (result != PS_OK)
        film_release(film);
    return result;
}

ps_result film_add_ids(struct film *film, struct error *error)
{
    size_t count = film->width * film->height;
    film->object = calloc(count, sizeof *film->object);
    film->material = calloc(count, sizeof *film->material);
    return film->object && film->material
               ? PS_OK
               : error_memory(error, 2 * count * sizeof *film->object, "ids of pixels");
}

static bool is_of_halves(int plane)
{
    return (plane >= FILM_COLOR_R && plane <= FILM_WEIGHT) || plane == FILM_COVERAGE;
}

static ps_result add_part(struct film *film, bool is_half, struct error *error)
{
    struct film **part = is_half ? &film->half : &film->odd;
    if (*part)
        return PS_OK;
    *part = malloc(sizeof **part);
    if (!*part)
        return error_memory(error, sizeof **part, "half the film");
    **part = (struct film){
        .width = film->width, .height = film->height, .window = film->window, .is_half = is_half};
    return PS_OK;
}

ps_result film_add_halves(struct film *film, struct error *error)
{
    ps_result result = add_part(film, false, error);
    return result == PS_OK ? add_planes(film->odd, is_of_halves, error) : result;
}

static bool is_reflected(int plane)
{
    return plane >= FILM_REFLECTED_R && plane <= FILM_REFLECTED_B;
}

static bool is_hard(int plane)
{
    return plane >= FILM_HARD_R && plane <= FILM_HARD_B;
}

ps_result film_add_reflected(struct film *film, bool hard_apart, struct error *error)
{
    ps_result result = add_planes(film, is_reflected, error);
    return result == PS_OK && hard_apart ? add_planes(film, is_hard, error) : result;
}

ps_result film_add_half_of_reflected(struct film *film, bool of_pass, struct error *error)
{
    ps_result result = add_part(film, of_pass, error);
    struct film *part = of_pass ? film->half : film->odd;
    return result == PS_OK ? film_add_reflected(part, film->has[FILM_HARD_R], error) : result;
}

static ps_result empty_planes(struct film *film, struct error *error)
{
    size_t bytes = film->width * film->height * sizeof(float);
    for (int plane = 0; plane < FILM_PLANES; plane++) {
        if (!film->has[plane])
            continue;
        if (film->planes[plane] && film->passes > 0)
            memset(film->planes[plane], 0, bytes);
        else if (!film->planes[plane])
            film->planes[plane] = plane_create(film->width, film->height);
        if (!film->planes[plane])
            return error_memory(error, bytes, "the film");
    }
    return PS_OK;
}

ps_result film_begin_pass(struct film *film, uint32_t number, struct error *error)
{
    ps_result result = empty_planes(film, error);
    if (result == PS_OK && film->odd)
        result = film_begin_pass(film->odd, number, error);
    if (result == PS_OK && film->half)
        result = film_begin_pass(film->half, number, error);
    film->number = number;
    film->passes = 0;
    return result;
}

static void release_part(struct film *part)
{
    if (part)
        film_release(part);
    free(part);
}

void film_release(struct film *film)
{
    release_part(film->odd);
    release_part(film->half);
    free(film->object);
    free(film->material);
    for (int plane = 0; plane < FILM_PLANES; plane++)
        free(film->planes[plane]);
    *film = (struct film){.passes = 0};
}

size_t film_bytes(const struct film *film)
{
    size_t planes = 0;
    for (int plane = 0; plane < FILM_PLANES; plane++)
        planes += film->planes[plane] != NULL;
    planes += (film->object != NULL) + (film->material != NULL);
    return film->width * film->height * sizeof(float) * planes +
           (film->odd ? film_bytes(film->odd) : 0) + (film->half ? film_bytes(film->half) : 0);
}

/* `film` may be NULL, or without the plane. */
static void average_light(const struct film *film, int plane)
{
    float *sums = film ? film->planes[plane] : NULL;
    float per_pass = film && film->passes ? 1.0f / (float)film->passes : 0.0f;
    for (size_t i = 0; sums && i < film->width * film->height; i++)
        sums[i] *= per_pass;
}

static void average_geometry(struct film *film, int plane)
{
    const float *visible = film->planes[FILM_VISIBLE];
    float *sums = film->planes[plane];
    for (size_t i = 0; sums && i < film->width * film->height; i++)
        sums[i] *= visible[i] > 0.0f ? 1.0f / visible[i] : 0.0f;
}

void film_average(struct film *film)
{
    for (int channel = 0; channel < 3; channel++) {
        average_light(film, FILM_DIRECT_R + channel);
        const struct film *const parts[] = {film, film->odd, film->half};
        for (int i = 0; i < 3; i++) {
            average_light(parts[i], FILM_REFLECTED_R + channel);
            average_light(parts[i], FILM_HARD_R + channel);
        }
    }
    if (!film->planes[FILM_DEPTH])
        return;
    for (int plane = FILM_ALBEDO_R; plane <= FILM_DEPTH; plane++)
        average_geometry(film, plane);
    average_geometry(film, FILM_GLOSS);
    for (size_t i = 0; i < film->width * film->height; i++)
        if (film->planes[FILM_VISIBLE][i] <= 0.0f)
            film->planes[FILM_DEPTH][i] = INFINITY;
}
