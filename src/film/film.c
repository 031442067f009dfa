#include "film/film.h"

#include <psplat/math.h>
#include <stdlib.h>

ps_result film_create(size_t width, size_t height, struct film *film, struct error *error)
{
    *film = (struct film){.width = width, .height = height};
    for (int plane = 0; plane < FILM_PLANES; plane++) {
        film->planes[plane] = calloc(width * height, sizeof(float));
        if (!film->planes[plane]) {
            film_release(film);
            return error_memory(error, width * height * sizeof(float) * FILM_PLANES, "the film");
        }
    }
    return PS_OK;
}

void film_release(struct film *film)
{
    for (int plane = 0; plane < FILM_PLANES; plane++)
        free(film->planes[plane]);
    *film = (struct film){.passes = 0};
}

size_t film_bytes(const struct film *film)
{
    return film->width * film->height * sizeof(float) * FILM_PLANES;
}

static void add_color(struct film *film, enum film_plane red, size_t pixel, ps_rgb color)
{
    film->planes[red][pixel] += color.r;
    film->planes[red + 1][pixel] += color.g;
    film->planes[red + 2][pixel] += color.b;
}

static void add_vector(struct film *film, enum film_plane x, size_t pixel, ps_vec3 vector)
{
    add_color(film, x, pixel, (ps_rgb){vector.x, vector.y, vector.z});
}

/* The share of the light that arrives where a pixel looks, and that its albedo and the way to the
 * camera leave. */
static ps_rgb reflectance_of(const ps_tile *tile, uint32_t lane)
{
    ps_rgb albedo = {tile->albedo_r[lane], tile->albedo_g[lane], tile->albedo_b[lane]};
    ps_rgb throughput = {tile->throughput_r[lane], tile->throughput_g[lane],
                         tile->throughput_b[lane]};
    return ps_rgb_multiply(albedo, throughput);
}

static void add_lane(struct film *film, const ps_tile *tile, ps_rgb direct, uint32_t lane,
                     size_t pixel)
{
    if (tile->object[lane] == PS_NO_OBJECT)
        return;
    ps_rgb albedo = reflectance_of(tile, lane);
    ps_rgb reflectance = ps_rgb_scale(albedo, 1.0f / PS_PI);
    ps_rgb irradiance = {tile->irradiance_r[lane], tile->irradiance_g[lane],
                         tile->irradiance_b[lane]};
    add_color(film, FILM_DIRECT_R, pixel, ps_rgb_multiply(reflectance, direct));
    add_color(film, FILM_COLOR_R, pixel, ps_rgb_multiply(reflectance, irradiance));
    add_color(film, FILM_ALBEDO_R, pixel, albedo);
    ps_vec3 normal = {tile->normal_x[lane], tile->normal_y[lane], tile->normal_z[lane]};
    ps_vec3 position = {tile->position_x[lane], tile->position_y[lane], tile->position_z[lane]};
    add_vector(film, FILM_NORMAL_X, pixel, normal);
    add_vector(film, FILM_POSITION_X, pixel, position);
    film->planes[FILM_WEIGHT][pixel] += tile->weight[lane];
    film->planes[FILM_DEPTH][pixel] += tile->depth[lane];
    film->planes[FILM_COVERAGE][pixel] += 1.0f;
}

void film_add_tile(struct film *film, const struct gbuffer *gbuffer, uint32_t index)
{
    const ps_tile *tile = &gbuffer->tiles[index];
    const ps_rgb *direct = &gbuffer->direct[(size_t)index * PS_TILE_PIXELS];
    const ps_rgb *emitted = &gbuffer->emitted[(size_t)index * PS_TILE_PIXELS];
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        if (!gbuffer_pixel(gbuffer, index, lane, &x, &y))
            continue;
        add_color(film, FILM_DIRECT_R, y * film->width + x, emitted[lane]);
        add_lane(film, tile, direct[lane], lane, y * film->width + x);
    }
}

void film_count_pass(struct film *film)
{
    film->passes++;
}

static void scale_planes(struct film *film, int first, int last, size_t pixel, float factor)
{
    for (int plane = first; plane <= last; plane++)
        film->planes[plane][pixel] *= factor;
}

void film_average(struct film *film)
{
    float per_pass = film->passes ? 1.0f / (float)film->passes : 0.0f;
    for (size_t pixel = 0; pixel < film->width * film->height; pixel++) {
        float coverage = film->planes[FILM_COVERAGE][pixel];
        scale_planes(film, FILM_DIRECT_R, FILM_DIRECT_B, pixel, per_pass);
        scale_planes(film, FILM_ALBEDO_R, FILM_DEPTH, pixel, coverage > 0 ? 1.0f / coverage : 0.0f);
        if (coverage <= 0.0f)
            film->planes[FILM_DEPTH][pixel] = INFINITY;
    }
}
