/* surroundings.c: what stands beside the objects of a scene, and the scene as a whole; see
 * object.h. */
#include "pov/expression.h"
#include "pov/object.h"

#include <math.h>
#include <string.h>

/* Colours of a picture whose gamma is assumed to be that of the display are decoded by it
 * (write.c). */
static void read_settings(struct pov_reader *reader)
{
    struct pov_token token;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (pov_is_word(&token, POV_assumed_gamma)) {
            struct pov_token next = pov_next(reader);
            bool is_srgb = pov_is_word(&next, POV_srgb);
            if (!is_srgb)
                pov_unread(reader, next);
            reader->gamma = is_srgb ? 2.2 : fmin(fmax(pov_read_float(reader), 0.1), 10.0);
            reader->has_gamma = true;
            if (fabs(reader->gamma - 1.0) > 1e-6)
                pov_warn(reader, &token,
                         "assumed_gamma %g: colours are made linear by it; light adds up otherwise "
                         "than in POV-Ray",
                         reader->gamma);
        } else if (pov_is_word(&token, POV_ambient_light)) {
            memcpy(reader->ambient_light, pov_read_color(reader).v, sizeof reader->ambient_light);
        } else if (pov_is(&token, '{')) {
            pov_skip_block(reader); /* radiosity, photons, subsurface: psplat has its own ways */
        } else if (pov_begins_number(reader, &token)) {
            pov_unread(reader, token);
            pov_read_number(reader);
        } else if (pov_begins_string(reader, &token)) {
            pov_unread(reader, token);
            pov_read_string(reader);
        } else if (token.kind != POV_WORD && !pov_is(&token, ',')) {
            pov_unexpected(reader, &token, "a setting, or '}'");
        }
    }
}

static void read_background(struct pov_reader *reader, const struct pov_token *token)
{
    reader->background_token = *token;
    reader->background_file = pov_file(reader);
    pov_expect(reader, '{');
    memcpy(reader->background, pov_read_color(reader).v, sizeof reader->background);
    reader->has_background = true;
    pov_expect(reader, '}');
}

const struct pov_pigment *pov_read_sky(struct pov_reader *reader)
{
    struct pov_token token;
    struct pov_pigment *sky = NULL;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        struct transform step;
        if (pov_is_word(&token, POV_pigment)) {
            pov_expect(reader, '{');
            struct pov_pigment pigment = pov_read_pigment(reader, &token, pov_usual_pigment);
            if (sky)
                pov_warn(reader, &token, "sky_sphere: only the first pigment counts");
            else
                sky = pov_copy(reader, &pigment, sizeof pigment);
        } else if (pov_read_step(reader, &token, &step)) {
            if (sky)
                sky->place = transform_compose(&step, &sky->place);
        } else if (pov_is_word(&token, POV_emission)) {
            pov_read_color(reader);
        } else if (value && value->kind == POV_VALUE_SKY) {
            sky = value->pigment ? pov_copy(reader, value->pigment, sizeof *sky) : NULL;
        } else {
            pov_unexpected(reader, &token, "a pigment, or '}'");
        }
    }
    return sky;
}

bool pov_read_surroundings(struct pov_reader *reader, const struct pov_token *token)
{
    switch (token->kind == POV_WORD ? token->word : POV_WORD_COUNT) {
    case POV_global_settings:
        read_settings(reader);
        return true;
    case POV_background:
        read_background(reader, token);
        return true;
    case POV_sky_sphere: {
        const struct pov_pigment *sky = pov_read_sky(reader);
        reader->sky = sky ? sky : reader->sky;
        return true;
    }
    case POV_fog:
    case POV_rainbow:
    case POV_media:
    case POV_photons:
        pov_warn(reader, token, "%s is left out", pov_text(reader, token->word));
        pov_skip_braces(reader);
        return true;
    default:
        return false;
    }
}

static void read_camera(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_camera camera = pov_read_camera(reader);
    if (reader->camera)
        pov_warn(reader, token, "the last camera counts");
    reader->camera = pov_copy(reader, &camera, sizeof camera);
    reader->camera_token = *token;
    reader->camera_file = pov_file(reader);
}

static void add_object(struct pov_reader *reader, struct pov_object *object)
{
    if (object && pov_grow(reader, (void **)&reader->objects, &reader->object_capacity,
                           reader->object_count + 1, sizeof *reader->objects))
        reader->objects[reader->object_count++] = object;
}

void pov_read_scene(struct pov_reader *reader)
{
    struct pov_token token;
    while (token = pov_next(reader), token.kind != POV_END) {
        if (pov_begins_object(reader, &token))
            add_object(reader, pov_read_object(reader, &token));
        else if (pov_is_word(&token, POV_camera))
            read_camera(reader, &token);
        else if (pov_is_word(&token, POV_default)) /* also without # */
            pov_read_default(reader);
        else if (!pov_read_surroundings(reader, &token) && !pov_is(&token, ';'))
            pov_unexpected(reader, &token, "an object, a light, a camera or a directive");
    }
}
