/* write_mesh.c: meshes; see write.h.
 *
 * A mesh that is a file of its own, and comes again, becomes a group: its file is read once,
 * whatever the number of instances.
 */
#include "pov/write.h"

#include <math.h>
#include <stdlib.h>

/* --- files and groups
 * -------------------------------------------------------------------------------- */

/* D. Knuth, "The Art of Computer Programming", 6.4: by the golden ratio; folded, since lists take
 * the low bits. */
uint64_t pov_hash_address(const void *address)
{
    uint64_t hash = (uint64_t)(uintptr_t)address * 0x9e3779b97f4a7c15;
    return hash ^ (hash >> 32);
}

/* The file that has the mesh already; NULL: none. */
static struct pov_mesh_file *find_file(const struct pov_writer *writer, const struct mesh *mesh)
{
    size_t i = name_index_find(&writer->meshes, pov_hash_address(mesh));
    for (; i != NAME_INDEX_NONE; i = name_index_before(&writer->meshes, i))
        if (writer->mesh_files[i].mesh == mesh)
            return &writer->mesh_files[i];
    return NULL;
}

static void note_file(struct pov_writer *writer, const struct mesh *mesh)
{
    const struct scene_text *scene = &writer->reader->scene;
    if (!pov_grow(writer->reader, (void **)&writer->mesh_files, &writer->mesh_file_capacity,
                  writer->mesh_file_count + 1, sizeof *writer->mesh_files))
        return;
    writer->mesh_files[writer->mesh_file_count++] =
        (struct pov_mesh_file){mesh, scene->files[scene->file_count - 1].name, NULL};
    if (!name_index_add(&writer->meshes, pov_hash_address(mesh)))
        pov_no_memory(writer->reader);
}

/* The group of a file. NULL: reported. */
static const char *group_of(struct pov_writer *writer, struct pov_mesh_file *file,
                            const char *material)
{
    struct scene_text *scene = &writer->reader->scene;
    FILE *out = scene->groups.stream;
    if (file->group)
        return file->group;
    file->group = scene_text_name(scene, "mesh");
    if (!file->group) {
        pov_no_memory(writer->reader);
        return NULL;
    }
    fputs("  ", out);
    put_text(out, file->group);
    fputs(":\n  - mesh: {file: ", out);
    put_path(out, file->name);
    fputs(", use: [geometry], material: ", out);
    put_text(out, material);
    fputs("}\n", out);
    return file->group;
}

/* Patterns lie in the space of the group. */
static void write_instance(struct pov_writer *writer, struct pov_mesh_file *file,
                           const struct transform *placement, const struct pov_above *look)
{
    FILE *out = writer->reader->scene.objects.stream;
    struct transform from_scene;
    if (!transform_invert(placement, &from_scene)) /* pov_placement has seen that there is one */
        return;
    const char *material = pov_write_material(writer, look, &from_scene);
    const char *group = material ? group_of(writer, file, material) : NULL;
    if (!group)
        return;
    fputs("  - instance: {of: ", out);
    put_text(out, group);
    pov_end_object(writer, look, placement, &from_scene);
}

/* A mesh that is shared stays where it is. */
static void write_mesh(struct pov_writer *writer, const struct pov_object *object,
                       const struct mesh *mesh, bool is_shared, const struct pov_above *look)
{
    struct pov_reader *reader = writer->reader;
    struct transform placement;
    struct pov_mesh_file *known = is_shared ? find_file(writer, mesh) : NULL;
    size_t files = reader->scene.file_count;
    if (mesh->triangle_count == 0 || !pov_placement(writer, object, &look->place, &placement))
        return;
    if (known) {
        write_instance(writer, known, &placement, look);
        return;
    }
    if (!pov_charge(reader, mesh->vertex_count, 32) ||
        !pov_charge(reader, mesh->triangle_count, 13))
        return;
    if (!mesh_put(&reader->scene, reader->options->base, reader->scene.objects.stream, mesh)) {
        pov_no_memory(reader);
        return;
    }
    if (is_shared && reader->scene.file_count > files)
        note_file(writer, mesh);
    pov_end_object(writer, look, &placement, &transform_identity);
}

/* --- pictures over x and y
 * ---------------------------------------------------------------------------- */

bool pov_is_planar(const struct pov_above *look)
{
    const struct pov_pigment *p = look->texture ? &look->texture->pigment : NULL;
    return p && p->pattern == POV_PATTERN_IMAGE && !p->is_uv && !look->is_uv && p->map_type == 0;
}

/* The picture is laid over the mesh by its u and v. */
static void write_planar(struct pov_writer *writer, const struct pov_object *object,
                         const struct mesh *from, const struct pov_above *look)
{
    struct mesh mesh = *from;
    struct transform picture =
        transform_compose(&look->texture_place, &look->texture->pigment.place);
    struct transform inverse;
    mesh.uv = transform_invert(&picture, &inverse)
                  ? malloc((mesh.vertex_count + 1) * sizeof *mesh.uv)
                  : NULL;
    if (!mesh.uv) {
        write_mesh(writer, object, from, false, look);
        return;
    }
    struct transform map = transform_compose(&inverse, &look->place);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        struct vector p = transform_point(&map, mesh.points[i]);
        mesh.uv[i][0] = fmin(fmax(p.x, -1e6), 1e6);
        mesh.uv[i][1] = fmin(fmax(p.y, -1e6), 1e6);
    }
    write_mesh(writer, object, &mesh, false, look);
    free(mesh.uv);
}

void pov_write_mesh(struct pov_writer *writer, const struct pov_object *object,
                    const struct mesh *mesh, const struct pov_above *look)
{
    if (pov_is_planar(look))
        write_planar(writer, object, mesh, look);
    else
        write_mesh(writer, object, mesh, true, look);
}

bool pov_write_pictured(struct pov_writer *writer, const struct pov_object *object,
                        const struct pov_above *look)
{
    struct mesh mesh = {0};
    if (!pov_has_extent(object) || !pov_tessellate(writer, object, &mesh))
        return false;
    write_planar(writer, object, &mesh, look);
    mesh_release(&mesh);
    return true;
}
