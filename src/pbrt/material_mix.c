/* material_mix.c: materials by name, and mixes of them; see material.h.
 *
 * pbrt-v4's `amount` is the share of the second material, pbrt-v3's that of the first.
 */
#include "pbrt/material_kinds.h"

#include "scene/material.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEEPEST_MIX 16 /* psd(5) */

static struct named_statement *find(const struct importer *importer, const char *name)
{
    const struct name_index *index = &importer->materials_by_name;
    size_t i = name_index_find(index, name_index_hash(name));
    for (; i != NAME_INDEX_NONE; i = name_index_before(index, i))
        if (strcmp(importer->materials[i].name, name) == 0)
            return &importer->materials[i];
    return NULL;
}

bool material_is_named(const struct importer *importer, const char *name)
{
    return find(importer, name) != NULL;
}

const struct statement *material_find(struct importer *importer, const char *name,
                                      const struct place *place)
{
    const struct named_statement *found = find(importer, name);
    if (found)
        return found->statement;
    importer_error(importer, place->origin, place->width, "there is no material '%.100s'", name);
    return NULL;
}

/* The scene's name of a named material; NULL: it has none, or that was reported. */
static const char *component(struct importer *importer, const char *name, const struct place *place,
                             int depth)
{
    const struct statement *statement = material_find(importer, name, place);
    struct named_statement *named = find(importer, name);
    struct text_buffer buffer;
    if (!statement)
        return NULL;
    if (named->written && depth + named->extent.height < DEEPEST_MIX) {
        importer->extent = named->extent;
        return named->written;
    }
    if (depth >= DEEPEST_MIX) {
        importer_error(importer, place->origin, place->width,
                       "mixes are in mixes more than %d deep", DEEPEST_MIX);
        return NULL;
    }
    if (!text_buffer_open(&buffer)) {
        importer_no_memory(importer);
        return NULL;
    }
    struct pattern opacity;
    bool is_surface = material_put(importer, buffer.stream, statement, depth + 1);
    if (is_surface && material_opacity(importer, statement, &opacity))
        material_put_key(buffer.stream, ", opacity", &opacity, true);
    char *text = text_buffer_close(&buffer);
    const char *found =
        text && is_surface ? scene_text_material(&importer->scene, name, text) : NULL;
    if (!text || (is_surface && !found))
        importer_no_memory(importer);
    free(text);
    named->written = found;
    named->extent = importer->extent;
    return found;
}

static const struct parameter *find_names(const struct statement *statement, const char *name)
{
    const struct parameter *parameter = statement_find(statement, name);
    return parameter && parameter->strings ? parameter : NULL;
}

static void put_components(FILE *out, const char *const names[2], const double weights[2])
{
    fputs("mix: [", out);
    for (int i = 0; i < 2; i++) {
        if (!names[i])
            continue;
        fputs(i == 1 && names[0] ? ", {material: " : "{material: ", out);
        put_text(out, names[i]);
        fputs(", weight: ", out);
        put_number(out, weights[i]);
        fputc('}', out);
    }
    fputc(']', out);
}

void material_put_mix(struct importer *importer, FILE *out, const struct statement *statement,
                      int depth)
{
    const struct parameter *list = find_names(statement, "materials");
    const struct parameter *first = find_names(statement, "namedmaterial1");
    const struct parameter *second = find_names(statement, "namedmaterial2");
    const char *names[2] = {NULL, NULL};
    struct pattern amount;
    double share[3];
    struct place place = statement_place(statement, list);
    if (list && list->count == 2) {
        names[0] = list->strings[0];
        names[1] = list->strings[1];
    } else if (first && second && first->count == 1 && second->count == 1) {
        names[0] = first->strings[0];
        names[1] = second->strings[0];
    } else {
        importer_error(importer, place.origin, place.width,
                       "Material mix: expected two names, \"string materials\" [ \"A\" \"B\" ]");
        return;
    }
    texture_parameter(importer, statement, "amount", (const double[3]){0.5, 0.5, 0.5}, &amount);
    pattern_mean(&amount, share);
    if (!pattern_is_constant(&amount) || share[0] != share[1] || share[1] != share[2])
        importer_warn(importer, place.origin, place.width,
                      "Material mix: an amount that varies is taken for its mean");
    double weight = fmin(fmax((share[0] + share[1] + share[2]) / 3.0, 0.0), 1.0);
    const double weights[2] = {list ? 1.0 - weight : weight, list ? weight : 1.0 - weight};
    const char *found[2] = {NULL, NULL};
    struct mix_extent whole = {1, 0};
    for (int i = 0; i < 2; i++)
        if (weights[i] > 0.0) {
            importer->extent = (struct mix_extent){0, 0};
            found[i] = component(importer, names[i], &place, depth);
            if (importer->extent.height >= whole.height)
                whole.height = importer->extent.height + 1;
            whole.parts += importer->extent.parts;
        }
    importer->extent = whole;
    if (whole.parts > MATERIAL_MOST_COMPONENTS)
        importer_error(importer, place.origin, place.width,
                       "Material mix: it comes to %d materials, of which psplat mixes up to %d",
                       whole.parts, MATERIAL_MOST_COMPONENTS);
    if (!found[0] && !found[1])
        fputs("diffuse: 0", out);
    else
        put_components(out, found, weights);
    statement_report_unused(importer, statement);
}
