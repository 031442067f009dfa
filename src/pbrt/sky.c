/* sky.c: pictures of infinite lights, drawn anew by longitude and latitude as psd(5) has them.
 *
 * pbrt-v3's pictures are by longitude and latitude too, but about the z axis of the light, which
 * the transform turns as it likes. pbrt-v4's are squares: the octahedron, unfolded and stretched to
 * equal areas (P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", Journal of
 * Graphics Tools 2008). The new picture has about as many pixels around the horizon as the old one.
 */
#include "pbrt/light.h"

#include "image/image.h"
#include "pbrt/spectrum.h"
#include "scene/texture.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define WIDEST 8192

/* From a unit vector to the square, both in 0..1, v downwards in the picture. */
static void equal_area_square(struct vector d, double uv[2])
{
    double x = fabs(d.x), y = fabs(d.y), r = sqrt(fmax(1.0 - fabs(d.z), 0.0));
    double most = fmax(x, y), least = fmin(x, y);
    double phi = atan(most > 0.0 ? least / most : 0.0) * 2.0 / PI;
    phi = x < y ? 1.0 - phi : phi;
    double v = phi * r, u = r - v;
    if (d.z < 0.0) {
        double swapped = u;
        u = 1.0 - v;
        v = 1.0 - swapped;
    }
    uv[0] = 0.5 * (copysign(u, d.x) + 1.0);
    uv[1] = 0.5 * (copysign(v, d.y) + 1.0);
}

/* pbrt-v3: z is up, and the top row of the picture. */
static void longitude_latitude(struct vector d, double uv[2])
{
    double turn = atan2(d.y, d.x) / (2.0 * PI);
    uv[0] = turn < 0.0 ? turn + 1.0 : turn;
    uv[1] = atan2(hypot(d.x, d.y), d.z) / PI;
}

/* Where psd(5) has a pixel of a sky: the middle of the picture is at negative z, the top at y. */
static struct vector direction_of(double u, double v)
{
    double longitude = 2.0 * PI * (u - 0.5), sine = sin(PI * v);
    return (struct vector){sine * sin(longitude), cos(PI * v), -sine * cos(longitude)};
}

static double luminance_of(const float rgba[4])
{
    return spectrum_luminance((const double[3]){rgba[0], rgba[1], rgba[2]});
}

/* Returns the illuminance of a surface that faces the light's z axis: the integral of luminance
 * times cosine. */
static double draw(const struct texture *texture, const struct transform *to_light, bool square,
                   struct image *sky, float *const planes[3])
{
    double illuminance = 0.0;
    for (size_t row = 0; row < sky->height; row++)
        for (size_t column = 0; column < sky->width; column++) {
            double u = ((double)column + 0.5) / (double)sky->width,
                   v = ((double)row + 0.5) / (double)sky->height;
            double uv[2];
            struct vector d = transform_direction(to_light, direction_of(u, v));
            double length = vector_length(d);
            float rgba[4];
            d = (struct vector){d.x / length, d.y / length, d.z / length};
            (square ? equal_area_square : longitude_latitude)(d, uv);
            texture_sample(texture, (float)uv[0], (float)(1.0 - uv[1]), rgba);
            illuminance += fmax(d.z, 0.0) * sin(PI * v) * luminance_of(rgba);
            for (int c = 0; c < 3; c++)
                planes[c][row * sky->width + column] = rgba[c];
        }
    return illuminance * 2.0 * PI * PI / ((double)sky->width * (double)sky->height);
}

/* The picture, to be owned by a side file; NULL: reported. */
static struct image *make_sky(struct importer *importer, const struct texture *texture,
                              const struct transform *to_light, bool square, double *illuminance)
{
    struct image *sky = calloc(1, sizeof *sky);
    float *planes[3] = {NULL, NULL, NULL};
    if (!sky) {
        importer_no_memory(importer);
        return NULL;
    }
    sky->width = square ? 2 * (size_t)texture->width : texture->width;
    sky->width = sky->width < WIDEST ? sky->width : WIDEST;
    sky->height = (sky->width + 1) / 2;
    bool good = true;
    for (int c = 0; c < 3 && good; c++) {
        planes[c] = image_add_channel(sky, (const char *const[]){"R", "G", "B"}[c]);
        good = planes[c] != NULL;
    }
    if (!good) {
        importer_no_memory(importer);
        image_release(sky);
        free(sky);
        return NULL;
    }
    *illuminance = draw(texture, to_light, square, sky, planes);
    return sky;
}

/* Draws the picture anew into a side file. NULL: reported. */
static const char *convert(struct importer *importer, const struct statement *statement,
                           const struct texture *texture, double *illuminance)
{
    struct transform placement, to_light;
    bool square = importer->version == 4;
    if (!importer_placement(importer, &importer->state.ctm, &statement->origin, statement->width,
                            &placement) ||
        !transform_invert(&placement, &to_light))
        return NULL;
    if (square && texture->width != texture->height) {
        importer_warn(importer, &statement->origin, statement->width,
                      "LightSource infinite: pbrt-v4's pictures are square; this one is read by "
                      "longitude and latitude");
        square = false;
    }
    struct image *sky = make_sky(importer, texture, &to_light, square, illuminance);
    if (!sky)
        return NULL;
    struct side_file *file =
        scene_text_file(&importer->scene, importer->options->base, "sky", "exr");
    if (!file) {
        image_release(sky);
        free(sky);
        importer_no_memory(importer);
        return NULL;
    }
    file->picture = sky;
    return file->name;
}

/* False: reported. */
static bool load(struct importer *importer, const struct statement *statement, const char *name,
                 struct texture *texture)
{
    struct error error;
    char *path = importer_file_path(importer, name);
    if (!path)
        return false;
    const struct texture_description description = {.path = path};
    bool good =
        texture_load(&description, &(struct texture_storage){.folder = importer->options->folder},
                     texture, &error) == PS_OK;
    if (!good)
        importer_error(importer, &statement->origin, statement->width, "%s %s: %.300s",
                       statement->directive, statement->kind, error.text);
    free(path);
    return good;
}

double light_picture_luminance(struct importer *importer, const struct statement *statement,
                               const char *file)
{
    struct texture texture;
    double sum = 0.0;
    if (!load(importer, statement, file, &texture))
        return 1.0;
    for (uint32_t row = 0; row < texture.height; row++)
        for (uint32_t column = 0; column < texture.width; column++) {
            float rgba[4];
            texture_texel(&texture, column, row, rgba);
            sum += luminance_of(rgba);
        }
    double mean = sum / ((double)texture.width * (double)texture.height);
    texture_release(&texture);
    return mean > 0.0 ? mean : 1.0;
}

void light_add_sky(struct importer *importer, const struct statement *statement, const char *name,
                   const double rgb[3])
{
    struct texture texture = {0};
    double illuminance = 0.0, wanted = statement_number(importer, statement, "illuminance", -1.0);
    if (!load(importer, statement, name, &texture))
        return;
    const char *file = convert(importer, statement, &texture, &illuminance);
    double factor = wanted > 0.0 && illuminance > 0.0 ? wanted / illuminance : 1.0;
    if (file) {
        FILE *out = importer->scene.lights.stream;
        fputs("  - sky: {file: ", out);
        put_path(out, file);
        fputs(", radiance: ", out);
        put_color(out, (const double[3]){factor * rgb[0], factor * rgb[1], factor * rgb[2]});
        fputs("}\n", out);
    }
    texture_release(&texture);
}
