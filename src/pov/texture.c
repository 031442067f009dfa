/* texture.c: textures, materials, and what of a scene can be declared; see object.h. */
#include "pov/expression.h"
#include "pov/object.h"

#include <string.h>

static struct pov_texture usual_texture(const struct pov_reader *reader)
{
    return reader->look->texture;
}

static void read_texture_part(struct pov_reader *reader, const struct pov_token *token,
                              struct pov_texture *texture)
{
    switch (token->kind == POV_WORD ? token->word : POV_WORD_COUNT) {
    case POV_pigment:
        pov_expect(reader, '{');
        texture->pigment = pov_read_pigment(reader, token, reader->look->texture.pigment);
        return;
    case POV_finish:
        pov_expect(reader, '{');
        texture->finish = pov_read_finish(reader, texture->finish);
        return;
    case POV_normal:
    case POV_material_map:
        pov_note(reader, token, "normal and material_map are left out", &texture->note);
        pov_skip_braces(reader);
        return;
    default:
        break;
    }
    if (pov_read_transform(reader, token, &texture->pigment.place))
        return;
    if (pov_read_pattern_part(reader, token, &texture->pigment)) {
        if (!pov_is_word(token, POV_uv_mapping) && !pov_is_word(token, POV_turbulence))
            pov_note(reader, token,
                     "a pattern of textures: their mean colours stand for them, with one finish",
                     &texture->note);
        return;
    }
    pov_unexpected(reader, token, "a part of a texture, or '}'");
}

struct pov_texture pov_read_texture(struct pov_reader *reader, const struct pov_token *first)
{
    struct pov_texture texture = usual_texture(reader);
    struct pov_token token;
    if (!pov_enter(reader, first))
        return texture;
    texture.name = POV_texture;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_TEXTURE) {
            texture = *value->texture;
            texture.name = token.word;
        } else if (value && value->kind == POV_VALUE_PIGMENT) {
            texture.pigment = *value->pigment;
        } else if (value && value->kind == POV_VALUE_FINISH) {
            texture.finish = *value->finish;
        } else {
            read_texture_part(reader, &token, &texture);
        }
    }
    pov_leave(reader);
    return texture;
}

struct pov_material pov_read_material(struct pov_reader *reader)
{
    struct pov_object parts = {.place = transform_identity, .texture_place = transform_identity};
    struct pov_token token;
    if (!pov_enter(reader, pov_peek(reader)))
        return (struct pov_material){NULL, NULL};
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_MATERIAL) {
            parts.texture = value->material->texture;
            parts.interior = value->material->interior;
        } else if (!pov_read_modifier(reader, &token, &parts)) {
            pov_unexpected(reader, &token, "a part of a material, or '}'");
        }
    }
    if (parts.texture) {
        struct pov_texture *texture = pov_copy(reader, parts.texture, sizeof *texture);
        if (texture)
            texture->pigment.place =
                transform_compose(&parts.texture_place, &texture->pigment.place);
        parts.texture = texture;
    }
    pov_leave(reader);
    return (struct pov_material){parts.texture, parts.interior};
}

/* --- declared
 * ------------------------------------------------------------------------------------- */

/* "transform { ... }" */
static struct transform read_transform_block(struct pov_reader *reader)
{
    struct transform place = transform_identity;
    struct pov_token token;
    bool inverts = false;
    if (!pov_enter(reader, pov_peek(reader)))
        return place;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_TRANSFORM)
            place = transform_compose(value->transform, &place);
        else if (pov_is_word(&token, POV_inverse))
            inverts = true;
        else if (!pov_read_transform(reader, &token, &place))
            pov_unexpected(reader, &token, "a transform, or '}'");
    }
    pov_leave(reader);
    struct transform inverse = place;
    if (inverts && !transform_invert(&place, &inverse))
        pov_error(reader, &token, "this transform has no inverse");
    return inverse;
}

static struct pov_value kept(struct pov_reader *reader, enum pov_value_kind kind, const void *from,
                             size_t size)
{
    struct pov_value value = {.kind = kind};
    value.pigment = pov_copy(reader, from, size); /* whichever pointer: they share their place */
    return value.pigment ? value : (struct pov_value){0};
}

/* "texture {...} texture {...}": layers. */
static struct pov_value read_layers(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_token next = *token;
    struct pov_value value = {0};
    do {
        const struct pov_texture *below = value.texture;
        pov_expect(reader, '{');
        struct pov_texture texture = pov_read_texture(reader, &next);
        if (below)
            texture.below = below;
        value = kept(reader, POV_VALUE_TEXTURE, &texture, sizeof texture);
        if (!pov_is_word(pov_peek(reader), POV_texture))
            break;
        next = pov_next(reader);
    } while (value.kind != POV_VALUE_NONE);
    return value;
}

bool pov_read_declared(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_value *value)
{
    if (pov_begins_object(reader, token)) {
        value->object = pov_read_object(reader, token);
        value->kind = value->object ? POV_VALUE_OBJECT : POV_VALUE_NONE;
        return true;
    }
    switch (token->word) {
    case POV_texture:
        *value = read_layers(reader, token);
        return true;
    case POV_pigment: {
        pov_expect(reader, '{');
        struct pov_pigment p = pov_read_pigment(reader, token, reader->look->texture.pigment);
        *value = kept(reader, POV_VALUE_PIGMENT, &p, sizeof p);
        return true;
    }
    case POV_finish: {
        pov_expect(reader, '{');
        struct pov_finish f = pov_read_finish(reader, reader->look->texture.finish);
        *value = kept(reader, POV_VALUE_FINISH, &f, sizeof f);
        return true;
    }
    case POV_interior: {
        pov_expect(reader, '{');
        struct pov_interior i = pov_read_interior(reader, reader->look->interior);
        *value = kept(reader, POV_VALUE_INTERIOR, &i, sizeof i);
        return true;
    }
    case POV_material: {
        pov_expect(reader, '{');
        struct pov_material m = pov_read_material(reader);
        *value = kept(reader, POV_VALUE_MATERIAL, &m, sizeof m);
        return true;
    }
    case POV_color_map:
    case POV_colour_map:
    case POV_pigment_map:
    case POV_texture_map:
        pov_expect(reader, '{');
        value->map = pov_read_color_map(reader);
        value->kind = value->map ? POV_VALUE_COLOR_MAP : POV_VALUE_NONE;
        return true;
    case POV_transform: {
        struct transform t = read_transform_block(reader);
        *value = kept(reader, POV_VALUE_TRANSFORM, &t, sizeof t);
        return true;
    }
    case POV_sky_sphere:
        value->pigment = pov_read_sky(reader);
        value->kind = POV_VALUE_SKY;
        return true;
    case POV_camera: {
        struct pov_camera c = pov_read_camera(reader);
        *value = kept(reader, POV_VALUE_CAMERA, &c, sizeof c);
        return true;
    }
    default:
        return false;
    }
}

void pov_read_default(struct pov_reader *reader)
{
    struct pov_token token;
    pov_expect(reader, '{');
    struct pov_look look = *reader->look;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (pov_is_word(&token, POV_texture)) {
            pov_expect(reader, '{');
            look.texture = pov_read_texture(reader, &token);
        } else if (pov_is_word(&token, POV_pigment)) {
            pov_expect(reader, '{');
            look.texture.pigment = pov_read_pigment(reader, &token, look.texture.pigment);
        } else if (pov_is_word(&token, POV_finish)) {
            pov_expect(reader, '{');
            look.texture.finish = pov_read_finish(reader, look.texture.finish);
        } else if (token.kind == POV_WORD) {
            pov_skip_braces(reader);
        } else {
            pov_unexpected(reader, &token, "texture, pigment or finish");
        }
    }
    struct pov_look *copy = pov_copy(reader, &look, sizeof look);
    if (copy)
        reader->look = copy;
}

/* --- transforms
 * ----------------------------------------------------------------------------------- */

/* POV-Ray's axes are left-handed and so are its angles: in their own coordinates the matrices are
 * the usual ones. */
struct transform pov_rotation(struct vector degrees)
{
    static const struct vector axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double angles[3] = {degrees.x, degrees.y, degrees.z};
    struct transform whole = transform_identity, turn;
    for (int i = 0; i < 3; i++)
        if (transform_rotate(angles[i], axes[i], &turn))
            whole = transform_compose(&turn, &whole);
    return whole;
}

/* "matrix <12 numbers>": where x, y, z and the origin go. */
static struct transform read_matrix(struct pov_reader *reader)
{
    struct transform map = transform_identity;
    pov_expect(reader, '<');
    for (int i = 0; i < 12 && !reader->stopped; i++) {
        map.m[i % 3][i / 3] = pov_read_float(reader);
        if (i < 11)
            pov_expect(reader, ',');
    }
    pov_expect(reader, '>');
    return map;
}

bool pov_read_step(struct pov_reader *reader, const struct pov_token *token, struct transform *step)
{
    struct vector a;
    switch (token->kind == POV_WORD ? token->word : POV_WORD_COUNT) {
    case POV_translate:
        a = pov_read_vector(reader);
        *step = transform_translate(a.x, a.y, a.z);
        return true;
    case POV_rotate:
        *step = pov_rotation(pov_read_vector(reader));
        return true;
    case POV_scale:
        a = pov_read_vector(reader);
        if (a.x == 0.0 || a.y == 0.0 || a.z == 0.0)
            pov_warn(reader, token, "scale: factors of 0 count as 1, as POV-Ray has them");
        *step =
            transform_scale(a.x == 0.0 ? 1.0 : a.x, a.y == 0.0 ? 1.0 : a.y, a.z == 0.0 ? 1.0 : a.z);
        return true;
    case POV_matrix:
        *step = read_matrix(reader);
        return true;
    case POV_transform: {
        struct pov_token next = pov_next(reader);
        const struct pov_value *value = pov_named(reader, &next);
        if (value && value->kind == POV_VALUE_TRANSFORM) { /* of old, without braces */
            *step = *value->transform;
            return true;
        }
        pov_unread(reader, next);
        *step = read_transform_block(reader);
        return true;
    }
    default:
        return false;
    }
}

bool pov_read_transform(struct pov_reader *reader, const struct pov_token *token,
                        struct transform *place)
{
    struct transform step = transform_identity;
    if (!pov_read_step(reader, token, &step))
        return false;
    *place = transform_compose(&step, place);
    return true;
}
