/* light_sky.c: light from all around: one radiance, or a picture by longitude and latitude.
 *
 * The picture is interpolated bilinearly, for skies that are seen. Directions are chosen by a table
 * with one cell a pixel (Pharr, Jakob and Humphreys, "Physically based rendering", on image
 * infinite lights): the chance of a cell is the luminance that the interpolated picture has in it
 * on average, times its solid angle, so a cell is dark only where all of the picture in it is.
 * Inside a cell directions are uniform by solid angle (even in longitude and in the cosine of the
 * polar angle), which leaves no sine to divide by at the poles. A sky of one radiance is looked at
 * by the cosine at the surface that it lights, where only that counts: each sample then tells the
 * same, or meets what is in the way. Light paths start as those of a sun.
 */
#include "scene/light_kinds.h"

#include <stdlib.h>

/* A place in the picture, both in [0,1]. */
struct place {
    double u, v;
};

static struct place place_of(const struct light_sky *sky, ps_vec3 direction)
{
    double x = (double)direction.x, z = (double)direction.z;
    double u = 0.5 + atan2(x, -z) / (2.0 * PI_DOUBLE) + (double)sky->turn;
    return (struct place){u - floor(u), atan2(hypot(x, z), (double)direction.y) / PI_DOUBLE};
}

static double polar_angle(const struct light_sky *sky, size_t row)
{
    return PI_DOUBLE * (double)row / (double)sky->picture.height;
}

/* cos a - cos b, without their difference. */
static double between_cosines(double a, double b)
{
    return 2.0 * sin(0.5 * (a + b)) * sin(0.5 * (b - a));
}

static double cell_solid_angle(const struct light_sky *sky, size_t row)
{
    double height = between_cosines(polar_angle(sky, row), polar_angle(sky, row + 1));
    return 2.0 * PI_DOUBLE / (double)sky->picture.width * height;
}

/* A pixel of the picture, times the sky's radiance. */
static ps_rgb pixel(const struct light_sky *sky, size_t column, size_t row)
{
    const float *rgb = sky->picture.rgb[row * sky->picture.width + column];
    return ps_rgb_multiply(sky->radiance,
                           (ps_rgb){fmaxf(rgb[0], 0.0f), fmaxf(rgb[1], 0.0f), fmaxf(rgb[2], 0.0f)});
}

/* --- interpolation --- */

/* Two neighbours along an axis, and how much the second counts. */
struct blend {
    size_t first, second;
    float share;
};

/* The picture goes round. */
static struct blend blend_columns(const struct light_sky *sky, double u)
{
    size_t width = sky->picture.width;
    double x = u * (double)width - 0.5, low = floor(x);
    size_t first = low < 0.0 ? width - 1 : (size_t)low % width;
    return (struct blend){first, (first + 1) % width, (float)(x - low)};
}

static struct blend blend_rows(const struct light_sky *sky, double v)
{
    size_t last = sky->picture.height - 1;
    double y = fmin(fmax(v * (double)sky->picture.height - 0.5, 0.0), (double)last);
    size_t first = (size_t)y;
    return (struct blend){first, first < last ? first + 1 : last, (float)(y - floor(y))};
}

static ps_rgb mix(ps_rgb a, ps_rgb b, float share)
{
    return ps_rgb_add(ps_rgb_scale(a, 1.0f - share), ps_rgb_scale(b, share));
}

ps_rgb light_sky_radiance(const struct light_sky *sky, ps_vec3 direction)
{
    if (!sky->picture.rgb)
        return sky->radiance;
    struct place place = place_of(sky, direction);
    struct blend x = blend_columns(sky, place.u), y = blend_rows(sky, place.v);
    ps_rgb upper = mix(pixel(sky, x.first, y.first), pixel(sky, x.second, y.first), x.share);
    ps_rgb lower = mix(pixel(sky, x.first, y.second), pixel(sky, x.second, y.second), x.share);
    return mix(upper, lower, y.share);
}

/* --- the table --- */

/* How much the rows above and below count, on average by solid angle, in the interpolated picture
 * over a row of cells. */
struct row_shares {
    float above, below;
};

/* The share of the row above falls linearly from 1/2 at the top of the cell to 0 in its middle:
 * the integral of (m - t) sin t from a to m is (m - a) cos a + sin a - sin m. */
static struct row_shares shares_of_row(const struct light_sky *sky, size_t row)
{
    double top = polar_angle(sky, row), bottom = polar_angle(sky, row + 1);
    double middle = 0.5 * (top + bottom);
    double above = (middle - top) * cos(top) + sin(top) - sin(middle);
    double below = (middle - bottom) * cos(bottom) + sin(bottom) - sin(middle);
    double all = (bottom - top) * between_cosines(top, bottom);
    return (struct row_shares){(float)(above / all), (float)(below / all)};
}

/* The interpolated picture's mean over a cell, along its row of pixels alone: even in longitude. */
static ps_rgb mean_along_row(const struct light_sky *sky, size_t column, size_t row)
{
    size_t width = sky->picture.width;
    ps_rgb sides = ps_rgb_add(pixel(sky, (column + width - 1) % width, row),
                              pixel(sky, (column + 1) % width, row));
    return ps_rgb_add(ps_rgb_scale(pixel(sky, column, row), 0.75f), ps_rgb_scale(sides, 0.125f));
}

static ps_rgb mean_of_cell(const struct light_sky *sky, struct row_shares shares, size_t column,
                           size_t row)
{
    size_t last = sky->picture.height - 1;
    ps_rgb above = mean_along_row(sky, column, row > 0 ? row - 1 : 0);
    ps_rgb below = mean_along_row(sky, column, row < last ? row + 1 : last);
    ps_rgb mean = ps_rgb_scale(mean_along_row(sky, column, row), 1 - shares.above - shares.below);
    mean = ps_rgb_add(mean, ps_rgb_scale(above, shares.above));
    return ps_rgb_add(mean, ps_rgb_scale(below, shares.below));
}

/* Fills the weights of the cells; sets the radiance integrated over all directions, and the solid
 * angle. */
static void weigh_cells(struct light_sky *sky, float *weights)
{
    double red = 0.0, green = 0.0, blue = 0.0, squares = 0.0;
    for (size_t row = 0; row < sky->picture.height; row++) {
        struct row_shares shares = shares_of_row(sky, row);
        double solid_angle = cell_solid_angle(sky, row);
        for (size_t column = 0; column < sky->picture.width; column++) {
            ps_rgb mean = mean_of_cell(sky, shares, column, row);
            float luminance = ps_luminance(mean);
            *weights++ = luminance * (float)solid_angle;
            squares += (double)luminance * (double)luminance * solid_angle;
            red += (double)mean.r * solid_angle;
            green += (double)mean.g * solid_angle;
            blue += (double)mean.b * solid_angle;
        }
    }
    sky->fluence = (ps_rgb){(float)red, (float)green, (float)blue};
    double all = (double)ps_luminance(sky->fluence);
    sky->solid_angle = squares > 0.0 ? (float)(all * all / squares) : 0.0f;
}

static ps_result check_picture(const struct sky_picture *picture, struct error *error)
{
    size_t count = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(picture->rgb[i][0]) || !isfinite(picture->rgb[i][1]) ||
            !isfinite(picture->rgb[i][2]))
            return error_set(error, PS_ERROR_INVALID,
                             "the sky's picture has a number that is not finite, in column %zu of "
                             "row %zu",
                             i % picture->width, i / picture->width);
    return PS_OK;
}

static ps_result distribute(struct light_sky *sky, struct error *error)
{
    size_t width = sky->picture.width, height = sky->picture.height;
    if (width == 0 || height == 0)
        return error_set(error, PS_ERROR_INVALID, "the sky's picture is empty");
    ps_result result = check_picture(&sky->picture, error);
    if (result != PS_OK)
        return result;
    float *weights = calloc(height, width * sizeof *weights);
    if (!weights)
        return error_memory(error, width * height * sizeof *weights, "the sky");
    weigh_cells(sky, weights);
    if (!isfinite(sky->fluence.r + sky->fluence.g + sky->fluence.b))
        result = error_set(error, PS_ERROR_INVALID, "the sky's picture is too bright to add up");
    else
        result = distribution_2d_create(weights, width, height, &sky->by_radiance, error);
    free(weights);
    return result;
}

ps_result light_sky_create(const struct light_description *description,
                           const struct light_bounds *bounds, const struct sky_picture *picture,
                           struct light_sky *sky, struct error *error)
{
    *sky = (struct light_sky){
        .radiance = description->amount,
        .turn = (float)(fmod(description->rotate, 360.0) / 360.0),
        .fluence = ps_rgb_scale(description->amount, 4.0f * PS_PI),
        .solid_angle = 4.0f * PS_PI,
        .bounds = *bounds,
    };
    if (description->unit != UNIT_RADIANCE)
        return error_set(error, PS_ERROR_INVALID, "a sky needs its radiance");
    if (!picture)
        return PS_OK;
    sky->picture = *picture;
    return distribute(sky, error);
}

void light_sky_release(struct light_sky *sky)
{
    distribution_2d_release(&sky->by_radiance);
    *sky = (struct light_sky){.turn = 0.0f};
}

/* --- sampling --- */

ps_rgb light_sky_power(const struct light_sky *sky)
{
    return ps_rgb_scale(sky->fluence, light_scene_area(&sky->bounds));
}

static float cell_pdf(const struct light_sky *sky, size_t row, float probability)
{
    return (float)((double)probability / cell_solid_angle(sky, row));
}

/* Sines and cosines by the square of the half angle's sine, which is even where the cosine is, and
 * precise at the poles. */
static ps_vec3 direction_in_cell(const struct light_sky *sky, const struct distribution_cell *cell)
{
    double top = sin(0.5 * polar_angle(sky, cell->row));
    double bottom = sin(0.5 * polar_angle(sky, cell->row + 1));
    double half = top * top + (bottom * bottom - top * top) * (double)cell->rest_row;
    double u = ((double)cell->column + (double)cell->rest_column) / (double)sky->picture.width;
    double longitude = 2.0 * PI_DOUBLE * (u - 0.5 - (double)sky->turn);
    double sine = 2.0 * sqrt(half * (1.0 - half));
    return (ps_vec3){(float)(sine * sin(longitude)), (float)(1.0 - 2.0 * half),
                     (float)(-sine * cos(longitude))};
}

void light_sky_sample(const struct light_sky *sky, ps_vec3 normal, const float u[2],
                      struct light_sample *sample)
{
    *sample = (struct light_sample){.distance = INFINITY, .pdf = 0.25f / PS_PI};
    if (sky->picture.rgb) {
        struct distribution_cell cell = distribution_2d_choose(&sky->by_radiance, u[0], u[1]);
        sample->direction = direction_in_cell(sky, &cell);
        sample->pdf = cell_pdf(sky, cell.row, cell.probability);
    } else if (ps_dot(normal, normal) > 0.0f) {
        sample->direction = ps_cosine_direction(normal, u[0], u[1]);
        sample->pdf = ps_max(ps_dot(sample->direction, normal), 0.0f) / PS_PI;
    } else {
        sample->direction = light_any_direction(u[0], u[1]);
    }
    ps_rgb radiance = light_sky_radiance(sky, sample->direction);
    sample->weight = ps_rgb_scale(radiance, 1.0f / sample->pdf);
}

ps_rgb light_sky_emit(const struct light_sky *sky, const float u[4], ps_ray *ray)
{
    struct light_sample sample;
    light_sky_sample(sky, (ps_vec3){0, 0, 0}, u, &sample);
    *ray = light_ray_into_scene(&sky->bounds, sample.direction, u[2], u[3]);
    return ps_rgb_scale(sample.weight, light_scene_area(&sky->bounds));
}

static size_t cell_index(double place, uint32_t count)
{
    size_t index = (size_t)(place * (double)count);
    return index < count ? index : count - 1;
}

float light_sky_pdf(const struct light_sky *sky, ps_vec3 normal, ps_vec3 direction)
{
    if (!sky->picture.rgb)
        return ps_dot(normal, normal) > 0.0f ? ps_max(ps_dot(direction, normal), 0.0f) / PS_PI
                                             : 0.25f / PS_PI;
    struct place place = place_of(sky, direction);
    size_t column = cell_index(place.u, sky->picture.width);
    size_t row = cell_index(place.v, sky->picture.height);
    return cell_pdf(sky, row, distribution_2d_probability(&sky->by_radiance, column, row));
}
