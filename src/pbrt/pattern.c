/* pattern.c: values that vary over a surface, in the words of psd(5); see texture.h. */
#include "pbrt/texture.h"

#include "base/text.h"
#include <math.h>
#include <string.h>

bool color_is(const double rgb[3], double value)
{
    return rgb[0] == value && rgb[1] == value && rgb[2] == value;
}

struct pattern pattern_constant(const double rgb[3])
{
    struct pattern pattern = {.kind = PATTERN_CONSTANT, .placement = transform_identity};
    memcpy(pattern.colors[0], rgb, sizeof pattern.colors[0]);
    memcpy(pattern.colors[1], rgb, sizeof pattern.colors[1]);
    return pattern;
}

void pattern_multiply(struct pattern *pattern, const double rgb[3])
{
    for (int i = 0; i < 3; i++) {
        pattern->colors[0][i] *= rgb[i];
        pattern->colors[1][i] *= rgb[i];
    }
}

static bool has_two_colors(const struct pattern *pattern)
{
    return pattern->kind != PATTERN_CONSTANT && pattern->kind != PATTERN_IMAGE;
}

void pattern_mean(const struct pattern *pattern, double rgb[3])
{
    for (int i = 0; i < 3; i++) {
        double other = has_two_colors(pattern) ? pattern->colors[1][i] : pattern->colors[0][i];
        double mean = 0.5 * (pattern->colors[0][i] + other);
        rgb[i] = pattern->kind == PATTERN_IMAGE ? 0.5 * mean : mean;
    }
}

bool pattern_is_constant(const struct pattern *pattern)
{
    return pattern->kind == PATTERN_CONSTANT;
}

bool pattern_is_black(const struct pattern *pattern)
{
    for (int i = 0; i < 3; i++)
        if (pattern->colors[0][i] != 0.0 ||
            (has_two_colors(pattern) && pattern->colors[1][i] != 0.0))
            return false;
    return true;
}

void pattern_clamp(struct importer *importer, const struct place *place, const char *what,
                   double most, struct pattern *pattern)
{
    bool changed = false;
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < 3; i++) {
            double value = pattern->colors[c][i], clamped = fmin(fmax(value, 0.0), most);
            changed = changed || (clamped != value && (c == 0 || has_two_colors(pattern)));
            pattern->colors[c][i] = clamped;
        }
    if (changed)
        importer_warn(importer, place->origin, place->width, "%s: limited to 0..%g", what, most);
}

static void put_value(FILE *out, const double rgb[3], bool is_number)
{
    if (is_number)
        put_number(out, (rgb[0] + rgb[1] + rgb[2]) / 3.0);
    else
        put_color(out, rgb);
}

static void put_pair(FILE *out, const char *key, const double pair[2], double otherwise)
{
    if (pair[0] == otherwise && pair[1] == otherwise)
        return;
    fprintf(out, ", %s: [", key);
    put_number(out, pair[0]);
    fputs(", ", out);
    put_number(out, pair[1]);
    fputc(']', out);
}

static void put_image(FILE *out, const struct pattern *pattern, bool is_number)
{
    /* pbrt decodes pictures for numbers too, where psd(5) takes them as they are. */
    const char *encoding = pattern->encoding;
    if (!encoding && is_number && !text_has_suffix(pattern->file, ".exr"))
        encoding = "srgb";
    fputs("{image: {file: ", out);
    put_path(out, pattern->file);
    if (!color_is(pattern->colors[0], 1.0)) {
        fputs(", color: ", out);
        put_value(out, pattern->colors[0], is_number);
    }
    if (pattern->wrap)
        fprintf(out, ", wrap: %s", pattern->wrap);
    if (encoding)
        fprintf(out, ", encoding: %s", encoding);
    if (pattern->nearest)
        fputs(", interpolate: nearest", out);
    put_pair(out, "repeat", pattern->repeat, 1.0);
    put_pair(out, "offset", pattern->offset, 0.0);
    fputs("}}", out);
}

void put_pattern(FILE *out, const struct pattern *pattern, bool is_number)
{
    static const char *const words[] = {
        [PATTERN_CHECKER] = "checker", [PATTERN_NOISE] = "noise", [PATTERN_GRADIENT] = "gradient"};
    if (pattern->kind == PATTERN_CONSTANT) {
        put_value(out, pattern->colors[0], is_number);
        return;
    }
    if (pattern->kind == PATTERN_IMAGE) {
        put_image(out, pattern, is_number);
        return;
    }
    fprintf(out, "{%s: {colors: [", words[pattern->kind]);
    put_value(out, pattern->colors[0], is_number);
    fputs(", ", out);
    put_value(out, pattern->colors[1], is_number);
    fputc(']', out);
    if (pattern->kind == PATTERN_NOISE)
        fprintf(out, ", octaves: %ld", pattern->octaves);
    if (pattern->turbulence > 0.0) {
        fputs(", turbulence: ", out);
        put_number(out, pattern->turbulence);
    }
    put_placement(out, &pattern->placement);
    fputs("}}", out);
}
