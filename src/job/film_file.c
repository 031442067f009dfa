#include "job/film_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FORMAT "1"
#define MOST_TERMS 8 /* of an expansion; what two doubles hold has fewer */

static const char *const plane_names[FILM_PLANES] = {
    [FILM_DIRECT_R] = "direct.R",
    [FILM_DIRECT_G] = "direct.G",
    [FILM_DIRECT_B] = "direct.B",
    [FILM_COLOR_R] = "indirect.R",
    [FILM_COLOR_G] = "indirect.G",
    [FILM_COLOR_B] = "indirect.B",
    [FILM_WEIGHT] = "weight",
    [FILM_ALBEDO_R] = "albedo.R",
    [FILM_ALBEDO_G] = "albedo.G",
    [FILM_ALBEDO_B] = "albedo.B",
    [FILM_NORMAL_X] = "N.X",
    [FILM_NORMAL_Y] = "N.Y",
    [FILM_NORMAL_Z] = "N.Z",
    [FILM_POSITION_X] = "P.X",
    [FILM_POSITION_Y] = "P.Y",
    [FILM_POSITION_Z] = "P.Z",
    [FILM_DEPTH] = "Z",
    [FILM_VISIBLE] = "visible",
    [FILM_COVERAGE] = "coverage",
    [FILM_REFLECTED_R] = "reflected.R",
    [FILM_REFLECTED_G] = "reflected.G",
    [FILM_REFLECTED_B] = "reflected.B",
    [FILM_HARD_R] = "hard.R",
    [FILM_HARD_G] = "hard.G",
    [FILM_HARD_B] = "hard.B",
    [FILM_GLOSS] = "gloss",
    [FILM_SPLATTED_R] = "splatted.R",
    [FILM_SPLATTED_G] = "splatted.G",
    [FILM_SPLATTED_B] = "splatted.B",
    [FILM_VARIANCE] = "variance",
};

#define NAME_SIZE 64

/* The name of a term of a plane of the sum: "sum.direct.R", "rest.odd.weight", "rest2.squares". */
static void name_term(int plane, int term, char name[NAME_SIZE])
{
    char layer[16] = "sum";
    if (term == 1)
        snprintf(layer, sizeof layer, "rest");
    else if (term > 1)
        snprintf(layer, sizeof layer, "rest%d", term);
    if (plane == FILM_SUM_OF_SQUARES)
        snprintf(name, NAME_SIZE, "%s.squares", layer);
    else
        snprintf(name, NAME_SIZE, "%s.%s%s", layer,
                 plane < FILM_SUM_OF_ODD    ? ""
                 : plane < FILM_SUM_OF_HALF ? "odd."
                                            : "half.",
                 plane_names[plane % FILM_PLANES]);
}

/* --- writing
 * ---------------------------------------------------------------------------------------- */

static ps_result out_of_memory(const struct image *image, struct error *error)
{
    return error_memory(error, image->width * image->height * sizeof(float), "a film's file");
}

static ps_result add_plane(struct image *image, const struct exact_plane *sums, int plane,
                           struct error *error)
{
    for (int term = 0; term < MOST_TERMS; term++) {
        char name[NAME_SIZE];
        float *samples = malloc(sums->size * sizeof *samples);
        if (!samples)
            return out_of_memory(image, error);
        bool any = exact_plane_term(sums, term, samples);
        if (!any && term > 0) {
            free(samples);
            return PS_OK;
        }
        name_term(plane, term, name);
        ps_result result = image_adopt_channel(image, name, samples, error);
        if (result != PS_OK) {
            free(samples);
            return result;
        }
    }
    return error_set(error, PS_ERROR_INVALID, "a film whose sums are no numbers cannot be kept");
}

/* The two halves of an id, each of which a float holds. */
static ps_result add_ids(struct image *image, const char *name, const uint32_t *ids,
                         struct error *error)
{
    static const char *const halves[] = {"low", "high"};
    for (int half = 0; half < 2 && ids; half++) {
        char channel[NAME_SIZE];
        snprintf(channel, sizeof channel, "%s.%s", name, halves[half]);
        float *samples = image_add_channel(image, channel);
        if (!samples)
            return out_of_memory(image, error);
        for (size_t i = 0; i < image->width * image->height; i++)
            samples[i] = (float)(ids[i] >> 16 * half & 0xffff);
    }
    return PS_OK;
}

/* For viewers: the mean of direct and indirect light. */
static ps_result add_picture(struct image *image, const struct film_sum *sum, struct error *error)
{
    static const char *const names[3] = {"R", "G", "B"};
    double passes = pass_set_size(&sum->passes);
    for (int c = 0; c < 3; c++) {
        const double *direct = sum->planes[FILM_DIRECT_R + c].high;
        const double *indirect = sum->planes[FILM_COLOR_R + c].high;
        float *samples = image_add_channel(image, names[c]);
        if (!samples)
            return out_of_memory(image, error);
        for (size_t i = 0; i < image->width * image->height; i++)
            samples[i] = (float)((direct[i] + indirect[i]) / passes);
    }
    return PS_OK;
}

static ps_result add_facts(struct image *image, const struct image *facts,
                           const struct pass_set *passes, struct error *error)
{
    char *set = pass_set_format(passes);
    ps_result result = PS_OK;
    if (!set)
        return out_of_memory(image, error);
    for (size_t i = 0; i < facts->attribute_count && result == PS_OK; i++)
        result = image_set_attribute(image, facts->attributes[i].name, facts->attributes[i].value,
                                     error);
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.film", FORMAT, error);
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.pass_set", set, error);
    free(set);
    return result;
}

static ps_result make_image(const struct film_sum *sum, const struct image *facts,
                            struct image *image, struct error *error)
{
    *image = (struct image){.width = sum->width, .height = sum->height, .window = sum->window};
    ps_result result = add_facts(image, facts, &sum->passes, error);
    if (result == PS_OK)
        result = add_picture(image, sum, error);
    for (int plane = 0; plane < FILM_SUM_PLANES && result == PS_OK; plane++)
        if (sum->planes[plane].high)
            result = add_plane(image, &sum->planes[plane], plane, error);
    if (result == PS_OK)
        result = add_ids(image, "object", sum->object, error);
    return result == PS_OK ? add_ids(image, "material", sum->material, error) : result;
}

ps_result film_file_write(const char *path, const struct film_sum *sum, const struct image *facts,
                          enum image_compression compression, struct workers *workers,
                          struct error *error)
{
    struct image image;
    ps_result result = make_image(sum, facts, &image, error);
    if (result == PS_OK)
        result = image_write_exr(&image, path, compression, workers, error);
    image_release(&image);
    return result;
}

/* --- reading
 * ---------------------------------------------------------------------------------------- */

static ps_result damaged(const char *path, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "cannot read '%s': it is no whole film: %s", path,
                     what);
}

static ps_result check_format(const char *path, const struct image *image, struct error *error)
{
    const char *format = image_attribute(image, "psplat.film");
    if (!format)
        return error_set(error, PS_ERROR_INVALID,
                         "'%s' is no film (--checkpoint writes films; a picture does not hold "
                         "what adds up)",
                         path);
    if (strcmp(format, FORMAT) != 0)
        return error_set(error, PS_ERROR_INVALID,
                         "'%s' is a film of format '%.40s'; this psplat reads format " FORMAT, path,
                         format);
    return PS_OK;
}

/* An expansion's terms, added up, are what they were made of. */
static ps_result read_plane(const struct image *image, int plane, struct exact_plane *sums,
                            struct error *error)
{
    for (int term = 0; term < MOST_TERMS; term++) {
        char name[NAME_SIZE];
        name_term(plane, term, name);
        const float *samples = image_channel(image, name);
        if (!samples)
            return PS_OK;
        if (term == 0 && !exact_plane_create(image->width * image->height, sums))
            return out_of_memory(image, error);
        if (!exact_plane_add(sums, samples))
            return out_of_memory(image, error);
    }
    return PS_OK;
}

static bool is_half_of_id(float value)
{
    return value >= 0.0f && value <= 65535.0f && value == floorf(value);
}

static ps_result read_ids(const char *path, const struct image *image, const char *name,
                          uint32_t **ids, struct error *error)
{
    char channel[NAME_SIZE];
    size_t pixels = image->width * image->height;
    snprintf(channel, sizeof channel, "%s.low", name);
    const float *low = image_channel(image, channel);
    snprintf(channel, sizeof channel, "%s.high", name);
    const float *high = image_channel(image, channel);
    if (!low || !high)
        return damaged(path, "numbers of objects are missing", error);
    *ids = malloc(pixels * sizeof **ids);
    if (!*ids)
        return out_of_memory(image, error);
    for (size_t i = 0; i < pixels; i++) {
        if (!is_half_of_id(low[i]) || !is_half_of_id(high[i]))
            return damaged(path, "numbers of objects are none", error);
        (*ids)[i] = (uint32_t)low[i] | (uint32_t)high[i] << 16;
    }
    return PS_OK;
}

static bool has_planes(const struct film_sum *sum, int first, int end)
{
    bool has = true;
    for (int plane = first; plane < end; plane++)
        has &= sum->planes[plane].high != NULL;
    return has;
}

/* Whether a part has the direct light that has noise, as far as the sum has it. */
static bool has_direct(const struct film_sum *sum, int part)
{
    bool hard = sum->planes[FILM_HARD_R].high != NULL;
    return has_planes(sum, part + FILM_REFLECTED_R, part + FILM_REFLECTED_B + 1) &&
           (!hard || has_planes(sum, part + FILM_HARD_R, part + FILM_HARD_B + 1));
}

/* Half of that light: of each pass or of the passes, or both; none of them in pieces. */
static bool has_halves(const struct film_sum *sum)
{
    static const int parts[] = {FILM_SUM_OF_HALF, FILM_SUM_OF_ODD};
    bool whole = true;
    int count = 0;
    for (int i = 0; i < 2; i++) {
        bool has = false;
        for (int plane = FILM_REFLECTED_R; plane <= FILM_HARD_B; plane++)
            has |= sum->planes[parts[i] + plane].high != NULL;
        whole &= !has || has_direct(sum, parts[i]);
        count += has;
    }
    return whole && count > 0;
}

/* All that a film of the driver has: the light of the odd passes in any case, where the reflected
 * light is apart, half of it, and all channels of splatted light, or none. */
static bool has_what_it_needs(const struct film_sum *sum)
{
    static const int odd = FILM_SUM_OF_ODD;
    bool reflects = sum->planes[FILM_REFLECTED_R].high != NULL, splats = false;
    for (int plane = FILM_SPLATTED_R; plane <= FILM_SPLATTED_B; plane++)
        splats |= sum->planes[plane].high != NULL;
    return has_planes(sum, 0, FILM_ON_REQUEST) && sum->planes[FILM_SUM_OF_SQUARES].high &&
           has_planes(sum, odd + FILM_COLOR_R, odd + FILM_WEIGHT + 1) &&
           sum->planes[odd + FILM_COVERAGE].high &&
           (!reflects || (has_direct(sum, 0) && has_halves(sum))) &&
           (!splats || has_planes(sum, FILM_SPLATTED_R, FILM_SPLATTED_B + 1));
}

static ps_result read_passes(const char *path, const struct image *image, struct pass_set *passes,
                             struct error *error)
{
    const char *text = image_attribute(image, "psplat.pass_set");
    struct error reason;
    ps_result result = pass_set_parse(text ? text : "", passes, &reason);
    if (result != PS_OK)
        return error_set(error, result, "cannot read '%s': psplat.pass_set: %.600s", path,
                         reason.text);
    return passes->count > 0 ? PS_OK : damaged(path, "it says of no passes", error);
}

static ps_result take_sums(const char *path, const struct image *image, struct film_sum *sum,
                           struct error *error)
{
    sum->width = image->width;
    sum->height = image->height;
    sum->window = image->window;
    ps_result result = read_passes(path, image, &sum->passes, error);
    for (int plane = 0; plane < FILM_SUM_PLANES && result == PS_OK; plane++)
        result = read_plane(image, plane, &sum->planes[plane], error);
    if (result == PS_OK && !has_what_it_needs(sum))
        return damaged(path, "layers are missing", error);
    if (result == PS_OK)
        result = read_ids(path, image, "object", &sum->object, error);
    return result == PS_OK ? read_ids(path, image, "material", &sum->material, error) : result;
}

ps_result film_file_sums(const char *path, const struct image *image, struct film_sum *sum,
                         struct error *error)
{
    *sum = (struct film_sum){.width = 0};
    ps_result result = check_format(path, image, error);
    if (result == PS_OK)
        result = take_sums(path, image, sum, error);
    if (result != PS_OK)
        film_sum_release(sum);
    return result;
}

static bool keeps_none(const void *user, const char *name)
{
    (void)user;
    (void)name;
    return false;
}

ps_result film_file_read(const char *path, struct film_sum *sum, struct image *facts,
                         struct error *error)
{
    *sum = (struct film_sum){.width = 0};
    *facts = (struct image){.width = 0};
    ps_result result = image_read_exr(path, facts, error);
    if (result == PS_OK)
        result = film_file_sums(path, facts, sum, error);
    if (result == PS_OK)
        image_keep_channels(facts, keeps_none, NULL);
    else
        image_release(facts);
    return result;
}
