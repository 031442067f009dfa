/* texture_image.c: pictures as textures; see texture.h. */
#include "pbrt/texture.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const double one[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};

static bool is_readable(const char *name)
{
    static const char *const suffixes[] = {".png", ".jpg", ".jpeg", ".exr",
                                           ".tga", ".bmp", ".hdr",  ".webp"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0] && dot; i++)
        if (strcasecmp(dot, suffixes[i]) == 0)
            return true;
    return false;
}

struct pattern texture_image(struct importer *importer, const struct place *place, const char *name)
{
    struct pattern pattern = pattern_constant(one);
    char *path = importer_file_path(importer, name), *shown = importer_file_name(importer, name);
    if (!is_readable(name)) {
        importer_warn(importer, place->origin, place->width,
                      "'%.200s' is no picture of a kind that psplat reads; grey stands in "
                      "for it",
                      name);
        pattern = pattern_constant(half);
    } else if (path && shown) {
        importer_check_file(importer, place, path);
        pattern.kind = PATTERN_IMAGE;
        pattern.file = arena_copy(&importer->arena, shown, strlen(shown));
        pattern.repeat[0] = pattern.repeat[1] = 1.0;
        if (!pattern.file) {
            importer_no_memory(importer);
            pattern = pattern_constant(half);
        }
    }
    free(path);
    free(shown);
    return pattern;
}

void texture_mapping(struct importer *importer, const struct statement *statement,
                     struct pattern *pattern)
{
    const char *mapping = statement_string(importer, statement, "mapping");
    if (mapping && strcmp(mapping, "uv") != 0)
        importer_warn(
            importer, &statement->origin, statement->width,
            "Texture %s: mapping '%.40s' has no counterpart; u and v of the shape are taken",
            statement->kind, mapping);
    pattern->repeat[0] = statement_number(importer, statement, "uscale", 1.0);
    pattern->repeat[1] = statement_number(importer, statement, "vscale", 1.0);
    pattern->offset[0] = statement_number(importer, statement, "udelta", 0.0);
    pattern->offset[1] = statement_number(importer, statement, "vdelta", 0.0);
}

static void read_encoding(struct importer *importer, const struct statement *statement,
                          struct pattern *pattern)
{
    const char *encoding = statement_string(importer, statement, "encoding");
    bool has_gamma = statement_find(statement, "gamma") != NULL;
    if (has_gamma && importer->version == 3)
        pattern->encoding = statement_bool(importer, statement, "gamma", true) ? NULL : "linear";
    if (!encoding)
        return;
    if (strcmp(encoding, "linear") == 0)
        pattern->encoding = "linear";
    else if (strcmp(encoding, "sRGB") != 0)
        importer_warn(importer, &statement->origin, statement->width,
                      "Texture imagemap: encoding '%.40s' is taken for sRGB", encoding);
}

static void read_wrap(struct importer *importer, const struct statement *statement,
                      struct pattern *pattern)
{
    const char *wrap = statement_string(importer, statement, "wrap");
    if (!wrap || strcmp(wrap, "repeat") == 0)
        return;
    pattern->wrap = "clamp";
    if (strcmp(wrap, "clamp") != 0)
        importer_warn(importer, &statement->origin, statement->width,
                      "Texture imagemap: wrap '%.40s' has no counterpart; clamp is taken", wrap);
}

struct pattern texture_image_map(struct importer *importer, const struct statement *statement)
{
    static const char *const filtering[] = {"trilinear", "maxanisotropy", "maxaniso"};
    const char *name = statement_string(importer, statement, "filename");
    struct place place = statement_place(statement, NULL);
    statement_ignore(statement, filtering, sizeof filtering / sizeof filtering[0]);
    if (!name) {
        importer_error(importer, place.origin, place.width,
                       "Texture imagemap: \"string filename\" is missing");
        return pattern_constant(half);
    }
    struct pattern pattern = texture_image(importer, &place, name);
    const char *filter = statement_string(importer, statement, "filter");
    pattern.nearest = filter && strcmp(filter, "point") == 0;
    texture_mapping(importer, statement, &pattern);
    read_encoding(importer, statement, &pattern);
    read_wrap(importer, statement, &pattern);
    double scale = statement_number(importer, statement, "scale", 1.0);
    pattern_multiply(&pattern, (const double[3]){scale, scale, scale});
    if (statement_bool(importer, statement, "invert", false))
        importer_warn(importer, place.origin, place.width, "Texture imagemap: invert is left out");
    return pattern;
}
