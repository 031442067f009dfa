/* ply_mesh.c: a PLY file's geometry as a mesh. */
#include "import/geometry.h"

#include <stdlib.h>

bool ply_has_colors(const struct mesh_job *job)
{
    const struct ply *ply = &job->ply;
    for (size_t i = 0; ply->colors && i < ply->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            if (ply->colors[i][k] != 1.0f)
                return true;
    return false;
}

/* Leaves triangles that have an area, in their order, and counts the others. */
static void drop_triangles(const struct ply *ply, struct mesh_description *mesh, size_t *dropped)
{
    for (size_t i = 0; i < ply->triangle_count; i++) {
        const uint32_t a = mesh->triangles[i][0], b = mesh->triangles[i][1],
                       c = mesh->triangles[i][2];
        if (!mesh_has_area(ply->vertices[a], ply->vertices[b], ply->vertices[c])) {
            ++*dropped;
            continue;
        }
        uint32_t *kept = mesh->triangles[mesh->triangle_count++];
        kept[0] = a;
        kept[1] = b;
        kept[2] = c;
    }
}

static void fill_vertex(struct mesh_job *job, size_t from, size_t to, struct mesh_description *mesh)
{
    const struct ply *ply = &job->ply;
    mesh->vertices[to] = ply->vertices[from];
    if (mesh->normals)
        mesh->normals[to] = ply->normals[from];
    for (int k = 0; mesh->uv && k < 2; k++)
        mesh->uv[to][k] = isfinite(ply->uv[from][k]) ? ply->uv[from][k] : 0.0f;
    if (mesh->colors) {
        mesh_fill_color(job, ply->colors[from], mesh->colors[to]);
        job->colors.alpha_lost |= ply->colors[from][3] != 1.0f;
    }
}

static ps_result fill(struct mesh_job *job, uint32_t *numbers, bool colors,
                      struct mesh_description *mesh, size_t *dropped)
{
    const struct ply *ply = &job->ply;
    const struct mesh_parts parts = {
        .normals = ply->normals != NULL, .uv = ply->uv != NULL, .colors = colors};
    drop_triangles(ply, mesh, dropped);
    size_t count = mesh_number_vertices(mesh, numbers, ply->vertex_count);
    if (count == 0)
        return PS_OK;
    ps_result result = mesh_allocate_vertices(job, mesh, count, &parts);
    if (result != PS_OK)
        return result;
    for (size_t i = 0; i < ply->vertex_count; i++)
        if (numbers[i] != UINT32_MAX)
            fill_vertex(job, i, numbers[i], mesh);
    return mesh_settle_normals(job, mesh);
}

ps_result ply_fill(struct mesh_job *job, bool colors, struct mesh_description *mesh,
                   size_t *dropped)
{
    struct ply *ply = &job->ply;
    size_t bytes = (ply->vertex_count + 1) * sizeof(uint32_t);
    uint32_t *numbers = malloc(bytes);
    mesh->triangles = ply->triangles;
    ply->triangles = NULL;
    ps_result result =
        numbers ? fill(job, numbers, colors, mesh, dropped) : mesh_out_of_memory(job, bytes);
    free(numbers);
    return result;
}
