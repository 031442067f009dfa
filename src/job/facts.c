#include "job/facts.h"

#include "base/digest.h"
#include "base/text.h"
#include "base/version.h"
#include "scene/scene_digest.h"
#include "splat/kernel.h"
#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An attribute by its key, and what messages call it. */
struct fact {
    const char *key, *name;
};

/* What passes depend on; in the order in which users want to be told. */
static const struct fact binding[] = {
    {"psplat.version", "the version of psplat"},
    {"psplat.size", "the size"},
    {"psplat.crop", "the crop"},
#define ROW(part_, name_) {"psplat.digest." name_, "the scene's " name_},
    SCENE_PARTS(ROW)
#undef ROW
        {"psplat.seed", "the seed"},
    {"psplat.bounces", "bounces"},
    {"psplat.direct", "direct"},
    {"psplat.light_samples", "light_samples"},
    {"psplat.light_choices", "light_choices"},
    {"psplat.aa_samples", "aa_samples"},
    {"psplat.discontinuity_buffer", "discontinuity_buffer"},
    {"psplat.isa", "the instruction set (see --isa)"},
    {"psplat.injection", "the injection"},
    {"psplat.stratification", "the stratification"},
    {"psplat.visibility", "the visibility"},
    {"psplat.filter", "the filter"},
    {"psplat.estimator", "the estimator"},
    {"psplat.plugins", "the versions of plugins"},
};

static ps_result set_number(struct image *image, const char *key, uint64_t number,
                            struct error *error)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRIu64, number);
    return image_set_attribute(image, key, text, error);
}

static ps_result set_bounces(struct image *image, uint32_t bounces, struct error *error)
{
    if (bounces == PS_ALL_BOUNCES)
        return image_set_attribute(image, "psplat.bounces", "all", error);
    return set_number(image, "psplat.bounces", bounces, error);
}

ps_result facts_set_strategy(struct image *image, const struct strategy *strategy,
                             struct error *error)
{
    char name[64], value[2048];
    snprintf(name, sizeof name, "psplat.%s", kinds[strategy->type->kind].name);
    strategy_format(strategy, value, sizeof value);
    return image_set_attribute(image, name, value, error);
}

static ps_result set_strategies(struct image *image, const struct render_settings *settings,
                                struct error *error)
{
    ps_result result = PS_OK;
    for (int kind = 0; kind < PS_KINDS && result == PS_OK; kind++)
        result = facts_set_strategy(image, &settings->strategies[kind], error);
    return result;
}

/* `facts`: keys and values. */
static ps_result set_texts(struct image *image, const char *const facts[][2], size_t count,
                           struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < count && result == PS_OK; i++)
        result = image_set_attribute(image, facts[i][0], facts[i][1], error);
    return result;
}

static void format_colour(ps_rgb colour, char *text, size_t size)
{
    const float values[3] = {colour.r, colour.g, colour.b};
    char numbers[3][32];
    for (int i = 0; i < 3; i++) {
        snprintf(numbers[i], sizeof numbers[i], "%.9g", (double)values[i]);
        text_delocalize(numbers[i]);
    }
    snprintf(text, size, "[%s, %s, %s]", numbers[0], numbers[1], numbers[2]);
}

ps_result facts_set_crop(struct image *image, struct rectangle part, struct error *error)
{
    char crop[96] = "none";
    if (part.width > 0)
        snprintf(crop, sizeof crop, "%zu,%zu,%zu,%zu", part.x, part.y, part.width, part.height);
    return image_set_attribute(image, "psplat.crop", crop, error);
}

ps_result facts_of_settings(struct image *image, const char *scene_path,
                            const struct render_settings *settings, struct error *error)
{
    char direct[64] = "rays", indirect[32], ambient[128];
    if (settings->direct == DIRECT_SHADOWMAP)
        snprintf(direct, sizeof direct, "shadowmap:resolution=%" PRIu32,
                 settings->direct_resolution);
    text_from_number(settings->indirect_exposure, indirect, sizeof indirect);
    format_colour(settings->ambient, ambient, sizeof ambient);
    const char *const facts[][2] = {{"psplat.version", PSPLAT_VERSION},
                                    {"psplat.scene", scene_path},
                                    {"psplat.direct", direct},
                                    {"psplat.indirect_exposure", indirect},
                                    {"psplat.ambient", ambient}};
    ps_result result = set_texts(image, facts, sizeof facts / sizeof facts[0], error);
    if (result == PS_OK)
        result = facts_set_crop(image, settings->crop, error);
    if (result == PS_OK)
        result = set_number(image, "psplat.seed", settings->seed, error);
    if (result == PS_OK)
        result = set_bounces(image, settings->bounces, error);
    return result == PS_OK ? set_strategies(image, settings, error) : result;
}

static ps_result set_versions(struct image *image, const struct render_settings *settings,
                              struct error *error)
{
    char text[1024];
    size_t length = 0;
    for (int kind = 0; kind <= PS_ESTIMATOR; kind++) {
        const struct strategy_type *type = settings->strategies[kind].type;
        int written = snprintf(text + length, sizeof text - length, "%s%.60s %.60s",
                               kind > 0 ? ", " : "", type->name, type->version);
        length += written > 0 ? (size_t)written : 0;
    }
    return image_set_attribute(image, "psplat.plugins", text, error);
}

static ps_result set_digests(struct image *image, const struct scene_description *description,
                             const struct scene *scene, struct error *error)
{
#define ROW(part_, name_) "psplat.digest." name_,
    static const char *const keys[] = {SCENE_PARTS(ROW)};
#undef ROW
    struct scene_digest digest = scene_digest_of(description, scene);
    ps_result result = PS_OK;
    for (int part = 0; part < SCENE_PART_COUNT && result == PS_OK; part++) {
        char text[32];
        snprintf(text, sizeof text, "%016" PRIx64, digest.parts[part]);
        result = image_set_attribute(image, keys[part], text, error);
    }
    return result;
}

/* The numbers of a camera, in one order. */
#define CAMERA_NUMBERS 23

static void camera_numbers(struct camera *camera, float *numbers[CAMERA_NUMBERS])
{
    ps_vec3 *const vectors[] = {&camera->location, &camera->forward, &camera->corner,
                                &camera->across,   &camera->down,    &camera->lens_u,
                                &camera->lens_v};
    size_t n = 0;
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        numbers[n++] = &vectors[i]->x;
        numbers[n++] = &vectors[i]->y;
        numbers[n++] = &vectors[i]->z;
    }
    numbers[n++] = &camera->aperture;
    numbers[n++] = &camera->focus;
    assert(n == CAMERA_NUMBERS);
}

/* In hexadecimal, which loses nothing. */
static ps_result set_floats(struct image *image, const char *key, const char *first,
                            float *const numbers[], int count, struct error *error)
{
    char text[1024];
    int length = snprintf(text, sizeof text, "%s", first);
    for (int i = 0; i < count; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, "%s%a",
                           length > 0 ? " " : "", (double)*numbers[i]);
    return image_set_attribute(image, key, text, error);
}

/* Whether `text` begins with so many finite numbers. */
static bool read_floats(const char *text, float *const numbers[], int count)
{
    for (int i = 0; i < count && text; i++) {
        char *end;
        *numbers[i] = strtof(text, &end);
        text = end > text && isfinite(*numbers[i]) ? end : NULL;
    }
    return text != NULL;
}

static ps_result set_camera(struct image *image, const struct camera *camera, struct error *error)
{
    struct camera copy = *camera;
    float *numbers[CAMERA_NUMBERS];
    camera_numbers(&copy, numbers);
    return set_floats(image, "psplat.camera", camera->orthographic ? "orthographic" : "perspective",
                      numbers, CAMERA_NUMBERS, error);
}

static ps_result set_bounds(struct image *image, const struct scene *scene, struct error *error)
{
    ps_vec3 center = scene->center;
    float radius = scene->radius;
    float *const numbers[] = {&center.x, &center.y, &center.z, &radius};
    return set_floats(image, "psplat.bounds", "", numbers, 4, error);
}

ps_result facts_view(const struct image *facts, struct scene *scene, uint32_t *aa_samples,
                     struct error *error)
{
    const char *samples = image_attribute(facts, "psplat.aa_samples");
    const char *camera = image_attribute(facts, "psplat.camera");
    const char *bounds = image_attribute(facts, "psplat.bounds");
    float *numbers[CAMERA_NUMBERS];
    float *const of_bounds[] = {&scene->center.x, &scene->center.y, &scene->center.z,
                                &scene->radius};
    scene->camera = (struct camera){
        .orthographic = camera && strncmp(camera, "orthographic", 12) == 0,
    };
    camera_numbers(&scene->camera, numbers);
    if (!read_floats(camera ? strchr(camera, ' ') : NULL, numbers, CAMERA_NUMBERS))
        return error_set(error, PS_ERROR_INVALID, "the film does not tell its camera");
    if (!read_floats(bounds, of_bounds, 4))
        return error_set(error, PS_ERROR_INVALID, "the film does not tell its scene's bounds");
    *aa_samples = samples ? (uint32_t)strtoul(samples, NULL, 10) : 0;
    return *aa_samples > 0
               ? PS_OK
               : error_set(error, PS_ERROR_INVALID, "the film does not tell its aa_samples");
}

ps_result facts_of_job(struct image *image, const struct scene_description *description,
                       const struct scene *scene, const struct render_settings *settings,
                       struct error *error)
{
    struct kernel_variant kernel;
    char size[64], exposure[32];
    ps_result result = settings_choose_kernel(settings, &kernel, error);
    if (result != PS_OK)
        return result;
    snprintf(size, sizeof size, "%zux%zu", scene->width, scene->height);
    text_from_number(description->image.exposure, exposure, sizeof exposure);
    const char *const facts[][2] = {
        {"psplat.size", size},
        {"psplat.exposure", exposure},
        {"psplat.isa", kernel.name},
        {"psplat.discontinuity_buffer", settings->discontinuity_buffer ? "yes" : "no"}};
    result = facts_of_settings(image, description->path, settings, error);
    if (result == PS_OK)
        result = set_texts(image, facts, sizeof facts / sizeof facts[0], error);
    if (result == PS_OK)
        result = set_camera(image, &scene->camera, error);
    if (result == PS_OK)
        result = set_bounds(image, scene, error);
    if (result == PS_OK)
        result = set_number(image, "psplat.light_samples", scene->light_samples, error);
    if (result == PS_OK)
        result = set_number(image, "psplat.light_choices", scene->light_choices, error);
    if (result == PS_OK)
        result = set_number(image, "psplat.aa_samples", settings->aa_samples, error);
    if (result == PS_OK)
        result = set_versions(image, settings, error);
    return result == PS_OK ? set_digests(image, description, scene, error) : result;
}

/* NULL where there is none. A film that tells no crop is of the whole picture. */
static const char *value_of(const struct image *facts, const char *key)
{
    const char *value = image_attribute(facts, key);
    return !value && strcmp(key, "psplat.crop") == 0 ? "none" : value;
}

uint64_t facts_digest(const struct image *facts)
{
    uint64_t digest = DIGEST_START;
    for (size_t i = 0; i < sizeof binding / sizeof binding[0]; i++) {
        const char *value = value_of(facts, binding[i].key);
        digest_add(&digest, value ? value : "", value ? strlen(value) + 1 : 1);
    }
    return digest;
}

bool facts_agree(const struct image *a, const struct image *b, char *difference, size_t size)
{
    for (size_t i = 0; i < sizeof binding / sizeof binding[0]; i++) {
        const char *x = value_of(a, binding[i].key), *y = value_of(b, binding[i].key);
        bool tells = strncmp(binding[i].key, "psplat.digest.", 14) != 0;
        if (x && y && strcmp(x, y) == 0)
            continue;
        if (tells && x && y)
            snprintf(difference, size, "%s, '%.500s' and '%.500s'", binding[i].name, x, y);
        else
            snprintf(difference, size, "%s", binding[i].name);
        return false;
    }
    return true;
}
