/* value.h: what identifiers of a POV-Ray scene stand for.
 *
 * Values are copied; what they point to lies in the reader's arena and does not change, but for
 * elements of arrays.
 */
#ifndef POV_VALUE_H
#define POV_VALUE_H

#include "scene/vector.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define POV_TERMS 5 /* x y z, or red green blue, then filter and transmit */

/* A float is a vector of one term. */
struct pov_number {
    double v[POV_TERMS];
    int terms;
    bool is_color;
};

enum pov_value_kind {
    POV_VALUE_NONE, /* not declared, or an element that nothing was put into */
    POV_VALUE_NUMBER,
    POV_VALUE_STRING,
    POV_VALUE_ARRAY,
    POV_VALUE_MACRO, /* and functions */
    POV_VALUE_FUNCTION,
    POV_VALUE_PIGMENT,
    POV_VALUE_FINISH,
    POV_VALUE_TEXTURE,
    POV_VALUE_INTERIOR,
    POV_VALUE_MATERIAL,
    POV_VALUE_COLOR_MAP,
    POV_VALUE_TRANSFORM,
    POV_VALUE_OBJECT,
    POV_VALUE_CAMERA,
    POV_VALUE_SKY,
    POV_VALUE_OTHER /* what has no counterpart: media, fog, splines, normals */
};

struct pov_value {
    enum pov_value_kind kind;
    union {
        struct pov_number number;
        const char *text;
        struct pov_array *array;
        const struct pov_macro *macro;
        const struct pov_pigment *pigment; /* also of a sky_sphere */
        const struct pov_finish *finish;
        const struct pov_texture *texture;
        const struct pov_interior *interior;
        const struct pov_material *material;
        const struct pov_color_map *map;
        const struct transform *transform;
        const struct pov_object *object;
        const struct pov_camera *camera;
    };
};

#define POV_DIMENSIONS 5

struct pov_array {
    int dimensions;
    size_t sizes[POV_DIMENSIONS];
    struct pov_value *elements; /* the last index goes fastest */
    enum pov_value_kind held;   /* what was put into it last */
};

#define POV_PARAMETERS 56 /* as POV-Ray has it */

/* A macro's or a function's body: tokens of a file. */
struct pov_macro {
    const struct pov_tokens *tokens;
    size_t start; /* of the body: behind the parameters */
    uint32_t name, parameters[POV_PARAMETERS];
    int parameter_count;
    bool unsupported; /* a function whose body can't be computed here */
};

static inline struct pov_value pov_float(double value)
{
    return (struct pov_value){.kind = POV_VALUE_NUMBER, .number = {{value}, 1, false}};
}

static inline struct pov_value pov_vector(struct vector a)
{
    return (struct pov_value){.kind = POV_VALUE_NUMBER, .number = {{a.x, a.y, a.z}, 3, false}};
}

/* A float stands for a vector of three of it. */
static inline struct vector pov_number_vector(const struct pov_number *n)
{
    if (n->terms == 1)
        return (struct vector){n->v[0], n->v[0], n->v[0]};
    return (struct vector){n->v[0], n->v[1], n->v[2]};
}

#endif
