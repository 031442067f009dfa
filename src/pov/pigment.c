/* pigment.c: colours, maps of colours and patterns; see object.h and the reference of POV-Ray 3.7,
 * "Pigment".
 *
 * psplat has patterns of two colours. checker and gradient are the same ones, but for maps of more
 * colours; what looks like clouds becomes noise between the means of the lower and the upper half
 * of the map; the mean colour stands for what is left.
 */
#include "pov/expression.h"
#include "pov/object.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct pov_pigment pov_usual_pigment = {
    .axis = {0, 1, 0}, .place = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

static const struct {
    uint32_t word;
    enum pov_pattern pattern;
} patterns[] = {
    {POV_checker, POV_PATTERN_CHECKER},    {POV_gradient, POV_PATTERN_GRADIENT},
    {POV_marble, POV_PATTERN_GRADIENT},    {POV_agate, POV_PATTERN_NOISE},
    {POV_bozo, POV_PATTERN_NOISE},         {POV_bumps, POV_PATTERN_NOISE},
    {POV_spotted, POV_PATTERN_NOISE},      {POV_granite, POV_PATTERN_NOISE},
    {POV_wrinkles, POV_PATTERN_NOISE},     {POV_dents, POV_PATTERN_NOISE},
    {POV_leopard, POV_PATTERN_NOISE},      {POV_crackle, POV_PATTERN_NOISE},
    {POV_wood, POV_PATTERN_NOISE},         {POV_brick, POV_PATTERN_OTHER},
    {POV_hexagon, POV_PATTERN_OTHER},      {POV_tiles, POV_PATTERN_OTHER},
    {POV_square, POV_PATTERN_OTHER},       {POV_triangular, POV_PATTERN_OTHER},
    {POV_boxed, POV_PATTERN_OTHER},        {POV_cells, POV_PATTERN_OTHER},
    {POV_cylindrical, POV_PATTERN_OTHER},  {POV_julia, POV_PATTERN_OTHER},
    {POV_mandel, POV_PATTERN_OTHER},       {POV_magnet, POV_PATTERN_OTHER},
    {POV_onion, POV_PATTERN_OTHER},        {POV_planar, POV_PATTERN_OTHER},
    {POV_quilted, POV_PATTERN_OTHER},      {POV_radial, POV_PATTERN_OTHER},
    {POV_ripples, POV_PATTERN_OTHER},      {POV_slope, POV_PATTERN_OTHER},
    {POV_spherical, POV_PATTERN_OTHER},    {POV_spiral1, POV_PATTERN_OTHER},
    {POV_spiral2, POV_PATTERN_OTHER},      {POV_waves, POV_PATTERN_OTHER},
    {POV_average, POV_PATTERN_OTHER},      {POV_facets, POV_PATTERN_OTHER},
    {POV_cubic, POV_PATTERN_OTHER},        {POV_pavement, POV_PATTERN_OTHER},
    {POV_tiling, POV_PATTERN_OTHER},       {POV_function, POV_PATTERN_OTHER},
    {POV_density_file, POV_PATTERN_OTHER}, {POV_pigment_pattern, POV_PATTERN_OTHER},
    {POV_object, POV_PATTERN_OTHER},       {POV_image_pattern, POV_PATTERN_OTHER},
};

/* --- maps
 * --------------------------------------------------------------------------------------- */

void pov_color_at(const struct pov_color_map *map, double at, double color[POV_TERMS])
{
    const struct pov_map_entry *e = map->entries;
    size_t i = 0;
    while (i < map->count && e[i].at <= at)
        i++;
    if (i == 0 || i == map->count) {
        memcpy(color, e[i == 0 ? 0 : i - 1].color, sizeof e->color);
        return;
    }
    double span = e[i].at - e[i - 1].at, share = span > 0.0 ? (at - e[i - 1].at) / span : 1.0;
    for (int k = 0; k < POV_TERMS; k++)
        color[k] = e[i - 1].color[k] + share * (e[i].color[k] - e[i - 1].color[k]);
}

static void mean_between(const struct pov_color_map *map, double from, double to,
                         double mean[POV_TERMS])
{
    enum { STEPS = 64 };
    memset(mean, 0, POV_TERMS * sizeof *mean);
    for (int i = 0; i < STEPS; i++) {
        double color[POV_TERMS];
        pov_color_at(map, from + (to - from) * (i + 0.5) / STEPS, color);
        for (int k = 0; k < POV_TERMS; k++)
            mean[k] += color[k] / STEPS;
    }
}

/* The line of least squares through the map from 0 to `last`: its mean, and so the light in all, is
 * the map's. Where the line leaves what colours the map has, it is cut there. `ends`: the map's
 * there, then the line's. */
static void line_through(const struct pov_color_map *map, double last, double ends[2][POV_TERMS])
{
    enum { STEPS = 64 };
    double sums[2][POV_TERMS] = {{0}}, least[POV_TERMS], most[POV_TERMS], squares = 0.0;
    for (int k = 0; k < POV_TERMS; k++) {
        least[k] = fmin(ends[0][k], ends[1][k]);
        most[k] = fmax(ends[0][k], ends[1][k]);
    }
    for (int i = 0; i < STEPS; i++) {
        double color[POV_TERMS], t = (i + 0.5) / STEPS - 0.5;
        pov_color_at(map, last * (t + 0.5), color);
        squares += t * t;
        for (int k = 0; k < POV_TERMS; k++) {
            sums[0][k] += color[k] / STEPS;
            sums[1][k] += color[k] * t;
            least[k] = fmin(least[k], color[k]);
            most[k] = fmax(most[k], color[k]);
        }
    }
    for (int k = 0; k < POV_TERMS; k++)
        for (int end = 0; end < 2; end++)
            ends[end][k] =
                fmin(fmax(sums[0][k] + (end - 0.5) * sums[1][k] / squares, least[k]), most[k]);
}

/* The map that a pattern has without one: from black to white. */
static const struct pov_color_map *map_of(const struct pov_pigment *pigment)
{
    static struct pov_map_entry entries[] = {{0, {0, 0, 0, 0, 0}}, {1, {1, 1, 1, 0, 0}}};
    static const struct pov_color_map grey = {2, entries};
    return pigment->map && pigment->map->count > 0 ? pigment->map : &grey;
}

/* Of checker, brick and hexagon where no colours are listed. */
static void usual_colors(const struct pov_pigment *pigment, double colors[POV_LISTED][POV_TERMS])
{
    static const double checker[POV_LISTED][POV_TERMS] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                        brick[POV_LISTED][POV_TERMS] = {{0.5, 0.5, 0.5}, {0.6, 0.15, 0.15}};
    memcpy(colors, pigment->word == POV_brick ? brick : checker, sizeof checker);
    for (int i = 0; i < pigment->listed_count; i++)
        memcpy(colors[i], pigment->listed[i], sizeof checker[i]);
}

static bool is_listed(const struct pov_pigment *pigment)
{
    return pigment->word == POV_checker || pigment->word == POV_brick ||
           pigment->word == POV_hexagon || pigment->word == POV_tiles ||
           pigment->word == POV_object;
}

void pov_pigment_ends(const struct pov_pigment *pigment, double colors[2][POV_TERMS])
{
    if (is_listed(pigment)) {
        double listed[POV_LISTED][POV_TERMS];
        usual_colors(pigment, listed);
        memcpy(colors, listed, 2 * sizeof listed[0]);
    } else if (pigment->pattern == POV_PATTERN_GRADIENT) {
        double last = pigment->word == POV_marble ? 0.5 : 1.0;
        pov_color_at(map_of(pigment), 0.0, colors[0]);
        pov_color_at(map_of(pigment), last, colors[1]);
        if (map_of(pigment)->count > 2)
            line_through(map_of(pigment), last, colors);
    } else {
        mean_between(map_of(pigment), 0.0, 0.5, colors[0]);
        mean_between(map_of(pigment), 0.5, 1.0, colors[1]);
    }
}

void pov_pigment_mean(const struct pov_pigment *pigment, double color[POV_TERMS])
{
    static const double grey[POV_TERMS] = {0.5, 0.5, 0.5};
    double listed[POV_LISTED][POV_TERMS];
    if (pigment->pattern == POV_PATTERN_PLAIN || pigment->pattern == POV_PATTERN_IMAGE) {
        memcpy(color, pigment->pattern == POV_PATTERN_PLAIN ? pigment->color : grey, sizeof grey);
    } else if (is_listed(pigment)) {
        /* The usual brick is 8 by 3 by 4.5, with 0.5 of mortar between. */
        double shares[POV_LISTED] = {0.5, 0.5, 0};
        if (pigment->word == POV_brick)
            memcpy(shares, (const double[]){0.2, 0.8, 0}, sizeof shares);
        else if (pigment->word == POV_hexagon)
            shares[0] = shares[1] = shares[2] = 1.0 / 3.0;
        usual_colors(pigment, listed);
        for (int k = 0; k < POV_TERMS; k++)
            color[k] =
                shares[0] * listed[0][k] + shares[1] * listed[1][k] + shares[2] * listed[2][k];
    } else {
        mean_between(map_of(pigment), 0.0, 1.0, color);
    }
}

/* --- reading maps
 * --------------------------------------------------------------------------------- */

/* A pigment or texture in a list counts by its mean. */
static bool read_mean(struct pov_reader *reader, double color[POV_TERMS])
{
    struct pov_token token = pov_next(reader);
    struct pov_value *value = pov_named(reader, &token);
    if (value && value->kind == POV_VALUE_PIGMENT) {
        pov_pigment_mean(value->pigment, color);
    } else if (value && value->kind == POV_VALUE_TEXTURE) {
        pov_pigment_mean(&value->texture->pigment, color);
    } else if (pov_is_word(&token, POV_pigment)) {
        pov_expect(reader, '{');
        struct pov_pigment pigment = pov_read_pigment(reader, &token, pov_usual_pigment);
        pov_pigment_mean(&pigment, color);
    } else if (pov_is_word(&token, POV_texture)) {
        pov_expect(reader, '{');
        struct pov_texture texture = pov_read_texture(reader, &token);
        pov_pigment_mean(&texture.pigment, color);
    } else {
        pov_unread(reader, token);
        return false;
    }
    return true;
}

/* A colour, or what in pigment_map and texture_map stands for one: the parts of a pigment without
 * its braces. */
static void read_map_color(struct pov_reader *reader, double color[POV_TERMS])
{
    struct pov_token token;
    if (read_mean(reader, color)) {
        while (token = pov_next(reader), !pov_is(&token, ']') && token.kind != POV_END) {
            struct transform unused = transform_identity;
            if (pov_is_word(&token, POV_texture) || pov_is_word(&token, POV_finish) ||
                pov_is_word(&token, POV_normal))
                pov_skip_braces(reader); /* a layer above it */
            else if (!pov_read_transform(reader, &token, &unused))
                break;
        }
        pov_unread(reader, token);
        return;
    }
    token = pov_next(reader);
    pov_unread(reader, token);
    if (pov_begins_number(reader, &token)) {
        struct pov_number n = pov_read_color(reader);
        memcpy(color, n.v, sizeof n.v);
        return;
    }
    struct pov_pigment pigment = pov_usual_pigment;
    while (token = pov_next(reader), !pov_is(&token, ']') && token.kind != POV_END)
        if (!pov_read_pattern_part(reader, &token, &pigment) &&
            !pov_read_transform(reader, &token, &pigment.place)) {
            pov_unexpected(reader, &token, "a colour");
            break;
        }
    pov_unread(reader, token);
    pov_pigment_mean(&pigment, color);
}

/* "[0.3 color]", or of old "[0 0.3 color color]" */
static int read_entry(struct pov_reader *reader, struct pov_map_entry entries[2])
{
    int count = 1;
    entries[0].at = pov_read_optional(reader, 0.0); /* of an average it may be missing */
    pov_skip_comma(reader);
    struct pov_token token = pov_next(reader);
    pov_unread(reader, token);
    const struct pov_value *value = token.kind == POV_WORD ? pov_lookup(reader, token.word) : NULL;
    bool is_float = token.kind == POV_NUMBER || pov_is(&token, '-') || pov_is(&token, '(') ||
                    (value && value->kind == POV_VALUE_NUMBER && value->number.terms == 1);
    if (is_float) {
        entries[1].at = pov_read_float(reader);
        pov_skip_comma(reader);
        count = 2;
    }
    for (int i = 0; i < count; i++) {
        read_map_color(reader, entries[i].color);
        pov_skip_comma(reader);
    }
    pov_expect(reader, ']');
    return count;
}

static int compare_entries(const void *a, const void *b)
{
    const struct pov_map_entry *p = a, *q = b;
    return (p->at > q->at) - (p->at < q->at);
}

const struct pov_color_map *pov_read_color_map(struct pov_reader *reader)
{
    struct pov_map_entry *list = NULL, entries[2] = {{0}};
    size_t count = 0, capacity = 0;
    struct pov_token token;
    struct pov_color_map *map = pov_allocate(reader, 1, sizeof *map);
    if (!pov_enter(reader, pov_peek(reader)))
        return NULL;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        struct pov_value *value = pov_named(reader, &token);
        size_t added = 0;
        const struct pov_map_entry *from = entries;
        if (value && value->kind == POV_VALUE_COLOR_MAP) {
            added = value->map->count;
            from = value->map->entries;
        } else if (pov_is(&token, '[')) {
            added = (size_t)read_entry(reader, entries);
        } else if (!pov_is_word(&token, POV_interpolate)) {
            pov_unexpected(reader, &token, "'[' of a map's entry, or '}'");
        }
        if (!pov_grow(reader, (void **)&list, &capacity, count + added, sizeof *list))
            break;
        if (added > 0)
            memcpy(list + count, from, added * sizeof *list);
        count += added;
    }
    for (size_t i = 1; i < count; i++) /* those of one place stay in their order */
        if (list[i].at < list[i - 1].at)
            qsort(list, count, sizeof *list, compare_entries);
    if (map && count > 0) {
        map->count = count;
        map->entries = pov_copy(reader, list, count * sizeof *list);
    }
    free(list);
    pov_leave(reader);
    return map && (map->entries || count == 0) ? map : NULL;
}

/* --- patterns
 * ----------------------------------------------------------------------------------- */

static void read_listed(struct pov_reader *reader, struct pov_pigment *pigment)
{
    while (pigment->listed_count < POV_LISTED && !reader->stopped) {
        double *color = pigment->listed[pigment->listed_count];
        if (!read_mean(reader, color)) {
            struct pov_token token = pov_next(reader);
            pov_unread(reader, token);
            if (!pov_begins_number(reader, &token))
                return;
            memcpy(color, pov_read_color(reader).v, POV_TERMS * sizeof *color);
        }
        pigment->listed_count++;
        pov_skip_comma(reader);
        pov_accept_word(reader, POV_tile2);
    }
}

/* Those of spirals, julias, agates. */
static void read_numbers(struct pov_reader *reader)
{
    while (!reader->stopped) {
        struct pov_token token = pov_next(reader);
        pov_unread(reader, token);
        if (!pov_begins_number(reader, &token) || pov_is_word(&token, POV_color) ||
            pov_is_word(&token, POV_colour))
            return;
        pov_read_number(reader);
        pov_skip_comma(reader);
    }
}

/* "{ OBJECT outside, inside }" */
static void read_object_pattern(struct pov_reader *reader, struct pov_pigment *pigment)
{
    pov_expect(reader, '{');
    struct pov_token token = pov_next(reader);
    const struct pov_value *value = pov_named(reader, &token);
    if (pov_begins_object(reader, &token))
        pov_read_object(reader, &token);
    else if (!value || value->kind != POV_VALUE_OBJECT)
        pov_unexpected(reader, &token, "an object");
    pov_skip_comma(reader);
    read_listed(reader, pigment);
    pov_expect(reader, '}');
}

/* "df3 "FILE"" */
static void skip_density_file(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    if (token.kind != POV_WORD || strcmp(pov_text(reader, token.word), "df3") != 0)
        pov_unread(reader, token);
    pov_read_string(reader);
}

/* What stands behind a pattern's name. */
static void read_pattern(struct pov_reader *reader, struct pov_pigment *pigment)
{
    pigment->listed_count = 0;
    switch (pigment->word) {
    case POV_checker:
    case POV_brick:
    case POV_hexagon:
        read_listed(reader, pigment);
        break;
    case POV_tiles: {
        bool braces = pov_accept(reader, '{');
        read_listed(reader, pigment);
        if (braces)
            pov_expect(reader, '}');
        break;
    }
    case POV_object:
        read_object_pattern(reader, pigment);
        break;
    case POV_slope:
        if (pov_accept(reader, '{'))
            pov_skip_block(reader);
        else
            read_numbers(reader);
        break;
    case POV_density_file:
        skip_density_file(reader);
        break;
    case POV_gradient:
        pigment->axis = pov_read_vector(reader);
        break;
    case POV_marble:
        pigment->axis = (struct vector){1, 0, 0};
        break;
    case POV_function:
    case POV_image_pattern:
    case POV_pigment_pattern:
    case POV_average:
    case POV_cubic: {
        struct pov_token token = pov_next(reader);
        while (!pov_is(&token, '{') && !pov_is(&token, '}') && token.kind != POV_END &&
               pigment->word == POV_function)
            token = pov_next(reader);
        if (pov_is(&token, '{')) {
            bool raw = reader->raw;
            reader->raw = true;
            pov_skip_block(reader);
            reader->raw = raw;
        } else {
            pov_unread(reader, token);
        }
        break;
    }
    default:
        read_numbers(reader);
    }
}

static void read_turbulence(struct pov_reader *reader, struct pov_pigment *pigment)
{
    struct vector t = pov_read_vector(reader);
    pigment->turbulence = (fabs(t.x) + fabs(t.y) + fabs(t.z)) / 3.0;
}

void pov_note(struct pov_reader *reader, const struct pov_token *token, const char *text,
              struct pov_note *note)
{
    if (!note->text)
        *note = (struct pov_note){text, *token, pov_file(reader)};
}

/* Words that change a pattern in ways that psplat's don't know. */
static bool skip_detail(struct pov_reader *reader, const struct pov_token *token,
                        struct pov_note *note)
{
    switch (token->word) {
    case POV_frequency:
    case POV_phase:
    case POV_octaves:
    case POV_omega:
    case POV_lambda:
    case POV_brick_size:
    case POV_mortar:
    case POV_accuracy:
    case POV_agate_turb:
    case POV_control0:
    case POV_control1:
    case POV_form:
    case POV_metric:
    case POV_noise_generator:
    case POV_offset:
    case POV_solid:
    case POV_poly_wave:
    case POV_exponent:
    case POV_falloff:
        if (token->word == POV_frequency || token->word == POV_phase)
            pov_note(reader, token, "frequency and phase of a pattern are left out", note);
        pov_read_optional(reader, 0.0);
        return true;
    case POV_altitude:
    case POV_exterior: /* of fractals, as interior: two numbers */
    case POV_interior:
    case POV_interpolate:
        read_numbers(reader);
        return true;
    case POV_warp:
        pov_note(reader, token, "warp is left out", note);
        pov_skip_braces(reader);
        return true;
    case POV_sine_wave:
    case POV_triangle_wave:
    case POV_scallop_wave:
        pov_note(reader, token, "the wave of a pattern is left out", note);
        return true;
    case POV_ramp_wave:
    case POV_interior_texture:
        return true;
    default:
        return false;
    }
}

bool pov_read_pattern_part(struct pov_reader *reader, const struct pov_token *token,
                           struct pov_pigment *pigment)
{
    if (token->kind != POV_WORD || pov_lookup(reader, token->word))
        return false;
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++)
        if (patterns[i].word == token->word) {
            pigment->pattern = patterns[i].pattern;
            pigment->word = token->word;
            pigment->token = *token;
            pigment->file = pov_file(reader);
            read_pattern(reader, pigment);
            return true;
        }
    switch (token->word) {
    case POV_color_map:
    case POV_colour_map:
    case POV_pigment_map:
    case POV_texture_map:
        pov_expect(reader, '{');
        pigment->map = pov_read_color_map(reader);
        return true;
    case POV_image_map:
        pigment->token = *token;
        pigment->file = pov_file(reader);
        pov_read_image(reader, pigment);
        return true;
    case POV_turbulence:
        read_turbulence(reader, pigment);
        return true;
    case POV_uv_mapping:
        pigment->is_uv = true;
        return true;
    default:
        return skip_detail(reader, token, &pigment->note);
    }
}

struct pov_pigment pov_read_pigment(struct pov_reader *reader, const struct pov_token *first,
                                    struct pov_pigment pigment)
{
    struct pov_token token;
    if (!pov_enter(reader, first))
        return pigment;
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_PIGMENT) {
            pigment = *value->pigment;
        } else if (value && value->kind == POV_VALUE_COLOR_MAP) {
            pigment.map = value->map;
        } else if (pov_is_word(&token, POV_quick_color) || pov_is_word(&token, POV_quick_colour)) {
            pov_read_color(reader);
        } else if (pov_begins_number(reader, &token)) {
            pov_unread(reader, token);
            pigment.pattern = POV_PATTERN_PLAIN;
            memcpy(pigment.color, pov_read_color(reader).v, sizeof pigment.color);
        } else if (!pov_read_pattern_part(reader, &token, &pigment) &&
                   !pov_read_transform(reader, &token, &pigment.place)) {
            pov_unexpected(reader, &token, "a colour, a pattern or '}' in a pigment");
        }
        pov_skip_comma(reader);
    }
    pov_leave(reader);
    return pigment;
}
