/* job.c: the steps of an import in their order, and what they share. */
#include "import/job.h"

#include "import/check.h"
#include "import/source.h"
#include "import/steps.h"
#include <assimp/cimport.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void mesh_note(struct mesh_report *report, const char *format, ...)
{
    char *notes = report->notes;
    size_t size = sizeof report->notes, before = strlen(notes);
    size_t start = before > 0 && before + 1 < size ? before + 1 : before;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(notes + start, size - start, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= size - start) {
        notes[before] = '\0';
        return;
    }
    for (char *c = notes + start; *c; c++)
        if (*c == '\n')
            *c = '?'; /* in a name: it would make two lines */
    if (start > before)
        notes[before] = '\n';
}

ps_result mesh_out_of_memory(struct mesh_job *job, size_t bytes)
{
    return error_memory(job->error, bytes, "a mesh file");
}

struct affine mesh_node_placement(const struct mesh_job *job, const struct mesh_node *node)
{
    return affine_compose(&job->to_scene, &node->to_file);
}

const struct mesh_node *mesh_node_named(const struct mesh_job *job, const char *name, size_t n)
{
    const struct mesh_node *last = NULL;
    for (size_t i = 0; i < job->node_count; i++) {
        if (strcmp(job->nodes[i].node->mName.data, name) != 0)
            continue;
        last = &job->nodes[i];
        if (n-- == 0)
            break;
    }
    return last;
}

const struct json *mesh_gltf_node(const struct mesh_job *job, size_t index)
{
    size_t made_by_assimp = job->gltf.single_root ? 0 : 1;
    return index < made_by_assimp ? NULL : job->gltf.nodes[index - made_by_assimp];
}

/* The rotation that brings the axis to y, right-handed: z to y and y to -z as from Blender; x to y
 * and y to -x. Then the unit, then the request's placement. */
static struct affine map_of_request(const struct mesh_request *request)
{
    const float s = (float)request->unit;
    struct affine map = {{s, 0, 0}, {0, s, 0}, {0, 0, s}, {0, 0, 0}};
    if (request->up == 0) {
        map.x = (ps_vec3){0, s, 0};
        map.y = (ps_vec3){-s, 0, 0};
    } else if (request->up == 2) {
        map.y = (ps_vec3){0, 0, -s};
        map.z = (ps_vec3){0, s, 0};
    }
    return affine_compose(&request->placement, &map);
}

static ps_result prepare(struct mesh_job *job)
{
    const struct mesh_request *request = job->request;
    if (!(request->unit > 0) || !isfinite(request->unit) || request->up < 0 || request->up > 2)
        return error_set(job->error, PS_ERROR_INVALID, "%s: a unit above 0 and an axis are needed",
                         request->path);
    if (!(request->smooth_angle >= 0 && request->smooth_angle <= 180))
        return error_set(job->error, PS_ERROR_INVALID,
                         "%s: a smooth angle of 0 to 180 degrees is needed", request->path);
    job->to_scene = map_of_request(request);
    double volume = fabs((double)affine_determinant(&job->to_scene));
    if (!(volume > 0) || !isfinite(volume))
        return error_set(job->error, PS_ERROR_INVALID,
                         "%s: placed with a scale of 0, or without end", request->path);
    job->scale = cbrt(volume);
    return mesh_format_of(request->path, &job->format, job->error);
}

static ps_result convert(struct mesh_job *job)
{
    bool has_polygons = false;
    ps_result result = mesh_check_faces(job, &has_polygons);
    if (result == PS_OK && has_polygons)
        result = mesh_source_triangulate(job);
    if (result == PS_OK && has_polygons)
        result = mesh_check_faces(job, &has_polygons);
    if (result == PS_OK)
        result = mesh_list_nodes(job);
    if (result == PS_OK)
        result = mesh_read_materials(job);
    if (result == PS_OK && job->request->geometry)
        result = mesh_read_objects(job);
    if (result == PS_OK)
        mesh_settle_materials(job);
    if (result == PS_OK)
        mesh_note_omissions(job);
    if (result == PS_OK)
        mesh_note_textures(job);
    if (result == PS_OK && job->request->camera)
        result = mesh_read_cameras(job);
    if (result == PS_OK && job->request->lights)
        result = mesh_read_lights(job);
    return result;
}

static void release_names(struct mesh_names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->names[i]);
    free(names->names);
}

static void release(struct mesh_job *job)
{
    if (job->scene)
        aiReleaseImport(job->scene);
    gltf_release(&job->gltf);
    obj_release(&job->obj);
    ply_release(&job->ply);
    mesh_files_release(&job->files);
    free(job->nodes);
    free(job->materials);
    free(job->missing_library);
    release_names(&job->lost);
    release_names(&job->other_case);
}

ps_result mesh_job_run(struct mesh_job *job)
{
    ps_result result = prepare(job);
    if (result == PS_OK)
        result = mesh_source_open(job);
    if (result == PS_OK)
        result = convert(job);
    release(job);
    if (result != PS_OK)
        scene_description_release(job->fragment);
    return result;
}
