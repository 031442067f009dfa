/* object.c: reads objects; see object.h and the reference of POV-Ray 3.7, "Object". */
#include "pov/object.h"
#include "pov/expression.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct pov_object *new_object(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_object *object = pov_allocate(reader, 1, sizeof *object);
    if (object) {
        object->token = *token;
        object->file = pov_file(reader);
        object->place = object->texture_place = transform_identity;
    }
    return object;
}

/* --- shapes
 * --------------------------------------------------------------------------------------- */

static void read_sphere(struct pov_reader *reader, struct pov_object *object)
{
    object->shape = POV_SHAPE_SPHERE;
    object->p[0] = pov_read_vector(reader);
    pov_skip_comma(reader);
    object->r[0] = fabs(pov_read_float(reader));
}

static void read_box(struct pov_reader *reader, struct pov_object *object)
{
    object->shape = POV_SHAPE_BOX;
    object->p[0] = pov_read_vector(reader);
    pov_skip_comma(reader);
    object->p[1] = pov_read_vector(reader);
}

static void read_cylinder(struct pov_reader *reader, struct pov_object *object)
{
    read_box(reader, object);
    object->shape = POV_SHAPE_CYLINDER;
    pov_skip_comma(reader);
    object->r[0] = fabs(pov_read_float(reader));
    object->open = pov_accept_word(reader, POV_open);
}

static void read_cone(struct pov_reader *reader, struct pov_object *object)
{
    object->shape = POV_SHAPE_CONE;
    for (int i = 0; i < 2; i++) {
        object->p[i] = pov_read_vector(reader);
        pov_skip_comma(reader);
        object->r[i] = fabs(pov_read_float(reader));
        pov_skip_comma(reader);
    }
    object->open = pov_accept_word(reader, POV_open);
}

static void read_plane(struct pov_reader *reader, struct pov_object *object)
{
    object->shape = POV_SHAPE_PLANE;
    object->p[0] = pov_read_vector(reader);
    pov_skip_comma(reader);
    object->r[0] = pov_read_float(reader);
    double length = vector_length(object->p[0]);
    if (!(length > 0.0))
        pov_error(reader, &object->token, "plane: its normal is 0");
    object->p[0] = vector_unit(object->p[0]);
}

static void read_torus(struct pov_reader *reader, struct pov_object *object)
{
    object->shape = POV_SHAPE_TORUS;
    object->r[0] = fabs(pov_read_float(reader));
    pov_skip_comma(reader);
    object->r[1] = fabs(pov_read_float(reader));
}

static void read_disc(struct pov_reader *reader, struct pov_object *object)
{
    read_box(reader, object);
    object->shape = POV_SHAPE_DISC;
    pov_skip_comma(reader);
    object->r[0] = fabs(pov_read_float(reader));
    if (pov_accept(reader, ','))
        object->r[1] = fabs(pov_read_float(reader));
}

static void read_triangle(struct pov_reader *reader, struct pov_object *object)
{
    pov_read_triangle(reader, object, pov_is_word(&object->token, POV_smooth_triangle));
}

static void read_height_field(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_token token = pov_next(reader);
    object->shape = POV_SHAPE_HEIGHT_FIELD;
    while (token.kind == POV_WORD && !pov_begins_string(reader, &token) &&
           token.word != POV_function)
        token = pov_next(reader); /* the kind of file */
    if (pov_is_word(&token, POV_function)) {
        pov_note(reader, &object->token, "of a function is left out", &object->note);
        object->shape = POV_SHAPE_NOTHING;
        while (token = pov_next(reader), !pov_is(&token, '{') && token.kind != POV_END)
            continue;
        pov_skip_block(reader);
        return;
    }
    pov_unread(reader, token);
    object->image = pov_read_string(reader);
    pov_skip_comma(reader);
}

/* --- groups
 * --------------------------------------------------------------------------------------- */

/* Lists in the arena double, so that their copies cost no more than twice. */
static void add_child(struct pov_reader *reader, struct pov_object *group, struct pov_object *child)
{
    size_t count = group->child_count;
    bool is_full = (count & (count - 1)) == 0;
    if (is_full) {
        struct pov_object **grown = pov_allocate(reader, count ? 2 * count : 1, sizeof *grown);
        if (!grown)
            return;
        if (count > 0)
            memcpy(grown, group->children, count * sizeof *grown);
        group->children = grown;
    }
    group->children[group->child_count++] = child;
}

static void read_group(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_token token;
    bool is_difference = pov_is_word(&object->token, POV_difference);
    bool intersects = is_difference || pov_is_word(&object->token, POV_intersection);
    object->shape = intersects ? POV_SHAPE_INTERSECTION : POV_SHAPE_UNION;
    while (token = pov_next(reader), pov_begins_object(reader, &token)) {
        struct pov_object *child = pov_read_object(reader, &token);
        if (child && is_difference && object->child_count > 0) {
            child = pov_copy(reader, child, sizeof *child);
            if (child)
                child->inverse = !child->inverse;
        }
        if (child)
            add_child(reader, object, child);
    }
    pov_unread(reader, token);
    if (object->child_count == 0)
        object->shape = POV_SHAPE_NOTHING;
}

/* "object { NAME ... }" or "object { sphere {...} ... }" */
static void read_named(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_token token = pov_next(reader), first = object->token;
    struct pov_value *value = pov_named(reader, &token);
    if (value && value->kind == POV_VALUE_OBJECT) {
        const char *file = object->file;
        *object = *value->object;
        object->token = first;
        object->file = file;
    } else if (pov_begins_object(reader, &token)) {
        const struct pov_object *inner = pov_read_object(reader, &token);
        if (inner)
            *object = *inner;
    } else {
        pov_unexpected(reader, &token, "an object");
    }
}

/* --- all objects
 * ---------------------------------------------------------------------------------- */

static const struct {
    uint32_t word;
    void (*read)(struct pov_reader *reader, struct pov_object *object); /* NULL: no counterpart */
} kinds[] = {
    {POV_object, read_named},
    {POV_union, read_group},
    {POV_merge, read_group},
    {POV_light_group, read_group},
    {POV_difference, read_group},
    {POV_intersection, read_group},
    {POV_sphere, read_sphere},
    {POV_box, read_box},
    {POV_cylinder, read_cylinder},
    {POV_cone, read_cone},
    {POV_plane, read_plane},
    {POV_torus, read_torus},
    {POV_disc, read_disc},
    {POV_triangle, read_triangle},
    {POV_smooth_triangle, read_triangle},
    {POV_polygon, pov_read_polygon},
    {POV_mesh, pov_read_mesh},
    {POV_mesh2, pov_read_mesh2},
    {POV_bicubic_patch, pov_read_bicubic_patch},
    {POV_height_field, read_height_field},
    {POV_lathe, pov_read_lathe},
    {POV_sor, pov_read_sor},
    {POV_prism, pov_read_prism},
    {POV_superellipsoid, pov_read_superellipsoid},
    {POV_light_source, pov_read_light},
    {POV_blob, NULL},
    {POV_isosurface, NULL},
    {POV_julia_fractal, NULL},
    {POV_ovus, NULL},
    {POV_parametric, NULL},
    {POV_poly, NULL},
    {POV_cubic, NULL},
    {POV_polynomial, NULL},
    {POV_quadric, NULL},
    {POV_quartic, NULL},
    {POV_sphere_sweep, NULL},
    {POV_text, NULL},
};

bool pov_begins_object(const struct pov_reader *reader, const struct pov_token *token)
{
    if (token->kind != POV_WORD || pov_lookup(reader, token->word))
        return false;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (kinds[i].word == token->word)
            return true;
    return false;
}

struct pov_object *pov_read_object(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_object *object = new_object(reader, token);
    size_t kind = 0;
    while (kinds[kind].word != token->word)
        kind++;
    if (!object || !pov_enter(reader, token))
        return NULL;
    pov_expect(reader, '{');
    if (kinds[kind].read) {
        kinds[kind].read(reader, object);
        pov_read_modifiers(reader, object);
    } else if (!reader->stopped) {
        pov_note(reader, token, "has no counterpart: left out", &object->note);
        pov_skip_block(reader);
    }
    pov_leave(reader);
    return reader->stopped ? NULL : object;
}

/* --- modifiers
 * ------------------------------------------------------------------------------------ */

/* The object's texture, to be changed: its own, or the default. NULL: reported. */
static struct pov_texture *own_texture(struct pov_reader *reader, struct pov_object *object)
{
    const struct pov_texture *from = object->texture ? object->texture : &reader->look->texture;
    struct pov_texture *texture = pov_copy(reader, from, sizeof *texture);
    if (!texture)
        return NULL;
    /* What moved with the object so far counts as the texture's own. */
    texture->pigment.place = transform_compose(&object->texture_place, &texture->pigment.place);
    object->texture_place = transform_identity;
    object->texture = texture;
    return texture;
}

static void add_texture(struct pov_reader *reader, struct pov_object *object,
                        struct pov_texture texture, bool is_layer)
{
    struct pov_texture *kept = pov_copy(reader, &texture, sizeof texture);
    if (!kept)
        return;
    if (is_layer && object->texture && !kept->below)
        kept->below = object->texture;
    object->texture = kept;
    object->texture_place = transform_identity;
}

static void read_clips(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_token token;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (!pov_begins_object(reader, &token)) {
            if (!pov_is_word(&token, POV_bounded_by))
                pov_unexpected(reader, &token, "an object, or '}'");
            continue;
        }
        struct pov_object *clip = pov_read_object(reader, &token);
        /* A list of its own: that of a declared object is shared. */
        struct pov_object **list =
            clip ? pov_allocate(reader, object->clip_count + 1, sizeof *list) : NULL;
        if (!list)
            return;
        if (object->clip_count > 0)
            memcpy(list, object->clips, object->clip_count * sizeof *list);
        list[object->clip_count++] = clip;
        object->clips = list;
    }
}

static bool read_look(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_object *object)
{
    struct pov_texture *texture;
    switch (token->word) {
    case POV_texture: {
        bool is_layer = object->texture && object->is_own_texture;
        pov_expect(reader, '{');
        add_texture(reader, object, pov_read_texture(reader, token), is_layer);
        object->is_own_texture = true;
        return true;
    }
    case POV_pigment: {
        pov_expect(reader, '{');
        struct pov_pigment pigment = pov_read_pigment(reader, token, reader->look->texture.pigment);
        if (texture = own_texture(reader, object), texture)
            texture->pigment = pigment;
        return true;
    }
    case POV_finish: {
        pov_expect(reader, '{');
        struct pov_finish finish = pov_read_finish(
            reader, object->texture ? object->texture->finish : reader->look->texture.finish);
        if (texture = own_texture(reader, object), texture)
            texture->finish = finish;
        return true;
    }
    case POV_interior: {
        pov_expect(reader, '{');
        struct pov_interior interior = pov_read_interior(reader, reader->look->interior);
        object->interior = pov_copy(reader, &interior, sizeof interior);
        return true;
    }
    case POV_material: {
        pov_expect(reader, '{');
        struct pov_material material = pov_read_material(reader);
        if (material.texture)
            add_texture(reader, object, *material.texture, false);
        object->interior = material.interior ? material.interior : object->interior;
        return true;
    }
    case POV_interior_texture:
        pov_warn(reader, token, "interior_texture is left out");
        pov_skip_braces(reader);
        return true;
    case POV_normal:
        if (texture = own_texture(reader, object), texture)
            pov_note(reader, token, "normal and material_map are left out", &texture->note);
        pov_skip_braces(reader);
        return true;
    case POV_uv_mapping:
        object->is_uv = true;
        return true;
    default:
        return false;
    }
}

static bool read_flag(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_object *object)
{
    switch (token->word) {
    case POV_inverse:
        object->inverse = !object->inverse;
        return true;
    case POV_no_image:
        object->no_image = true;
        return true;
    case POV_smooth:
        object->smooth = true;
        return true;
    case POV_open:
        object->open = true;
        return true;
    case POV_no_shadow:
    case POV_no_reflection:
        pov_warn(reader, token, "%s is left out", pov_text(reader, token->word));
        return true;
    case POV_hollow:
    case POV_sturm:
    case POV_double_illuminate:
    case POV_split_union:
    case POV_hierarchy:
    case POV_global_lights:
        pov_read_optional(reader, 1.0);
        return true;
    case POV_water_level:
        pov_warn(reader, token, "water_level is left out");
        pov_read_float(reader);
        return true;
    case POV_bounded_by:
    case POV_photons:
        pov_skip_braces(reader);
        return true;
    case POV_clipped_by:
        read_clips(reader, object);
        return true;
    default:
        return false;
    }
}

bool pov_read_modifier(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_object *object)
{
    struct transform step;
    if (token->kind != POV_WORD)
        return false;
    if (pov_read_step(reader, token, &step)) {
        object->place = transform_compose(&step, &object->place);
        object->texture_place = transform_compose(&step, &object->texture_place);
        return true;
    }
    return read_look(reader, token, object) || read_flag(reader, token, object);
}

void pov_read_modifiers(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_token token;
    object->is_own_texture = false;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_TEXTURE)
            add_texture(reader, object, *value->texture, false);
        else if (!pov_is(&token, ',') && !pov_read_modifier(reader, &token, object))
            pov_unexpected(reader, &token, "a transform, texture or other modifier, or '}'");
    }
    if (token.kind == POV_END)
        pov_unexpected(reader, &token, "'}'");
}
