/* scene_text.c: the scene that shows a lone model, section by section.
 *
 * Sky, sun and ground go together: a sun as wide as a softbox, from the left, the front and above,
 * models the shape; and the ground has the radiance of the sky where both are seen, so that no
 * horizon stands behind the model,
 *
 *     reflectance = pi L_sky / (E_sun cos(theta) + pi L_sky).
 */
#include "model/model.h"

#include "import/import.h"
#include "parser/yaml/quote.h"
#include <locale.h>
#include <math.h>
#include <psplat/math.h>
#include <stdio.h>
#include <stdlib.h>

#define SKY_RADIANCE 0.45
#define SUN_IRRADIANCE 4.0
#define SUN_ANGLE 25.0
static const ps_vec3 sun_direction = {0.6F, -1.0F, -0.7F};

#define GROUND_RADII 40.0 /* of the model: as far as a picture shows */

#define LAMP_RADIANCE 10.0

/* Above middle grey, to which the tone map brings the mean of the picture. */
#define EXPOSURE 0.8

static float reach(ps_vec3 p)
{
    return fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z)));
}

/* Four of the model's size, and more where it is far from the origin. */
static int digits_of(const struct box *box)
{
    double size = (double)ps_length(ps_subtract(box->high, box->low));
    double farthest = (double)fmaxf(reach(box->low), reach(box->high));
    return 4 + (int)fmin(ceil(log10(fmax(farthest / size, 1.0))), 5.0);
}

static void write_point(FILE *stream, const char *key, ps_vec3 p, int digits)
{
    fprintf(stream, "%s: [%.*g, %.*g, %.*g]", key, digits, (double)p.x, digits, (double)p.y, digits,
            (double)p.z);
}

static void write_camera(FILE *stream, const struct model *model)
{
    const struct room *room = &model->room;
    if (model->has_camera) {
        fputs("# The file has a camera, which the mesh below brings. One that is written here goes "
              "before it:\n"
              "# camera: auto\n\n",
              stream);
        return;
    }
    if (room->is_room) {
        fputs("# The model is a room, so the camera looks into it. `camera: auto` would look at it "
              "from outside.\n"
              "camera: {",
              stream);
        write_point(stream, "location", room->location, digits_of(&model->box));
        write_point(stream, ", look_at", room->look_at, digits_of(&model->box));
        fprintf(stream, ", angle: %g}\n\n", room->angle);
        return;
    }
    fputs("# The camera goes where it sees the whole model, in front of it (at +z), a little to "
          "the right and above.\n"
          "# `psplat check --bounds` prints its place in numbers, and the size of the model.\n"
          "camera: {location: auto, look_at: auto}\n\n",
          stream);
}

static bool has_ground(const struct model *model)
{
    return !model->has_camera && !model->has_lights && !model->room.is_room;
}

static void write_materials(FILE *stream, const struct model *model)
{
    if (!has_ground(model) && model->has_materials)
        return;
    fputs("materials: # the part of the light that each surface gives back\n", stream);
    if (!model->has_materials)
        fprintf(stream, "  grey: {diffuse: %g} # of the model, whose file has no materials\n",
                MESH_PLAIN_REFLECTANCE);
    double sky = (double)PS_PI * SKY_RADIANCE;
    double slope = 1.0 / (double)ps_length(sun_direction);
    if (has_ground(model))
        fprintf(stream, "  ground: {diffuse: %.3f}\n", sky / (SUN_IRRADIANCE * slope + sky));
    fputc('\n', stream);
}

static void write_lights(FILE *stream, const struct model *model)
{
    if (model->has_lights) {
        fputs("# The file has lights, or surfaces that shine. More lights can be added here.\n"
              "lights: []\n\n",
              stream);
        return;
    }
    fputs("lights:\n", stream);
    if (model->room.is_room) {
        fputs("  - sphere: # a lamp below the ceiling\n      ", stream);
        write_point(stream, "location", model->room.lamp, digits_of(&model->box));
        fprintf(stream, "\n      radius: %.2g\n      radiance: %g\n      visible: no\n\n",
                model->room.lamp_radius, LAMP_RADIANCE);
        return;
    }
    fprintf(stream, "  - sky: {radiance: %g} # even, all around\n", SKY_RADIANCE);
    write_point(stream, "  - sun: {direction", sun_direction, 4);
    fprintf(stream, ", angle: %g, irradiance: %g} # wide, for soft shadows\n\n", SUN_ANGLE,
            SUN_IRRADIANCE);
}

/* A plane lies around its point next to the origin, which is moved where the model is far from
 * there. */
static void write_ground(FILE *stream, const struct box *box)
{
    double radius = 0.5 * (double)ps_length(ps_subtract(box->high, box->low));
    ps_vec3 center = box_center(box);
    fprintf(stream,
            "  - plane: # the ground, just below the model\n"
            "      normal: [0, 1, 0]\n"
            "      distance: auto\n"
            "      extent: %.2g\n",
            GROUND_RADII * radius);
    center.y = 0;
    if ((double)ps_length(center) > radius) {
        write_point(stream, "      translate", center, digits_of(box));
        fputc('\n', stream);
    }
    fputs("      material: ground\n", stream);
}

static void write_objects(FILE *stream, const struct model *model, const char *file)
{
    static const char axes[] = "xyz";
    fputs("objects:\n  - mesh:\n      file: ", stream);
    yaml_quote(stream, file);
    fprintf(stream, "\n      use: [geometry, materials%s%s]\n", model->has_camera ? ", camera" : "",
            model->has_lights ? ", lights" : "");
    fprintf(stream, "      up: %c # which of its axes points upwards: x, y or z\n",
            axes[model->up]);
    fputs("      # rotate: [0, 30, 0]\n", stream);
    if (!model->has_materials)
        fputs("      material: grey\n", stream);
    if (has_ground(model))
        write_ground(stream, &model->box);
    fputc('\n', stream);
}

static void write_scene(FILE *stream, const struct model *model, const char *file)
{
    fputs("# A scene around one model. psd(5) describes all that can be said here, `psplat check` "
          "finds mistakes.\n"
          "psd: 1\n\n",
          stream);
    write_camera(stream, model);
    fprintf(stream,
            "image: {width: 800, height: 450, exposure: %g} # exposure: stops brighter than the "
            "tone map makes it\n\n",
            EXPOSURE);
    write_materials(stream, model);
    write_lights(stream, model);
    write_objects(stream, model, file);
    fputs("render:\n"
          "  tonemap: {filmic: {exposure: auto}} # brings the picture to middle grey, however "
          "bright the lights are\n",
          stream);
}

char *model_scene_text(const struct model *model, const char *file)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return NULL;
    locale_t decimal_point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    locale_t caller = uselocale(decimal_point);
    write_scene(stream, model, file);
    uselocale(caller);
    freelocale(decimal_point);
    bool good = ferror(stream) == 0;
    if (fclose(stream) == 0 && good)
        return text;
    free(text);
    return NULL;
}
