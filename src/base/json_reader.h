/* json_reader.h: reads JSON (RFC 8259) into a tree that refers to the text.
 *
 * Strict: no comments, no trailing commas. Nesting up to JSON_DEPTH, values up to JSON_VALUES.
 * Strings and keys stay as they are in the text, escapes included, and point into it. A tree can be
 * written anew, with parts left out, replaced or added.
 */
#ifndef BASE_JSON_READER_H
#define BASE_JSON_READER_H

#include "base/arena.h"
#include "base/error.h"
#include <stdbool.h>

#define JSON_DEPTH 64
#define JSON_VALUES 4000000

enum json_kind { JSON_NULL, JSON_BOOLEAN, JSON_NUMBER, JSON_STRING, JSON_ARRAY, JSON_OBJECT };

struct json_text {
    const char *start;
    size_t length;
};

struct json {
    enum json_kind kind;
    struct json_text key;  /* of an object's member */
    struct json_text text; /* string, number, boolean */
    double number;
    struct json *items, *next; /* of an array, an object: the first; what follows in it */
    struct json **table;       /* of an array: all */
    size_t count;
    /* For json_rewrite alone. */
    bool hidden;             /* of an object's member: left out */
    const char *replacement; /* JSON in the place of the value, or NULL */
    const char *appended;    /* JSON after the last item, without a comma before it, or NULL */
};

/* The tree lives as long as the arena and the text. PS_ERROR_INVALID with line and column, or
 * PS_ERROR_MEMORY. */
ps_result json_read(struct arena *arena, char *text, size_t length, struct json **root,
                    struct error *error);

/* The tree as text with a zero after it, to be freed; NULL: out of memory. */
char *json_rewrite(const struct json *root, size_t *length);

/* The first member of that name; NULL where there is none, or `object` is NULL or no object. */
struct json *json_member(const struct json *object, const char *name);

/* NULL where `array` is NULL, no array or shorter. */
struct json *json_element(const struct json *array, size_t index);

/* The string without its escapes, NUL-terminated; NULL where it is out of memory, holds U+0000, or
 * an escape that makes no sense. The caller frees it. Bytes are not judged: see utf8_is_valid. */
char *json_unescape(const struct json_text *text);

bool json_is(const struct json_text *text, const char *expected);

/* The member as a whole number of 0..2^53, or `fallback` where there is none; false where it is
 * something else. */
bool json_size(const struct json *object, const char *name, size_t fallback, size_t *value);

/* The member as a number, or `fallback` where there is none or it is no finite number. */
double json_number(const struct json *object, const char *name, double fallback);

#endif
