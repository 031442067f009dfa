/* memory.c: whether a picture of some size can be rendered here at all.
 *
 * A system that lends more memory than it has lets a render of a mistyped size begin and kills it
 * later, with others. So what grows with the picture is compared with the machine's memory
 * beforehand: once before the scene is loaded, by what any scene needs, and once when it is there,
 * with all of its planes and what the process has by then. What else the system runs is not known,
 * and not asked for.
 */
#include "base/machine.h"
#include "base/text.h"
#include "film/film_sum.h"
#include "pipeline/planes.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"

/* Photons, surfels, splats and stacks of threads, which do not grow with the picture. */
#define BESIDE 0x1p24

/* Over the sum of the planes: their margins, and what allocators round up. */
#define ROUNDED_UP 1.06

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

/* Planes of a film with its parts, but for ids. */
static size_t count_film(const struct planes *planes)
{
    size_t of_surfaces = FILM_VISIBLE - FILM_ALBEDO_R + 1, of_odd = 5; /* light, weight, coverage */
    size_t reflected = planes->reflected ? 3 + (planes->reflected_hard ? 3 : 0) : 0;
    return FILM_ON_REQUEST - (planes->surfaces ? 0 : of_surfaces) + (planes->gloss ? 1 : 0) +
           (planes->variance ? 1 : 0) + (planes->splatted ? 3 : 0) + (planes->odd ? of_odd : 0) +
           reflected * (1 + (planes->halves_of_pass ? 1 : 0) + (planes->halves_of_passes ? 1 : 0));
}

/* Of a pixel: the film, and the sums of its passes with the squares of its light. */
static size_t film_pixel(const struct planes *planes)
{
    size_t count = count_film(planes), ids = planes->ids ? 2 * sizeof(uint32_t) : 0;
    size_t sums = planes->sums ? (count + 1) * sizeof(double) + ids : 0;
    return count * sizeof(float) + ids + sums;
}

/* What a file of the film is made of: its planes in two floats each, three for viewers, four of
 * ids. */
static size_t file_pixel(const struct planes *planes)
{
    return (2 * (count_film(planes) + 1) + 7) * sizeof(float);
}

/* The picture, less the planes that it takes over from the film, and what makes it: halves of the
 * light, and what the denoiser asks for. */
static size_t picture_pixel(const struct render_settings *settings, const struct planes *planes)
{
    const ps_denoiser_vtable *denoiser = &settings->strategies[PS_DENOISER].type->table.denoiser;
    bool has_error = denoiser->flags & PS_DENOISER_ERROR && !settings->picture_alone &&
                     !settings->no_error_layer;
    size_t rgb_layers = settings->display ? 3 : 2, halves = planes->odd ? 6 : 0;
    size_t copies = denoiser->filter ? 6 : 0; /* of a part of the light, and of half of it */
    size_t making = (halves + copies) * sizeof(float) + denoiser->pixel_bytes;
    size_t normalizing = planes->odd ? 11 * sizeof(float) : 0;
    return (3 * rgb_layers + (has_error ? 1 : 0)) * sizeof(float) + larger(making, normalizing);
}

static double gbuffer_part(const struct gbuffer *layout, const struct planes *planes)
{
    struct interleaved interleaved = interleaved_layout(layout, 1);
    interleaved.has_geometric_normals = planes->geometric;
    size_t bytes = gbuffer_bytes_with(
        layout, (struct gbuffer_parts){planes->discontinuity_buffer, planes->direct_half,
                                       planes->hard, planes->gloss, planes->geometric,
                                       planes->radiance, planes->caustics});
    if (planes->edges)
        bytes += layout->tile_count * PS_TILE_PIXELS;
    if (planes->splats || planes->caustics)
        bytes += interleaved_bytes(&interleaved);
    return (double)bytes + (planes->splats ? (double)gathered_light_bytes(layout) : 0);
}

/* G-buffer, film and sums last to the end. Beside them are, at different times, what the estimator
 * needs in a pass, the picture with its denoiser, and the film's file. */
static double memory_of_picture(const struct render_settings *settings, const struct planes *planes,
                                size_t width, size_t height, bool keeps_film)
{
    struct rectangle film = planes_window(settings, width, height);
    struct gbuffer layout = planes_layout(settings, width, height);
    const ps_estimator_vtable *estimator =
        &settings->strategies[PS_ESTIMATOR].type->table.estimator;
    size_t at_once = picture_pixel(settings, planes);
    if (keeps_film)
        at_once = larger(at_once, file_pixel(planes));
    at_once = larger(at_once, (size_t)estimator->pixel_bytes);
    return gbuffer_part(&layout, planes) +
           (double)film.width * (double)film.height * (double)(film_pixel(planes) + at_once);
}

/* What there is, and whether the settings say so. */
static bool memory_of(const struct render_settings *settings, double *there)
{
    *there = machine_memory_within(settings->memory_limit);
    return *there == settings->memory_limit;
}

/* Beside what the process has. */
static double with_process(double bytes)
{
    return ROUNDED_UP * bytes + machine_memory_of_process() + BESIDE;
}

bool memory_allows(const struct render_settings *settings, double bytes)
{
    double there;
    memory_of(settings, &there);
    return with_process(bytes) <= there;
}

/* `beside`: bytes that are taken, or will be, whatever the picture is. */
static ps_result check(const struct render_settings *settings, size_t width, size_t height,
                       double picture, double beside, struct error *error)
{
    struct rectangle film = planes_window(settings, width, height);
    double there;
    bool is_limited = memory_of(settings, &there);
    char taken[TEXT_SIZE_LENGTH], other[TEXT_SIZE_LENGTH], limit[TEXT_SIZE_LENGTH];
    if (picture + beside <= there)
        return PS_OK;
    return error_set(
        error, PS_ERROR_MEMORY,
        "a picture of %zux%zu pixels takes %s of memory to render%s%s%s, and %s %s; a "
        "smaller one is had by --size, a part of it by --crop, all of it in parts by "
        "--tile",
        film.width, film.height, text_of_size(picture, taken), beside > 0.0 ? " beside " : "",
        beside > 0.0 ? text_of_size(beside, other) : "",
        beside > 0.0 ? " of the scene and the program" : "",
        is_limited ? "--memory-limit is" : "this machine has", text_of_size(there, limit));
}

ps_result render_check_memory(const struct render_settings *settings, size_t width, size_t height,
                              bool keeps_film, struct error *error)
{
    bool sums = keeps_film || settings_pass_count(settings) > 1;
    struct planes planes = planes_wanted(settings, NULL, sums, keeps_film);
    return check(settings, width, height,
                 memory_of_picture(settings, &planes, width, height, keeps_film), 0.0, error);
}

ps_result memory_check(const struct render_settings *settings, const struct planes *planes,
                       const struct scene *scene, bool keeps_film, struct error *error)
{
    size_t width = scene->width, height = scene->height;
    double picture = memory_of_picture(settings, planes, width, height, keeps_film);
    double beside = with_process(0.0) + scene_bytes_to_come(scene);
    return check(settings, width, height, ROUNDED_UP * picture, beside, error);
}
