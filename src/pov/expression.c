/* expression.c: see expression.h. */
#include "pov/expression.h"

#include <math.h>
#include <string.h>

static const struct pov_number zero = {{0}, 1, false};

static struct pov_number of_float(double value)
{
    return (struct pov_number){{value}, 1, false};
}

/* --- terms
 * -------------------------------------------------------------------------------------- */

/* To at least as many terms as the other has. */
static void promote(struct pov_number *n, const struct pov_number *other)
{
    for (int i = n->terms; i < other->terms; i++)
        n->v[i] = n->terms == 1 ? n->v[0] : 0.0;
    n->is_color = n->is_color || other->is_color;
    n->terms = n->terms > other->terms ? n->terms : other->terms;
}

static struct pov_number combine(struct pov_reader *reader, const struct pov_token *operator,
                                 struct pov_number a, struct pov_number b)
{
    promote(&a, &b);
    promote(&b, &a);
    for (int i = 0; i < a.terms; i++)
        switch (operator->symbol) {
        case '+':
            a.v[i] += b.v[i];
            break;
        case '-':
            a.v[i] -= b.v[i];
            break;
        case '*':
            a.v[i] *= b.v[i];
            break;
        default:
            if (b.v[i] == 0.0 && !(a.is_color && i >= 3))
                pov_error(reader, operator, "division by zero");
            a.v[i] = b.v[i] == 0.0 ? 0.0 : a.v[i] / b.v[i];
        }
    for (int i = 0; i < a.terms; i++)
        if (!isfinite(a.v[i])) {
            pov_error(reader, operator, "the result is too large");
            a.v[i] = 0.0;
        }
    return a;
}

/* --- vectors and colours
 * -------------------------------------------------------------------------- */

/* Behind "<". Commas may be missing. */
static struct pov_number read_vector_literal(struct pov_reader *reader)
{
    struct pov_number result = {{0}, 0, false};
    do {
        struct pov_number term = pov_read_number(reader);
        if (result.terms == POV_TERMS) {
            pov_error(reader, pov_peek(reader), "a vector has at most %d terms", POV_TERMS);
            return zero;
        }
        result.v[result.terms++] = term.v[0];
        pov_skip_comma(reader);
    } while (!pov_accept(reader, '>') && !reader->stopped);
    return result;
}

/* As a colour of the scene, which is made linear by its assumed_gamma later. */
static double decode_srgb(const struct pov_reader *reader, double value)
{
    double linear = value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
    return reader->gamma == 1.0 ? linear : pow(fmax(linear, 0.0), 1.0 / reader->gamma);
}

/* "rgbt <...>" behind its first word: where the terms go. */
static struct pov_number read_color_terms(struct pov_reader *reader, uint32_t word)
{
    struct pov_number n = pov_read_number(reader), color = {{0}, POV_TERMS, true};
    bool is_srgb = word == POV_srgb || word == POV_srgbf || word == POV_srgbt || word == POV_srgbft;
    bool filters = word == POV_rgbf || word == POV_rgbft || word == POV_srgbf || word == POV_srgbft;
    bool transmits = word == POV_rgbt || word == POV_srgbt;
    int wanted = 3 + (filters || transmits) + (word == POV_rgbft || word == POV_srgbft);
    promote(&n, &(struct pov_number){.terms = wanted});
    for (int i = 0; i < 3; i++)
        color.v[i] = is_srgb ? decode_srgb(reader, n.v[i]) : n.v[i];
    if (filters)
        color.v[3] = n.v[3];
    if (wanted == 5)
        color.v[4] = n.v[4];
    if (transmits)
        color.v[4] = n.is_color ? n.v[4] : n.v[3];
    return color;
}

static bool is_channel(uint32_t word, int *index)
{
    static const uint32_t words[] = {POV_red, POV_green, POV_blue, POV_filter, POV_transmit};
    for (*index = 0; *index < POV_TERMS; ++*index)
        if (words[*index] == word)
            return true;
    return false;
}

static bool is_color_form(uint32_t word)
{
    static const uint32_t words[] = {POV_rgb,  POV_rgbf,  POV_rgbt,  POV_rgbft,
                                     POV_srgb, POV_srgbf, POV_srgbt, POV_srgbft};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (words[i] == word)
            return true;
    return false;
}

/* "red 1 green 0.5", and "filter 0.5" behind a colour that there is. */
static void read_channels(struct pov_reader *reader, struct pov_number *color)
{
    int index;
    for (;;) {
        struct pov_token token = pov_next(reader);
        if (token.kind != POV_WORD || !is_channel(token.word, &index)) {
            pov_unread(reader, token);
            return;
        }
        promote(color, &(struct pov_number){.terms = POV_TERMS, .is_color = true});
        color->v[index] = pov_read_float(reader);
    }
}

/* "color ..." behind its first word. */
static struct pov_number read_color(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    struct pov_number color = {{0}, POV_TERMS, true};
    int index;
    if (token.kind == POV_WORD && is_color_form(token.word)) {
        color = read_color_terms(reader, token.word);
    } else {
        pov_unread(reader, token);
        if (token.kind != POV_WORD || !is_channel(token.word, &index))
            color = pov_read_number(reader);
    }
    read_channels(reader, &color);
    promote(&color, &(struct pov_number){.terms = POV_TERMS, .is_color = true});
    return color;
}

/* --- factors
 * -------------------------------------------------------------------------------------- */

static bool is_axis(uint32_t word, struct pov_number *axis)
{
    static const struct {
        uint32_t word;
        struct pov_number axis;
    } axes[] = {
        {POV_x, {{1, 0, 0}, 3, false}}, {POV_y, {{0, 1, 0}, 3, false}},
        {POV_z, {{0, 0, 1}, 3, false}}, {POV_u, {{1, 0}, 2, false}},
        {POV_v, {{0, 1}, 2, false}},    {POV_t, {{0, 0, 0, 1}, 4, false}},
    };
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++)
        if (axes[i].word == word) {
            *axis = axes[i].axis;
            return true;
        }
    return false;
}

static bool is_constant(const struct pov_reader *reader, uint32_t word, double *value)
{
    switch (word) {
    case POV_pi:
        *value = 3.14159265358979323846;
        return true;
    case POV_tau:
        *value = 2.0 * 3.14159265358979323846;
        return true;
    case POV_yes:
    case POV_on:
    case POV_true:
        *value = 1.0;
        return true;
    case POV_no:
    case POV_off:
    case POV_false:
    case POV_clock:
    case POV_clock_on:
    case POV_initial_clock:
    case POV_clock_delta:
    case POV_now:
        *value = 0.0;
        return true;
    case POV_final_clock:
    case POV_frame_number:
    case POV_initial_frame:
    case POV_final_frame:
        *value = 1.0;
        return true;
    case POV_version:
        *value = reader->version;
        return true;
    case POV_image_width:
        *value = 800.0;
        return true;
    case POV_image_height:
        *value = 600.0;
        return true;
    default:
        return false;
    }
}

bool pov_begins_number(const struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_number axis;
    double constant;
    int channel;
    if (token->kind == POV_NUMBER)
        return true;
    if (token->kind == POV_SYMBOL)
        return token->symbol == '<' || token->symbol == '(' || token->symbol == '-' ||
               token->symbol == '+' || token->symbol == '!';
    if (token->kind != POV_WORD)
        return false;
    const struct pov_value *value = pov_lookup(reader, token->word);
    if (value && value->kind == POV_VALUE_ARRAY)
        return value->array->held == POV_VALUE_NUMBER || value->array->held == POV_VALUE_NONE ||
               value->array->held == POV_VALUE_FUNCTION || value->array->held == POV_VALUE_ARRAY;
    if (value)
        return value->kind == POV_VALUE_NUMBER || value->kind == POV_VALUE_FUNCTION;
    return is_axis(token->word, &axis) || is_constant(reader, token->word, &constant) ||
           is_color_form(token->word) || is_channel(token->word, &channel) ||
           token->word == POV_color || token->word == POV_colour || pov_is_function(token->word);
}

struct pov_value *pov_element(struct pov_reader *reader, const struct pov_token *name,
                              struct pov_value *value)
{
    while (value && value->kind == POV_VALUE_ARRAY && pov_is(pov_peek(reader), '[') &&
           pov_accept(reader, '[')) {
        const struct pov_array *array = value->array;
        size_t at = 0;
        for (int i = 0; i < array->dimensions && !reader->stopped; i++) {
            double index = floor(pov_read_condition(reader).v[0] + 1e-8);
            if (!(index >= 0.0 && index < (double)array->sizes[i])) {
                pov_error(reader, name, "'%.60s': index %g lies outside of its %zu elements",
                          pov_text(reader, name->word), index, array->sizes[i]);
                return NULL;
            }
            at = at * array->sizes[i] + (size_t)index;
            pov_expect(reader, ']');
            if (i + 1 < array->dimensions)
                pov_expect(reader, '[');
        }
        value = reader->stopped ? NULL : &array->elements[at];
    }
    return value;
}

static struct pov_number read_name(struct pov_reader *reader, const struct pov_token *token,
                                   struct pov_value *value)
{
    value = pov_element(reader, token, value);
    if (value && value->kind == POV_VALUE_FUNCTION) {
        struct pov_value result = pov_call_function(reader, token, value->macro);
        return result.kind == POV_VALUE_NUMBER ? result.number : zero;
    }
    if (value && value->kind == POV_VALUE_NUMBER)
        return value->number;
    if (value && value->kind == POV_VALUE_NONE)
        pov_error(reader, token, "this element of '%.60s' has no value",
                  pov_text(reader, token->word));
    else
        pov_unexpected(reader, token, "a number");
    return zero;
}

static struct pov_number read_word(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_value *value = pov_lookup(reader, token->word);
    struct pov_number result = zero;
    double constant;
    int channel;
    if (value)
        return read_name(reader, token, value);
    if (is_axis(token->word, &result))
        return result;
    if (is_constant(reader, token->word, &constant))
        return of_float(constant);
    if (token->word == POV_color || token->word == POV_colour)
        return read_color(reader);
    if (is_color_form(token->word) || is_channel(token->word, &channel)) {
        pov_unread(reader, *token);
        return read_color(reader);
    }
    if (!pov_read_function(reader, token, &result))
        pov_unexpected(reader, token, "a number");
    return result;
}

/* ".x" and the like. */
static void read_component(struct pov_reader *reader, struct pov_number *n)
{
    static const struct {
        uint32_t word;
        int index;
    } names[] = {{POV_x, 0},    {POV_y, 1},      {POV_z, 2},       {POV_t, 3},
                 {POV_u, 0},    {POV_v, 1},      {POV_red, 0},     {POV_green, 1},
                 {POV_blue, 2}, {POV_filter, 3}, {POV_transmit, 4}};
    struct pov_token token = pov_next_raw(reader);
    for (size_t i = 0; i < sizeof names / sizeof names[0] && token.kind == POV_WORD; i++)
        if (token.word == names[i].word) {
            *n = of_float(n->terms == 1 ? n->v[0] : n->v[names[i].index]);
            return;
        }
    if (pov_is_word(&token, POV_gray))
        *n = of_float(0.297 * n->v[0] + 0.589 * n->v[1] + 0.114 * n->v[2]);
    else
        pov_unexpected(reader, &token, "x, y, z, red, green, ... behind the dot");
}

static struct pov_number read_factor(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    struct pov_number result = zero;
    if (!pov_enter(reader, &token))
        return zero;
    if (token.kind == POV_NUMBER) {
        result = of_float(token.number);
    } else if (pov_is(&token, '(')) {
        result = pov_read_condition(reader);
        pov_expect(reader, ')');
    } else if (pov_is(&token, '<')) {
        result = read_vector_literal(reader);
    } else if (pov_is(&token, '-') || pov_is(&token, '+') || pov_is(&token, '!')) {
        result = read_factor(reader);
        for (int i = 0; i < result.terms; i++)
            result.v[i] = token.symbol == '-'   ? -result.v[i]
                          : token.symbol == '!' ? result.v[i] == 0.0
                                                : result.v[i];
    } else if (token.kind == POV_WORD) {
        result = read_word(reader, &token);
    } else {
        pov_unexpected(reader, &token, "a number");
    }
    while (pov_accept(reader, '.'))
        read_component(reader, &result);
    pov_leave(reader);
    return result;
}

static struct pov_number read_term(struct pov_reader *reader)
{
    struct pov_number result = read_factor(reader);
    for (;;) {
        struct pov_token token = pov_next(reader);
        if (!pov_is(&token, '*') && !pov_is(&token, '/')) {
            pov_unread(reader, token);
            return result;
        }
        result = combine(reader, &token, result, read_factor(reader));
    }
}

struct pov_number pov_read_number(struct pov_reader *reader)
{
    struct pov_number result = read_term(reader);
    for (;;) {
        struct pov_token token = pov_next(reader);
        if (!pov_is(&token, '+') && !pov_is(&token, '-')) {
            pov_unread(reader, token);
            return result;
        }
        result = combine(reader, &token, result, read_term(reader));
    }
}

/* --- comparisons and logic
 * ------------------------------------------------------------------------ */

/* POV-Ray's floats are the same within that. */
#define SAME 1e-10

static bool compare(uint32_t symbol, double a, double b)
{
    switch (symbol) {
    case '<':
        return a < b && fabs(a - b) > SAME;
    case '>':
        return a > b && fabs(a - b) > SAME;
    case '=':
        return fabs(a - b) <= SAME;
    case POV_NOT_EQUAL:
        return fabs(a - b) > SAME;
    case POV_LESS_EQUAL:
        return a <= b || fabs(a - b) <= SAME;
    default:
        return a >= b || fabs(a - b) <= SAME;
    }
}

static bool is_comparison(const struct pov_token *token)
{
    return token->kind == POV_SYMBOL && (token->symbol >= POV_LESS_EQUAL ||
                                         (token->symbol && strchr("<>=", (int)token->symbol)));
}

/* Of two texts. */
static struct pov_number compare_texts(struct pov_reader *reader)
{
    const char *a = pov_read_string(reader);
    struct pov_token token = pov_next(reader);
    if (!is_comparison(&token))
        pov_unexpected(reader, &token, "a comparison of texts");
    const char *b = reader->stopped ? NULL : pov_read_string(reader);
    int order = a && b ? strcmp(a, b) : 0;
    return a && b ? of_float(compare(token.symbol, (double)order, 0.0)) : zero;
}

static struct pov_number read_comparison(struct pov_reader *reader)
{
    struct pov_token first = pov_next(reader);
    pov_unread(reader, first);
    if (pov_begins_string(reader, &first))
        return compare_texts(reader);
    struct pov_number result = pov_read_number(reader);
    for (;;) {
        struct pov_token token = pov_next(reader);
        if (!is_comparison(&token)) {
            pov_unread(reader, token);
            return result;
        }
        struct pov_number b = pov_read_number(reader);
        bool holds = true;
        promote(&result, &b);
        promote(&b, &result);
        for (int i = 0; i < result.terms; i++)
            holds = compare(token.symbol, result.v[i], b.v[i]) && holds;
        result = of_float(holds);
    }
}

static struct pov_number read_logic(struct pov_reader *reader)
{
    struct pov_number result = read_comparison(reader);
    for (;;) {
        struct pov_token token = pov_next(reader);
        if (!pov_is(&token, '&') && !pov_is(&token, '|')) {
            pov_unread(reader, token);
            return result;
        }
        bool a = result.v[0] != 0.0, b = read_comparison(reader).v[0] != 0.0;
        result = of_float(token.symbol == '&' ? a && b : a || b);
    }
}

struct pov_number pov_read_condition(struct pov_reader *reader)
{
    struct pov_number result = read_logic(reader);
    struct pov_token token = pov_next(reader);
    if (!pov_is(&token, '?')) {
        pov_unread(reader, token);
        return result;
    }
    if (!pov_enter(reader, &token))
        return zero;
    bool holds = result.v[0] != 0.0;
    struct pov_number yes = pov_read_condition(reader);
    pov_expect(reader, ':');
    struct pov_number no = pov_read_condition(reader);
    pov_leave(reader);
    return holds ? yes : no;
}

/* --- what else is read by them
 * ---------------------------------------------------------------------- */

struct pov_number pov_read_color(struct pov_reader *reader)
{
    struct pov_number n = pov_read_number(reader), color = {{0}, POV_TERMS, true};
    int terms = n.terms == 1 ? 3 : n.terms; /* a float is grey, and lets nothing through */
    for (int i = 0; i < terms; i++)
        color.v[i] = n.terms == 1 ? n.v[0] : n.v[i];
    read_channels(reader, &color);
    return color;
}

double pov_read_float(struct pov_reader *reader)
{
    return pov_read_number(reader).v[0];
}

struct vector pov_read_vector(struct pov_reader *reader)
{
    struct pov_number n = pov_read_number(reader);
    return pov_number_vector(&n);
}

double pov_read_parenthesis(struct pov_reader *reader)
{
    pov_expect(reader, '(');
    double value = pov_read_condition(reader).v[0];
    pov_expect(reader, ')');
    return value;
}

double pov_read_optional(struct pov_reader *reader, double otherwise)
{
    struct pov_token token = pov_next(reader);
    pov_unread(reader, token);
    return pov_begins_number(reader, &token) ? pov_read_float(reader) : otherwise;
}

void pov_skip_comma(struct pov_reader *reader)
{
    pov_accept(reader, ',');
}
