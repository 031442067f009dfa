/* light.c: reads light sources; see object.h and the reference of POV-Ray 3.7, "Light Source". */
#include "pov/expression.h"
#include "pov/object.h"

#include <math.h>
#include <string.h>

static void read_area(struct pov_reader *reader, struct pov_light *light)
{
    light->area = true;
    for (int i = 0; i < 2; i++) {
        light->axes[i] = pov_read_vector(reader);
        pov_skip_comma(reader);
    }
    for (int i = 0; i < 2; i++) {
        light->sizes[i] = (int)fmin(fmax(pov_read_float(reader), 1.0), 1000.0);
        pov_skip_comma(reader);
    }
}

/* Words without a value; false: it is none of them. */
static bool read_kind(uint32_t word, struct pov_light *light)
{
    switch (word) {
    case POV_spotlight:
        light->spot = true;
        break;
    case POV_cylinder:
        light->spot = light->cylinder = true;
        break;
    case POV_parallel:
        light->parallel = true;
        break;
    case POV_shadowless:
        light->shadowless = true;
        break;
    case POV_circular:
        light->circular = true;
        break;
    case POV_orient:
        light->orient = true;
        break;
    case POV_jitter:
        break;
    default:
        return false;
    }
    return true;
}

static double *number_of(struct pov_light *light, uint32_t word)
{
    switch (word) {
    case POV_radius:
        return &light->radius;
    case POV_falloff:
        return &light->falloff;
    case POV_tightness:
        return &light->tightness;
    case POV_fade_distance:
        return &light->fade_distance;
    case POV_fade_power:
        return &light->fade_power;
    default:
        return NULL;
    }
}

/* False: the token is no part of a light. */
static bool read_part(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_object *object, struct pov_light *light)
{
    double *number = token->kind == POV_WORD ? number_of(light, token->word) : NULL;
    if (number) {
        *number = pov_read_float(reader);
        return true;
    }
    if (token->kind != POV_WORD)
        return false;
    if (read_kind(token->word, light))
        return true;
    switch (token->word) {
    case POV_point_at:
        object->p[1] = pov_read_vector(reader);
        return true;
    case POV_area_light:
        read_area(reader, light);
        return true;
    case POV_adaptive:
    case POV_area_illumination:
    case POV_media_attenuation:
    case POV_media_interaction:
        pov_read_optional(reader, 1.0);
        return true;
    case POV_projected_through:
        pov_warn(reader, token, "projected_through is left out");
        pov_skip_braces(reader);
        return true;
    case POV_looks_like: {
        struct pov_token next;
        pov_expect(reader, '{');
        next = pov_next(reader);
        struct pov_object **list = pov_allocate(reader, 1, sizeof *list);
        struct pov_value *value = pov_named(reader, &next);
        struct pov_object *child = NULL;
        if (value && value->kind == POV_VALUE_OBJECT)
            child = pov_copy(reader, value->object, sizeof *child);
        else if (pov_begins_object(reader, &next))
            child = pov_read_object(reader, &next);
        else
            pov_unexpected(reader, &next, "an object");
        if (list && child) {
            pov_read_modifiers(reader, child);
            list[0] = child;
            object->children = list;
            object->child_count = 1;
        }
        return true;
    }
    default:
        return false;
    }
}

void pov_read_light(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_light light = {.radius = 30.0, .falloff = 45.0};
    struct pov_token token = pov_next(reader);
    const struct pov_value *value = pov_named(reader, &token);
    object->shape = POV_SHAPE_LIGHT;
    if (value && value->kind == POV_VALUE_OBJECT && value->object->light) { /* a declared one */
        const struct pov_token first = object->token;
        *object = *value->object;
        object->token = first;
        object->file = pov_file(reader);
        light = *object->light;
    } else {
        pov_unread(reader, token);
        object->p[0] = pov_read_vector(reader);
        pov_skip_comma(reader);
        memcpy(light.color, pov_read_color(reader).v, sizeof light.color);
    }
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END)
        if (!pov_is(&token, ',') && !read_part(reader, &token, object, &light) &&
            !pov_read_modifier(reader, &token, object))
            pov_unexpected(reader, &token, "a part of a light, or '}'");
    pov_unread(reader, token);
    object->light = pov_copy(reader, &light, sizeof light);
}
