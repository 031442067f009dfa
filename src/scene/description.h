/* description.h: what a .psd file, and the files it names, say, as plain data.
 *
 * The parser fills it; scene.h turns it into a scene that can be traced. Nothing here knows YAML,
 * assimp or Embree. Lengths in scene units, angles in degrees, colours linear Rec.709, right-handed
 * coordinates. Indices into arrays of the description are checked by whoever fills it. Pointers are
 * owned by the description unless stated otherwise.
 */
#ifndef SCENE_DESCRIPTION_H
#define SCENE_DESCRIPTION_H

#include "base/origin.h"
#include "scene/affine.h"
#include "settings/render_description.h"
#include <psplat/param.h>
#include <stdbool.h>

/* "No such thing", where an index is expected. */
#define NO_INDEX SIZE_MAX

/* --- camera and picture
 * ------------------------------------------------------------------------ */

enum camera_kind { CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC };

struct camera_description {
    char *name;
    enum camera_kind kind;
    ps_vec3 location, look_at, up;
    bool finds_location, finds_look_at; /* from what there is to see: camera_frame.h */
    double angle;          /* horizontal field of view; 0 when vertical_angle is given */
    double vertical_angle; /* 0 when angle is given; both 0: chosen with the location */
    double width;          /* orthographic: of what the picture shows; 0: chosen likewise */
    double aperture;       /* radius of the lens; 0: a pinhole */
    double focus;          /* distance at which things are sharp; 0: that of look_at */
    struct origin origin;
};

enum pixel_filter { PIXEL_BOX, PIXEL_TENT, PIXEL_GAUSSIAN };

struct image_description {
    int64_t width, height;
    double exposure; /* stops, of the PNG preview */
    int32_t filter;  /* enum pixel_filter: where in and around a pixel passes look */
    struct origin origin;
};

/* --- textures and pigments
 * ---------------------------------------------------------------------- */

enum texture_wrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR };
enum texture_encoding { ENCODING_AUTO, ENCODING_SRGB, ENCODING_LINEAR }; /* auto: by file type */

/* A picture file, or its bytes where it came inside of another file. */
struct texture_description {
    char *path;           /* for messages too; relative to the working folder */
    char *layer;          /* of an OpenEXR file; NULL: its picture */
    unsigned char *bytes; /* NULL: read the file */
    size_t byte_count;
    int32_t wrap_u, wrap_v; /* enum texture_wrap */
    int32_t encoding;       /* enum texture_encoding, of the colours; alpha is always linear */
    bool nearest;           /* rather than bilinear */
    struct origin origin;
};

enum pigment_kind {
    PIGMENT_COLOR,    /* colors[0] */
    PIGMENT_IMAGE,    /* colors[0] times the texture at (u, v) */
    PIGMENT_CHECKER,  /* cubes of side 1, alternating; point in the pigment's space */
    PIGMENT_GRADIENT, /* from colors[0] to [1] along `axis` over a length of 1, and again */
    PIGMENT_NOISE     /* colors mixed by fractal noise of features about 1 wide */
};

/* Which numbers of a texture count; a scalar (roughness, opacity) takes the mean of r, g, b. */
enum texture_channel { CHANNEL_RGB, CHANNEL_R, CHANNEL_G, CHANNEL_B, CHANNEL_A };

/* A colour, or a number, that may vary over a surface. Procedural kinds work on the point in the
 * space of the file or group that the object stands in, carried by `placement` into their own. */
struct pigment_description {
    enum pigment_kind kind;
    ps_rgb colors[2];
    size_t texture;          /* of PIGMENT_IMAGE */
    int32_t channel;         /* enum texture_channel, of PIGMENT_IMAGE */
    int32_t uv_set;          /* of PIGMENT_IMAGE: 0, or 1 for the mesh's second coordinates */
    double scale_u, scale_v; /* of PIGMENT_IMAGE: how often the texture repeats over 0..1 */
    double cross_u, cross_v; /* its u is scale_u u + cross_u v + offset_u, its v likewise */
    double offset_u, offset_v;
    bool complement;    /* of PIGMENT_IMAGE: 1 minus that */
    bool vertex_colors; /* of PIGMENT_COLOR, PIGMENT_IMAGE: times the mesh's; opacity: times their
                           alpha */
    struct affine placement; /* of the pattern in the object's space */
    ps_vec3 axis;            /* of PIGMENT_GRADIENT */
    int64_t octaves;         /* of PIGMENT_NOISE */
    double turbulence;       /* of PIGMENT_NOISE, PIGMENT_GRADIENT: displacement by noise */
};

/* --- materials
 * ----------------------------------------------------------------------------------- */

enum material_kind {
    MATERIAL_DIFFUSE,    /* color: Lambertian reflectance, on both sides */
    MATERIAL_MIRROR,     /* color: reflectance at every angle */
    MATERIAL_METAL,      /* color: reflectance at normal incidence; roughness */
    MATERIAL_GLOSSY,     /* color: diffuse reflectance; specular: the coat's at normal incidence */
    MATERIAL_DIELECTRIC, /* smooth glass or water: ior, absorption; color: tint of what passes */
    MATERIAL_MIX         /* of other materials, by weight */
};

struct material_description {
    char *name;
    enum material_kind kind;
    struct pigment_description color;
    struct pigment_description specular;  /* glossy */
    struct pigment_description roughness; /* metal, glossy: GGX alpha = roughness^2; 0: smooth */
    double ior;                           /* dielectric: inside relative to outside */
    ps_rgb absorption;                    /* dielectric: per scene unit of the way through */
    struct pigment_description emission;  /* radiance, W/(m^2 sr); black: none */
    bool emission_both;                   /* from both sides, not only the front */
    struct pigment_description opacity;   /* below 1/2 there is no surface */
    bool blended; /* rather is opacity the share of the surface's points that are there */
    struct pigment_description bump;       /* height in scene units; a colour: flat */
    struct pigment_description normal_map; /* a colour: none; its red is a factor on tilts */
    size_t *components;                    /* mix: materials, never itself or a later mix */
    double *weights;                       /* mix: shares, their sum at most 1 */
    size_t component_count;
    bool varying; /* mix of two: their weights are share, which is 0..1, and 1 - share */
    struct pigment_description share;
    struct origin origin;
};

/* All that it has. */
#define MATERIAL_PIGMENTS 8
static inline void material_pigments(struct material_description *material,
                                     struct pigment_description *pigments[MATERIAL_PIGMENTS])
{
    struct pigment_description *const all[MATERIAL_PIGMENTS] = {
        &material->color,   &material->specular, &material->roughness,  &material->emission,
        &material->opacity, &material->bump,     &material->normal_map, &material->share};
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        pigments[i] = all[i];
}

/* Whether only the name is known of a material: a mix of nothing, which stands for what a mesh file
 * names and does not define. No scene holds one. */
static inline bool material_is_absent(const struct material_description *material)
{
    return material->kind == MATERIAL_MIX && material->component_count == 0;
}

/* --- lights ----------------------------------------------------------------------------------- */

enum light_kind {
    LIGHT_POINT,
    LIGHT_SPOT,
    LIGHT_SUN,       /* parallel but for its angle; shines along `direction` */
    LIGHT_RECTANGLE, /* centre location, half edges; shines to the side of their cross product */
    LIGHT_DISC,      /* around location, to the side of `direction` */
    LIGHT_SPHERE,    /* around location */
    LIGHT_SKY        /* from all around: a colour or a picture (latitude, longitude) */
};

/* What `amount` is. */
enum light_unit {
    UNIT_INTENSITY, /* W/sr: point, spot (in the middle of its cone) */
    UNIT_POWER,     /* W: all but sun and sky */
    UNIT_RADIANCE,  /* W/(m^2 sr): rectangle, disc, sphere, sky; sun with an angle */
    UNIT_IRRADIANCE /* W/m^2 across the beam: sun */
};

struct light_description {
    enum light_kind kind;
    ps_rgb amount;
    enum light_unit unit;
    ps_vec3 location, point_at;
    ps_vec3 direction;      /* of the light's travel: sun, disc */
    double radius, falloff; /* spot: half angles, full intensity inside radius, none outside
                                    falloff; disc, sphere: radius is a length */
    double tightness;       /* spot: exponent of the cosine to its axis, as POV-Ray; 0: none */
    double angle;           /* sun: its diameter; 0: a point */
    ps_vec3 half_edges[2];  /* rectangle */
    bool both_sides;        /* rectangle, disc */
    bool visible;           /* rectangle, disc, sphere, sky: seen by the camera itself */
    size_t texture;         /* sky: NO_INDEX for a colour */
    double rotate;          /* sky: about y */
    struct origin origin;
};

/* --- geometry --------------------------------------------------------------------------------- */

/* Triangles that objects share. */
struct mesh_description {
    const char *file; /* that they are from, of the description's names; NULL: the scene itself */
    ps_vec3 *vertices;
    ps_vec3 *normals; /* of each vertex, any length; NULL: flat */
    float (*uv)[2];   /* of each vertex, v upwards; NULL: none */
    float (*second_uv)[2];
    float (*colors)[4]; /* of each vertex: linear, with alpha, all 0..1; NULL: none */
    size_t vertex_count;
    uint32_t (*triangles)[3];
    size_t triangle_count;
};

enum object_kind {
    OBJECT_QUAD,
    OBJECT_BOX,
    OBJECT_TRIANGLES,
    OBJECT_SPHERE,
    OBJECT_CYLINDER,     /* points[0] to [1], radius */
    OBJECT_CONE,         /* points[0] with radius to points[1] with to_radius */
    OBJECT_DISC,         /* center, normal, radius, hole_radius */
    OBJECT_PLANE,        /* normal . p = distance; a square of half-width extent, 0: auto */
    OBJECT_TORUS,        /* center at the origin, about y: radius, minor_radius */
    OBJECT_HEIGHT_FIELD, /* texture's brightness over x, z in 0..1, as POV-Ray */
    OBJECT_MESH,         /* mesh */
    OBJECT_INSTANCE      /* group */
};

struct object_description {
    enum object_kind kind;
    size_t material;         /* an instance's: instead of those of its objects, or NO_INDEX */
    struct affine placement; /* from the object's space to that of the file, or group */
    ps_vec3 *vertices;       /* quad: 4 in order around; box: 2 opposite corners; triangles: any */
    size_t vertex_count;
    uint32_t (*triangles)[3]; /* triangles only: indices into vertices */
    size_t triangle_count;
    ps_vec3 center; /* sphere, disc */
    ps_vec3 points[2];
    ps_vec3 normal; /* disc, plane */
    double radius, to_radius, minor_radius, hole_radius;
    double distance; /* plane; DISTANCE_BELOW_ALL: just below all that is no endless plane */
    double extent;
    bool open;        /* cylinder, cone: without their ends */
    bool smooth;      /* height field: with normals between those of its faces */
    int64_t segments; /* around: cylinder, cone, disc, torus */
    size_t texture;   /* height field */
    size_t mesh;
    size_t group;
    bool hidden;     /* from the camera, while it takes part in the light */
    bool front_only; /* hidden in the same way where the camera is behind it */
    struct origin origin;
};

/* Objects that are placed together, any number of times; groups inside are resolved, so that none
 * of the objects is an instance. */
struct group_description {
    char *name; /* NULL: of a mesh that repeats (repeated_meshes.h) */
    struct object_description *objects;
    size_t object_count;
};

/* --- rendering -------------------------------------------------------------------------------- */

struct scene_description {
    char *path;   /* of the main file */
    char *folder; /* the only one to read meshes and pictures from (input_file.h), or NULL */
    char *cache;  /* a folder for what was made of meshes and pictures, or NULL */
    double texture_memory;              /* bytes that pictures may take; 0: half of the following */
    double memory_limit;                /* bytes that all may take; 0: the machine's */
    struct camera_description *cameras; /* the first is the default; at least one */
    size_t camera_count;
    struct image_description image;
    struct texture_description *textures;
    size_t texture_count;
    struct material_description *materials;
    size_t material_count;
    struct light_description *lights;
    size_t light_count;
    struct mesh_description *meshes;
    size_t mesh_count;
    struct group_description *groups;
    size_t group_count;
    struct object_description *objects;
    size_t object_count;
    struct render_description render;
    char **files; /* every name that an origin refers to, and paths of mesh files */
    size_t file_count;
};

#define DISTANCE_BELOW_ALL (-INFINITY)

/* A plane that takes its size from the rest of the scene. */
static inline bool object_is_endless(const struct object_description *object)
{
    return object->kind == OBJECT_PLANE && !(object->extent > 0);
}

/* A plane that takes its size or place from the rest of the scene, and is made when that is
 * there. */
static inline bool object_comes_last(const struct object_description *object)
{
    return object_is_endless(object) ||
           (object->kind == OBJECT_PLANE && object->distance == DISTANCE_BELOW_ALL);
}

/* Frees what the members own, and zeroes the description. */
void scene_description_release(struct scene_description *description);

/* Frees what an object owns. */
void object_description_release(struct object_description *object);

#endif
