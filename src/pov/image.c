/* image.c: pictures as pigments; see object.h. */
#include "pov/expression.h"
#include "pov/object.h"

/* The word that says what kind of file follows; psplat looks into the file. */
static bool is_format(uint32_t word)
{
    static const uint32_t words[] = {POV_bmp, POV_exr, POV_gif, POV_hdr, POV_iff, POV_jpeg, POV_pgm,
                                     POV_png, POV_pot, POV_ppm, POV_sys, POV_tga, POV_tiff};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (words[i] == word)
            return true;
    return false;
}

static void read_part(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_pigment *pigment)
{
    switch (token->kind == POV_WORD ? token->word : POV_WORD_COUNT) {
    case POV_map_type:
        pigment->map_type = (int)fmin(fmax(pov_read_float(reader), 0.0), 10.0);
        break;
    case POV_once:
        pigment->once = true;
        break;
    case POV_interpolate:
        pigment->nearest = pov_read_float(reader) < 2.0;
        break;
    case POV_gamma: {
        struct pov_token next = pov_next(reader);
        if (!pov_is_word(&next, POV_srgb)) {
            pov_unread(reader, next);
            pov_read_float(reader);
        }
        pov_warn(reader, token, "gamma of a picture is left out: files of PNG and JPEG are sRGB");
        break;
    }
    case POV_filter:
    case POV_transmit:
        pov_accept_word(reader, POV_all);
        if (!pov_is(pov_peek(reader), '}'))
            pov_read_float(reader);
        if (pov_accept(reader, ','))
            pov_read_float(reader);
        pov_warn(reader, token, "%s of a picture is left out", pov_text(reader, token->word));
        break;
    case POV_premultiplied:
        pov_read_optional(reader, 0.0);
        break;
    default:
        pov_unexpected(reader, token, "a part of a picture, or '}'");
    }
}

void pov_read_image(struct pov_reader *reader, struct pov_pigment *pigment)
{
    struct pov_token token;
    pigment->pattern = POV_PATTERN_IMAGE;
    pigment->word = POV_image_map;
    pigment->nearest = true; /* unless it says interpolate */
    pigment->image = NULL;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        if (pov_begins_string(reader, &token)) {
            pov_unread(reader, token);
            pigment->image = pov_read_string(reader);
        } else if (pov_is(&token, '<')) { /* two axes, of old */
            while (token = pov_next(reader), !pov_is(&token, '>') && token.kind != POV_END)
                continue;
        } else if (token.kind != POV_WORD || !is_format(token.word)) {
            read_part(reader, &token, pigment);
        }
        pov_skip_comma(reader);
    }
    if (!pigment->image && !reader->stopped)
        pov_error(reader, &token, "image_map without the name of a file");
}
