/* schema_scene.c: the tables of the whole file, cameras, picture and settings; see schema.h. */
#include "parser/schema/schema_language.h"
#include "parser/schema/schema_rows.h"
#include "settings/kinds.h"
#include "settings/quality.h"

#define LARGEST_SEED 9007199254740992.0 /* 2^53: any double counts up to it in ones */

static const struct schema_row scene_rows[] = {
    VALUE(PS_INT(struct schema_scene, psd, NULL, 1, 1, "",
                 "version of the format that the file is written in")),
    SCHEMA_OTHER_ROW("include", "path of a file, or list of them", "none",
                     "files that belong to the scene"),
    PART(SCHEMA_NAMED, "parameters", "parameter", "none",
         "names for formulas that the command line can set"),
    SCHEMA_OTHER_ROW("define", "map of values by name", "none", "names for formulas"),
    PART(SCHEMA_MAP, "camera", "camera", "cameras, or a mesh, must bring one",
         "from where the scene is seen"),
    PART(SCHEMA_NAMED, "cameras", "camera", "none", "more cameras, by names of their own"),
    PART(SCHEMA_MAP, "image", "image", "its defaults", "size and exposure of the picture"),
    PART(SCHEMA_NAMED, "materials", "material", "none", "surfaces, by names that objects refer to"),
    PART(SCHEMA_LIST, "lights", "lights", "none", "what shines"),
    PART(SCHEMA_NAMED_LISTS, "groups", "objects", "none",
         "objects that are placed together, by names that instances refer to"),
    PART(SCHEMA_LIST, "objects", "objects", "none", "what is lit"),
    PART(SCHEMA_MAP, "render", "render", "its defaults",
         "settings, which the command line overrides"),
};

static const char *const projections[] = {"perspective", "orthographic", NULL};

#define CAMERA(member) offsetof(struct camera_keys, camera.member)

static const struct schema_row camera_rows[] = {
    ROW(SCHEMA_POINT_OR_AUTO, "location", offsetof(struct camera_keys, location), PS_PARAM_VEC3,
        "scene units", "where the camera is; auto: where it sees all there is", ANY),
    ROW(SCHEMA_POINT_OR_AUTO, "look_at", offsetof(struct camera_keys, look_at), PS_PARAM_VEC3,
        "scene units", "the point in the middle of the picture; auto: of what there is", ANY,
        DEFAULT(AUTO_WORD)),
    ROW(SCHEMA_VALUE, "up", CAMERA(up), PS_PARAM_VEC3, "",
        "the direction that points upwards in the picture", ANY, DEFAULT("[0, 1, 0]")),
    VALUE(PS_CHOICE(struct camera_keys, projection, "perspective", projections,
                    "whether things shrink with distance")),
    ROW(SCHEMA_VALUE, "angle", CAMERA(angle), PS_PARAM_NUMBER, "degrees",
        "horizontal field of view; excludes vertical_angle", .param.minimum = 0,
        .param.maximum = 180, .param.flags = PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX,
        .absent =
            "67.38, unless vertical_angle is given; of location: auto 35 along the longer side",
        CHOICE(1, 1)),
    ROW(SCHEMA_VALUE, "vertical_angle", CAMERA(vertical_angle), PS_PARAM_NUMBER, "degrees",
        "vertical field of view; excludes angle", .param.minimum = 0, .param.maximum = 180,
        .param.flags = PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX, .absent = "follows from angle",
        CHOICE(1, 2)),
    ROW(SCHEMA_VALUE, "width", CAMERA(width), PS_PARAM_NUMBER, "scene units",
        "width of what an orthographic camera shows", ABOVE_0,
        .absent = "an orthographic camera requires it, but for location: auto"),
    ROW(SCHEMA_VALUE, "aperture", CAMERA(aperture), PS_PARAM_NUMBER, "scene units",
        "radius of the lens; 0: everything is sharp", FROM_0, DEFAULT("0")),
    ROW(SCHEMA_VALUE, "focus", CAMERA(focus), PS_PARAM_NUMBER, "scene units",
        "distance at which things are sharp", ABOVE_0, .absent = "the distance of look_at"),
};

static const char *const pixel_filters[] = {"box", "tent", "gaussian", NULL};

static const struct schema_row image_rows[] = {
    VALUE(
        PS_INT(struct image_description, width, "800", 1, 65536, "pixels", "width of the picture")),
    VALUE(PS_INT(struct image_description, height, "450", 1, 65536, "pixels",
                 "height of the picture")),
    VALUE(PS_NUMBER(struct image_description, exposure, "0", -20, 20, 0, "stops",
                    "brightness of the PNG preview: each stop doubles it")),
    VALUE(PS_CHOICE(struct image_description, filter, "box", pixel_filters,
                    "filter over the camera samples of a pixel")),
};

#define STRATEGY_ROW(kind_, name_, summary_, default_)                                             \
    ROW(SCHEMA_STRATEGY, name_, offsetof(struct render_description, strategies[kind_]),            \
        PS_PARAM_STRING, "", "plugin: " summary_, ANY, .absent = "psplat's default"),

static const char *const all_bounces[] = {"all", NULL};

static const char *const direct_ways[] = {"rays", "shadowmap", NULL};

static const char *const qualities[] = QUALITY_WORDS;

static const char *const automatic[] = {"auto", NULL};

static const struct schema_row render_rows[] = {
    STRATEGY_KINDS(STRATEGY_ROW) VALUE(
        PS_CHOICE(struct render_description, quality, "normal", qualities,
                  "how much work the picture is worth, where numbers of samples are not given")),
    VALUE(PS_NUMBER_OR(struct render_description, passes, "auto", 1, 1e6, PS_PARAM_WHOLE, automatic,
                       "", "how many independent passes are added up; auto: by quality")),
    VALUE(PS_NUMBER_OR(struct render_description, bounces, "all", 1, 1000, PS_PARAM_WHOLE,
                       all_bounces, "bounces",
                       "how many surfaces indirect light may meet before the one that is seen")),
    VALUE(PS_INT(struct render_description, seed, "0", 0, LARGEST_SEED, "",
                 "start of the random numbers")),
    VALUE(PS_INT(struct render_description, light_samples, "4", 1, 65536, "",
                 "shadow rays to each area light, for a pixel and pass")),
    VALUE(PS_INT(struct render_description, light_choices, "8", 1, MOST_LIGHT_CHOICES, "lights",
                 "lights that a point that is seen asks, where there are more than twice as many")),
    BOOL("discontinuity_buffer", offsetof(struct render_description, discontinuity_buffer), "no",
         "whether direct light is averaged over neighbouring pixels that see the lights alike"),
    VALUE(PS_INT(struct render_description, aa_samples, "8", 1, MOST_AA_SAMPLES, "",
                 "camera samples in each pass of a pixel that differs from its neighbours")),
    VALUE(PS_CHOICE(struct render_description, direct, "rays", direct_ways,
                    "how direct light finds shadows; area lights: by rays alone")),
    VALUE(PS_INT(struct render_description, direct_resolution, "1024", 1, 8192, "pixels",
                 "pixels along the side of each map of direct: shadowmap")),
    VALUE(PS_NUMBER(struct render_description, indirect_exposure, "1", 0, INFINITY, 0, "",
                    "factor on the indirect light when it joins the direct light")),
    VALUE(PS_COLOR(struct render_description, ambient, "0", 0, INFINITY, "W/(m^2 sr)",
                   "radiance of pixels that no indirect light reached")),
};

static const struct schema_section sections[] = {
    ONLY(scene, "the whole file"),
    ONLY_OR_WORD(camera, AUTO_WORD, "from where, and how, the scene is seen"),
    ONLY(image, "size and exposure of the picture"),
    ONLY(render, "how the picture is made"),
};

const struct schema_part schema_scene_part = {sections, COUNT(sections)};
