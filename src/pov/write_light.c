/* write_light.c: POV-Ray's lights as psplat's; see write.h.
 *
 * A light of POV-Ray lights a surface with its colour times the cosine, at any distance unless it
 * fades; psplat's of intensity I with I / (pi d^2) times the cosine. fade_distance f and fade_power
 * 2 make 2 / (1 + (d / f)^2) of the colour, which far beyond f is 2 f^2 / d^2: an intensity of 2 pi
 * f^2. A light that does not fade, or otherwise, gets the intensity that is right where the camera
 * looks.
 *
 * An area light of POV-Ray is a grid of points that each shine in all directions. Spheres of its
 * area do the same, in a row where it is long.
 */
#include "pov/write.h"

#include <math.h>

#define PI 3.14159265358979323846

/* What POV-Ray makes of a light's colour at that distance. */
static double faded(const struct pov_light *light, double distance)
{
    if (!(light->fade_power > 0.0) || !(light->fade_distance > 1e-10))
        return 1.0;
    double ratio = distance / light->fade_distance;
    if (light->fade_power >= 1000.0)
        return 1.0 / (ratio * ratio);
    return 2.0 / (1.0 + pow(ratio, light->fade_power));
}

/* W/sr for a colour of 1. */
static double intensity_of(struct pov_writer *writer, const struct pov_object *object,
                           struct vector location)
{
    const struct pov_light *light = object->light;
    double square = light->fade_distance * light->fade_distance;
    bool fades = light->fade_power > 0.0 && light->fade_distance > 1e-10;
    if (fades && light->fade_power >= 1000.0)
        return PI * square;
    if (fades && light->fade_power == 2.0)
        return 2.0 * PI * square;
    double distance = vector_length(vector_subtract(location, writer->middle));
    distance = distance > 1e-6 ? distance : 1.0;
    pov_warn_at(writer->reader, object->file, &object->token,
                fades ? "light_source: fades by the square of the distance instead, and as in "
                        "POV-Ray where the camera looks"
                      : "light_source without fade_power: fades by the square of the distance, and "
                        "is as in POV-Ray where the camera looks");
    return PI * distance * distance * faded(light, distance);
}

static void put_end(struct pov_writer *writer, const char *key, const double color[3],
                    double factor)
{
    FILE *out = writer->reader->scene.lights.stream;
    double rgb[3];
    for (int i = 0; i < 3; i++)
        rgb[i] = fmin(fmax(color[i] * factor, 0.0), 1e30);
    fprintf(out, ", %s: ", key);
    put_color(out, rgb);
    fputs("}\n", out);
}

static void put_begin(struct pov_writer *writer, const char *kind, const char *key, struct vector a)
{
    FILE *out = writer->reader->scene.lights.stream;
    fprintf(out, "  - %s: {%s: ", kind, key);
    put_vector(out, a);
}

static bool differ(struct vector a, struct vector b)
{
    return vector_length(vector_subtract(a, b)) > 1e-6 * (vector_length(a) + 1e-3);
}

static void put_sun(struct pov_writer *writer, struct vector from, struct vector to,
                    const double color[3])
{
    put_begin(writer, "sun", "direction",
              transform_direction(&writer->mirror, vector_subtract(to, from)));
    fputs(", angle: 0", writer->reader->scene.lights.stream);
    put_end(writer, "irradiance", color, PI);
}

static void put_spot(struct pov_writer *writer, const struct pov_light *light, struct vector from,
                     struct vector to, const double color[3], double intensity)
{
    FILE *out = writer->reader->scene.lights.stream;
    double falloff = fmin(fmax(light->falloff, 0.01), 90.0);
    double radius = fmin(fmax(light->radius, 0.01), falloff);
    put_begin(writer, "spotlight", "location", transform_point(&writer->mirror, from));
    fputs(", point_at: ", out);
    put_vector(out, transform_point(&writer->mirror, to));
    fputs(", radius: ", out);
    put_number(out, radius);
    fputs(", falloff: ", out);
    put_number(out, falloff);
    if (light->tightness > 0.0) {
        fputs(", tightness: ", out);
        put_number(out, fmin(light->tightness, 1e4));
    }
    put_end(writer, "intensity", color, intensity);
}

/* Spheres along the longer side, each as wide as the shorter one; points where that is 0. */
static void put_area(struct pov_writer *writer, const struct pov_light *light,
                     struct vector location, const struct transform *place, const double color[3],
                     double intensity)
{
    struct vector axes[2];
    for (int i = 0; i < 2; i++)
        axes[i] = transform_direction(place, light->axes[i]);
    double a = light->sizes[0] > 1 ? vector_length(axes[0]) : 0.0,
           b = light->sizes[1] > 1 ? vector_length(axes[1]) : 0.0;
    int longer = a >= b ? 0 : 1, count = 1;
    double length = fmax(a, b), width = fmin(a, b);
    double most = fmin(light->sizes[longer], 16.0);
    if (!(length < 1e12))
        length = width = 0.0;
    if (length > 0.0)
        count = (int)fmin(fmax(width > 0.0 ? round(length / width) : most, 1.0), most);
    double area = length * width / count * (light->circular ? PI / 4.0 : 1.0);
    double radius = sqrt(area / PI);
    if (count > 1) /* apart: they would hide each other */
        radius = fmin(radius, 0.4 * length / count);
    for (int i = 0; i < count; i++) {
        double share = (i + 0.5) / count - 0.5;
        struct vector p = {location.x + share * axes[longer].x, location.y + share * axes[longer].y,
                           location.z + share * axes[longer].z};
        p = transform_point(&writer->mirror, p);
        if (!(radius > 1e-6 * (vector_length(p) + 1e-3))) {
            put_begin(writer, "point", "location", p);
            put_end(writer, "intensity", color, intensity / count);
            continue;
        }
        put_begin(writer, "sphere", "location", p);
        fputs(", radius: ", writer->reader->scene.lights.stream);
        put_number(writer->reader->scene.lights.stream, radius);
        fputs(", visible: no", writer->reader->scene.lights.stream);
        put_end(writer, "radiance", color, intensity / count / (PI * radius * radius));
    }
}

void pov_write_light(struct pov_writer *writer, const struct pov_object *object,
                     const struct transform *place)
{
    const struct pov_light *light = object->light;
    struct vector from = transform_point(place, object->p[0]);
    struct vector to = transform_point(place, object->p[1]);
    double color[3];
    for (int i = 0; i < 3; i++)
        if (light->color[i] < 0.0)
            pov_warn_at(writer->reader, object->file, &object->token,
                        "light_source: negative light is left out");
    pov_linear(writer->reader, light->color, color);
    if (!(fmax(color[0], fmax(color[1], color[2])) > 0.0) || !(vector_length(from) < 1e15) ||
        !(vector_length(to) < 1e15))
        return;
    if (light->shadowless)
        pov_warn_at(writer->reader, object->file, &object->token,
                    "light_source: shadowless is left out; it casts shadows");
    if (light->cylinder)
        pov_warn_at(writer->reader, object->file, &object->token,
                    "light_source: a spotlight stands in for a cylinder");
    if (light->spot && light->area)
        pov_warn_at(writer->reader, object->file, &object->token,
                    "light_source: a spotlight with an area shines from a point");
    if (light->parallel && !light->spot && differ(from, to)) {
        put_sun(writer, from, to, color);
        return;
    }
    double intensity = intensity_of(writer, object, from);
    if (light->spot && differ(from, to)) {
        put_spot(writer, light, from, to, color, intensity);
    } else if (light->area && !light->spot) {
        put_area(writer, light, from, place, color, intensity);
    } else {
        put_begin(writer, "point", "location", transform_point(&writer->mirror, from));
        put_end(writer, "intensity", color, intensity);
    }
}
