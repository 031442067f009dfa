/* write_solid.c: solids by boolean operations, each made once; see write.h.
 *
 * Copies of a declared object share the list of what it is made of, and differ in their transforms
 * and looks: what is left of the parts' surfaces is kept in the space of the object, and written
 * for each copy from the same meshes.
 */
#include "pov/write.h"

/* Shared by copies. */
static const void *key_of(const struct pov_object *object)
{
    return object->child_count > 0 ? (const void *)object->children : (const void *)object->clips;
}

static bool is_same(const struct pov_object *a, const struct pov_object *b)
{
    return a->shape == b->shape && a->children == b->children && a->child_count == b->child_count &&
           a->clips == b->clips && a->clip_count == b->clip_count && a->mesh == b->mesh &&
           a->open == b->open && a->inverse == b->inverse;
}

/* NULL: reported. */
static const struct pov_solid *find_solid(struct pov_writer *writer,
                                          const struct pov_object *object)
{
    uint64_t hash = pov_hash_address(key_of(object));
    size_t i = name_index_find(&writer->solid_index, hash);
    for (; i != NAME_INDEX_NONE; i = name_index_before(&writer->solid_index, i))
        if (is_same(writer->solids[i].object, object))
            return &writer->solids[i];
    if (!pov_grow(writer->reader, (void **)&writer->solids, &writer->solid_capacity,
                  writer->solid_count + 1, sizeof *writer->solids))
        return NULL;
    if (!name_index_add(&writer->solid_index, hash)) {
        pov_no_memory(writer->reader);
        return NULL;
    }
    struct pov_solid *solid = &writer->solids[writer->solid_count++];
    *solid = (struct pov_solid){.object = object};
    pov_make_solid(writer, solid);
    return writer->reader->stopped ? NULL : solid;
}

void pov_write_solid(struct pov_writer *writer, const struct pov_object *object,
                     const struct pov_above *above)
{
    const struct pov_solid *solid = find_solid(writer, object);
    const struct pov_above look = pov_below(object, above);
    for (size_t i = 0; solid && i < solid->piece_count && !writer->reader->stopped; i++) {
        const struct pov_piece *piece = &solid->pieces[i];
        struct pov_above part = look;
        for (size_t k = 0; k < piece->way_length; k++)
            part = pov_below(piece->way[k], &part);
        part.place = look.place; /* the mesh is in the space of the solid */
        pov_write_mesh(writer, piece->part, piece->mesh, &part);
    }
}
