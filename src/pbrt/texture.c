/* texture.c: see texture.h.
 *
 * The classes of textures and their parameters are those of the pbrt-v4 and pbrt-v3 file formats,
 * "Textures".
 */
#include "pbrt/texture.h"

#include "image/image.h"
#include "pbrt/spectrum.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};

static bool is_class(const struct statement *statement, const char *name)
{
    return strcmp(statement->kind, name) == 0;
}

/* Whether pbrt looks for a texture of the type float. */
static bool wants_numbers(const struct importer *importer, const struct statement *statement,
                          const char *parameter)
{
    static const char *const names[] = {"alpha",     "sigma",    "bumpmap", "displacement",
                                        "roughness", "metallic", "scale"};
    bool is_texture = strcmp(statement->directive, "Texture") == 0;
    if (strcmp(parameter, "amount") == 0)
        return is_texture || importer->version == 4;
    size_t length = strlen(parameter);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        size_t part = strlen(names[i]); /* also shadowalpha, conductor.uroughness */
        if (length >= part && strcmp(parameter + length - part, names[i]) == 0)
            return true;
    }
    return is_texture && statement->of_numbers;
}

/* Textures of floats and of spectra are two sets of names: the wanted one goes first. pbrt-v3's are
 * those from before the statement. */
static const struct pattern *find_texture(const struct importer *importer,
                                          const struct statement *statement, const char *parameter,
                                          const char *name)
{
    bool numbers = wants_numbers(importer, statement, parameter);
    const struct name_index *index = &importer->textures_by_name;
    const struct pattern *other = NULL;
    size_t end = importer->version == 3 ? statement->textures : SIZE_MAX;
    size_t i = name_index_find(index, name_index_hash(name));
    for (; i != NAME_INDEX_NONE; i = name_index_before(index, i)) {
        const struct named_pattern *named = &importer->textures[i];
        if (i >= end || strcmp(named->name, name) != 0)
            continue;
        if (named->of_numbers == numbers)
            return named->pattern;
        other = other ? other : named->pattern;
    }
    return other;
}

bool texture_parameter(struct importer *importer, const struct statement *statement,
                       const char *name, const double otherwise[3], struct pattern *pattern)
{
    const struct parameter *parameter = statement_find(statement, name);
    *pattern = pattern_constant(otherwise);
    if (!parameter)
        return false;
    if (parameter_is(parameter, "texture")) {
        const struct pattern *found =
            parameter->count == 1 ? find_texture(importer, statement, name, parameter->strings[0])
                                  : NULL;
        if (found)
            *pattern = *found;
        else
            importer_error(importer, &parameter->origin, parameter->width,
                           "%s: no texture '%.100s' before this", name,
                           parameter->count > 0 ? parameter->strings[0] : "");
        return true;
    }
    struct spectrum spectrum;
    if (spectrum_read(importer, parameter, &spectrum)) {
        spectrum_reflectance(&spectrum, pattern->colors[0]);
        memcpy(pattern->colors[1], pattern->colors[0], sizeof pattern->colors[0]);
        spectrum_release(&spectrum);
    }
    return true;
}

/* --- combinations
 * --------------------------------------------------------------------------------- */

/* The colour of a pattern where only one can be used. */
static void flatten(struct importer *importer, const struct statement *statement,
                    const struct pattern *pattern, double rgb[3])
{
    pattern_mean(pattern, rgb);
    if (!pattern_is_constant(pattern))
        importer_warn(importer, &statement->origin, statement->width,
                      "Texture %s: a texture in it that varies is taken for its mean",
                      statement->kind);
}

static struct pattern product(struct importer *importer, const struct statement *statement)
{
    bool is_v3 = statement_find(statement, "tex1") != NULL;
    struct pattern a, b;
    double rgb[3];
    texture_parameter(importer, statement, is_v3 ? "tex1" : "tex", one, &a);
    texture_parameter(importer, statement, is_v3 ? "tex2" : "scale", one, &b);
    struct pattern *varies = pattern_is_constant(&a) ? &b : &a;
    flatten(importer, statement, varies == &a ? &b : &a, rgb);
    pattern_multiply(varies, rgb);
    return *varies;
}

static struct pattern mixture(struct importer *importer, const struct statement *statement)
{
    struct pattern a, b, amount;
    double share[3], rgb[2][3], sum[3];
    texture_parameter(importer, statement, "tex1", zero, &a);
    texture_parameter(importer, statement, "tex2", one, &b);
    texture_parameter(importer, statement, "amount", half, &amount);
    flatten(importer, statement, &amount, share);
    if (color_is(share, 0.0))
        return a;
    if (color_is(share, 1.0))
        return b;
    flatten(importer, statement, &a, rgb[0]);
    flatten(importer, statement, &b, rgb[1]);
    for (int i = 0; i < 3; i++)
        sum[i] = (1.0 - share[i]) * rgb[0][i] + share[i] * rgb[1][i];
    return pattern_constant(sum);
}

/* --- patterns
 * ------------------------------------------------------------------------------------- */

/* pbrt-v4's transform is texture to world; pbrt-v3 takes the same one as world to texture. */
static void place_pattern(struct importer *importer, const struct statement *statement,
                          struct pattern *pattern)
{
    struct transform ctm = importer->state.ctm;
    if (importer->version == 3 && !transform_invert(&importer->state.ctm, &ctm))
        ctm = importer->state.ctm; /* which importer_placement refuses */
    importer_placement(importer, &ctm, &statement->origin, statement->width, &pattern->placement);
}

/* A picture of 2 x 2 texels, which repeats: on u and v the first colour lies where floor(u) +
 * floor(v) is even. */
static void draw_checker(struct importer *importer, struct pattern *pattern)
{
    struct side_file *file =
        scene_text_file(&importer->scene, importer->options->base, "checker", "exr");
    struct image *picture = calloc(1, sizeof *picture);
    if (!file || !picture) {
        free(picture);
        importer_no_memory(importer);
        return;
    }
    file->picture = picture;
    picture->width = picture->height = 2;
    for (int c = 0; c < 3; c++) {
        float *samples = image_add_channel(picture, (const char *const[]){"R", "G", "B"}[c]);
        for (int i = 0; i < 4 && samples; i++) /* rows from the top: 2 3, 0 1 */
            samples[i] = (float)pattern->colors[i == 0 || i == 3][c];
    }
    pattern->kind = PATTERN_IMAGE;
    pattern->file = arena_copy(&importer->arena, file->name, strlen(file->name));
    pattern->nearest = true;
    for (int i = 0; i < 2; i++) {
        pattern->repeat[i] *= 0.5;
        pattern->offset[i] *= 0.5;
    }
    memcpy(pattern->colors[0], one, sizeof one);
    if (!pattern->file || picture->channel_count != 3)
        importer_no_memory(importer);
}

static struct pattern checkerboard(struct importer *importer, const struct statement *statement)
{
    static const char *const filtering[] = {"aamode"};
    struct pattern a, b, pattern;
    long dimension = statement_integer(importer, statement, "dimension", 2, 2, 3);
    statement_ignore(statement, filtering, 1);
    texture_parameter(importer, statement, "tex1", one, &a);
    texture_parameter(importer, statement, "tex2", zero, &b);
    pattern = pattern_constant(zero);
    flatten(importer, statement, &a, pattern.colors[0]);
    flatten(importer, statement, &b, pattern.colors[1]);
    pattern.kind = PATTERN_CHECKER;
    if (dimension == 3) {
        place_pattern(importer, statement, &pattern);
        return pattern;
    }
    texture_mapping(importer, statement, &pattern);
    draw_checker(importer, &pattern);
    return pattern;
}

static struct pattern noise(struct importer *importer, const struct statement *statement)
{
    struct pattern pattern = pattern_constant(zero);
    memcpy(pattern.colors[1], one, sizeof one);
    pattern.kind = PATTERN_NOISE;
    pattern.octaves = statement_integer(importer, statement, "octaves", 8, 1, 1000);
    pattern.octaves = pattern.octaves < 16 ? pattern.octaves : 16;
    (void)statement_number(importer, statement, "roughness", 0.5);
    place_pattern(importer, statement, &pattern);
    importer_warn(importer, &statement->origin, statement->width,
                  "Texture %s: psplat's own noise stands in for it", statement->kind);
    return pattern;
}

/* pbrt's marble goes through nine colours along y; its lightest and darkest stand for them. */
static struct pattern marble(struct importer *importer, const struct statement *statement)
{
    static const double light[3] = {0.58, 0.58, 0.6}, dark[3] = {0.2, 0.2, 0.33};
    static const char *const octaves[] = {"octaves", "roughness"};
    struct pattern pattern = pattern_constant(light);
    memcpy(pattern.colors[1], dark, sizeof dark);
    pattern.kind = PATTERN_GRADIENT;
    pattern.turbulence = fmax(statement_number(importer, statement, "variation", 0.2), 0.0);
    double scale = statement_number(importer, statement, "scale", 1.0);
    statement_ignore(statement, octaves, 2);
    place_pattern(importer, statement, &pattern);
    if (scale > 0.0) {
        struct transform smaller = transform_scale(1.0 / scale, 1.0 / scale, 1.0 / scale);
        pattern.placement = transform_compose(&pattern.placement, &smaller);
    }
    importer_warn(importer, &statement->origin, statement->width,
                  "Texture marble: a gradient with turbulence stands in for it");
    return pattern;
}

/* Of dots the ground, of corners the mean: one colour. */
static struct pattern one_color(struct importer *importer, const struct statement *statement)
{
    static const char *const dots[] = {"outside"}, *const corners[] = {"v00", "v01", "v10", "v11"};
    bool is_dots = is_class(statement, "dots");
    const char *const *names = is_dots ? dots : corners;
    size_t count = is_dots ? 1 : 4;
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        struct pattern pattern;
        double rgb[3];
        texture_parameter(importer, statement, names[i], i % 2 ? one : zero, &pattern);
        pattern_mean(&pattern, rgb);
        for (int c = 0; c < 3; c++)
            sum[c] += rgb[c] / (double)count;
    }
    importer_warn(importer, &statement->origin, statement->width,
                  "Texture %s: one colour stands in for it", statement->kind);
    return pattern_constant(sum);
}

static struct pattern resolve(struct importer *importer, const struct statement *statement)
{
    static const char *const noises[] = {"fbm", "wrinkled", "windy"};
    if (is_class(statement, "constant")) {
        struct pattern pattern;
        texture_parameter(importer, statement, "value", one, &pattern);
        return pattern;
    }
    if (is_class(statement, "imagemap"))
        return texture_image_map(importer, statement);
    if (is_class(statement, "scale"))
        return product(importer, statement);
    if (is_class(statement, "mix"))
        return mixture(importer, statement);
    if (is_class(statement, "checkerboard"))
        return checkerboard(importer, statement);
    if (is_class(statement, "marble"))
        return marble(importer, statement);
    if (is_class(statement, "dots") || is_class(statement, "bilerp"))
        return one_color(importer, statement);
    for (size_t i = 0; i < sizeof noises / sizeof noises[0]; i++)
        if (is_class(statement, noises[i]))
            return noise(importer, statement);
    importer_warn(importer, &statement->origin, statement->width,
                  "Texture '%.40s' has no counterpart; grey stands in for it", statement->kind);
    return pattern_constant(half);
}

void texture_define(struct importer *importer, const struct statement *statement, const char *name,
                    const char *type)
{
    static const char *const types[] = {"float", "spectrum", "color"};
    bool known = false;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        known = known || strcmp(types[i], type) == 0;
    if (!known) {
        importer_error(
            importer, &statement->origin, statement->width,
            "Texture '%.100s': expected the type \"float\" or \"spectrum\", got \"%.40s\"", name,
            type);
        return;
    }
    struct pattern *pattern = arena_allocate(&importer->arena, sizeof *pattern);
    char *copy = arena_copy(&importer->arena, name, strlen(name));
    if (!pattern || !copy ||
        !importer_grow(importer, (void **)&importer->textures, &importer->texture_capacity,
                       importer->texture_count + 1, sizeof *importer->textures)) {
        importer_no_memory(importer);
        return;
    }
    *pattern = resolve(importer, statement);
    statement_report_unused(importer, statement);
    if (!name_index_add(&importer->textures_by_name, name_index_hash(name))) {
        importer_no_memory(importer);
        return;
    }
    importer->textures[importer->texture_count++] =
        (struct named_pattern){copy, statement->of_numbers, pattern};
}
