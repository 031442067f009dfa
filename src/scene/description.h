/* description.h: what a .psd file says, as plain data.
 *
 * The parser fills it; scene.h turns it into a scene that can be traced. Nothing here knows YAML or
 * Embree. Lengths in scene units, angles in degrees, colours linear Rec.709, right-handed
 * coordinates.
 */
#ifndef SCENE_DESCRIPTION_H
#define SCENE_DESCRIPTION_H

#include <psplat/param.h>
#include <stdbool.h>

/* Where something was written, for errors found after parsing. `file` is owned by the description;
 * line and column count from 1; line 0 means "not from a file". */
struct origin {
    const char *file;
    int line, column;
};

struct camera_description {
    ps_vec3 location, look_at, up;
    double angle;          /* horizontal field of view; 0 when vertical_angle is given */
    double vertical_angle; /* 0 when angle is given */
    struct origin origin;
};

struct image_description {
    int64_t width, height;
    double exposure; /* stops, of the PNG preview */
    struct origin origin;
};

struct material_description {
    char *name;
    ps_rgb diffuse;
    struct origin origin;
};

enum light_kind { LIGHT_POINT, LIGHT_SPOT };

struct light_description {
    enum light_kind kind;
    ps_vec3 location, point_at;
    ps_rgb intensity;       /* W/sr */
    double radius, falloff; /* half angles: full intensity inside radius, none outside falloff */
    struct origin origin;
};

enum object_kind { OBJECT_QUAD, OBJECT_BOX, OBJECT_TRIANGLES, OBJECT_SPHERE };

/* Applied in this order: scale, rotate about x, then y, then z (right-handed), translate. */
struct transform_description {
    ps_vec3 scale, rotate, translate;
};

struct object_description {
    enum object_kind kind;
    size_t material; /* index into materials */
    struct transform_description transform;
    ps_vec3 *vertices; /* quad: 4 in order around; box: 2 opposite corners; triangles: any; owned */
    size_t vertex_count;
    uint32_t (*triangles)[3]; /* triangles only: indices into vertices, checked; owned */
    size_t triangle_count;
    ps_vec3 center; /* sphere */
    double radius;  /* sphere */
    struct origin origin;
};

/* The seven kinds of strategy, in pipeline order, named as ps_kind in psplat/module.h. A choice is
 * a plugin's name (or path) with parameters, still as text: only the plugin's table can check them.
 */
struct parameter_text {
    char *key, *value; /* owned; vectors are written "[x, y, z]" */
    struct origin key_origin, value_origin;
};

struct strategy_choice {
    char *name; /* NULL: not stated, the default applies; owned */
    struct parameter_text *parameters;
    size_t parameter_count;
    struct origin origin;
};

#define STRATEGY_KINDS 7

struct render_description {
    struct strategy_choice strategies[STRATEGY_KINDS];
    int64_t passes;
    int64_t seed;
    double indirect_exposure; /* factor on the indirect light when it joins the direct light */
    ps_rgb ambient;           /* radiance of pixels that no indirect light reached */
};

struct scene_description {
    char *path; /* of the main file */
    struct camera_description camera;
    struct image_description image;
    struct material_description *materials;
    size_t material_count;
    struct light_description *lights;
    size_t light_count;
    struct object_description *objects;
    size_t object_count;
    struct render_description render;
    char **files; /* every name that an origin refers to */
    size_t file_count;
};

/* Frees what the members own, and zeroes the description. */
void scene_description_release(struct scene_description *description);

/* Frees what a choice owns, and zeroes it. */
void strategy_choice_release(struct strategy_choice *choice);

#endif
