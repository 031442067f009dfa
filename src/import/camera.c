/* camera.c: cameras, from glTF's JSON or from assimp's list.
 *
 * A glTF camera looks along -z of its node with y up; its scale is that of the request alone, since
 * glTF's views take no scale from nodes. assimp's other readers give location, direction and up in
 * the node's space, and the whole horizontal angle.
 */
#include "import/steps.h"

#include <stdlib.h>
#include <string.h>

#define DEGREES (180.0 / 3.14159265358979323846)

static ps_vec3 unit_or(ps_vec3 v, ps_vec3 fallback)
{
    float length = ps_length(v);
    return length > 0 && isfinite(length) ? ps_scale(v, 1 / length) : fallback;
}

static struct camera_description place(const struct mesh_job *job, const struct affine *map,
                                       ps_vec3 location, ps_vec3 forward, ps_vec3 up)
{
    ps_vec3 at = affine_point(map, location);
    forward = unit_or(affine_direction(map, forward), (ps_vec3){0, 0, -1});
    return (struct camera_description){
        .location = at,
        .look_at = ps_add_scaled(at, (float)job->scale, forward),
        .up = unit_or(affine_direction(map, up), (ps_vec3){0, 1, 0}),
        .origin = job->request->origin,
    };
}

static bool is_sound(const struct camera_description *camera)
{
    bool has_angle = camera->kind == CAMERA_ORTHOGRAPHIC
                         ? camera->width > 0 && isfinite(camera->width)
                         : fmax(camera->angle, camera->vertical_angle) > 0 &&
                               fmax(camera->angle, camera->vertical_angle) < 180;
    return has_angle && mesh_is_finite(camera->location) && mesh_is_finite(camera->look_at) &&
           ps_length(ps_cross(ps_subtract(camera->look_at, camera->location), camera->up)) > 0;
}

static ps_result add(struct mesh_job *job, struct camera_description camera, const char *name)
{
    struct scene_description *fragment = job->fragment;
    size_t bytes = (fragment->camera_count + 1) * sizeof *fragment->cameras;
    if (!is_sound(&camera)) {
        mesh_note(job->report, "camera %.100s cannot be used", name);
        return PS_OK;
    }
    struct camera_description *cameras = realloc(fragment->cameras, bytes);
    if (!cameras)
        return mesh_out_of_memory(job, bytes);
    fragment->cameras = cameras;
    camera.name = strdup(name);
    cameras[fragment->camera_count++] = camera;
    return camera.name ? PS_OK : mesh_out_of_memory(job, strlen(name));
}

/* --- glTF
 * ----------------------------------------------------------------------------------------- */

static ps_result add_gltf_camera(struct mesh_job *job, size_t node, const struct json *source)
{
    struct affine map = mesh_node_placement(job, &job->nodes[node]);
    struct camera_description camera =
        place(job, &map, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, -1}, (ps_vec3){0, 1, 0});
    const struct json *orthographic = json_member(source, "orthographic");
    if (orthographic) {
        camera.kind = CAMERA_ORTHOGRAPHIC;
        camera.width = 2 * json_number(orthographic, "xmag", 0) * job->scale;
    } else {
        camera.vertical_angle =
            json_number(json_member(source, "perspective"), "yfov", 0) * DEGREES;
    }
    return add(job, camera, job->nodes[node].node->mName.data);
}

static ps_result read_gltf_cameras(struct mesh_job *job)
{
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && i < job->node_count; i++) {
        const struct json *node = mesh_gltf_node(job, i);
        size_t index;
        if (!json_member(node, "camera") || !json_size(node, "camera", 0, &index))
            continue;
        const struct json *source = json_element(json_member(job->gltf.root, "cameras"), index);
        if (source)
            result = add_gltf_camera(job, i, source);
    }
    return result;
}

/* --- other formats
 * -------------------------------------------------------------------------------- */

static ps_result add_assimp_camera(struct mesh_job *job, unsigned index)
{
    const struct aiCamera *source = job->scene->mCameras[index];
    size_t before = 0;
    for (unsigned i = 0; i < index; i++)
        before += strcmp(job->scene->mCameras[i]->mName.data, source->mName.data) == 0;
    const struct mesh_node *node = mesh_node_named(job, source->mName.data, before);
    struct affine map = node ? mesh_node_placement(job, node) : job->to_scene;
    struct camera_description camera =
        place(job, &map, mesh_vector(source->mPosition), mesh_vector(source->mLookAt),
              mesh_vector(source->mUp));
    if (source->mOrthographicWidth > 0) {
        camera.kind = CAMERA_ORTHOGRAPHIC;
        camera.width = 2 * source->mOrthographicWidth * job->scale;
    } else {
        camera.angle = source->mHorizontalFOV * DEGREES;
    }
    return add(job, camera, source->mName.data);
}

ps_result mesh_read_cameras(struct mesh_job *job)
{
    if (job->gltf.root)
        return read_gltf_cameras(job);
    ps_result result = PS_OK;
    for (unsigned i = 0; result == PS_OK && i < job->scene->mNumCameras; i++)
        result = add_assimp_camera(job, i);
    return result;
}
