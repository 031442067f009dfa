/* surface.c: the material of a shape: that of the graphics state, with its light and its holes; see
 * material.h. */
#include "pbrt/material.h"

#include "pbrt/light.h"
#include <stdlib.h>
#include <string.h>

/* Holes by alpha and by the material's opacity; as many as psd(5) has room for. */
static void put_holes(struct importer *importer, FILE *out, const struct statement *shape,
                      const struct pattern *alpha, struct surface *surface)
{
    const struct statement *material = importer->state.material;
    const struct place place = statement_place(shape, NULL);
    struct pattern opacity, holes = *alpha;
    bool has_alpha = !pattern_is_constant(alpha) || alpha->colors[0][0] < 1.0;
    bool has_opacity = material && material_opacity(importer, material, &opacity);
    if (has_alpha) {
        pattern_clamp(importer, &place, "alpha", 1.0, &holes);
        importer_warn(importer, place.origin, place.width, "alpha is a hole where it is below 1/2");
    }
    if (has_opacity && pattern_is_constant(&holes)) {
        pattern_multiply(&opacity, holes.colors[0]);
        holes = opacity;
    } else if (has_opacity && pattern_is_constant(&opacity)) {
        pattern_multiply(&holes, opacity.colors[0]);
    } else if (has_opacity) {
        importer_warn(importer, place.origin, place.width,
                      "opacity of the material is left out where alpha varies too");
    }
    if (!has_alpha && !has_opacity)
        return;
    fputs(", opacity: ", out);
    put_pattern(out, &holes, true);
    surface->has_holes = true;
}

/* The keys that the shape adds to its material. False: the shape is left out. */
static bool put_light(struct importer *importer, FILE *out, const struct statement *shape,
                      double area, struct surface *surface)
{
    const struct statement *light = importer->state.area_light;
    static const double one[3] = {1, 1, 1};
    struct pattern alpha;
    texture_parameter(importer, shape, "alpha", one, &alpha);
    bool is_gone = pattern_is_constant(&alpha) && pattern_is_black(&alpha);
    if (light) {
        struct pattern emission = light_emission(importer, light, area);
        bool both = statement_bool(importer, light, "twosided", false);
        fputs(", emission: ", out);
        put_pattern(out, &emission, false);
        if (both)
            fputs(", emission_both: yes", out);
        surface->one_sided = surface->one_sided || !both;
        surface->unseen = is_gone;
    }
    if (is_gone) /* its light stays */
        alpha = pattern_constant(one);
    put_holes(importer, out, shape, &alpha, surface);
    return light || !is_gone;
}

/* The keys of the material that the graphics state has. */
static bool put_material(struct importer *importer, FILE *out, const struct statement *shape)
{
    const struct statement *material = importer->state.material;
    struct place place = statement_place(shape, NULL);
    if (!material && importer->state.material_name)
        return true; /* was reported */
    if (!material) {
        fputs("diffuse: 0.5", out);
        return true;
    }
    if (material_put(importer, out, material, 0))
        return true;
    if (importer->state.area_light) {
        fputs("diffuse: 0", out);
        return true;
    }
    importer_warn(importer, place.origin, place.width,
                  "shapes that are borders of media alone are left out");
    return false;
}

struct surface material_surface(struct importer *importer, const struct statement *shape,
                                double area)
{
    struct surface surface = {0};
    struct text_buffer buffer;
    const char *name = importer->state.material_name;
    struct place place = statement_place(shape, NULL);
    if (name && !importer->state.material && importer->version == 4) /* named after NamedMaterial */
        importer->state.material = material_find(importer, name, &place);
    const struct statement *material = importer->state.material;
    if (!text_buffer_open(&buffer)) {
        importer_no_memory(importer);
        return surface;
    }
    surface.one_sided = material && (strcmp(material->kind, "glass") == 0 ||
                                     strcmp(material->kind, "dielectric") == 0);
    bool is_seen = put_material(importer, buffer.stream, shape) &&
                   put_light(importer, buffer.stream, shape, area, &surface);
    char *text = text_buffer_close(&buffer);
    if (text && is_seen && *text) {
        const char *wanted = name                         ? name
                             : importer->state.area_light ? "light"
                             : material                   ? material->kind
                                                          : "grey";
        surface.material = scene_text_material(&importer->scene, wanted, text);
        if (!surface.material)
            importer_no_memory(importer);
    }
    if (!text)
        importer_no_memory(importer);
    free(text);
    return surface;
}

void surface_finish(struct importer *importer, FILE *out, const struct surface *surface,
                    const struct transform *placement)
{
    fputs(", material: ", out);
    put_text(out, surface->material);
    if (surface->unseen)
        fputs(", camera: no", out);
    put_placement(out, placement);
    fputs("}\n", out);
    if (importer->current_object)
        importer->current_object->shapes++;
}
