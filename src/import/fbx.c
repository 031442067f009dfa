/* fbx.c: the records of a binary FBX file and the braces of a text one, without any meaning.
 *
 * A record is: where it ends, how many properties, their bytes (each 32 bits, or 64 from version
 * 7500 on), the length of its name, the name, the properties, then records inside of it up to one of
 * zeros. An array property may be deflated, which makes it at most 1032 times as long.
 */
#include "import/format.h"

#include <stdlib.h>
#include <string.h>

#define MAGIC "Kaydara FBX Binary  "
#define HEADER 27
#define BEST_DEFLATION 1032

static ps_result complain(const struct mesh_file *file, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s: FBX: %s", file->path, what);
}

/* --- binary --------------------------------------------------------------------------------------- */

static uint64_t read_number(const struct mesh_file *file, uint64_t at, int bytes)
{
    uint64_t value = 0;
    for (int i = bytes - 1; i >= 0; i--)
        value = value << 8 | (unsigned char)file->bytes[at + (uint64_t)i];
    return value;
}

struct record {
    uint64_t end, children; /* where they start */
};

static uint64_t bytes_of_scalar(char type)
{
    switch (type) {
    case 'C':
    case 'B':
        return 1;
    case 'Y':
        return 2;
    case 'I':
    case 'F':
        return 4;
    case 'D':
    case 'L':
        return 8;
    default:
        return 0;
    }
}

static uint64_t bytes_of_element(char type)
{
    switch (type) {
    case 'f':
    case 'i':
        return 4;
    case 'd':
    case 'l':
        return 8;
    case 'b':
    case 'c':
        return 1;
    default:
        return 0;
    }
}

/* The property at `at`, behind its letter; 0 where it is none, or longer than `room`. */
static uint64_t property_length(const struct mesh_file *file, uint64_t at, uint64_t room, char type)
{
    uint64_t length = bytes_of_scalar(type), element = bytes_of_element(type);
    if ((type == 'S' || type == 'R') && room >= 4)
        length = 4 + read_number(file, at, 4);
    if (element > 0 && room >= 12) {
        uint64_t whole = element * read_number(file, at, 4), stored = read_number(file, at + 8, 4);
        bool is_deflated = read_number(file, at + 4, 4) != 0;
        length = whole <= stored * (is_deflated ? BEST_DEFLATION : 1) ? 12 + stored : 0;
    }
    return length <= room ? length : 0;
}

static bool has_sound_properties(const struct mesh_file *file, uint64_t at, uint64_t end)
{
    while (at < end) {
        uint64_t length = property_length(file, at + 1, end - at - 1, file->bytes[at]);
        if (length == 0)
            return false;
        at += 1 + length;
    }
    return true;
}

/* `end` is 0 for the zeros after the last record of a list. */
static bool read_record(const struct mesh_file *file, uint64_t at, uint64_t limit, int width,
                        struct record *record)
{
    uint64_t header = 3 * (uint64_t)width + 1;
    *record = (struct record){0, 0};
    if (limit - at < header)
        return at == limit;
    record->end = read_number(file, at, width);
    uint64_t properties = read_number(file, at + 2 * (uint64_t)width, width);
    uint64_t name = (unsigned char)file->bytes[at + header - 1];
    if (record->end == 0)
        return true;
    if (record->end > limit || record->end < at + header + name ||
        properties > record->end - at - header - name)
        return false;
    record->children = at + header + name + properties;
    return has_sound_properties(file, at + header + name, record->children);
}

static ps_result check_binary(const struct mesh_file *file, struct error *error)
{
    const int width = read_number(file, HEADER - 4, 4) >= 7500 ? 8 : 4;
    uint64_t limits[MESH_NESTING] = {file->length}, at = HEADER;
    int depth = 0;
    for (;;) {
        struct record record;
        if (!read_record(file, at, limits[depth], width, &record))
            return complain(file, "a record does not lie inside of its parent", error);
        if (record.end > 0 && record.children < record.end) {
            if (++depth == MESH_NESTING)
                return complain(file, "nested more than 256 deep", error);
            limits[depth] = record.end;
            at = record.children;
        } else if (record.end > 0) {
            at = record.end;
        } else if (depth > 0) {
            at = limits[depth--];
        } else {
            return PS_OK;
        }
    }
}

/* --- text ----------------------------------------------------------------------------------------- */

static ps_result check_text(const struct mesh_file *file, struct error *error)
{
    bool is_quoted = false, is_comment = false;
    int depth = 0;
    for (size_t i = 0; i < file->length; i++) {
        char c = file->bytes[i];
        if (c == '"' && !is_comment)
            is_quoted = !is_quoted;
        if (c == '\n' || (c == ';' && !is_quoted))
            is_comment = c == ';';
        if (is_quoted || is_comment)
            continue;
        depth += c == '{' ? 1 : c == '}' ? -1 : 0;
        if (depth > MESH_NESTING)
            return complain(file, "nested more than 256 deep", error);
        if (c == '*' && strtoull(file->bytes + i + 1, NULL, 10) > file->length)
            return complain(file, "an array of more numbers than there are", error);
    }
    return PS_OK;
}

ps_result fbx_check(const struct mesh_file *file, struct error *error)
{
    if (file->length >= sizeof MAGIC && memcmp(file->bytes, MAGIC, sizeof MAGIC) == 0)
        return file->length > HEADER ? check_binary(file, error)
                                     : complain(file, "the file is cut short", error);
    return check_text(file, error);
}
