/* finish.c: how surfaces answer to light, and what is inside; see object.h and the reference of
 * POV-Ray 3.7, "Finish", "Interior". */
#include "pov/expression.h"
#include "pov/object.h"

#include <string.h>

const struct pov_finish pov_usual_finish = {.ambient = {0.1, 0.1, 0.1},
                                            .diffuse = 0.6,
                                            .brilliance = 1.0,
                                            .roughness = 0.05,
                                            .phong_size = 40.0};
const struct pov_interior pov_usual_interior = {.ior = 1.0};

static void read_rgb(struct pov_reader *reader, double rgb[3])
{
    memcpy(rgb, pov_read_color(reader).v, 3 * sizeof *rgb);
}

/* "reflection { min, max fresnel metallic ... }" or "reflection value" */
static void read_reflection(struct pov_reader *reader, struct pov_finish *finish)
{
    struct pov_token token;
    if (!pov_accept(reader, '{')) {
        read_rgb(reader, finish->reflection[0]);
        memcpy(finish->reflection[1], finish->reflection[0], sizeof finish->reflection[0]);
        return;
    }
    int count = 0;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (pov_begins_number(reader, &token)) {
            pov_unread(reader, token);
            read_rgb(reader, finish->reflection[count > 0]);
            if (count++ == 0)
                memcpy(finish->reflection[1], finish->reflection[0], sizeof finish->reflection[0]);
        } else if (pov_is_word(&token, POV_fresnel)) {
            finish->fresnel = pov_read_optional(reader, 1.0) != 0.0;
        } else if (pov_is_word(&token, POV_metallic)) {
            finish->reflects_metallic = pov_read_optional(reader, 1.0) != 0.0;
        } else if (pov_is_word(&token, POV_falloff) || pov_is_word(&token, POV_exponent)) {
            pov_read_float(reader);
        } else if (!pov_is(&token, ',')) {
            pov_unexpected(reader, &token, "a colour or '}' in reflection");
        }
    }
}

static double *number_of(struct pov_finish *finish, uint32_t word)
{
    switch (word) {
    case POV_diffuse:
        return &finish->diffuse;
    case POV_brilliance:
        return &finish->brilliance;
    case POV_specular:
        return &finish->specular;
    case POV_roughness:
        return &finish->roughness;
    case POV_phong:
        return &finish->phong;
    case POV_phong_size:
        return &finish->phong_size;
    default:
        return NULL;
    }
}

static void read_part(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_finish *finish)
{
    double *number = token->kind == POV_WORD ? number_of(finish, token->word) : NULL;
    if (number) {
        pov_accept_word(reader, POV_albedo);
        *number = pov_read_float(reader);
        if (pov_accept(reader, ',')) /* diffuse's second number: light from behind */
            pov_read_float(reader);
        return;
    }
    switch (token->kind == POV_WORD ? token->word : POV_WORD_COUNT) {
    case POV_ambient:
        read_rgb(reader, finish->ambient);
        finish->has_ambient = true;
        break;
    case POV_emission:
        read_rgb(reader, finish->emission);
        break;
    case POV_reflection:
        read_reflection(reader, finish);
        break;
    case POV_metallic:
        finish->metallic = pov_read_optional(reader, 1.0);
        break;
    case POV_reflection_exponent:
    case POV_crand:
    case POV_conserve_energy:
    case POV_caustics:
    case POV_ior: /* of old */
        pov_read_optional(reader, 0.0);
        break;
    case POV_irid:
    case POV_subsurface:
        pov_note(reader, token, "irid and subsurface are left out", &finish->note);
        pov_skip_braces(reader);
        break;
    default:
        pov_unexpected(reader, token, "a part of a finish, or '}'");
    }
}

struct pov_finish pov_read_finish(struct pov_reader *reader, struct pov_finish finish)
{
    struct pov_token token;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_FINISH)
            finish = *value->finish;
        else if (!pov_is(&token, ','))
            read_part(reader, &token, &finish);
    }
    return finish;
}

struct pov_interior pov_read_interior(struct pov_reader *reader, struct pov_interior interior)
{
    struct pov_token token;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_INTERIOR) {
            interior = *value->interior;
            continue;
        }
        switch (token.kind == POV_WORD ? token.word : POV_WORD_COUNT) {
        case POV_ior:
            interior.ior = pov_read_float(reader);
            break;
        case POV_fade_distance:
            interior.fade_distance = pov_read_float(reader);
            break;
        case POV_fade_power:
            interior.fade_power = pov_read_float(reader);
            break;
        case POV_fade_color:
        case POV_fade_colour:
            read_rgb(reader, interior.fade_color);
            break;
        case POV_caustics:
        case POV_dispersion:
        case POV_dispersion_samples:
            pov_read_float(reader);
            break;
        case POV_media:
            pov_note(reader, &token, "media is left out", &interior.note);
            pov_skip_braces(reader);
            break;
        default:
            if (!pov_is(&token, ','))
                pov_unexpected(reader, &token, "a part of an interior, or '}'");
        }
    }
    return interior;
}
