/* resolve.c: the film becomes a picture: normalization, ambient fallback, denoiser, combination. */
#include "base/clock.h"
#include "pipeline/denoise.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The layers of the picture that come straight from the film. */
static const struct layer {
    const char *name;
    enum film_plane plane;
} layers[] = {
    {"direct.R", FILM_DIRECT_R}, {"direct.G", FILM_DIRECT_G}, {"direct.B", FILM_DIRECT_B},
    {"albedo.R", FILM_ALBEDO_R}, {"albedo.G", FILM_ALBEDO_G}, {"albedo.B", FILM_ALBEDO_B},
    {"N.X", FILM_NORMAL_X},      {"N.Y", FILM_NORMAL_Y},      {"N.Z", FILM_NORMAL_Z},
    {"P.X", FILM_POSITION_X},    {"P.Y", FILM_POSITION_Y},    {"P.Z", FILM_POSITION_Z},
    {"Z", FILM_DEPTH},           {"weight", FILM_WEIGHT},
};

static bool is_layer_of(const char *channel, const char *name, size_t length)
{
    return strcspn(channel, ".") == length && strncmp(channel, name, length) == 0;
}

bool render_makes_layer(const char *name, size_t length)
{
    bool found =
        length > 0 && (is_layer_of("indirect", name, length) ||
                       is_layer_of("error", name, length) || is_layer_of("display", name, length));
    for (size_t i = 0; i < sizeof layers / sizeof layers[0] && length > 0; i++)
        found |= is_layer_of(layers[i].name, name, length);
    return found;
}

static ps_result add_rgb(struct image *image, const char *const names[3], struct rgb_planes *planes,
                         struct error *error)
{
    planes->r = image_add_channel(image, names[0]);
    planes->g = image_add_channel(image, names[1]);
    planes->b = image_add_channel(image, names[2]);
    if (planes->r && planes->g && planes->b)
        return PS_OK;
    error_memory(error, 3 * image->width * image->height * sizeof(float), "the picture");
    return PS_ERROR_MEMORY;
}

/* The planes change hands: copies would take as much time as all that is computed here. */
static ps_result move_film_layers(struct film *film, struct image *image, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < sizeof layers / sizeof layers[0] && result == PS_OK; i++) {
        float **plane = &film->planes[layers[i].plane];
        if (!*plane)
            continue;
        result = image_adopt_channel(image, layers[i].name, *plane, error);
        if (result == PS_OK)
            *plane = NULL;
    }
    return result;
}

ps_result leave_out(struct render *render, ps_kind kind, ps_result result, const char *instead,
                    struct error *error)
{
    char warning[1400];
    const char *name = strategy_in(render, kind)->type->name;
    if (result == PS_CANCELLED)
        error_set(error, result, "%s %.80s was stopped", kinds[kind].name, name);
    snprintf(warning, sizeof warning, "%.1200s; the picture %s", error->text, instead);
    own_host(render)->log(own_host(render), PS_LOG_WARNING, warning);
    return result;
}

/* The accumulated light as it stands (plugins/normalization/density.c). */
static void average_passes(const struct render *render, struct rgb_planes out)
{
    const struct film *film = &render->film;
    float scale = film->passes ? 1.0f / (float)film->passes : 0.0f;
    for (size_t i = 0; i < pixels_of(render); i++) {
        out.r[i] = film->planes[FILM_COLOR_R][i] * scale;
        out.g[i] = film->planes[FILM_COLOR_G][i] * scale;
        out.b[i] = film->planes[FILM_COLOR_B][i] * scale;
    }
}

static ps_film_view view_of(const struct film *film)
{
    return (ps_film_view){
        .size = sizeof(ps_film_view),
        .passes = film->passes,
        .pixel_count = film->width * film->height,
        .color_r = film->planes[FILM_COLOR_R],
        .color_g = film->planes[FILM_COLOR_G],
        .color_b = film->planes[FILM_COLOR_B],
        .weight = film->planes[FILM_WEIGHT],
        .coverage = film->planes[FILM_COVERAGE],
    };
}

static ps_result normalize_film(struct render *render, const struct film *film,
                                struct rgb_planes out, struct error *error)
{
    const struct strategy *strategy = strategy_in(render, PS_NORMALIZATION);
    ps_film_view view = view_of(film);
    double start = clock_seconds();
    ps_result result = strategy->type->table.normalization.resolve(strategy->state, strategy->host,
                                                                   &view, out.r, out.g, out.b);
    statistics_add_seconds(render->statistics, "normalize", clock_seconds() - start);
    return render_judge(render, PS_NORMALIZATION, result, error);
}

/* Where nothing has weight, anything may stand, and the ambient colour will; so only what has
 * counts. */
static void mend_normalized(struct render *render, struct rgb_planes out)
{
    const float *weight = render->film.planes[FILM_WEIGHT];
    for (size_t i = 0; i < pixels_of(render); i++)
        if (!(weight[i] > 0.0f) && !isfinite(out.r[i] + out.g[i] + out.b[i]))
            out.r[i] = out.g[i] = out.b[i] = 0.0f;
    mend_rgb(render, out, &render->refused.pixels[1]);
}

static ps_result normalize(struct render *render, struct rgb_planes out, struct error *error)
{
    ps_result result = normalize_film(render, &render->film, out, error);
    if (result != PS_OK) {
        average_passes(render, out);
        result = leave_out(render, PS_NORMALIZATION, result, "is normalized by density", error);
    }
    mend_normalized(render, out);
    return result;
}

/* Pixels that no indirect light reached take the ambient colour (Hoet 2014, section 4.3). Light
 * from nearby has no weight (gathered_light.h), so what came out counts, too. */
static void fill_ambient(struct render *render, struct rgb_planes out)
{
    const struct film *film = &render->film;
    size_t dark = 0;
    for (size_t i = 0; i < film->width * film->height; i++) {
        if (film->planes[FILM_WEIGHT][i] > 0.0f || out.r[i] + out.g[i] + out.b[i] > 0.0f)
            continue;
        float covered = film->planes[FILM_COVERAGE][i] / (float)film->passes;
        out.r[i] = covered * render->settings->ambient.r;
        out.g[i] = covered * render->settings->ambient.g;
        out.b[i] = covered * render->settings->ambient.b;
        dark += covered > 0.0f;
    }
    render->dark_pixels = (double)dark;
}

/* What the odd passes leave of the film. */
static void subtract_odd(const struct film *film, float *sums, struct film *even)
{
    static const enum film_plane planes[] = {FILM_COLOR_R, FILM_COLOR_G, FILM_COLOR_B, FILM_WEIGHT,
                                             FILM_COVERAGE};
    size_t pixels = film->width * film->height;
    *even = (struct film){
        .width = film->width,
        .height = film->height,
        .passes = film->passes - film->odd->passes,
    };
    for (size_t k = 0; k < sizeof planes / sizeof planes[0]; k++, sums += pixels) {
        const float *all = film->planes[planes[k]], *odd = film->odd->planes[planes[k]];
        for (size_t i = 0; i < pixels; i++)
            sums[i] = fmaxf(all[i] - odd[i], 0.0f);
        even->planes[planes[k]] = sums;
    }
}

/* Normalizes both halves; `sums` is room for five planes. */
static ps_result normalize_halves(struct render *render, float *sums, struct halves *halves,
                                  struct error *error)
{
    const struct film *film = &render->film;
    size_t pixels = pixels_of(render);
    struct film even;
    subtract_odd(film, sums, &even);
    halves->odd_share = (float)film->odd->passes / (float)film->passes;
    halves->even = planes_at(halves->light, pixels);
    halves->odd = planes_at(halves->light + 3 * pixels, pixels);
    ps_result result = normalize_film(render, &even, halves->even, error);
    return result == PS_OK ? normalize_film(render, film->odd, halves->odd, error) : result;
}

static ps_result make_halves(struct render *render, struct halves *halves, struct error *error)
{
    const struct film *film = &render->film;
    uint32_t flags = strategy_in(render, PS_DENOISER)->type->table.denoiser.flags;
    size_t plane = pixels_of(render) * sizeof(float);
    ps_result result = PS_OK;
    *halves = (struct halves){.light = NULL};
    if (plane == 0 || !(flags & PS_DENOISER_HALVES) || !film->odd ||
        !film->odd->planes[FILM_COLOR_R] || film->odd->passes == 0 ||
        film->odd->passes == film->passes)
        return PS_OK;
    float *sums = malloc(5 * plane);
    halves->light = malloc(6 * plane);
    if (sums && halves->light)
        result = normalize_halves(render, sums, halves, error);
    else
        result = error_memory(error, 11 * plane, "half the film");
    free(sums);
    return result;
}

/* Room for the denoiser's estimate of its error, where it makes one and somebody wants it; NULL
 * elsewhere. */
static ps_result create_estimate(const struct render *render, float **estimate, struct error *error)
{
    const struct render_settings *settings = render->settings;
    uint32_t flags = strategy_in(render, PS_DENOISER)->type->table.denoiser.flags;
    *estimate = NULL;
    if (!(flags & PS_DENOISER_ERROR) || settings->picture_alone || settings->no_error_layer)
        return PS_OK;
    *estimate = calloc(pixels_of(render), sizeof **estimate);
    return *estimate
               ? PS_OK
               : error_memory(error, pixels_of(render) * sizeof **estimate, "the layer error");
}

static void combine(const struct render *render, struct rgb_planes indirect, struct rgb_planes out)
{
    float *const *planes = render->film.planes;
    float exposure = (float)render->settings->indirect_exposure;
    for (size_t i = 0; i < pixels_of(render); i++) {
        out.r[i] = planes[FILM_DIRECT_R][i] + exposure * indirect.r[i];
        out.g[i] = planes[FILM_DIRECT_G][i] + exposure * indirect.g[i];
        out.b[i] = planes[FILM_DIRECT_B][i] + exposure * indirect.b[i];
    }
}

/* Where an earlier stage failed, the error stays that one's. */
static ps_result display(struct render *render, struct rgb_planes picture, ps_result earlier,
                         struct image *image, struct error *error)
{
    const float *const light[3] = {picture.r, picture.g, picture.b};
    struct error other;
    ps_result shown = display_fill(render, light, image, earlier == PS_OK ? error : &other);
    return earlier == PS_OK ? shown : earlier;
}

ps_result resolve_image(struct render *render, bool shows, struct image *image, struct error *error)
{
    static const char *const picture_names[3] = {"R", "G", "B"};
    static const char *const indirect_names[3] = {"indirect.R", "indirect.G", "indirect.B"};
    *image = (struct image){
        .width = render->film.width, .height = render->film.height, .window = render->film.window};
    struct rgb_planes picture, indirect;
    float *estimate;
    double start = clock_seconds();
    ps_result result = add_rgb(image, picture_names, &picture, error);
    if (result == PS_OK)
        result = add_rgb(image, indirect_names, &indirect, error);
    if (result == PS_OK && shows)
        result = display_add(image, error);
    if (result == PS_OK)
        result = create_estimate(render, &estimate, error);
    if (result != PS_OK) {
        image_release(image);
        return result;
    }
    ps_result normalized = normalize(render, indirect, error);
    fill_ambient(render, indirect);
    struct halves halves;
    ps_result halved = make_halves(render, &halves, error);
    film_average(&render->film);
    ps_result denoised = halved == PS_OK
                             ? denoise_film(render, indirect, &halves, estimate, error)
                             : leave_out(render, PS_DENOISER, halved, "is not denoised", error);
    free(halves.light);
    combine(render, indirect, picture);
    ps_result made = normalized != PS_OK ? normalized : denoised;
    if (shows)
        made = display(render, picture, made, image, error);
    result = move_film_layers(&render->film, image, error);
    if (result == PS_OK && estimate && denoised == PS_OK) {
        result = image_adopt_channel(image, "error", estimate, error);
        estimate = result == PS_OK ? NULL : estimate;
    }
    free(estimate);
    statistics_add_seconds(render->statistics, "resolve", clock_seconds() - start);
    if (result != PS_OK) {
        image_release(image);
        return result;
    }
    return made;
}
