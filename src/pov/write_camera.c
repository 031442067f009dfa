/* write_camera.c: POV-Ray's camera as psplat's; see write.h.
 *
 * look_at turns direction, up and right of POV-Ray's camera, and keeps their lengths; `angle` makes
 * direction as long as it takes (reference of POV-Ray 3.7, "Camera").
 */
#include "pov/write.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Turned to look_at; before transforms. */
static void turn(struct pov_camera *camera)
{
    struct vector to = vector_subtract(camera->look_at, camera->location);
    double direction = vector_length(camera->direction), right = vector_length(camera->right),
           up = vector_length(camera->up);
    bool is_left_handed =
        vector_dot(vector_cross(camera->right, camera->up), camera->direction) >= 0.0;
    if (!camera->has_look_at || !(vector_length(to) > 0.0))
        return;
    camera->direction = vector_scale(vector_unit(to), direction);
    struct vector side = vector_cross(camera->sky, camera->direction);
    if (!(vector_length(side) > 1e-9 * direction))
        side = vector_cross((struct vector){0, 0, 1}, camera->direction);
    side = vector_unit(side);
    camera->right = vector_scale(side, is_left_handed ? right : -right);
    camera->up = vector_scale(vector_unit(vector_cross(camera->direction, side)), up);
}

static void write_image(struct pov_writer *writer, double aspect)
{
    double width = aspect >= 1.0 ? 800.0 : round(600.0 * aspect);
    double height = aspect >= 1.0 ? round(800.0 / aspect) : 600.0;
    fprintf(writer->reader->scene.image.stream, "{width: %d, height: %d}\n",
            (int)fmin(fmax(width, 1.0), 65536.0), (int)fmin(fmax(height, 1.0), 65536.0));
}

static void write_lens(struct pov_writer *writer, const struct pov_camera *camera,
                       struct vector direction)
{
    FILE *out = writer->reader->scene.camera.stream;
    if (!(camera->aperture > 0.0) || camera->orthographic)
        return;
    struct vector focal = camera->has_focal_point ? camera->focal_point : camera->look_at;
    double focus =
        vector_dot(vector_subtract(transform_point(&camera->place, focal), camera->location),
                   vector_unit(direction));
    fputs(", aperture: ", out);
    put_number(out, fmin(0.5 * camera->aperture, 1e6));
    if (focus > 1e-6) {
        fputs(", focus: ", out);
        put_number(out, fmin(focus, 1e9));
    }
}

void pov_write_camera(struct pov_writer *writer)
{
    static const struct pov_camera usual = {.direction = {0, 0, 1},
                                            .right = {4.0 / 3.0, 0, 0},
                                            .up = {0, 1, 0},
                                            .sky = {0, 1, 0},
                                            .place = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
    struct pov_reader *reader = writer->reader;
    struct pov_camera camera = reader->camera ? *reader->camera : usual;
    FILE *out = reader->scene.camera.stream;
    turn(&camera);
    struct vector direction = transform_direction(&camera.place, camera.direction),
                  right = transform_direction(&camera.place, camera.right),
                  up = transform_direction(&camera.place, camera.up);
    double looks =
        camera.has_look_at ? vector_length(vector_subtract(camera.look_at, camera.location)) : 1.0;
    camera.location = transform_point(&camera.place, camera.location);
    double width = vector_length(right), height = vector_length(up),
           depth = vector_length(direction);
    bool good = width > 1e-9 && height > 1e-9 && depth > 1e-9 && width < 1e9 && height < 1e9 &&
                depth < 1e9 && vector_length(camera.location) < 1e12 && looks < 1e12 &&
                vector_length(vector_cross(direction, up)) > 1e-6 * depth * height;
    if (!good) {
        pov_error(reader, &reader->camera_token,
                  "camera: direction, up and right must be of some length, and differ");
        return;
    }
    bool is_left_handed = vector_dot(vector_cross(right, up), direction) >= 0.0;
    writer->mirror = is_left_handed ? transform_scale(1, 1, -1) : transform_identity;
    writer->middle =
        vector_add(camera.location, vector_scale(vector_unit(direction), fmax(looks, 1e-3)));
    writer->extent = 100.0 * (vector_length(camera.location) + looks + 1.0);
    struct vector middle = transform_point(&writer->mirror, writer->middle);
    write_image(writer, width / height);
    fputs("{location: ", out);
    put_vector(out, transform_point(&writer->mirror, camera.location));
    fputs(", look_at: ", out);
    put_vector(out, middle);
    fputs(", up: ", out);
    put_vector(out, transform_direction(&writer->mirror, vector_unit(up)));
    double angle = camera.angle > 0.0 ? fmin(camera.angle, 179.0)
                                      : 2.0 * atan(0.5 * width / depth) * 180.0 / PI;
    if (camera.orthographic) {
        if (camera.angle > 0.0)
            width = 2.0 * looks * tan(0.5 * angle * PI / 180.0);
        fputs(", projection: orthographic, width: ", out);
        put_number(out, fmax(width, 1e-6));
    } else {
        fputs(", angle: ", out);
        put_number(out, fmin(fmax(angle, 0.01), 179.0));
    }
    write_lens(writer, &camera, direction);
    fputs("}\n", out);
}
