/* scene.h: a scene ready to be traced: shapes in world space, materials, lights, camera.
 *
 * Made once from a description and constant afterwards, so every thread may read it.
 */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/error.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/shape.h"

struct material {
    ps_rgb diffuse; /* two-sided Lambertian reflectance */
};

struct scene {
    struct shape *shapes;
    size_t shape_count;
    struct material *materials;
    size_t material_count;
    struct light *lights;
    float *light_cdf; /* cumulative share of power, light_count entries, last 1 */
    size_t light_count;
    struct camera camera;
    size_t width, height;
    ps_vec3 center; /* of the bounding sphere of shapes */
    float radius;
    float surface_offset; /* see ps_pass */
};

/* PS_ERROR_MEMORY, or PS_OK; release it with scene_release. */
ps_result scene_create(const struct scene_description *description, struct scene *scene,
                       struct error *error);
void scene_release(struct scene *scene);

/* Chooses a light by power with u in [0,1); returns its index and probability. Needs light_count >
 * 0. */
size_t scene_choose_light(const struct scene *scene, float u, float *probability);

#endif
