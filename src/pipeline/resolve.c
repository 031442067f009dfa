/* resolve.c: the film becomes a picture: normalization, ambient fallback, denoiser, combination. */
#include "base/clock.h"
#include "pipeline/render_state.h"
#include <stdio.h>
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
    bool found = length > 0 && is_layer_of("indirect", name, length);
    for (size_t i = 0; i < sizeof layers / sizeof layers[0] && length > 0; i++)
        found |= is_layer_of(layers[i].name, name, length);
    return found;
}

struct rgb_planes {
    float *r, *g, *b;
};

size_t picture_bytes(size_t width, size_t height)
{
    size_t rgb_layers = 2; /* the picture and its indirect light */
    return 3 * rgb_layers * width * height * sizeof(float);
}

static ps_result add_rgb(struct image *image, const char *const names[3], struct rgb_planes *planes,
                         struct error *error)
{
    planes->r = image_add_channel(image, names[0]);
    planes->g = image_add_channel(image, names[1]);
    planes->b = image_add_channel(image, names[2]);
    if (planes->r && planes->g && planes->b)
        return PS_OK;
    return error_memory(error, 3 * image->width * image->height * sizeof(float), "the picture");
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

static size_t pixels_of(const struct render *render)
{
    return render->film.width * render->film.height;
}

static void copy_rgb(const struct render *render, struct rgb_planes from, struct rgb_planes to)
{
    size_t bytes = pixels_of(render) * sizeof(float);
    memcpy(to.r, from.r, bytes);
    memcpy(to.g, from.g, bytes);
    memcpy(to.b, from.b, bytes);
}

/* A last stage that fails, or is stopped, must not cost the picture: it is left out, with a warning. */
static ps_result leave_out(const struct render *render, ps_kind kind, ps_result result,
                           const char *instead, struct error *error)
{
    char warning[256];
    const char *name = render->settings->strategies[kind].descriptor->name;
    const char *what = result == PS_CANCELLED ? "was stopped" : "failed";
    snprintf(warning, sizeof warning, "%s %.80s %s; the picture %s", kinds[kind].name, name, what,
             instead);
    render->host.log(&render->host, PS_LOG_WARNING, warning);
    return error_set(error, result, "%s %.80s %s", kinds[kind].name, name, what);
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

static ps_result normalize(struct render *render, struct rgb_planes out, struct error *error)
{
    const struct strategy *strategy = &render->settings->strategies[PS_NORMALIZATION];
    const ps_normalization_vtable *vtable = strategy->descriptor->vtable;
    const struct film *film = &render->film;
    ps_film_view view = {
        .size = sizeof view,
        .passes = film->passes,
        .pixel_count = film->width * film->height,
        .color_r = film->planes[FILM_COLOR_R],
        .color_g = film->planes[FILM_COLOR_G],
        .color_b = film->planes[FILM_COLOR_B],
        .weight = film->planes[FILM_WEIGHT],
        .coverage = film->planes[FILM_COVERAGE],
    };
    double start = clock_seconds();
    ps_result result = vtable->resolve(strategy->state, &render->host, &view, out.r, out.g, out.b);
    statistics_add_seconds(render->statistics, "normalize", clock_seconds() - start);
    if (result == PS_OK)
        return PS_OK;
    average_passes(render, out);
    return leave_out(render, PS_NORMALIZATION, result, "is normalized by density", error);
}

/* Pixels that no indirect light reached take the ambient colour (Hoet 2014, section 4.3). Light from nearby has no
 * weight (gathered_light.h), so what came out counts, too. */
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
    statistics_count(render->statistics, "pixels without weight", (double)dark);
}

/* Needs room for a copy of the light. */
static ps_result denoise(struct render *render, struct rgb_planes indirect, struct rgb_planes copy,
                         struct error *error)
{
    const struct strategy *strategy = &render->settings->strategies[PS_DENOISER];
    const ps_denoiser_vtable *vtable = strategy->descriptor->vtable;
    float **planes = render->film.planes;
    ps_image_view view = {
        .size = sizeof view,
        .width = (uint32_t)render->film.width,
        .height = (uint32_t)render->film.height,
        .r = indirect.r,
        .g = indirect.g,
        .b = indirect.b,
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
    };
    double start = clock_seconds();
    if (!vtable->keeps_all)
        copy_rgb(render, indirect, copy);
    ps_result result = vtable->filter(strategy->state, &render->host, &view);
    statistics_add_seconds(render->statistics, "denoise", clock_seconds() - start);
    if (result == PS_OK)
        return PS_OK;
    if (!vtable->keeps_all)
        copy_rgb(render, copy, indirect);
    return leave_out(render, PS_DENOISER, result, "is not denoised", error);
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

ps_result resolve_image(struct render *render, struct image *image, struct error *error)
{
    static const char *const picture_names[3] = {"R", "G", "B"};
    static const char *const indirect_names[3] = {"indirect.R", "indirect.G", "indirect.B"};
    *image = (struct image){.width = render->film.width, .height = render->film.height};
    struct rgb_planes picture, indirect;
    double start = clock_seconds();
    ps_result result = add_rgb(image, picture_names, &picture, error);
    if (result == PS_OK)
        result = add_rgb(image, indirect_names, &indirect, error);
    if (result != PS_OK) {
        image_release(image);
        return result;
    }
    ps_result normalized = normalize(render, indirect, error);
    fill_ambient(render, indirect);
    film_average(&render->film);
    ps_result denoised = denoise(render, indirect, picture, error);
    combine(render, indirect, picture);
    result = move_film_layers(&render->film, image, error);
    statistics_add_seconds(render->statistics, "resolve", clock_seconds() - start);
    if (result != PS_OK) {
        image_release(image);
        return result;
    }
    return normalized != PS_OK ? normalized : denoised;
}
