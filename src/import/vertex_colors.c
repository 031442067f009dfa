/* vertex_colors.c: the colours of vertices, and which of them are not to be had.
 *
 * glTF's colours are linear. Those of OBJ, PLY and the rest are what paint and scanning programs
 * show, sRGB, as Blender reads them. Alpha counts in glTF alone.
 */
#include "import/geometry.h"

#include "image/tonemap.h"

/* A COLOR_0 that assimp left out, since it has not as many elements as there are vertices. */
static bool is_rejected(const struct mesh_geometry *geometry)
{
    return json_member(json_member(geometry->primitive, "attributes"), "COLOR_0") &&
           !geometry->mesh->mColors[0];
}

/* assimp leaves the alpha of glTF's colours that have none at 0. */
static bool has_alpha(const struct mesh_job *job, const struct mesh_geometry *geometry)
{
    return job->format == FORMAT_PLY || gltf_has_alpha(&job->gltf, geometry->primitive);
}

static bool is_white(const struct aiColor4D *color, bool alpha)
{
    return color->r == 1.0f && color->g == 1.0f && color->b == 1.0f && (!alpha || color->a == 1.0f);
}

bool mesh_has_colors(struct mesh_job *job, const struct mesh_geometry *geometry)
{
    const struct aiMesh *source = geometry->mesh;
    bool alpha = has_alpha(job, geometry) && job->gltf.root;
    job->colors.rejected |= is_rejected(geometry);
    if (!source->mColors[0])
        return false;
    for (unsigned i = 0; i < source->mNumVertices; i++)
        if (!is_white(&source->mColors[0][i], alpha))
            return true;
    return false;
}

static float clamp(struct mesh_job *job, float value)
{
    if (value >= 0.0f && value <= 1.0f)
        return value;
    job->colors.clamped = true;
    return value > 0.0f ? 1.0f : 0.0f; /* NaN: 0 */
}

void mesh_fill_color(struct mesh_job *job, const float srgb[3], float rgba[4])
{
    for (int k = 0; k < 3; k++)
        rgba[k] = (float)tonemap_linear((double)clamp(job, srgb[k]));
    rgba[3] = 1.0f;
}

void mesh_fill_colors(struct mesh_job *job, const struct mesh_geometry *geometry,
                      const uint32_t *new_indices, float (*filled)[4])
{
    const struct aiMesh *source = geometry->mesh;
    bool alpha = has_alpha(job, geometry);
    for (unsigned i = 0; i < source->mNumVertices; i++) {
        if (new_indices[i] == UINT32_MAX)
            continue;
        const struct aiColor4D color = source->mColors[0][i];
        const float parts[4] = {color.r, color.g, color.b, alpha ? color.a : 1.0f};
        float *rgba = filled[new_indices[i]];
        if (!job->gltf.root) {
            mesh_fill_color(job, parts, rgba);
            job->colors.alpha_lost |= parts[3] != 1.0f;
            continue;
        }
        for (int k = 0; k < 4; k++)
            rgba[k] = clamp(job, parts[k]);
    }
}

void mesh_note_colors(struct mesh_job *job)
{
    if (job->obj.text.partly_colored && job->request->materials)
        mesh_note(job->report,
                  "some vertices have colours and others none: the colours are left out");
    if (job->colors.rejected)
        mesh_note(job->report, "vertex colours that are not as many as the vertices are left out");
    if (job->colors.clamped)
        mesh_note(job->report, "what is below 0 or above 1 in vertex colours is left out");
    if (job->colors.alpha_lost)
        mesh_note(job->report, "the alpha of vertex colours is left out");
}
