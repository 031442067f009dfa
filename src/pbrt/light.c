/* light.c: see light.h.
 *
 * The kinds and parameters are those of the pbrt-v4 and pbrt-v3 file formats, "Lights". Radiances
 * are carried over as numbers: a light of 1 is one of 1 W/(m^2 sr) here. pbrt-v4's power and
 * illuminance, in lumens and lux, become numbers by the same rule: a surface that shines with 1 has
 * pi for each unit of its area.
 */
#include "pbrt/light.h"

#include "pbrt/spectrum.h"
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static void read_scale(struct importer *importer, const struct statement *statement, double rgb[3])
{
    const struct parameter *scale = statement_find(statement, "scale");
    struct spectrum spectrum;
    double factor[3];
    if (!scale || !spectrum_read(importer, scale, &spectrum))
        return;
    spectrum_illuminant(&spectrum, 3, factor);
    for (int i = 0; i < 3; i++)
        rgb[i] *= factor[i];
    spectrum_release(&spectrum);
}

void light_color(struct importer *importer, const struct statement *statement, const char *name,
                 const char *total, double per_unit, double rgb[3])
{
    const struct parameter *parameter = statement_find(statement, name);
    struct spectrum spectrum;
    struct place place = statement_place(statement, parameter);
    rgb[0] = rgb[1] = rgb[2] = 1.0;
    if (parameter && spectrum_read(importer, parameter, &spectrum)) {
        spectrum_illuminant(&spectrum, importer->version, rgb);
        spectrum_release(&spectrum);
    }
    read_scale(importer, statement, rgb);
    double wanted = statement_number(importer, statement, total, -1.0);
    for (int i = 0; i < 3 && wanted > 0.0; i++)
        rgb[i] *= wanted / per_unit;
    for (int i = 0; i < 3; i++)
        if (!(rgb[i] >= 0.0) || rgb[i] > 1e30) {
            importer_warn(importer, place.origin, place.width, "%s: limited to 0..1e30", name);
            rgb[i] = rgb[i] > 0.0 ? 1e30 : 0.0;
        }
}

/* --- kinds
 * ---------------------------------------------------------------------------------------- */

static void begin(FILE *out, const char *kind, const char *key, struct vector value)
{
    fprintf(out, "  - %s: {%s: ", kind, key);
    put_vector(out, value);
}

static void end(FILE *out, const char *key, const double rgb[3])
{
    fprintf(out, ", %s: ", key);
    put_color(out, rgb);
    fputs("}\n", out);
}

static struct vector read_point(struct importer *importer, const struct statement *statement,
                                const char *name, const struct transform *placement,
                                struct vector otherwise)
{
    struct vector point = statement_vector(importer, statement, name, otherwise);
    return transform_point(placement, point);
}

static void point(struct importer *importer, const struct statement *statement,
                  const struct transform *placement)
{
    FILE *out = importer->scene.lights.stream;
    double rgb[3];
    light_color(importer, statement, "I", "power", 4.0 * PI, rgb);
    begin(out, "point", "location",
          read_point(importer, statement, "from", placement, (struct vector){0, 0, 0}));
    end(out, "intensity", rgb);
}

/* Two points of a light's axis; false, reported, where they are one. */
static bool read_axis(struct importer *importer, const struct statement *statement,
                      const struct transform *placement, struct vector *from, struct vector *to)
{
    *from = read_point(importer, statement, "from", placement, (struct vector){0, 0, 0});
    *to = read_point(importer, statement, "to", placement, (struct vector){0, 0, 1});
    double length = vector_length(vector_subtract(*to, *from));
    if (length > 1e-6 * (vector_length(*from) + 1e-30) && length <= 1e30)
        return true;
    importer_error(importer, &statement->origin, statement->width,
                   "LightSource %s: from and to must differ", statement->kind);
    return false;
}

static void put_spotlight(struct importer *importer, struct vector from, struct vector to,
                          double radius, double falloff, const double rgb[3])
{
    FILE *out = importer->scene.lights.stream;
    begin(out, "spotlight", "location", from);
    fputs(", point_at: ", out);
    put_vector(out, to);
    fputs(", radius: ", out);
    put_number(out, radius);
    fputs(", falloff: ", out);
    put_number(out, falloff);
    end(out, "intensity", rgb);
}

static void spot(struct importer *importer, const struct statement *statement,
                 const struct transform *placement)
{
    struct vector from, to;
    double rgb[3], cone = statement_number(importer, statement, "coneangle", 30.0);
    double delta = statement_number(importer, statement, "conedeltaangle", 5.0);
    double falloff = fmin(fmax(cone, 0.01), 90.0), radius = fmin(fmax(cone - delta, 0.01), falloff);
    double start = cos(radius * PI / 180.0), stop = cos(falloff * PI / 180.0);
    if (falloff != cone)
        importer_warn(importer, &statement->origin, statement->width,
                      "LightSource spot: coneangle is limited to 90");
    light_color(importer, statement, "I", "power",
                2.0 * PI * ((1.0 - start) + (start - stop) / 2.0), rgb);
    if (read_axis(importer, statement, placement, &from, &to))
        put_spotlight(importer, from, to, radius, falloff, rgb);
}

static void distant(struct importer *importer, const struct statement *statement,
                    const struct transform *placement)
{
    FILE *out = importer->scene.lights.stream;
    struct vector from, to;
    double rgb[3];
    light_color(importer, statement, "L", "illuminance", 1.0, rgb);
    if (!read_axis(importer, statement, placement, &from, &to))
        return;
    begin(out, "sun", "direction", vector_subtract(to, from));
    fputs(", angle: 0", out);
    end(out, "irradiance", rgb);
}

static void infinite(struct importer *importer, const struct statement *statement,
                     const struct transform *placement)
{
    const char *file =
        statement_string(importer, statement, importer->version == 3 ? "mapname" : "filename");
    static const char *const sampling[] = {"samples", "nsamples"};
    double rgb[3];
    (void)placement;
    statement_ignore(statement, sampling, 2);
    light_color(importer, statement, "L", file ? "" : "illuminance", PI, rgb);
    if (statement_find(statement, "portal"))
        importer_warn(importer, &statement->origin, statement->width,
                      "LightSource infinite: portal is left out");
    if (file) {
        light_add_sky(importer, statement, file, rgb);
        return;
    }
    fputs("  - sky: {radiance: ", importer->scene.lights.stream);
    put_color(importer->scene.lights.stream, rgb);
    fputs("}\n", importer->scene.lights.stream);
}

static void goniometric(struct importer *importer, const struct statement *statement,
                        const struct transform *placement)
{
    static const char *const pictures[] = {"filename", "mapname"};
    statement_ignore(statement, pictures, 2);
    importer_warn(importer, &statement->origin, statement->width,
                  "LightSource goniometric: a point light that shines the same in all directions "
                  "stands in for it");
    point(importer, statement, placement);
}

static void projection(struct importer *importer, const struct statement *statement,
                       const struct transform *placement)
{
    static const char *const pictures[] = {"filename", "mapname"};
    struct vector from = transform_point(placement, (struct vector){0, 0, 0});
    struct vector to = transform_point(placement, (struct vector){0, 0, 1});
    double rgb[3], half = 0.5 * statement_number(importer, statement, "fov",
                                                 importer->version == 3 ? 45.0 : 90.0);
    half = fmin(fmax(half, 0.01), 90.0);
    statement_ignore(statement, pictures, 2);
    importer_warn(importer, &statement->origin, statement->width,
                  "LightSource projection: a spotlight without its picture stands in for it");
    light_color(importer, statement, "I", "", 1.0, rgb);
    put_spotlight(importer, from, to, half, half, rgb);
}

static const struct {
    const char *name;
    void (*add)(struct importer *importer, const struct statement *statement,
                const struct transform *placement);
} kinds[] = {
    {"point", point},           {"spot", spot},           {"distant", distant},
    {"infinite", infinite},     {"exinfinite", infinite}, {"goniometric", goniometric},
    {"projection", projection},
};

void light_add(struct importer *importer, const struct statement *statement)
{
    struct transform placement;
    if (!importer_placement(importer, &importer->state.ctm, &statement->origin, statement->width,
                            &placement))
        return;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(statement->kind, kinds[i].name) == 0) {
            kinds[i].add(importer, statement, &placement);
            statement_report_unused(importer, statement);
            return;
        }
    importer_warn(importer, &statement->origin, statement->width,
                  "LightSource '%.40s' has no counterpart: left out", statement->kind);
}

struct pattern light_emission(struct importer *importer, const struct statement *statement,
                              double area)
{
    static const char *const sampling[] = {"samples", "nsamples"};
    const char *file = statement_string(importer, statement, "filename");
    bool both = statement_bool(importer, statement, "twosided", false);
    double rgb[3];
    struct pattern pattern;
    statement_ignore(statement, sampling, 2);
    if (strcmp(statement->kind, "diffuse") != 0 && strcmp(statement->kind, "area") != 0)
        importer_warn(importer, &statement->origin, statement->width,
                      "AreaLightSource '%.40s' is taken for diffuse", statement->kind);
    if (area <= 0.0 && statement_find(statement, "power")) {
        importer_warn(importer, &statement->origin, statement->width,
                      "AreaLightSource: the power on a shape whose area is not known is taken for "
                      "its radiance");
        area = 1.0 / PI;
    }
    double mean = 1.0;
    if (file && statement_find(statement, "power"))
        mean = light_picture_luminance(importer, statement, file);
    light_color(importer, statement, "L", "power", mean * PI * area * (both ? 2.0 : 1.0), rgb);
    struct place place = statement_place(statement, NULL);
    pattern = file ? texture_image(importer, &place, file) : pattern_constant(rgb);
    if (file)
        pattern_multiply(&pattern, rgb);
    statement_report_unused(importer, statement);
    return pattern;
}
