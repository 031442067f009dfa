/* camera.c: see camera.h.
 *
 * The screen window of pbrt's perspective camera is -1..1 along the shorter side of the picture,
 * where that side spans `fov`: the half width of the window times tan(fov / 2) is the tangent of
 * half the horizontal angle.
 */
#include "pbrt/camera.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

struct screen {
    double left, right, bottom, top;
};

static const struct statement nothing = {.directive = "Camera", .kind = "perspective"};

void camera_settle(struct importer *importer)
{
    importer->mirror = transform_determinant(&importer->camera) < 0.0 ? 1.0 : -1.0;
}

/* --- film
 * ----------------------------------------------------------------------------------------- */

static void film_size(struct importer *importer, const struct statement *film, long size[2])
{
    bool is_v3 = importer->version == 3;
    size[0] = statement_integer(importer, film, "xresolution", is_v3 ? 640 : 1280, 1, 65536);
    size[1] = statement_integer(importer, film, "yresolution", is_v3 ? 480 : 720, 1, 65536);
}

/* A crop window is x0 x1 y0 y1 in shares of the picture, from the upper left corner, or pixels. */
static void read_crop(struct importer *importer, const struct statement *film, const long size[2])
{
    size_t count;
    const double *window = statement_list(importer, film, "cropwindow", 1, &count);
    double scale[2] = {(double)size[0], (double)size[1]};
    if (!window) {
        window = statement_list(importer, film, "pixelbounds", 1, &count);
        scale[0] = scale[1] = 1.0;
    }
    if (!window || count != 4)
        return;
    double x = ceil(window[0] * scale[0]), y = ceil(window[2] * scale[1]);
    double width = ceil(window[1] * scale[0]) - x, height = ceil(window[3] * scale[1]) - y;
    if (x > 0.0 || y > 0.0 || width < (double)size[0] || height < (double)size[1])
        importer_warn(
            importer, &film->origin, film->width,
            "Film: the scene has the whole picture; render with --crop %.0f,%.0f,%.0f,%.0f", x, y,
            width, height);
}

/* In stops: of pbrt-v3 the factor `scale`, of pbrt-v4 that of its sensor, the time that the shutter
 * is open times ISO / 100. */
static double film_exposure(struct importer *importer, const struct statement *film,
                            const struct statement *camera)
{
    double opens = statement_number(importer, camera, "shutteropen", 0.0);
    double factor = statement_number(importer, camera, "shutterclose", 1.0) - opens;
    if (importer->version == 3)
        factor = statement_number(importer, film, "scale", 1.0);
    else
        factor *= statement_number(importer, film, "iso", 100.0) / 100.0;
    return factor > 0.0 ? fmin(fmax(log2(factor), -20.0), 20.0) : 0.0;
}

static const char *pixel_filter(struct importer *importer)
{
    const struct statement *filter = importer->filter;
    static const char *const shape[] = {"xradius", "yradius", "xwidth", "ywidth", "sigma",
                                        "alpha",   "B",       "C",      "tau"};
    if (!filter)
        return importer->version == 3 ? "box" : "gaussian";
    statement_ignore(filter, shape, sizeof shape / sizeof shape[0]);
    statement_report_unused(importer, filter);
    if (strcmp(filter->kind, "box") == 0)
        return "box";
    if (strcmp(filter->kind, "triangle") == 0)
        return "tent";
    if (strcmp(filter->kind, "gaussian") != 0)
        importer_warn(importer, &filter->origin, filter->width,
                      "PixelFilter %.40s: gaussian stands in for it", filter->kind);
    return "gaussian";
}

static void write_image(struct importer *importer, const struct statement *film,
                        const struct statement *camera, const long size[2])
{
    static const char *const no_effect[] = {"filename", "diagonal", "maxsampleluminance",
                                            "maxcomponentvalue", "savefp16"};
    FILE *out = importer->scene.image.stream;
    double exposure = film_exposure(importer, film, camera);
    read_crop(importer, film, size);
    fprintf(out, "{width: %ld, height: %ld, filter: %s", size[0], size[1], pixel_filter(importer));
    if (exposure != 0.0) {
        fputs(", exposure: ", out);
        put_number(out, exposure);
    }
    fputs("}\n", out);
    statement_ignore(film, no_effect, sizeof no_effect / sizeof no_effect[0]);
    statement_report_unused(importer, film);
}

/* --- camera
 * --------------------------------------------------------------------------------------- */

static struct screen read_screen(struct importer *importer, const struct statement *camera,
                                 const long size[2])
{
    double shape = (double)size[0] / (double)size[1];
    double aspect = statement_number(importer, camera, "frameaspectratio", shape);
    if (!(aspect > 0.0))
        aspect = shape;
    double x = aspect > 1.0 ? aspect : 1.0, y = aspect > 1.0 ? 1.0 : 1.0 / aspect;
    struct screen screen = {-x, x, -y, y};
    size_t count;
    const double *window = statement_list(importer, camera, "screenwindow", 1, &count);
    if (window && count == 4)
        screen = (struct screen){window[0], window[1], window[2], window[3]};
    double width = screen.right - screen.left, height = screen.top - screen.bottom;
    struct place place = statement_place(camera, NULL);
    if (!(width > 0.0 && height > 0.0 && width < 1e6 && height < 1e6)) {
        importer_error(importer, place.origin, place.width,
                       "screenwindow: expected left, right, bottom, top");
        return (struct screen){-x, x, -y, y};
    }
    if (fabs(screen.left + screen.right) > 1e-6 * width ||
        fabs(screen.bottom + screen.top) > 1e-6 * height)
        importer_warn(
            importer, place.origin, place.width,
            "Camera: a window that is not about the axis has no counterpart; it is moved there");
    if (fabs(width / height - shape) > 1e-3 * shape)
        importer_warn(importer, place.origin, place.width,
                      "Camera: pixels that are not square have no counterpart; the width is kept");
    return screen;
}

/* The lengths of the camera's own units in the scene: of how much its transform scales. */
static double unit_of(struct importer *importer, const struct statement *camera,
                      const struct transform *to_world)
{
    double lengths[3];
    for (int j = 0; j < 3; j++)
        lengths[j] =
            vector_length((struct vector){to_world->m[0][j], to_world->m[1][j], to_world->m[2][j]});
    double off = fmax(fabs(lengths[0] - lengths[2]), fabs(lengths[1] - lengths[2]));
    if (off > 1e-4 * lengths[2])
        importer_warn(importer, &camera->origin, camera->width,
                      "Camera: a transform that scales by several factors has no counterpart");
    return lengths[2];
}

static void write_view(struct importer *importer, const struct transform *to_scene)
{
    FILE *out = importer->scene.camera.stream;
    struct vector origin = transform_point(to_scene, (struct vector){0, 0, 0});
    struct vector z = transform_direction(to_scene, (struct vector){0, 0, 1});
    struct vector up = transform_direction(to_scene, (struct vector){0, 1, 0});
    double length = vector_length(z), far = fmax(1.0, vector_length(origin)) / length;
    fputs("{location: ", out);
    put_vector(out, origin);
    fputs(", look_at: ", out);
    put_vector(out,
               (struct vector){origin.x + far * z.x, origin.y + far * z.y, origin.z + far * z.z});
    fputs(", up: ", out);
    put_vector(out, (struct vector){up.x / length, up.y / length, up.z / length});
}

static void write_lens(struct importer *importer, const struct statement *camera, double unit)
{
    FILE *out = importer->scene.camera.stream;
    double radius = statement_number(importer, camera, "lensradius", 0.0) * unit;
    double focus = statement_number(importer, camera, "focaldistance", 1e6) * unit;
    if (!(radius > 0.0 && focus > 0.0 && radius < 1e30 && focus < 1e30))
        return;
    fputs(", aperture: ", out);
    put_number(out, radius);
    fputs(", focus: ", out);
    put_number(out, focus);
}

static void write_projection(struct importer *importer, const struct statement *camera,
                             const struct screen *screen, double unit)
{
    FILE *out = importer->scene.camera.stream;
    double half_width = 0.5 * (screen->right - screen->left);
    if (strcmp(camera->kind, "orthographic") == 0) {
        fputs(", projection: orthographic, width: ", out);
        put_number(out, fmin(fmax(2.0 * half_width * unit, 1e-30), 1e30));
        return;
    }
    if (strcmp(camera->kind, "perspective") != 0)
        importer_warn(importer, &camera->origin, camera->width,
                      "Camera %.40s: perspective stands in for it", camera->kind);
    double fov = statement_number(importer, camera, "fov", 90.0);
    double half_fov = statement_number(importer, camera, "halffov", -1.0);
    fov = half_fov > 0.0 ? 2.0 * half_fov : fov;
    if (!(fov > 0.0 && fov < 180.0)) {
        importer_error(importer, &camera->origin, camera->width,
                       "fov: expected a number 0..180, got %g", fov);
        return;
    }
    double angle = 2.0 * atan(half_width * tan(0.5 * fov * PI / 180.0)) * 180.0 / PI;
    fputs(", angle: ", out);
    put_number(out, fmin(fmax(angle, 1e-6), 179.999));
    write_lens(importer, camera, unit);
}

void camera_write(struct importer *importer)
{
    const struct statement *camera =
        importer->camera_statement ? importer->camera_statement : &nothing;
    const struct statement *film = importer->film ? importer->film : &nothing;
    struct transform to_world, to_scene;
    long size[2];
    film_size(importer, film, size);
    write_image(importer, film, camera, size);
    struct screen screen = read_screen(importer, camera, size);
    if (!transform_invert(&importer->camera, &to_world)) {
        importer_error(importer, &camera->origin, camera->width,
                       "the camera's transform has no inverse");
        return;
    }
    if (!importer_placement(importer, &to_world, &camera->origin, camera->width, &to_scene))
        return;
    double unit = unit_of(importer, camera, &to_world);
    write_view(importer, &to_scene);
    write_projection(importer, camera, &screen, unit);
    fputs("}\n", importer->scene.camera.stream);
    statement_report_unused(importer, camera);
}
