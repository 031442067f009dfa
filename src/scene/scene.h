/* scene.h: a scene ready to be traced: shapes, groups and their instances, materials, lights,
 * cameras.
 *
 * Made once from a description and constant afterwards, so every thread may read it. Shapes come in
 * this order: those of the world, in world space, then those of each group, in the group's space.
 * Everything that a ray can meet has a number, its object: first the world's shapes, then for each
 * instance the shapes of its group.
 */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/error.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/light_bvh.h"
#include "scene/material.h"
#include "scene/shape.h"
#include "scene/texture.h"

#define NO_LIGHT PS_NO_LIGHT
#define NO_MATERIAL UINT32_MAX

/* A run of shapes that are placed together. */
struct group {
    size_t first_shape, shape_count;
};

struct instance {
    const struct group *group;
    struct affine placement;
    float front;       /* -1 where the placement mirrors, which turns windings, else 1 */
    uint32_t material; /* instead of its shapes', or NO_MATERIAL */
    bool hidden;       /* from the camera */
    bool front_only;   /* that is, from behind */
    uint32_t first_object;
};

struct scene {
    struct shape *shapes;
    size_t shape_count, world_shape_count;
    struct group *groups;
    size_t group_count;
    struct instance *instances;
    size_t instance_count;
    uint32_t object_count;
    struct texture *textures;
    size_t texture_count;
    struct mapped_budget *texture_memory; /* of those that lie in the cache; NULL: none do */
    struct material *materials;
    size_t material_count;
    struct microfacet_table *microfacets; /* NULL where no material mirrors */
    struct light *lights;
    struct distribution light_choice; /* by power */
    size_t light_count;
    uint32_t *afar; /* those that shine from infinity: afar_count of them */
    size_t afar_count;
    struct light_bvh *light_bvh; /* the others */
    void **owned;                /* arrays that lights borrow: owned_count entries */
    size_t owned_count;
    uint32_t *object_lights; /* the light that an object is, or NO_LIGHT */
    bool has_area_lights;    /* some light's sampling needs random numbers */
    bool has_split_lights;   /* some light is a subtree of light_bvh */
    bool sky_is_hidden;      /* from the camera itself */
    struct camera camera;
    enum pixel_filter pixel_filter;
    uint32_t light_samples;
    /* Lights that a point draws, of more than twice as many: one that is seen, and one that paths
     * meet. */
    uint32_t light_choices, path_light_choices;
    size_t width, height;
    size_t dropped_triangles; /* without area */
    ps_vec3 center;           /* of the bounding sphere of shapes */
    float radius;
    float surface_offset; /* see ps_pass */
};

/* PS_OK, or a message, and in `where` (may be NULL) what it is about; release it with
 * scene_release. Where triangles were dropped, `where` is the first object that lost some. A line
 * of 0 is no place. Reads texture files. */
ps_result scene_create(const struct scene_description *description, struct scene *scene,
                       struct origin *where, struct error *error);
void scene_release(struct scene *scene);

/* The description's first camera with what it had to find (camera_frame.h) in a scene made of
 * it. */
ps_result scene_find_camera(const struct scene_description *description, const struct scene *scene,
                            struct camera_description *camera, struct error *error);

/* The instance that an object stands in; NULL for the world's own shapes. */
const struct instance *scene_instance_of(const struct scene *scene, uint32_t object);

/* The shape of an object. */
const struct shape *scene_shape_of(const struct scene *scene, uint32_t object);

/* Bytes that shapes and textures take; and those that textures of the cache may yet take. */
size_t scene_bytes(const struct scene *scene);
double scene_bytes_to_come(const struct scene *scene);

/* Whether points that are seen ask some of the lights (light_bvh_is_chosen_from). */
bool scene_chooses_lights(const struct scene *scene);

/* Whether normals of some surface are smoothed or bent. */
bool scene_has_shading_normals(const struct scene *scene);

/* Whether some light is a sky. */
bool scene_has_sky(const struct scene *scene);

/* Whether some light is a point or a spot. */
bool scene_has_delta_lamps(const struct scene *scene);

/* Whether asking the lights again gives another answer. */
bool scene_samples_lights(const struct scene *scene);

/* Whether a light's shadows have edges and no noise to speak of: every point asks it, and it is a
 * point, a spot or a sun of at most five degrees. */
bool scene_light_casts_hard_shadows(const struct scene *scene, size_t light);

/* Whether the scene has such lights, and noise, of others or within a sun's penumbra, that would
 * hide those edges. */
bool scene_has_hard_shadows_apart(const struct scene *scene);

/* Chooses a light by power with *u in [0,1), which is rescaled so that it can be used again;
 * returns its index and probability. Needs light_count > 0. */
size_t scene_choose_light(const struct scene *scene, float *u, float *probability);

#endif
