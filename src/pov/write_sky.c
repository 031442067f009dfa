/* write_sky.c: background and sky_sphere as psplat's sky; see write.h.
 *
 * POV-Ray's background and sky are only seen; psplat's also light the scene. A sky of a pattern is
 * drawn by longitude and latitude, as psd(5) has it: the middle at negative z, the top at y.
 */
#include "pov/write.h"

#include "image/image.h"
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
#define WIDTH 256
#define HEIGHT 128

/* The colour of the gradient in a direction of POV-Ray's world. */
static void color_of(const struct pov_pigment *sky, const struct transform *to_pattern,
                     struct vector direction, double color[3])
{
    struct vector p = transform_point(to_pattern, direction);
    double at = vector_dot(p, sky->axis), mean[POV_TERMS];
    const struct pov_color_map *map = sky->map;
    at -= floor(at);
    if (vector_dot(p, sky->axis) >= 1.0 - 1e-9 && vector_dot(p, sky->axis) < 1.0 + 1e-9)
        at = 1.0; /* the zenith itself */
    pov_pigment_mean(sky, mean);
    if (sky->pattern == POV_PATTERN_GRADIENT && map && map->count > 0)
        pov_color_at(map, at, mean);
    for (int i = 0; i < 3; i++)
        color[i] = mean[i];
}

/* NULL: out of memory. */
static struct image *draw(struct pov_writer *writer, const struct transform *to_pattern)
{
    static const char *const names[] = {"R", "G", "B"};
    struct image *image = calloc(1, sizeof *image);
    float *planes[3];
    if (!image)
        return NULL;
    image->width = WIDTH;
    image->height = HEIGHT;
    for (int c = 0; c < 3; c++) {
        planes[c] = image_add_channel(image, names[c]);
        if (!planes[c]) {
            image_release(image);
            free(image);
            return NULL;
        }
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        size_t row = i / WIDTH, column = i % WIDTH;
        double longitude = 2.0 * PI * (((double)column + 0.5) / WIDTH - 0.5);
        double polar = PI * ((double)row + 0.5) / HEIGHT, color[3], linear[3];
        struct vector d = {sin(polar) * sin(longitude), cos(polar), -sin(polar) * cos(longitude)};
        d = transform_direction(&writer->mirror, d); /* it is its own inverse */
        color_of(writer->reader->sky, to_pattern, d, color);
        pov_linear(writer->reader, color, linear);
        for (int c = 0; c < 3; c++)
            planes[c][i] = (float)linear[c];
    }
    return image;
}

static void write_picture(struct pov_writer *writer)
{
    struct pov_reader *reader = writer->reader;
    struct transform to_pattern;
    if (!transform_invert(&reader->sky->place, &to_pattern))
        return;
    struct side_file *file = scene_text_file(&reader->scene, reader->options->base, "sky", "exr");
    if (file)
        file->picture = draw(writer, &to_pattern);
    if (!file || !file->picture) {
        pov_no_memory(reader);
        return;
    }
    fputs("  - sky: {file: ", reader->scene.lights.stream);
    put_path(reader->scene.lights.stream, file->name);
    fputs("}\n", reader->scene.lights.stream);
}

static void write_uniform(struct pov_writer *writer, const double color[3])
{
    double linear[3];
    pov_linear(writer->reader, color, linear);
    if (!(fmax(linear[0], fmax(linear[1], linear[2])) > 0.0))
        return;
    fputs("  - sky: {radiance: ", writer->reader->scene.lights.stream);
    put_color(writer->reader->scene.lights.stream, linear);
    fputs("}\n", writer->reader->scene.lights.stream);
}

void pov_write_sky(struct pov_writer *writer)
{
    struct pov_reader *reader = writer->reader;
    const struct pov_pigment *sky = reader->sky;
    double mean[POV_TERMS];
    bool shines = reader->background[0] + reader->background[1] + reader->background[2] > 0.0;
    if (sky || (reader->has_background && shines))
        pov_warn_at(reader, sky ? sky->file : reader->background_file,
                    sky ? &sky->token : &reader->background_token,
                    "background and sky_sphere light the scene too, as they do in POV-Ray's "
                    "radiosity alone");
    if (!sky) {
        if (reader->has_background)
            write_uniform(writer, reader->background);
        return;
    }
    if (sky->pattern == POV_PATTERN_GRADIENT && sky->map && sky->map->count > 0) {
        write_picture(writer);
        return;
    }
    if (sky->pattern != POV_PATTERN_PLAIN)
        pov_warn_at(reader, sky->file, &sky->token, "sky_sphere: its mean colour stands for it");
    pov_pigment_mean(sky, mean);
    write_uniform(writer, mean);
}
