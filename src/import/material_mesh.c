/* material_mesh.c: vertex colours and second texture coordinates, which meshes bring to their
 * materials.
 *
 * Vertex colours multiply the base colour, and where the material says that its alpha counts their
 * alpha the opacity. A mesh that has colours and no material of the file gets one, diffuse.
 */
#include "import/material.h"

#include "import/steps.h"

/* A mirror beside a diffuse part has a colour of its own. */
static void paint(struct mesh_job *job, struct material_description *material)
{
    if (material->kind != MATERIAL_MIRROR)
        material->color.vertex_colors = true;
    for (size_t i = 0; i < material->component_count; i++)
        paint(job, &job->fragment->materials[material->components[i]]);
}

ps_result mesh_material_paint(struct mesh_job *job, size_t *index)
{
    struct material_description painted = mesh_material_white(job->request->origin);
    painted.color.vertex_colors = true;
    if (*index == NO_INDEX)
        return mesh_material_add(job, &painted, "vertex colors", NULL, index);
    struct material_description *material = &job->fragment->materials[*index];
    if (material_is_absent(material)) {
        painted.name = material->name;
        *material = painted;
    } else {
        if (!material->color.vertex_colors && mesh_material_has_second_uv(job, *index))
            mesh_material_omit(job, "beside vertex colours, the second set of texture coordinates",
                               material->name);
        paint(job, material);
    }
    return PS_OK;
}

bool mesh_material_has_second_uv(const struct mesh_job *job, size_t index)
{
    struct material_description *material = &job->fragment->materials[index];
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    material_pigments(material, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        if (pigments[i]->kind == PIGMENT_IMAGE && pigments[i]->uv_set == 1)
            return true;
    for (size_t i = 0; i < material->component_count; i++)
        if (mesh_material_has_second_uv(job, material->components[i]))
            return true;
    return false;
}

/* Surfaces look up either colours or the second set (scene/material.h). */
static void forget_second_uv(struct material_description *material)
{
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    material_pigments(material, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        pigments[i]->uv_set = 0;
}

void mesh_settle_materials(struct mesh_job *job)
{
    for (size_t i = 0; i < job->fragment->material_count; i++) {
        struct material_description *material = &job->fragment->materials[i];
        bool painted = material->color.vertex_colors;
        material->opacity.vertex_colors &= painted;
        material->emission.vertex_colors &= painted;
        if (painted)
            forget_second_uv(material);
    }
}
