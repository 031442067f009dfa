/* json_reader.c: recursive descent. */
#include "base/json_reader.h"

#include "base/text.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST_WHOLE 9007199254740992.0

struct scanner {
    struct arena *arena;
    char *at, *start, *end;
    size_t values;
    int depth;
    struct error *error;
};

static ps_result complain(const struct scanner *scanner, const char *what)
{
    size_t line = 1, column = 1;
    for (const char *p = scanner->start; p < scanner->at; p++) {
        line += *p == '\n';
        column = *p == '\n' ? 1 : column + 1;
    }
    return error_set(scanner->error, PS_ERROR_INVALID, "JSON, line %zu, column %zu: %s", line,
                     column, what);
}

static void skip_space(struct scanner *scanner)
{
    while (scanner->at < scanner->end && *scanner->at && strchr(" \t\r\n", *scanner->at))
        scanner->at++;
}

static char next_character(const struct scanner *scanner)
{
    return scanner->at < scanner->end ? *scanner->at : '\0';
}

static bool accept(struct scanner *scanner, char c)
{
    skip_space(scanner);
    if (next_character(scanner) != c)
        return false;
    scanner->at++;
    return true;
}

static ps_result read_string(struct scanner *scanner, struct json_text *text)
{
    if (!accept(scanner, '"'))
        return complain(scanner, "expected a string");
    text->start = scanner->at;
    while (scanner->at < scanner->end && *scanner->at != '"') {
        if ((unsigned char)*scanner->at < ' ')
            return complain(scanner, "control character in a string");
        scanner->at += *scanner->at == '\\' && scanner->at + 1 < scanner->end ? 2 : 1;
    }
    if (scanner->at >= scanner->end)
        return complain(scanner, "string without an end");
    text->length = (size_t)(scanner->at - text->start);
    scanner->at++;
    return PS_OK;
}

static bool skip_digits(struct scanner *scanner)
{
    const char *start = scanner->at;
    while (scanner->at < scanner->end && *scanner->at >= '0' && *scanner->at <= '9')
        scanner->at++;
    return scanner->at > start;
}

static bool skip_one_of(struct scanner *scanner, const char *set)
{
    char c = next_character(scanner);
    if (c == '\0' || !strchr(set, c))
        return false;
    scanner->at++;
    return true;
}

/* RFC 8259: a whole part has no zeros before its first other digit. */
static bool skip_number(struct scanner *scanner)
{
    skip_one_of(scanner, "-");
    const char *whole = scanner->at;
    if (!skip_digits(scanner) || (*whole == '0' && scanner->at - whole > 1) ||
        (skip_one_of(scanner, ".") && !skip_digits(scanner)))
        return false;
    if (!skip_one_of(scanner, "eE"))
        return true;
    skip_one_of(scanner, "+-");
    return skip_digits(scanner);
}

static ps_result read_number(struct scanner *scanner, struct json *value)
{
    char copy[64];
    value->kind = JSON_NUMBER;
    value->text.start = scanner->at;
    if (!skip_number(scanner))
        return complain(scanner, "expected a value");
    value->text.length = (size_t)(scanner->at - value->text.start);
    if (value->text.length >= sizeof copy)
        return complain(scanner, "number of too many digits");
    memcpy(copy, value->text.start, value->text.length);
    copy[value->text.length] = '\0';
    if (!text_to_number(copy, &value->number))
        return complain(scanner, "number out of range");
    return PS_OK;
}

static bool read_word(struct scanner *scanner, struct json *value, const char *word,
                      enum json_kind kind)
{
    size_t length = strlen(word);
    if ((size_t)(scanner->end - scanner->at) < length || memcmp(scanner->at, word, length) != 0)
        return false;
    value->kind = kind;
    value->text = (struct json_text){scanner->at, length};
    scanner->at += length;
    return true;
}

static ps_result read_value(struct scanner *scanner, struct json *value);

static ps_result read_item(struct scanner *scanner, bool has_key, struct json **item)
{
    ps_result result = PS_OK;
    *item = NULL;
    if (++scanner->values > JSON_VALUES)
        return complain(scanner, "too many values");
    struct json *made = arena_allocate(scanner->arena, sizeof *made);
    if (!made)
        return error_memory(scanner->error, sizeof *made, "a JSON value");
    if (has_key)
        result = read_string(scanner, &made->key);
    if (result == PS_OK && has_key && !accept(scanner, ':'))
        result = complain(scanner, "expected ':'");
    if (result == PS_OK)
        result = read_value(scanner, made);
    *item = made;
    return result;
}

static ps_result make_table(struct scanner *scanner, struct json *array)
{
    size_t bytes = array->count * sizeof(struct json *);
    array->table = arena_allocate(scanner->arena, bytes);
    if (!array->table)
        return error_memory(scanner->error, bytes, "a JSON array");
    size_t i = 0;
    for (struct json *item = array->items; item; item = item->next)
        array->table[i++] = item;
    return PS_OK;
}

static ps_result read_items(struct scanner *scanner, struct json *value, bool is_object)
{
    const char close = is_object ? '}' : ']';
    struct json **link = &value->items;
    ps_result result = PS_OK;
    value->kind = is_object ? JSON_OBJECT : JSON_ARRAY;
    if (++scanner->depth > JSON_DEPTH)
        return complain(scanner, "nested too deeply");
    scanner->at++;
    bool more = !accept(scanner, close);
    while (result == PS_OK && more) {
        struct json *item;
        result = read_item(scanner, is_object, &item);
        if (result != PS_OK || !item)
            return result;
        *link = item;
        link = &item->next;
        value->count++;
        more = accept(scanner, ',');
        if (!more && !accept(scanner, close))
            return complain(scanner, is_object ? "expected ',' or '}'" : "expected ',' or ']'");
    }
    scanner->depth--;
    return is_object ? result : make_table(scanner, value);
}

static ps_result read_value(struct scanner *scanner, struct json *value)
{
    skip_space(scanner);
    switch (next_character(scanner)) {
    case '{':
        return read_items(scanner, value, true);
    case '[':
        return read_items(scanner, value, false);
    case '"':
        value->kind = JSON_STRING;
        return read_string(scanner, &value->text);
    default:
        if (read_word(scanner, value, "true", JSON_BOOLEAN) ||
            read_word(scanner, value, "false", JSON_BOOLEAN) ||
            read_word(scanner, value, "null", JSON_NULL))
            return PS_OK;
        return read_number(scanner, value);
    }
}

ps_result json_read(struct arena *arena, char *text, size_t length, struct json **root,
                    struct error *error)
{
    struct scanner scanner = {
        .arena = arena, .at = text, .start = text, .end = text + length, .error = error};
    ps_result result = read_item(&scanner, false, root);
    skip_space(&scanner);
    if (result == PS_OK && next_character(&scanner) != '\0')
        result = complain(&scanner, "text after the end");
    return result;
}

/* Four hexadecimal digits. */
static bool read_unit(const char *digits, size_t left, uint32_t *unit)
{
    static const char hexadecimal[] = "0123456789abcdef";
    *unit = 0;
    for (size_t i = 0; i < 4; i++) {
        const char *found =
            i < left && digits[i] ? strchr(hexadecimal, digits[i] | ('a' ^ 'A')) : NULL;
        if (!found)
            return false;
        *unit = 16 * *unit + (uint32_t)(found - hexadecimal);
    }
    return true;
}

/* The character of an escape \uXXXX, or of two that are a surrogate pair; what follows `u`. Bytes
 * used, or 0. */
static size_t read_code(const char *text, size_t left, uint32_t *code)
{
    uint32_t low;
    if (!read_unit(text, left, code) || *code == 0 || (*code >= 0xdc00 && *code < 0xe000))
        return 0;
    if (*code < 0xd800 || *code >= 0xe000)
        return 4;
    if (left < 10 || text[4] != '\\' || text[5] != 'u' || !read_unit(text + 6, left - 6, &low) ||
        low < 0xdc00 || low >= 0xe000)
        return 0;
    *code = 0x10000 + ((*code - 0xd800) << 10) + (low - 0xdc00);
    return 10;
}

static char *put_utf8(char *out, uint32_t code)
{
    static const unsigned char leads[] = {0, 0, 0xc0, 0xe0, 0xf0};
    size_t bytes = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = bytes; i > 1; i--) {
        out[i - 1] = (char)(0x80 | (code & 0x3f));
        code >>= 6;
    }
    out[0] = (char)(leads[bytes] | code);
    return out + bytes;
}

/* What follows a backslash; bytes used, or 0. */
static size_t read_escape(const char *text, size_t left, char **out)
{
    static const char names[] = "\"\\/bfnrt", characters[] = "\"\\/\b\f\n\r\t";
    const char *found = left > 0 && text[0] ? strchr(names, text[0]) : NULL;
    uint32_t code;
    if (found) {
        *(*out)++ = characters[found - names];
        return 1;
    }
    size_t used = left > 0 && text[0] == 'u' ? read_code(text + 1, left - 1, &code) : 0;
    if (used == 0)
        return 0;
    *out = put_utf8(*out, code);
    return used + 1;
}

char *json_unescape(const struct json_text *text)
{
    char *copy = malloc(text->length + 1),
         *out = copy; /* an escape is longer than what it stands for */
    for (size_t i = 0; copy && i < text->length;) {
        if (text->start[i] != '\\') {
            *out++ = text->start[i++];
            continue;
        }
        size_t used = read_escape(text->start + i + 1, text->length - i - 1, &out);
        if (used == 0) {
            free(copy);
            return NULL;
        }
        i += used + 1;
    }
    if (copy)
        *out = '\0';
    return copy;
}

bool json_is(const struct json_text *text, const char *expected)
{
    return text->length == strlen(expected) && memcmp(text->start, expected, text->length) == 0;
}

struct json *json_member(const struct json *object, const char *name)
{
    if (!object || object->kind != JSON_OBJECT)
        return NULL;
    for (struct json *item = object->items; item; item = item->next)
        if (json_is(&item->key, name))
            return item;
    return NULL;
}

struct json *json_element(const struct json *array, size_t index)
{
    if (!array || array->kind != JSON_ARRAY || index >= array->count)
        return NULL;
    return array->table[index];
}

static bool is_whole(const struct json *value)
{
    for (size_t i = 0; i < value->text.length; i++)
        if (value->text.start[i] < '0' || value->text.start[i] > '9')
            return false;
    return value->number <= LARGEST_WHOLE;
}

bool json_size(const struct json *object, const char *name, size_t fallback, size_t *value)
{
    const struct json *member = json_member(object, name);
    *value = fallback;
    if (!member)
        return true;
    if (member->kind != JSON_NUMBER || !is_whole(member))
        return false;
    *value = (size_t)member->number;
    return true;
}

double json_number(const struct json *object, const char *name, double fallback)
{
    const struct json *member = json_member(object, name);
    if (!member || member->kind != JSON_NUMBER || !isfinite(member->number))
        return fallback;
    return member->number;
}
