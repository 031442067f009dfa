/* material_specular.c: metals, mirrors and glass, and values that all kinds of materials have; see
 * material_kinds.h. */
#include "pbrt/material_kinds.h"

#include "pbrt/roughness.h"
#include "pbrt/spectrum.h"
#include <math.h>
#include <string.h>

static const double white[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};

void material_put_key(FILE *out, const char *key, const struct pattern *pattern, bool is_number)
{
    fprintf(out, "%s: ", key);
    put_pattern(out, pattern, is_number);
}

void material_nearest(struct importer *importer, const struct statement *statement,
                      const char *what)
{
    importer_warn(importer, &statement->origin, statement->width, "Material %s: %s",
                  statement->kind, what);
}

struct pattern material_read_reflectance(struct importer *importer,
                                         const struct statement *statement, const char *name,
                                         const double otherwise[3])
{
    struct pattern pattern;
    struct place place = statement_place(statement, NULL);
    texture_parameter(importer, statement, name, otherwise, &pattern);
    pattern_clamp(importer, &place, name, 1.0, &pattern);
    return pattern;
}

double material_index(struct importer *importer, const struct statement *statement,
                      double otherwise)
{
    const struct parameter *parameter = statement_find(statement, "eta");
    struct spectrum spectrum;
    parameter = parameter ? parameter : statement_find(statement, "index");
    if (!parameter)
        return otherwise;
    if (parameter_is(parameter, "texture")) {
        material_nearest(importer, statement,
                         "an index of refraction that varies has no counterpart");
        return otherwise;
    }
    if (!spectrum_read(importer, parameter, &spectrum))
        return otherwise;
    double index = spectrum_middle(&spectrum);
    spectrum_release(&spectrum);
    return fmin(fmax(index, 0.1), 10.0);
}

double material_normal_reflectance(double index)
{
    double root = (index - 1.0) / (index + 1.0);
    return root * root;
}

static bool read_constants(struct importer *importer, const struct statement *statement,
                           const char *name, const char *otherwise, struct spectrum *spectrum)
{
    const struct parameter *parameter = statement_find(statement, name);
    if (!parameter)
        return spectrum_named(otherwise, spectrum);
    if (parameter_is(parameter, "texture")) {
        material_nearest(
            importer, statement,
            "optical constants that vary have no counterpart; those of copper are taken");
        return spectrum_named(otherwise, spectrum);
    }
    return spectrum_read(importer, parameter, spectrum);
}

void material_conductor(struct importer *importer, FILE *out, const struct statement *statement,
                        const char *prefix)
{
    bool is_v3 = strcmp(statement->kind, "metal") == 0;
    char eta_name[32], k_name[32];
    struct spectrum eta = {0}, k = {0};
    struct pattern color = pattern_constant(half), given;
    snprintf(eta_name, sizeof eta_name, "%seta", prefix);
    snprintf(k_name, sizeof k_name, "%sk", prefix);
    if (!is_v3 && texture_parameter(importer, statement, "reflectance", half, &given)) {
        color = given;
    } else if (read_constants(importer, statement, eta_name, "metal-Cu-eta", &eta) &&
               read_constants(importer, statement, k_name, "metal-Cu-k", &k)) {
        spectrum_conductor(&eta, &k, color.colors[0]);
    }
    spectrum_release(&eta);
    spectrum_release(&k);
    pattern_clamp(importer, &(struct place){&statement->origin, statement->width}, "reflectance",
                  1.0, &color);
    struct pattern roughness = roughness_read(importer, statement, prefix, is_v3 ? 0.01 : 0.0);
    material_put_key(out, "metal: {color", &color, false);
    material_put_key(out, ", roughness", &roughness, true);
    fputc('}', out);
}

void material_coated_conductor(struct importer *importer, FILE *out,
                               const struct statement *statement)
{
    static const char *const coat[] = {"interface.roughness",
                                       "interface.uroughness",
                                       "interface.vroughness",
                                       "interface.eta",
                                       "thickness",
                                       "g",
                                       "albedo",
                                       "maxdepth",
                                       "nsamples"};
    statement_ignore(statement, coat, sizeof coat / sizeof coat[0]);
    material_nearest(importer, statement, "the metal without its coat stands in for it");
    material_conductor(importer, out, statement, "conductor.");
}

void material_dielectric(struct importer *importer, FILE *out, const struct statement *statement)
{
    bool is_v3 = strcmp(statement->kind, "glass") == 0;
    struct pattern reflected = material_read_reflectance(importer, statement, "Kr", white);
    struct pattern color = is_v3 ? material_read_reflectance(importer, statement, "Kt", white)
                                 : pattern_constant(white);
    struct pattern roughness = roughness_read(importer, statement, "", 0.0);
    double remapped_zero = roughness_from(0.0, true, importer->version);
    if (!pattern_is_constant(&roughness) || roughness.colors[0][0] > remapped_zero)
        material_nearest(importer, statement, "roughness is left out: psplat's glass is smooth");
    if (!pattern_is_constant(&reflected) || !color_is(reflected.colors[0], 1.0))
        material_nearest(importer, statement, "Kr is left out");
    fputs("dielectric: {ior: ", out);
    put_number(out, material_index(importer, statement, 1.5));
    material_put_key(out, ", color", &color, false);
    fputc('}', out);
}

/* A sheet reflects R = 2 F / (1 + F) of light from straight ahead, between its two sides, and lets
 * the rest through as it came: a border between like and like. */
void material_thin_dielectric(struct importer *importer, FILE *out,
                              const struct statement *statement)
{
    double f = material_normal_reflectance(material_index(importer, statement, 1.5)),
           r = 2.0 * f / (1.0 + f);
    const char *mirror = scene_text_material(&importer->scene, "sheet-mirror", "mirror: 1");
    const char *clear =
        scene_text_material(&importer->scene, "sheet-clear", "dielectric: {ior: 1}");
    material_nearest(importer, statement, "its reflection is taken to be the same at every angle");
    if (!mirror || !clear) {
        importer_no_memory(importer);
        return;
    }
    if (!(r > 0.0)) {
        fputs("dielectric: {ior: 1}", out);
        return;
    }
    importer->extent = (struct mix_extent){1, 2};
    fputs("mix: [{material: ", out);
    put_text(out, mirror);
    fputs(", weight: ", out);
    put_number(out, r);
    fputs("}, {material: ", out);
    put_text(out, clear);
    fputs(", weight: ", out);
    put_number(out, 1.0 - r);
    fputs("}]", out);
}

void material_mirror(struct importer *importer, FILE *out, const struct statement *statement)
{
    static const double kr[3] = {0.9, 0.9, 0.9};
    struct pattern color = material_read_reflectance(importer, statement, "Kr", kr);
    material_put_key(out, "mirror", &color, false);
}
