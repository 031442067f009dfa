/* scene_digest.h: whether two scenes are the same, part by part.
 *
 * By what was read, not by how it was written: names, comments, and where files lie do not count;
 * every number of the description does, and so does every texel and vertex.
 */
#ifndef SCENE_SCENE_DIGEST_H
#define SCENE_SCENE_DIGEST_H

#include "scene/scene.h"

/* X(PART, what a user calls it) */
#define SCENE_PARTS(X)                                                                             \
    X(SCENE_CAMERA, "camera")                                                                      \
    X(SCENE_GEOMETRY, "geometry")                                                                  \
    X(SCENE_MATERIALS, "materials")                                                                \
    X(SCENE_TEXTURES, "textures")                                                                  \
    X(SCENE_LIGHTS, "lights")

#define SCENE_PART(part_, name_) part_,
enum scene_part { SCENE_PARTS(SCENE_PART) SCENE_PART_COUNT };
#undef SCENE_PART

struct scene_digest {
    uint64_t parts[SCENE_PART_COUNT];
};

/* Of a scene and the description that it was made from. */
struct scene_digest scene_digest_of(const struct scene_description *description,
                                    const struct scene *scene);

/* Of single things, added to a digest. */
void scene_digest_material(uint64_t *digest, const struct material_description *material);
void scene_digest_light(uint64_t *digest, const struct light_description *light);
void scene_digest_object(uint64_t *digest, const struct object_description *object);
void scene_digest_camera(uint64_t *digest, const struct camera *camera);

#endif
