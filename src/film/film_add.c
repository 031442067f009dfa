/* film_add.c: adds what a pass sees to a film, tile by tile; see film.h.
 *
 * Rows of a tile's pixels are added plane by plane, so that compilers make vectors of it. Pixels at
 * edges are added by their samples (view/edges.h), a row of which stands for one pixel.
 */
#include "film/film.h"

#include <assert.h>
#include <psplat/math.h>
#include <string.h>

static const struct glossy_tile no_gloss; /* depth 0 */

/* A row of a tile's pixels that are in the picture. */
struct tile_row {
    const ps_tile *tile;
    const ps_rgb *direct, *emitted;   /* of the row's pixels */
    const ps_rgb *hard;               /* likewise; NULL: none is denoised apart */
    const float *splatted[3];         /* likewise; NULL: the tile's irradiance has it */
    const struct glossy_tile *glossy; /* of the tile */
    size_t lane, pixel;               /* its first, in the tile and in the film */
    size_t count;
    float shares[PS_TILE_SIZE]; /* of what each gathered, that is added */
};

static bool ends_at_surface(const struct tile_row *row, size_t i)
{
    return row->tile->object[row->lane + i] != PS_NO_OBJECT;
}

/* Gloss, or a mirror with nothing behind: a surface on the way stands for the pixel. */
static bool has_first_surface(const struct tile_row *row, size_t i)
{
    return row->glossy->depth[row->lane + i] > 0.0f;
}

static bool met_gloss(const struct tile_row *row, size_t i)
{
    return has_first_surface(row, i) && !row->glossy->sharp[row->lane + i];
}

/* Adds shares of values to a plane, where the film has it. */
static void add_shares(struct film *film, int plane, const struct tile_row *row,
                       const float *values)
{
    if (!film->planes[plane])
        return;
    float *sums = film->planes[plane] + row->pixel;
    for (size_t i = 0; i < row->count; i++)
        sums[i] += row->shares[i] <= 0.0f ? 0.0f : row->shares[i] * values[i];
}

/* The same of what pixels see; where their paths end at no surface, nothing. */
static void add_seen(struct film *film, int plane, const struct tile_row *row, const float *values)
{
    float seen[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++)
        seen[i] = ends_at_surface(row, i) ? values[i] : 0.0f;
    add_shares(film, plane, row, seen);
}

/* The weight of a sample in the planes albedo to depth: 1 where it saw a surface or gloss, 2^-20
 * for a mirror with nothing behind, 0 for nothing. So a mirror is recorded only where no other
 * sample of the pixel saw a surface, and denoisers skip it: its light has no noise. A power of two
 * keeps sums exact. */
static float presence(const struct tile_row *row, size_t i)
{
    const float mirror = 0x1p-20f;
    if (met_gloss(row, i) || ends_at_surface(row, i))
        return 1.0f;
    return has_first_surface(row, i) ? mirror : 0.0f;
}

/* What tells surfaces apart: that of the first one on the way, where there is one. */
static void add_feature(struct film *film, int plane, const struct tile_row *row,
                        const float *values, const float *glossy)
{
    float features[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++) {
        float there = presence(row, i);
        float value = has_first_surface(row, i) ? glossy[row->lane + i] : values[i];
        features[i] = there > 0.0f ? there * value : 0.0f;
    }
    add_shares(film, plane, row, features);
}

static void add_emitted(struct film *film, const struct tile_row *row)
{
    if (!film->planes[FILM_DIRECT_R])
        return;
    for (size_t i = 0; i < row->count; i++) {
        if (row->shares[i] <= 0.0f)
            continue;
        film->planes[FILM_DIRECT_R][row->pixel + i] += row->shares[i] * row->emitted[i].r;
        film->planes[FILM_DIRECT_G][row->pixel + i] += row->shares[i] * row->emitted[i].g;
        film->planes[FILM_DIRECT_B][row->pixel + i] += row->shares[i] * row->emitted[i].b;
    }
}

/* One of red, green and blue, of a row. */
struct row_channel {
    const float *albedo, *throughput, *irradiance; /* indirect */
    const float *radiance;                         /* indirect; NULL: none */
    const float *splatted;                         /* indirect irradiance; NULL: none is apart */
    const float *glossy;                           /* reflectance, of the tile */
    float direct[PS_TILE_SIZE];                    /* irradiance */
    float hard[PS_TILE_SIZE];                      /* what of it is denoised apart */
    float emitted[PS_TILE_SIZE];                   /* radiance */
};

/* The direct light that a denoiser may smooth: what surfaces reflect and, where the path met gloss,
 * all that it collected. */
static void add_denoised(struct film *film, const struct tile_row *row, int channel,
                         const struct row_channel *from, const float albedo[PS_TILE_SIZE])
{
    float hard[PS_TILE_SIZE], rest[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++) {
        bool seen = ends_at_surface(row, i); /* else lanes hold no light, but whatever */
        float reflectance = albedo[i] * (1.0f / PS_PI);
        hard[i] = seen ? reflectance * from->hard[i] : 0.0f;
        rest[i] = seen ? reflectance * ps_max(from->direct[i] - from->hard[i], 0.0f) : 0.0f;
        rest[i] += met_gloss(row, i) ? from->emitted[i] : 0.0f;
    }
    add_shares(film, FILM_HARD_R + channel, row, hard);
    add_shares(film, FILM_REFLECTED_R + channel, row, rest);
}

/* What was splatted beside other indirect light becomes part of it, and is added apart as well. */
static void add_splatted(struct film *film, const struct tile_row *row, int channel,
                         const float *irradiance, const float albedo[PS_TILE_SIZE],
                         float indirect[PS_TILE_SIZE])
{
    float splatted[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++) {
        splatted[i] = albedo[i] * (1.0f / PS_PI) * irradiance[i];
        indirect[i] += splatted[i];
    }
    add_seen(film, FILM_SPLATTED_R + channel, row, splatted);
}

/* Adds one channel of direct and indirect light: albedo throughput / pi * irradiance. The
 * throughput includes 1 / probability of the lobes and 1 / eta^2 in glass, so albedo times
 * throughput can exceed 1; the albedo plane is limited to 1. */
static void add_reflected(struct film *film, const struct tile_row *row, int channel,
                          const struct row_channel *from)
{
    float albedo[PS_TILE_SIZE], direct[PS_TILE_SIZE], indirect[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++) {
        albedo[i] = from->albedo[i] * from->throughput[i];
        float reflectance = albedo[i] * (1.0f / PS_PI);
        direct[i] = reflectance * from->direct[i];
        indirect[i] = reflectance * from->irradiance[i];
    }
    for (size_t i = 0; from->radiance && i < row->count; i++)
        indirect[i] += from->throughput[i] * from->radiance[i];
    if (from->splatted)
        add_splatted(film, row, channel, from->splatted, albedo, indirect);
    add_seen(film, FILM_DIRECT_R + channel, row, direct);
    add_denoised(film, row, channel, from, albedo);
    add_seen(film, FILM_COLOR_R + channel, row, indirect);
    for (size_t i = 0; i < row->count; i++)
        albedo[i] = ps_min(albedo[i], 1.0f);
    add_feature(film, FILM_ALBEDO_R + channel, row, albedo, from->glossy);
}

/* Where the first surface on the way stands for the pixel, the irradiance is not that one's. */
static void add_variance(struct film *film, const struct tile_row *row)
{
    float variance[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++)
        variance[i] = has_first_surface(row, i) ? 0.0f : row->tile->variance[row->lane + i];
    add_seen(film, FILM_VARIANCE, row, variance);
}

static void add_light(struct film *film, const struct tile_row *row)
{
    const ps_tile *tile = row->tile;
    const struct glossy_tile *glossy = row->glossy;
    size_t lane = row->lane;
    struct row_channel channels[3] = {
        {.albedo = tile->albedo_r + lane,
         .throughput = tile->throughput_r + lane,
         .irradiance = tile->irradiance_r + lane,
         .radiance = tile->radiance_r ? tile->radiance_r + lane : NULL,
         .splatted = row->splatted[0],
         .glossy = glossy->reflectance_r},
        {.albedo = tile->albedo_g + lane,
         .throughput = tile->throughput_g + lane,
         .irradiance = tile->irradiance_g + lane,
         .radiance = tile->radiance_g ? tile->radiance_g + lane : NULL,
         .splatted = row->splatted[1],
         .glossy = glossy->reflectance_g},
        {.albedo = tile->albedo_b + lane,
         .throughput = tile->throughput_b + lane,
         .irradiance = tile->irradiance_b + lane,
         .radiance = tile->radiance_b ? tile->radiance_b + lane : NULL,
         .splatted = row->splatted[2],
         .glossy = glossy->reflectance_b},
    };
    for (size_t i = 0; i < row->count; i++) {
        channels[0].direct[i] = row->direct[i].r;
        channels[1].direct[i] = row->direct[i].g;
        channels[2].direct[i] = row->direct[i].b;
        ps_rgb hard = row->hard ? row->hard[i] : (ps_rgb){0, 0, 0};
        channels[0].hard[i] = hard.r;
        channels[1].hard[i] = hard.g;
        channels[2].hard[i] = hard.b;
        channels[0].emitted[i] = row->emitted[i].r;
        channels[1].emitted[i] = row->emitted[i].g;
        channels[2].emitted[i] = row->emitted[i].b;
    }
    add_emitted(film, row);
    for (int channel = 0; channel < 3; channel++)
        add_reflected(film, row, channel, &channels[channel]);
    add_variance(film, row);
}

static void add_geometry(struct film *film, const struct tile_row *row)
{
    const ps_tile *tile = row->tile;
    const struct glossy_tile *glossy = row->glossy;
    size_t lane = row->lane;
    float ones[PS_TILE_SIZE], visible[PS_TILE_SIZE], zeros[PS_TILE_SIZE];
    for (size_t i = 0; i < row->count; i++) {
        ones[i] = 1.0f;
        zeros[i] = 0.0f;
        visible[i] = presence(row, i);
    }
    add_seen(film, FILM_WEIGHT, row, tile->weight + lane);
    add_seen(film, FILM_COVERAGE, row, ones);
    add_shares(film, FILM_VISIBLE, row, visible);
    add_feature(film, FILM_NORMAL_X, row, tile->normal_x + lane, glossy->normal_x);
    add_feature(film, FILM_NORMAL_Y, row, tile->normal_y + lane, glossy->normal_y);
    add_feature(film, FILM_NORMAL_Z, row, tile->normal_z + lane, glossy->normal_z);
    add_feature(film, FILM_POSITION_X, row, tile->position_x + lane, glossy->position_x);
    add_feature(film, FILM_POSITION_Y, row, tile->position_y + lane, glossy->position_y);
    add_feature(film, FILM_POSITION_Z, row, tile->position_z + lane, glossy->position_z);
    add_feature(film, FILM_DEPTH, row, tile->depth + lane, glossy->depth);
    add_feature(film, FILM_GLOSS, row, zeros, glossy->gloss);
}

static void keep_ids(struct film *film, const struct tile_row *row)
{
    memcpy(film->object + row->pixel, row->tile->object + row->lane,
           row->count * sizeof *film->object);
    memcpy(film->material + row->pixel, row->tile->material + row->lane,
           row->count * sizeof *film->material);
}

static struct tile_row row_of(const struct film *film, const struct gbuffer *gbuffer, uint32_t tile,
                              size_t lane, size_t pixel, size_t count)
{
    size_t first = (size_t)tile * PS_TILE_PIXELS + lane;
    bool half = film->is_half && gbuffer->direct_half;
    const ps_rgb *hard = half ? gbuffer->hard_half : gbuffer->hard;
    struct tile_row row = {
        .tile = &gbuffer->tiles[tile],
        .direct = half ? &gbuffer->direct_half[first] : &gbuffer->direct[first],
        .hard = hard ? &hard[first] : NULL,
        .emitted = &gbuffer->emitted[first],
        .glossy = gbuffer->glossy ? &gbuffer->glossy[tile] : &no_gloss,
        .lane = lane,
        .pixel = pixel,
        .count = count,
    };
    for (int c = 0; c < 3 && gbuffer->splatted; c++)
        row.splatted[c] = gbuffer_splatted(gbuffer, tile, c) + lane;
    return row;
}

static size_t at_most_a_tile(size_t pixels)
{
    return pixels < PS_TILE_SIZE ? pixels : PS_TILE_SIZE;
}

static bool is_odd_pass(const struct film *film)
{
    return film->odd && film->number % 2 == 1;
}

/* Which pixels of a tile are in the film: columns and rows from x and y on, counted in the tile. */
static struct rectangle part_in_film(const struct film *film, const struct gbuffer *gbuffer,
                                     uint32_t tile)
{
    const struct picture_window *window = &film->window;
    uint32_t x, y;
    gbuffer_pixel(gbuffer, tile, 0, &x, &y);
    struct rectangle part = {window->left > x ? window->left - x : 0,
                             window->top > y ? window->top - y : 0, 0, 0};
    size_t right = window->left + film->width, bottom = window->top + film->height;
    size_t end_x = right > x ? at_most_a_tile(right - x) : 0;
    size_t end_y = bottom > y ? at_most_a_tile(bottom - y) : 0;
    if (part.x < end_x && part.y < end_y) {
        part.width = end_x - part.x;
        part.height = end_y - part.y;
    }
    return part;
}

/* The pixels of that part in row `i` of it. */
static struct tile_row row_of_part(const struct film *film, const struct gbuffer *gbuffer,
                                   uint32_t tile, const struct rectangle *part, size_t i)
{
    uint32_t x, y;
    gbuffer_pixel(gbuffer, tile, 0, &x, &y);
    size_t column = x + part->x - film->window.left, row = y + part->y + i - film->window.top;
    return row_of(film, gbuffer, tile, (part->y + i) * PS_TILE_SIZE + part->x,
                  row * film->width + column, part->width);
}

bool film_has_pixel(const struct film *film, size_t x, size_t y)
{
    const struct picture_window *window = &film->window;
    return x >= window->left && y >= window->top && x - window->left < film->width &&
           y - window->top < film->height;
}

bool film_has_tile(const struct film *film, const struct gbuffer *gbuffer, uint32_t tile)
{
    return part_in_film(film, gbuffer, tile).width > 0;
}

void film_add_tile(struct film *film, const struct gbuffer *gbuffer, uint32_t index,
                   const uint8_t left_out[PS_TILE_PIXELS])
{
    assert(index < gbuffer->tile_count);
    const struct rectangle part = part_in_film(film, gbuffer, index);
    for (size_t y = 0; y < part.height; y++) {
        struct tile_row row = row_of_part(film, gbuffer, index, &part, y);
        for (size_t k = 0; k < row.count; k++)
            row.shares[k] = left_out && left_out[row.lane + k] ? 0.0f : 1.0f;
        add_light(film, &row);
        add_geometry(film, &row);
    }
    if (is_odd_pass(film))
        film_add_tile(film->odd, gbuffer, index, left_out);
    if (film->half)
        film_add_tile(film->half, gbuffer, index, left_out);
}

void film_keep_ids(struct film *film, const struct gbuffer *gbuffer, uint32_t index)
{
    const struct rectangle part = part_in_film(film, gbuffer, index);
    for (size_t y = 0; film->object && y < part.height; y++) {
        struct tile_row row = row_of_part(film, gbuffer, index, &part, y);
        keep_ids(film, &row);
    }
}

/* Only where all samples met gloss does their difference tell noise: at the edge of a glossy
 * surface they see different surfaces. */
static bool all_met_gloss(const struct gbuffer *gbuffer, uint32_t first, uint32_t count)
{
    bool all = gbuffer->glossy != NULL;
    for (uint32_t i = first; i < first + count && all; i++)
        all = gbuffer->glossy->depth[i] > 0.0f && !gbuffer->glossy->sharp[i];
    return all;
}

static void add_half_of_samples(struct film *half, const struct gbuffer *gbuffer, uint32_t first,
                                uint32_t count, float share, size_t x, size_t y)
{
    struct gbuffer whole = *gbuffer;
    uint32_t skipped = count / 2, left = count - skipped;
    if (count == 1 || !all_met_gloss(gbuffer, first, count)) {
        film_add_samples(half, gbuffer, first, count, share, x, y);
        return;
    }
    whole.direct_half = NULL;
    film_add_samples(half, &whole, first + skipped, left, share * (float)count / (float)left, x, y);
}

void film_add_samples(struct film *film, const struct gbuffer *gbuffer, uint32_t first,
                      uint32_t count, float share, size_t x, size_t y)
{
    float sums[FILM_PLANES][PS_TILE_SIZE] = {{0.0f}};
    size_t pixel = (y - film->window.top) * film->width + x - film->window.left;
    assert(film_has_pixel(film, x, y));
    struct film row_of_sums = {.width = PS_TILE_SIZE, .height = 1};
    for (int plane = 0; plane < FILM_PLANES; plane++)
        row_of_sums.planes[plane] = film->planes[plane] ? sums[plane] : NULL;
    for (uint32_t done = 0; done < count; done += PS_TILE_SIZE) {
        struct tile_row row =
            row_of(film, gbuffer, 0, first + done, 0, at_most_a_tile(count - done));
        for (size_t i = 0; i < row.count; i++)
            row.shares[i] = share;
        add_light(&row_of_sums, &row);
        add_geometry(&row_of_sums, &row);
    }
    for (int plane = 0; plane < FILM_PLANES; plane++)
        for (size_t i = 0; i < PS_TILE_SIZE && film->planes[plane]; i++)
            film->planes[plane][pixel] += sums[plane][i];
    if (is_odd_pass(film))
        film_add_samples(film->odd, gbuffer, first, count, share, x, y);
    if (film->half)
        add_half_of_samples(film->half, gbuffer, first, count, share, x, y);
}

void film_end_pass(struct film *film)
{
    film->passes = 1;
    if (film->odd)
        film->odd->passes = is_odd_pass(film);
    if (film->half)
        film->half->passes = 1;
}
