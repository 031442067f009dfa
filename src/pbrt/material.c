/* material.c: see material.h.
 *
 * The names and defaults are those of the pbrt-v4 and pbrt-v3 file formats, "Materials". A clear
 * coat reflects F = ((eta - 1) / (eta + 1))^2 of light from straight ahead.
 */
#include "pbrt/material_kinds.h"

#include "pbrt/roughness.h"
#include <math.h>
#include <string.h>

static const double black[3] = {0, 0, 0}, white[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5},
                    quarter[3] = {0.25, 0.25, 0.25};

/* --- kinds
 * ---------------------------------------------------------------------------------------- */

static void put_glossy(FILE *out, const struct pattern *diffuse, const struct pattern *specular,
                       const struct pattern *roughness)
{
    material_put_key(out, "glossy: {diffuse", diffuse, false);
    material_put_key(out, ", specular", specular, false);
    material_put_key(out, ", roughness", roughness, true);
    fputc('}', out);
}

static void diffuse(struct importer *importer, FILE *out, const struct statement *statement)
{
    bool is_v3 = strcmp(statement->kind, "matte") == 0;
    struct pattern color = material_read_reflectance(importer, statement,
                                                     is_v3 ? "Kd" : "reflectance", half),
                   sigma;
    texture_parameter(importer, statement, "sigma", black, &sigma);
    if (!pattern_is_black(&sigma))
        material_nearest(importer, statement,
                         "sigma is left out: psplat's diffuse surfaces are Lambertian");
    material_put_key(out, "diffuse", &color, false);
}

static void coated_diffuse(struct importer *importer, FILE *out, const struct statement *statement)
{
    static const char *const walks[] = {"thickness", "maxdepth", "nsamples", "g"};
    double f = material_normal_reflectance(material_index(importer, statement, 1.5));
    struct pattern color = material_read_reflectance(importer, statement, "reflectance", half);
    struct pattern specular = pattern_constant((const double[3]){f, f, f});
    struct pattern roughness = roughness_read(importer, statement, "", 0.0);
    statement_ignore(statement, walks, sizeof walks / sizeof walks[0]);
    put_glossy(out, &color, &specular, &roughness);
}

/* plastic, substrate, uber and translucent of pbrt-v3: Kd below, Ks above. */
static void kd_ks(struct importer *importer, FILE *out, const struct statement *statement)
{
    static const char *const elsewhere[] = {"opacity"}; /* material_opacity */
    bool substrate = strcmp(statement->kind, "substrate") == 0,
         uber = strcmp(statement->kind, "uber") == 0;
    statement_ignore(statement, elsewhere, uber ? 1 : 0);
    double f =
        substrate
            ? 1.0
            : material_normal_reflectance(uber ? material_index(importer, statement, 1.5) : 1.5);
    struct pattern kd =
        material_read_reflectance(importer, statement, "Kd", substrate ? half : quarter);
    struct pattern ks = material_read_reflectance(importer, statement, "Ks",
                                                  substrate ? half : quarter),
                   kr, kt;
    struct pattern roughness = roughness_read(importer, statement, "", 0.1);
    pattern_multiply(&ks, (const double[3]){f, f, f});
    kr = material_read_reflectance(importer, statement, "Kr", black);
    kt = material_read_reflectance(importer, statement, "Kt", black);
    if (pattern_is_black(&kd) && !pattern_is_black(&kt)) {
        fprintf(out, "dielectric: {ior: ");
        put_number(out, material_index(importer, statement, 1.5));
        material_put_key(out, ", color", &kt, false);
        fputc('}', out);
        return;
    }
    if (pattern_is_black(&kd) && pattern_is_black(&ks) && !pattern_is_black(&kr)) {
        material_put_key(out, "mirror", &kr, false);
        return;
    }
    if (!pattern_is_black(&kr) || !pattern_is_black(&kt))
        material_nearest(importer, statement, "Kr and Kt beside Kd and Ks are left out");
    put_glossy(out, &kd, &ks, &roughness);
}

/* Of uber; who calls material_put has it written. */
bool material_opacity(struct importer *importer, const struct statement *statement,
                      struct pattern *opacity)
{
    if (strcmp(statement->kind, "uber") != 0 ||
        !texture_parameter(importer, statement, "opacity", white, opacity))
        return false;
    material_nearest(importer, statement, "opacity is a hole where it is below 1/2");
    pattern_clamp(importer, &(struct place){&statement->origin, statement->width}, "opacity", 1.0,
                  opacity);
    return true;
}

/* What passes through a surface that shines on both sides has no counterpart. */
static void transmitting(struct importer *importer, FILE *out, const struct statement *statement)
{
    bool is_v3 = strcmp(statement->kind, "translucent") == 0;
    struct pattern color = material_read_reflectance(importer, statement,
                                                     is_v3 ? "Kd" : "reflectance", quarter),
                   share;
    static const char *const through[] = {"transmit", "transmittance", "Ks", "roughness",
                                          "remaproughness"};
    statement_ignore(statement, through, sizeof through / sizeof through[0]);
    if (is_v3) {
        texture_parameter(importer, statement, "reflect", half, &share);
        pattern_multiply(&color, share.colors[0]);
    } else {
        double scale = statement_number(importer, statement, "scale", 1.0);
        pattern_multiply(&color, (const double[3]){scale, scale, scale});
    }
    pattern_clamp(importer, &(struct place){&statement->origin, statement->width}, "scale", 1.0,
                  &color);
    material_nearest(importer, statement,
                     "a diffuse surface that lets nothing through stands in for it");
    material_put_key(out, "diffuse", &color, false);
}

/* A number of a material that has no textures here; one that varies counts by its mean. */
static double mean_number(struct importer *importer, const struct statement *statement,
                          const char *name, double otherwise)
{
    struct pattern pattern;
    double rgb[3];
    texture_parameter(importer, statement, name, (const double[3]){otherwise, otherwise, otherwise},
                      &pattern);
    pattern_mean(&pattern, rgb);
    return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

static void disney(struct importer *importer, FILE *out, const struct statement *statement)
{
    struct pattern color = material_read_reflectance(importer, statement, "color", half);
    double metallic = mean_number(importer, statement, "metallic", 0.0);
    double f = material_normal_reflectance(material_index(importer, statement, 1.5));
    struct pattern roughness = /* alpha is its square, as here */
        material_read_reflectance(importer, statement, "roughness", half);
    struct pattern specular = pattern_constant((const double[3]){f, f, f});
    material_nearest(importer, statement, "a metal or a glossy surface stands in for it");
    if (metallic < 0.5) {
        put_glossy(out, &color, &specular, &roughness);
        return;
    }
    material_put_key(out, "metal: {color", &color, false);
    material_put_key(out, ", roughness", &roughness, true);
    fputc('}', out);
}

/* Skin, wax, hair, and what was measured: only its colour, where the scene states one. */
static void colored(struct importer *importer, FILE *out, const struct statement *statement)
{
    static const char *const names[] = {"reflectance", "Kd", "color"};
    struct pattern color = pattern_constant(half);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (statement_find(statement, names[i]))
            color = material_read_reflectance(importer, statement, names[i], half);
    material_nearest(importer, statement, "a diffuse surface stands in for it");
    material_put_key(out, "diffuse", &color, false);
}

static const struct {
    const char *name;
    void (*put)(struct importer *importer, FILE *out, const struct statement *statement);
} kinds[] = {
    {"matte", diffuse},
    {"diffuse", diffuse},
    {"coateddiffuse", coated_diffuse},
    {"plastic", kd_ks},
    {"substrate", kd_ks},
    {"uber", kd_ks},
    {"translucent", transmitting},
    {"diffusetransmission", transmitting},
    {"coatedconductor", material_coated_conductor},
    {"glass", material_dielectric},
    {"dielectric", material_dielectric},
    {"thindielectric", material_thin_dielectric},
    {"mirror", material_mirror},
    {"disney", disney},
    {"subsurface", colored},
    {"kdsubsurface", colored},
    {"hair", colored},
    {"measured", colored},
    {"fourier", colored},
};

/* Bumps and pictures of normals, which any material may have. */
static void put_relief(struct importer *importer, FILE *out, const struct statement *statement)
{
    struct pattern bump;
    const char *name = statement_find(statement, "displacement") ? "displacement" : "bumpmap";
    if (texture_parameter(importer, statement, name, black, &bump) && !pattern_is_constant(&bump))
        material_put_key(out, ", bump", &bump, true);
    const char *normals = statement_string(importer, statement, "normalmap");
    if (!normals)
        return;
    struct pattern map =
        texture_image(importer, &(struct place){&statement->origin, statement->width}, normals);
    if (map.kind != PATTERN_IMAGE)
        return;
    fputs(", normal_map: {file: ", out);
    put_path(out, map.file);
    fputc('}', out);
}

bool material_put(struct importer *importer, FILE *out, const struct statement *statement,
                  int depth)
{
    const char *kind = statement->kind;
    if (strcmp(kind, "") == 0 || strcmp(kind, "none") == 0 || strcmp(kind, "interface") == 0)
        return false;
    if (strcmp(kind, "mix") == 0) {
        material_put_mix(importer, out, statement, depth);
        return true;
    }
    importer->extent = (struct mix_extent){0, 1};
    size_t i = 0, count = sizeof kinds / sizeof kinds[0];
    while (i < count && strcmp(kinds[i].name, kind) != 0)
        i++;
    if (i < count) {
        kinds[i].put(importer, out, statement);
    } else if (strcmp(kind, "metal") == 0 || strcmp(kind, "conductor") == 0) {
        material_conductor(importer, out, statement, "");
    } else {
        importer_warn(importer, &statement->origin, statement->width,
                      "Material '%.40s' has no counterpart; a diffuse surface stands in for it",
                      kind);
        fputs("diffuse: 0.5", out);
    }
    put_relief(importer, out, statement);
    statement_report_unused(importer, statement);
    return true;
}
