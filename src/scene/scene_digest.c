/* scene_digest.c: member by member, since structs have gaps and pointers;
 * tests/unit/test_scene_digest.c finds a member that was forgotten.
 */
#include "scene/scene_digest.h"

#include "base/digest.h"

#define ADD(member) digest_add(digest, &(member), sizeof(member))
#define ADD_ARRAY(array, count)                                                                    \
    do {                                                                                           \
        uint64_t count_ = (array) ? (count) : 0;                                                   \
        ADD(count_);                                                                               \
        if (count_ > 0)                                                                            \
            digest_add(digest, array, count_ * sizeof *(array));                                   \
    } while (0)

static void add_pigment(uint64_t *digest, const struct pigment_description *pigment)
{
    ADD(pigment->kind);
    ADD(pigment->colors);
    ADD(pigment->texture);
    ADD(pigment->channel);
    ADD(pigment->uv_set);
    ADD(pigment->scale_u);
    ADD(pigment->scale_v);
    ADD(pigment->cross_u);
    ADD(pigment->cross_v);
    ADD(pigment->offset_u);
    ADD(pigment->offset_v);
    ADD(pigment->complement);
    ADD(pigment->vertex_colors);
    ADD(pigment->placement);
    ADD(pigment->axis);
    ADD(pigment->octaves);
    ADD(pigment->turbulence);
}

void scene_digest_material(uint64_t *digest, const struct material_description *material)
{
    ADD(material->kind);
    add_pigment(digest, &material->color);
    add_pigment(digest, &material->specular);
    add_pigment(digest, &material->roughness);
    ADD(material->ior);
    ADD(material->absorption);
    add_pigment(digest, &material->emission);
    ADD(material->emission_both);
    add_pigment(digest, &material->opacity);
    ADD(material->blended);
    add_pigment(digest, &material->bump);
    add_pigment(digest, &material->normal_map);
    ADD(material->varying);
    add_pigment(digest, &material->share);
    ADD_ARRAY(material->components, material->component_count);
    ADD_ARRAY(material->weights, material->component_count);
}

void scene_digest_light(uint64_t *digest, const struct light_description *light)
{
    ADD(light->kind);
    ADD(light->amount);
    ADD(light->unit);
    ADD(light->location);
    ADD(light->point_at);
    ADD(light->direction);
    ADD(light->radius);
    ADD(light->falloff);
    ADD(light->tightness);
    ADD(light->angle);
    ADD(light->half_edges);
    ADD(light->both_sides);
    ADD(light->visible);
    ADD(light->texture);
    ADD(light->rotate);
}

void scene_digest_object(uint64_t *digest, const struct object_description *object)
{
    ADD(object->kind);
    ADD(object->material);
    ADD(object->placement);
    ADD_ARRAY(object->vertices, object->vertex_count);
    ADD_ARRAY(object->triangles, object->triangle_count);
    ADD(object->center);
    ADD(object->points);
    ADD(object->normal);
    ADD(object->radius);
    ADD(object->to_radius);
    ADD(object->minor_radius);
    ADD(object->hole_radius);
    ADD(object->distance);
    ADD(object->extent);
    ADD(object->open);
    ADD(object->smooth);
    ADD(object->segments);
    ADD(object->texture);
    ADD(object->mesh);
    ADD(object->group);
    ADD(object->hidden);
    ADD(object->front_only);
}

void scene_digest_camera(uint64_t *digest, const struct camera *camera)
{
    ADD(camera->orthographic);
    ADD(camera->location);
    ADD(camera->forward);
    ADD(camera->corner);
    ADD(camera->across);
    ADD(camera->down);
    ADD(camera->lens_u);
    ADD(camera->lens_v);
    ADD(camera->aperture);
    ADD(camera->focus);
}

static void add_objects(uint64_t *digest, const struct object_description *objects, size_t count)
{
    ADD(count);
    for (size_t i = 0; i < count; i++)
        scene_digest_object(digest, &objects[i]);
}

static void add_geometry(uint64_t *digest, const struct scene_description *description)
{
    for (size_t i = 0; i < description->mesh_count; i++) {
        const struct mesh_description *mesh = &description->meshes[i];
        ADD_ARRAY(mesh->vertices, mesh->vertex_count);
        ADD_ARRAY(mesh->normals, mesh->vertex_count);
        ADD_ARRAY(mesh->uv, mesh->vertex_count);
        ADD_ARRAY(mesh->second_uv, mesh->vertex_count);
        ADD_ARRAY(mesh->colors, mesh->vertex_count);
        ADD_ARRAY(mesh->triangles, mesh->triangle_count);
    }
    add_objects(digest, description->objects, description->object_count);
    for (size_t i = 0; i < description->group_count; i++)
        add_objects(digest, description->groups[i].objects, description->groups[i].object_count);
}

/* The encoding tells what the texels mean. */
static void add_texture(uint64_t *digest, const struct texture_description *description,
                        const struct texture *texture)
{
    const struct raster *raster = &texture->raster;
    uint64_t samples = texture_digest(texture);
    ADD(description->encoding);
    ADD(texture->wrap_u);
    ADD(texture->wrap_v);
    ADD(texture->nearest);
    ADD(raster->width);
    ADD(raster->height);
    ADD(raster->channels);
    ADD(raster->sample);
    ADD(raster->srgb);
    ADD(samples);
}

struct scene_digest scene_digest_of(const struct scene_description *description,
                                    const struct scene *scene)
{
    struct scene_digest parts;
    for (int i = 0; i < SCENE_PART_COUNT; i++)
        parts.parts[i] = DIGEST_START;
    scene_digest_camera(&parts.parts[SCENE_CAMERA], &scene->camera);
    digest_add(&parts.parts[SCENE_CAMERA], &scene->pixel_filter, sizeof scene->pixel_filter);
    add_geometry(&parts.parts[SCENE_GEOMETRY], description);
    for (size_t i = 0; i < description->material_count; i++)
        scene_digest_material(&parts.parts[SCENE_MATERIALS], &description->materials[i]);
    for (size_t i = 0; i < description->texture_count; i++)
        add_texture(&parts.parts[SCENE_TEXTURES], &description->textures[i], &scene->textures[i]);
    for (size_t i = 0; i < description->light_count; i++)
        scene_digest_light(&parts.parts[SCENE_LIGHTS], &description->lights[i]);
    return parts;
}
