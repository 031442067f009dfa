/* rvalue.c: texts, arrays, and whatever else can be declared; see expression.h. */
#include "pov/expression.h"

#include "base/text.h"
#include "pov/object.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_TEXT 65536

/* --- texts
 * -------------------------------------------------------------------------------------- */

bool pov_begins_string(const struct pov_reader *reader, const struct pov_token *token)
{
    if (token->kind == POV_STRING)
        return true;
    if (token->kind != POV_WORD)
        return false;
    const struct pov_value *value = pov_lookup(reader, token->word);
    if (value && value->kind == POV_VALUE_ARRAY)
        return value->array->held == POV_VALUE_STRING;
    if (value)
        return value->kind == POV_VALUE_STRING;
    switch (token->word) {
    case POV_chr:
    case POV_concat:
    case POV_datetime:
    case POV_str:
    case POV_strlwr:
    case POV_strupr:
    case POV_substr:
    case POV_vstr:
        return true;
    default:
        return false;
    }
}

/* str(value, minimal length, digits): fewer than 0 digits: as many as needed up to six. */
static int print_number(char *out, size_t size, double value, int length, int digits)
{
    if (digits < 0)
        snprintf(out, size, length < 0 ? "%0*f" : "%*f", abs(length), value);
    else
        snprintf(out, size, length < 0 ? "%0*.*f" : "%*.*f", abs(length), digits, value);
    text_delocalize(out);
    return (int)strlen(out);
}

static int within(double value, int least, int most)
{
    return value > most ? most : value > least ? (int)value : least;
}

static const char *read_str(struct pov_reader *reader)
{
    char text[512];
    double value = pov_read_condition(reader).v[0];
    pov_expect(reader, ',');
    int length = within(pov_read_float(reader), -100, 100);
    pov_expect(reader, ',');
    print_number(text, sizeof text, value, length, within(pov_read_float(reader), -1, 30));
    return pov_copy(reader, text, strlen(text) + 1);
}

/* vstr(terms, vector, separator, length, digits) */
static const char *read_vstr(struct pov_reader *reader)
{
    char text[2600] = "";
    size_t used = 0;
    int terms = within(pov_read_float(reader), 1, POV_TERMS);
    pov_expect(reader, ',');
    struct pov_number n = pov_read_number(reader);
    pov_expect(reader, ',');
    const char *separator = pov_read_string(reader);
    pov_expect(reader, ',');
    int length = within(pov_read_float(reader), -100, 100);
    pov_expect(reader, ',');
    int digits = within(pov_read_float(reader), -1, 30);
    for (int i = 0; i < terms && separator; i++) {
        if (i > 0)
            used += (size_t)snprintf(text + used, sizeof text - used, "%.50s", separator);
        used +=
            (size_t)print_number(text + used, 450, n.terms == 1 ? n.v[0] : n.v[i], length, digits);
    }
    return pov_copy(reader, text, used + 1);
}

static const char *read_concat(struct pov_reader *reader, const struct pov_token *token)
{
    char *whole = pov_copy(reader, "", 1);
    do {
        const char *part = pov_read_string(reader);
        size_t before = whole ? strlen(whole) : 0, added = part ? strlen(part) : 0;
        if (before + added > LONGEST_TEXT) {
            pov_error(reader, token, "a text is longer than %d bytes", LONGEST_TEXT);
            return NULL;
        }
        char *longer = part ? pov_allocate(reader, 1, before + added + 1) : NULL;
        if (!whole || !longer)
            return NULL;
        memcpy(longer, whole, before);
        memcpy(longer + before, part, added + 1);
        whole = longer;
    } while (pov_accept(reader, ','));
    return whole;
}

static const char *read_substr(struct pov_reader *reader, const struct pov_token *token)
{
    const char *text = pov_read_string(reader);
    pov_expect(reader, ',');
    double start = pov_read_float(reader);
    pov_expect(reader, ',');
    double length = pov_read_float(reader);
    if (!text)
        return NULL;
    if (!(start >= 1.0 && length >= 0.0 && start + length - 1.0 <= (double)strlen(text))) {
        pov_error(reader, token, "substr: there is no such part of the text");
        return NULL;
    }
    char *part = pov_allocate(reader, 1, (size_t)length + 1);
    if (part)
        memcpy(part, text + (size_t)start - 1, (size_t)length);
    return part;
}

static const char *read_cased(struct pov_reader *reader, bool upper)
{
    const char *text = pov_read_string(reader);
    char *copy = text ? pov_copy(reader, text, strlen(text) + 1) : NULL;
    char first = upper ? 'a' : 'A';
    for (char *c = copy; c && *c; c++)
        if (*c >= first && *c <= first + 25)
            *c ^= 0x20;
    return copy;
}

static const char *read_text_function(struct pov_reader *reader, const struct pov_token *token)
{
    const char *text = NULL;
    pov_expect(reader, '(');
    switch (token->word) {
    case POV_str:
        text = read_str(reader);
        break;
    case POV_vstr:
        text = read_vstr(reader);
        break;
    case POV_concat:
        text = read_concat(reader, token);
        break;
    case POV_substr:
        text = read_substr(reader, token);
        break;
    case POV_chr: {
        int code = within(pov_read_float(reader), 0, 255);
        char bytes[3] = {(char)code, '\0', '\0'};
        if (code >= 0x80) {
            bytes[0] = (char)(0xc0 | (code >> 6));
            bytes[1] = (char)(0x80 | (code & 0x3f));
        }
        text = pov_copy(reader, bytes, sizeof bytes);
        break;
    }
    case POV_strupr:
    case POV_strlwr:
        text = read_cased(reader, token->word == POV_strupr);
        break;
    default:
        pov_error(reader, token,
                  "datetime is not known here: the same scene makes the same picture");
    }
    pov_expect(reader, ')');
    return text;
}

const char *pov_read_string(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    const char *text = NULL;
    if (token.kind == POV_STRING)
        return token.text;
    if (!pov_begins_string(reader, &token)) {
        pov_unexpected(reader, &token, "a text");
        return NULL;
    }
    struct pov_value *value = pov_lookup(reader, token.word);
    if (value) {
        value = pov_element(reader, &token, value);
        if (value && value->kind == POV_VALUE_STRING)
            return value->text;
        pov_unexpected(reader, &token, "a text");
        return NULL;
    }
    if (pov_enter(reader, &token)) {
        text = read_text_function(reader, &token);
        pov_leave(reader);
    }
    return reader->stopped ? NULL : text;
}

/* --- arrays
 * ------------------------------------------------------------------------------------- */

/* Without comparisons: a comma may be missing before a vector. */
static struct pov_value read_element(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    pov_unread(reader, token);
    if (token.kind != POV_NUMBER && !pov_is(&token, '<') && !pov_is(&token, '-'))
        return pov_read_value(reader);
    return (struct pov_value){.kind = POV_VALUE_NUMBER, .number = pov_read_number(reader)};
}

/* "{a, b, ...}" or, where there are more dimensions, lists of those. `left`: elements that there is
 * room for. */
static void read_elements(struct pov_reader *reader, struct pov_array *array, int dimension,
                          struct pov_value *elements, size_t count)
{
    struct pov_token token = pov_next(reader);
    if (!pov_is(&token, '{')) {
        pov_unexpected(reader, &token, "'{'");
        return;
    }
    size_t step = count / array->sizes[dimension];
    for (size_t i = 0; !pov_accept(reader, '}') && !reader->stopped; i++) {
        if (i == array->sizes[dimension]) {
            pov_error(reader, &token, "more than the array's %zu elements", i);
            return;
        }
        if (dimension + 1 < array->dimensions)
            read_elements(reader, array, dimension + 1, elements + i * step, step);
        else
            elements[i] = read_element(reader);
        if (dimension + 1 == array->dimensions && i == 0)
            array->held = elements[0].kind;
        pov_skip_comma(reader);
    }
}

/* An array without a size has as many elements as are listed. */
static struct pov_value read_list(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_value *list = NULL, result = {.kind = POV_VALUE_ARRAY};
    size_t count = 0, capacity = 0;
    struct pov_array *array = pov_allocate(reader, 1, sizeof *array);
    pov_expect(reader, '{');
    while (!pov_accept(reader, '}') && !reader->stopped) {
        if (!pov_grow(reader, (void **)&list, &capacity, count + 1, sizeof *list))
            break;
        list[count++] = read_element(reader);
        pov_skip_comma(reader);
    }
    if (count == 0)
        pov_error(reader, token, "an array has one element or more");
    struct pov_value *elements = array ? pov_allocate(reader, count, sizeof *elements) : NULL;
    if (elements && list) {
        memcpy(elements, list, count * sizeof *elements);
        *array = (struct pov_array){1, {count}, elements, elements[0].kind};
    }
    free(list);
    result.array = array;
    return elements ? result : (struct pov_value){0};
}

/* Behind "array". */
static struct pov_value read_array(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_array array = {0};
    size_t count = 1;
    while (pov_is(pov_peek(reader), '[') && pov_accept(reader, '[')) { /* no directive in between */
        double size = pov_read_condition(reader).v[0];
        pov_expect(reader, ']');
        if (array.dimensions == POV_DIMENSIONS || !(size >= 1.0 && size <= 1e9) ||
            (double)count * size > 1e9) {
            pov_error(
                reader, token,
                "an array has up to %d dimensions, each of 1 or more, and at most 1e9 elements",
                POV_DIMENSIONS);
            return (struct pov_value){0};
        }
        array.sizes[array.dimensions++] = (size_t)size;
        count *= (size_t)size;
    }
    if (array.dimensions == 0)
        return read_list(reader, token);
    array.elements = pov_allocate(reader, count, sizeof *array.elements);
    struct pov_array *kept = array.elements ? pov_copy(reader, &array, sizeof array) : NULL;
    if (!kept)
        return (struct pov_value){0};
    if (pov_is(pov_peek(reader), '{'))
        read_elements(reader, kept, 0, kept->elements, count);
    return (struct pov_value){.kind = POV_VALUE_ARRAY, .array = kept};
}

/* Its own elements: what is assigned is a copy. */
static struct pov_value copy_array(struct pov_reader *reader, const struct pov_array *from)
{
    struct pov_array *array = pov_copy(reader, from, sizeof *from);
    size_t count = 1;
    for (int i = 0; i < from->dimensions; i++)
        count *= from->sizes[i];
    if (array)
        array->elements = pov_allocate(reader, count, sizeof *array->elements);
    if (!array || !array->elements)
        return (struct pov_value){0};
    memcpy(array->elements, from->elements, count * sizeof *array->elements);
    return (struct pov_value){.kind = POV_VALUE_ARRAY, .array = array};
}

/* --- all values
 * ----------------------------------------------------------------------------------- */

static struct pov_value read_text_value(struct pov_reader *reader)
{
    const char *text = pov_read_string(reader);
    return text ? (struct pov_value){.kind = POV_VALUE_STRING, .text = text}
                : (struct pov_value){0};
}

struct pov_value *pov_named(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_value *value = token->kind == POV_WORD ? pov_lookup(reader, token->word) : NULL;
    bool holds = value && value->kind == POV_VALUE_ARRAY && value->array->held >= POV_VALUE_PIGMENT;
    return holds ? pov_element(reader, token, value) : value;
}

/* A name that stands for something that is no number: "#declare A = B". */
static struct pov_value read_named(struct pov_reader *reader, const struct pov_token *token,
                                   struct pov_value *value)
{
    value = pov_element(reader, token, value);
    if (!value)
        return (struct pov_value){0};
    if (value->kind == POV_VALUE_NUMBER || value->kind == POV_VALUE_FUNCTION ||
        value->kind == POV_VALUE_STRING || value->kind == POV_VALUE_NONE)
        pov_unexpected(reader, token, "values of one kind");
    return value->kind == POV_VALUE_ARRAY ? copy_array(reader, value->array) : *value;
}

static struct pov_value read_unknown(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_token brace = pov_next(reader);
    if (token->kind != POV_WORD || !pov_is(&brace, '{')) {
        pov_unexpected(reader, token, "a value");
        return (struct pov_value){0};
    }
    pov_skip_block(reader);
    return (struct pov_value){.kind = POV_VALUE_OTHER};
}

static struct pov_value read_value(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    struct pov_value value = {0};
    const struct pov_value *whole = token.kind == POV_WORD ? pov_lookup(reader, token.word) : NULL;
    if (whole && whole->kind == POV_VALUE_ARRAY && !pov_is(pov_peek(reader), '['))
        return copy_array(reader, whole->array);
    if (pov_begins_string(reader, &token)) {
        pov_unread(reader, token);
        return read_text_value(reader);
    }
    if (pov_begins_number(reader, &token)) {
        pov_unread(reader, token);
        return (struct pov_value){.kind = POV_VALUE_NUMBER, .number = pov_read_condition(reader)};
    }
    reader->declaring = 0; /* within braces, directives are executed */
    if (token.kind == POV_WORD) {
        struct pov_value *named = pov_lookup(reader, token.word);
        if (named)
            return read_named(reader, &token, named);
        if (token.word == POV_array)
            return read_array(reader, &token);
        if (token.word == POV_function)
            return pov_define_function(reader);
        if (pov_read_declared(reader, &token, &value))
            return value;
    }
    return read_unknown(reader, &token);
}

struct pov_value pov_read_value(struct pov_reader *reader)
{
    struct pov_token token = pov_next(reader);
    struct pov_value value = {0};
    size_t declaring = reader->declaring;
    pov_unread(reader, token);
    if (pov_enter(reader, &token)) {
        value = read_value(reader);
        pov_leave(reader);
    }
    reader->declaring = declaring;
    return reader->stopped ? (struct pov_value){0} : value;
}
