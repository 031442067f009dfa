/* keys.h: what the sections of the scene language fill, where that is not yet what a description
 * holds: keys that exclude each other, names and paths still to be resolved, placements to be
 * composed. Nodes live as long as the reader; lists belong to whoever has the struct.
 */
#ifndef PARSER_SCHEMA_KEYS_H
#define PARSER_SCHEMA_KEYS_H

#include "parser/yaml/node.h"
#include "scene/description.h"

/* Object kinds that a description has no objects of. */
enum { KEYS_MESH_FILE = 1000, KEYS_GROUP, KEYS_INSTANCE };

/* In place of a value that is to be found. */
#define AUTO_WORD "auto"

struct point_or_auto {
    ps_vec3 point;
    int32_t automatic;
};

struct point_list {
    ps_vec3 *items;
    size_t count;
};

struct pair_list {
    float (*items)[2];
    size_t count;
};

struct triangle_list {
    uint32_t (*items)[3];
    size_t count;
};

struct camera_keys {
    struct camera_description camera;
    struct point_or_auto location, look_at;
    int32_t projection; /* enum camera_kind */
};

struct look_at_keys {
    ps_vec3 from, to, up;
};

struct placement_keys {
    ps_vec3 scale, rotate, translate;
    double matrix[12]; /* row by row */
};

struct texture_keys {
    const struct node *file, *layer;
    int32_t wrap, encoding;
    int32_t interpolate; /* 0 bilinear, 1 nearest */
};

/* A pattern, or a picture as a pigment. */
struct pigment_keys {
    ps_rgb colors[2];
    ps_rgb color;
    struct texture_keys texture;
    int32_t channel;
    double repeat[2], offset[2];
    ps_vec3 axis;
    int64_t octaves;
    double turbulence;
    struct placement_keys placement;
};

struct material_keys {
    struct material_description material;
    int32_t emission_both;
};

/* Of a mixed material. */
struct component_keys {
    size_t material;
    double weight;
};

struct light_keys {
    struct light_description light;
    ps_rgb intensity, power, radiance, irradiance;
    struct point_list corners;
    const struct node *file, *layer;
    int32_t both_sides, visible;
};

struct object_keys {
    struct object_description object;
    struct placement_keys placement;
    struct point_list vertices, normals;
    struct pair_list uv;
    struct triangle_list triangles;
    ps_number_or_choice extent, distance;
    int32_t camera, sides, open, smooth; /* sides: 0 both, 1 front */
    const struct node *file;             /* mesh, height field */
    const struct node *of;               /* instance */
    const struct node *materials;
    int32_t use; /* mesh: a bit for each word */
    double unit;
    int32_t up;
    int32_t diffuse_only;
    int32_t colors; /* 0 linear, 1 srgb */
    double bump_scale;
    double smooth_angle;
};

#endif
