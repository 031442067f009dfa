/* write_object.c: POV-Ray's objects as psplat's; see write.h.
 *
 * Groups are taken apart: each object in them is placed in the world by itself, and has its own
 * texture, or that of the nearest group that has one. Shapes that psplat has are written as such,
 * others as meshes.
 */
#include "pov/write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST 1e15 /* coordinates, whose squares floats still hold */
#define SMALLEST_DETERMINANT 1e-30

/* --- placing
 * -------------------------------------------------------------------------------------- */

bool pov_placement(struct pov_writer *writer, const struct pov_object *object,
                   const struct transform *place, struct transform *placement)
{
    struct transform inverse;
    double largest = 0.0;
    *placement = transform_compose(&writer->mirror, place);
    for (int i = 0; i < 12; i++) {
        double value = fabs(placement->m[i / 4][i % 4]);
        largest = value <= LARGEST ? fmax(largest, value) : INFINITY;
    }
    if (largest <= LARGEST && fabs(transform_determinant(placement)) >= SMALLEST_DETERMINANT &&
        transform_invert(placement, &inverse))
        return true;
    pov_warn_at(writer->reader, object->file, &object->token,
                "an object whose transform has no inverse, or too large numbers, is left out");
    return false;
}

static bool is_mirror_alone(const struct pov_writer *writer, const struct transform *placement)
{
    bool same = true;
    for (int i = 0; i < 12; i++)
        same = same && placement->m[i / 4][i % 4] == writer->mirror.m[i / 4][i % 4];
    return same;
}

/* What an object has that its surroundings have not said, and the transform down to it. */
struct pov_above pov_below(const struct pov_object *object, const struct pov_above *above)
{
    struct pov_above inner = *above;
    inner.place = transform_compose(&above->place, &object->place);
    inner.no_image = above->no_image || object->no_image;
    inner.is_uv = above->is_uv || object->is_uv;
    if (object->texture) {
        inner.texture = object->texture;
        inner.texture_place = transform_compose(&above->place, &object->texture_place);
    }
    if (object->interior)
        inner.interior = object->interior;
    return inner;
}

void pov_end_object(struct pov_writer *writer, const struct pov_above *look,
                    const struct transform *placement, const struct transform *from_scene)
{
    FILE *out = writer->reader->scene.objects.stream;
    const char *material = pov_write_material(writer, look, from_scene);
    if (!material)
        return;
    fputs(", material: ", out);
    put_text(out, material);
    if (look->no_image)
        fputs(", camera: no", out);
    if (placement)
        put_placement(out, placement);
    fputs("}\n", out);
}

/* --- psplat's own shapes
 * ---------------------------------------------------------------------------- */

static void put_key_vector(FILE *out, const char *key, struct vector a)
{
    fprintf(out, "%s: ", key);
    put_vector(out, a);
}

static void put_key_number(FILE *out, const char *key, double a)
{
    fprintf(out, "%s: ", key);
    put_number(out, a);
}

static bool is_within(struct vector a)
{
    return fabs(a.x) <= LARGEST && fabs(a.y) <= LARGEST && fabs(a.z) <= LARGEST;
}

/* Whether the shape has an extent, in the precision of floats. */
bool pov_has_extent(const struct pov_object *o)
{
    struct vector d = vector_subtract(o->p[1], o->p[0]);
    double size = fmax(vector_length(o->p[0]), vector_length(o->p[1])), r = fmax(o->r[0], o->r[1]);
    bool apart = vector_length(d) > 1e-6 * size && vector_length(d) > 1e-30;
    if (!is_within(o->p[0]) || !is_within(o->p[1]) || !(fmax(r, 0.0) <= LARGEST))
        return false;
    switch (o->shape) {
    case POV_SHAPE_SPHERE:
        return o->r[0] > 1e-30;
    case POV_SHAPE_BOX:
        return fmin(fabs(d.x), fmin(fabs(d.y), fabs(d.z))) > fmax(1e-6 * size, 1e-30);
    case POV_SHAPE_CYLINDER:
    case POV_SHAPE_CONE:
        return apart && r > 1e-30;
    case POV_SHAPE_TORUS:
        return o->r[1] > 1e-30 && o->r[1] < o->r[0] && (float)o->r[1] < (float)o->r[0];
    case POV_SHAPE_DISC:
        return o->r[0] > 1e-30 && vector_length(o->p[1]) > 1e-15 && (float)o->r[1] < (float)o->r[0];
    default:
        return true;
    }
}

static void put_shape(FILE *out, const struct pov_object *o, const struct vector p[2])
{
    switch (o->shape) {
    case POV_SHAPE_SPHERE:
        put_key_vector(out, "  - sphere: {center", p[0]);
        put_key_number(out, ", radius", o->r[0]);
        break;
    case POV_SHAPE_BOX:
        fputs("  - box: {corners: [", out);
        put_vector(out, p[0]);
        fputs(", ", out);
        put_vector(out, p[1]);
        fputc(']', out);
        break;
    case POV_SHAPE_CYLINDER:
        put_key_vector(out, "  - cylinder: {from", p[0]);
        put_key_vector(out, ", to", p[1]);
        put_key_number(out, ", radius", o->r[0]);
        break;
    case POV_SHAPE_CONE:
        put_key_vector(out, "  - cone: {from", p[0]);
        put_key_number(out, ", from_radius", o->r[0]);
        put_key_vector(out, ", to", p[1]);
        put_key_number(out, ", to_radius", o->r[1]);
        break;
    case POV_SHAPE_TORUS:
        put_key_number(out, "  - torus: {radius", o->r[0]);
        put_key_number(out, ", minor_radius", o->r[1]);
        break;
    default: /* POV_SHAPE_DISC */
        put_key_vector(out, "  - disc: {center", p[0]);
        put_key_vector(out, ", normal", p[1]);
        put_key_number(out, ", radius", o->r[0]);
        if (o->r[1] > 0.0)
            put_key_number(out, ", hole", o->r[1]);
    }
    if (o->open)
        fputs(", open: yes", out);
}

/* Numbers that only the mirror changes are written mirrored: no matrix is to be read then. */
static void write_shape(struct pov_writer *writer, const struct pov_object *object,
                        const struct pov_above *look)
{
    struct transform placement;
    struct vector p[2] = {object->p[0], object->p[1]};
    if (!pov_placement(writer, object, &look->place, &placement))
        return;
    if (!pov_has_extent(object)) {
        pov_warn_at(writer->reader, object->file, &object->token,
                    "%s without an extent is left out",
                    pov_text(writer->reader, object->token.word));
        return;
    }
    bool plain = is_mirror_alone(writer, &placement);
    for (int i = 0; i < 2 && plain; i++)
        p[i] = transform_point(&writer->mirror, p[i]);
    put_shape(writer->reader->scene.objects.stream, object, p);
    pov_end_object(writer, look, plain ? NULL : &placement, &transform_identity);
}

/* In the world's coordinates, by the normal and a point of it. */
static void write_plane(struct pov_writer *writer, const struct pov_object *object,
                        const struct pov_above *look)
{
    FILE *out = writer->reader->scene.objects.stream;
    struct transform placement;
    struct vector n = object->p[0];
    if (!pov_placement(writer, object, &look->place, &placement))
        return;
    struct vector point = transform_point(&placement, vector_scale(n, object->r[0]));
    n = transform_normal(&placement, n);
    n = vector_unit(n);
    double distance = vector_dot(n, point);
    if (!is_within(n) || !(fabs(distance) <= 1e12)) {
        pov_warn_at(writer->reader, object->file, &object->token, "a plane far away is left out");
        return;
    }
    put_key_vector(out, "  - plane: {normal", n);
    put_key_number(out, ", distance", distance);
    put_key_number(out, ", extent", writer->extent);
    pov_end_object(writer, look, NULL, &transform_identity);
}

static void write_height_field(struct pov_writer *writer, const struct pov_object *object,
                               const struct pov_above *look)
{
    FILE *out = writer->reader->scene.objects.stream;
    struct transform placement;
    const char *name = pov_write_file_name(writer, object->file, &object->token, object->image);
    if (name && pov_placement(writer, object, &look->place, &placement)) {
        fputs("  - height_field: {file: ", out);
        put_path(out, name);
        fputs(object->smooth ? ", smooth: yes" : ", smooth: no", out);
        pov_end_object(writer, look, &placement, &transform_identity);
    }
}

/* --- all
 * ------------------------------------------------------------------------------------------ */

void pov_warn_of_object(struct pov_writer *writer, const struct pov_object *object)
{
    const struct pov_note *note = &object->note;
    if (note->text)
        pov_warn_at(writer->reader, note->file, &note->token, "%s %s",
                    pov_text(writer->reader, note->token.word), note->text);
}

static void warn_of_map(struct pov_writer *writer, const struct pov_above *look)
{
    const struct pov_pigment *p = look->texture ? &look->texture->pigment : NULL;
    if (p && p->pattern == POV_PATTERN_IMAGE && (p->map_type != 0 || p->is_uv || look->is_uv))
        pov_warn_at(writer->reader, p->file, &p->token,
                    "image_map: it lies by psplat's own u and v of the shape");
}

static void write_children(struct pov_writer *writer, const struct pov_object *object,
                           const struct pov_above *look)
{
    writer->depth++;
    for (size_t i = 0; i < object->child_count && !writer->reader->stopped; i++)
        pov_write_object(writer, object->children[i], look);
    writer->depth--;
}

void pov_write_object(struct pov_writer *writer, const struct pov_object *object,
                      const struct pov_above *above)
{
    struct pov_above look = pov_below(object, above);
    if (writer->depth == POV_DEEPEST) {
        pov_error(writer->reader, &object->token, "objects are in each other more than %d deep",
                  POV_DEEPEST);
        return;
    }
    if (++writer->written > POV_MOST_OBJECTS)
        pov_error(writer->reader, &object->token,
                  "the scene has more than %d objects, those of groups each time",
                  POV_MOST_OBJECTS);
    pov_warn_of_object(writer, object);
    if (writer->reader->stopped || object->shape == POV_SHAPE_NOTHING)
        return;
    if (object->clip_count > 0 && object->shape != POV_SHAPE_UNION) {
        pov_write_solid(writer, object, above);
        return;
    }
    if (object->clip_count > 0)
        pov_warn_at(writer->reader, object->file, &object->token,
                    "clipped_by of a group is left out");
    warn_of_map(writer, &look);
    switch (object->shape) {
    case POV_SHAPE_LIGHT:
        pov_write_light(writer, object, &look.place);
        if (object->child_count > 0)
            pov_warn_at(writer->reader, object->file, &object->token,
                        "looks_like is left out: it would shade its light");
        break;
    case POV_SHAPE_UNION:
        write_children(writer, object, &look);
        break;
    case POV_SHAPE_INTERSECTION:
        pov_write_solid(writer, object, above);
        break;
    case POV_SHAPE_HEIGHT_FIELD:
        write_height_field(writer, object, &look);
        break;
    case POV_SHAPE_MESH:
        pov_write_mesh(writer, object, object->mesh, &look);
        break;
    case POV_SHAPE_PLANE:
        if (!pov_is_planar(&look) || !pov_write_pictured(writer, object, &look))
            write_plane(writer, object, &look);
        break;
    default:
        look.is_sphere = object->shape == POV_SHAPE_SPHERE;
        if (!pov_is_planar(&look) || !pov_write_pictured(writer, object, &look))
            write_shape(writer, object, &look);
    }
}
