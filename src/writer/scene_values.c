/* scene_values.c: numbers, texts and transforms of the .psd text; see scene_text.h. */
#include "base/text.h"
#include "parser/yaml/encoding.h"
#include "writer/scene_text.h"
#include <string.h>

void put_number(FILE *out, double value)
{
    char text[64];
    float rounded = (float)value;
    text_from_float(rounded == 0.0f ? 0.0f : rounded, text, sizeof text); /* no negative zero */
    fputs(text, out);
}

static void put_list(FILE *out, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        fputs(i == 0 ? "[" : ", ", out);
        put_number(out, values[i]);
    }
    fputc(']', out);
}

void put_vector(FILE *out, struct vector value)
{
    put_list(out, (const double[3]){value.x, value.y, value.z}, 3);
}

void put_color(FILE *out, const double rgb[3])
{
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
        put_number(out, rgb[0]);
    else
        put_list(out, rgb, 3);
}

/* What YAML wants to be escaped: controls, and marks of byte order. */
static bool is_special(uint32_t code)
{
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029 ||
           (code >= 0xfef0 && code <= 0xffff);
}

static void put_characters(FILE *out, const char *text)
{
    for (size_t left = strlen(text); left > 0;) {
        uint32_t code = 0;
        size_t length = utf8_decode(text, left, &code);
        if (length == 0) { /* does not happen: converters see to it */
            length = 1;
            code = 0xfffd;
        }
        if (code == '"' || code == '\\')
            fprintf(out, "\\%c", (int)code);
        else if (is_special(code))
            fprintf(out, "\\u%04x", code);
        else
            fwrite(text, 1, length, out);
        text += length;
        left -= length;
    }
}

void put_text(FILE *out, const char *text)
{
    fputc('"', out);
    put_characters(out, text);
    fputc('"', out);
}

/* psd(5): a text can't begin with an equals sign. */
void put_path(FILE *out, const char *path)
{
    fputs(*path == '=' ? "\"./" : "\"", out);
    put_characters(out, path);
    fputc('"', out);
}

static bool is_identity(const struct transform *map)
{
    bool same = true;
    for (int i = 0; i < 12; i++)
        same = same && map->m[i / 4][i % 4] == transform_identity.m[i / 4][i % 4];
    return same;
}

void put_placement(FILE *out, const struct transform *placement)
{
    if (is_identity(placement))
        return;
    fputs(", matrix: ", out);
    put_list(out, &placement->m[0][0], 12);
}
