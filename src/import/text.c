/* text.c: lines and words of OBJ, MTL and PLY. */
#include "import/text.h"

#include <stdlib.h>
#include <string.h>

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

bool text_next_line(const char **at, const char *end, struct text_line *line)
{
    if (*at >= end)
        return false;
    const char *stop = memchr(*at, '\n', (size_t)(end - *at));
    line->start = *at;
    line->end = stop ? stop : end;
    *at = stop ? stop + 1 : end;
    while (line->start < line->end && is_blank(*line->start))
        line->start++;
    while (line->start < line->end && is_blank(line->end[-1]))
        line->end--;
    return true;
}

bool text_line_starts(const struct text_line *line, const char *word, struct text_line *rest)
{
    size_t length = strlen(word);
    if ((size_t)(line->end - line->start) < length || memcmp(line->start, word, length) != 0 ||
        (line->start + length < line->end && !is_blank(line->start[length])))
        return false;
    *rest = (struct text_line){line->start + length, line->end};
    while (rest->start < rest->end && is_blank(*rest->start))
        rest->start++;
    return true;
}

static int hexadecimal(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

void mesh_decode_percent(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++, to++) {
        int high = *from == '%' ? hexadecimal(from[1]) : -1;
        int low = high >= 0 ? hexadecimal(from[2]) : -1;
        *to = *from;
        if (low >= 0 && high + low > 0) {
            *to = (char)(16 * high + low);
            from += 2;
        }
    }
    *to = '\0';
}

/* --- MTL
 * -------------------------------------------------------------------------------------------- */

/* assimp takes any line whose first letters are "ne", in either case of the first. */
static bool begins_material(const struct text_line *line)
{
    struct text_line rest;
    return text_line_starts(line, "newmtl", &rest);
}

void mtl_blank_preamble(struct mesh_file *file)
{
    const char *at = file->bytes, *end = file->bytes + file->length;
    struct text_line line;
    while (text_next_line(&at, end, &line)) {
        if (begins_material(&line))
            return;
        memset(file->bytes + (line.start - file->bytes), ' ', (size_t)(line.end - line.start));
    }
}

bool mtl_has_material(const struct mesh_file *file, const char *name)
{
    const char *at = file->bytes, *end = file->bytes + file->length;
    struct text_line line, rest;
    while (text_next_line(&at, end, &line))
        if (text_line_starts(&line, "newmtl", &rest) &&
            (size_t)(rest.end - rest.start) == strlen(name) &&
            memcmp(rest.start, name, strlen(name)) == 0)
            return true;
    return false;
}

/* --- PLY
 * -------------------------------------------------------------------------------------------- */

/* Of a name that assimp knows: it does not skip the data of others. */
#define GUARD "element edge 1\nproperty uchar guard\n"

/* Where the elements of a binary file's header start, and its data; false for others. */
static bool find_ply_data(const struct mesh_file *file, size_t *elements, size_t *data)
{
    const char *at = file->bytes, *start = at, *end = at + file->length;
    struct text_line line, rest, kind;
    bool binary = false;
    *elements = 0;
    for (; text_next_line(&at, end, &line); start = at) {
        if (text_line_starts(&line, "format", &rest))
            binary = !text_line_starts(&rest, "ascii", &kind);
        else if (*elements == 0 && text_line_starts(&line, "element", &rest))
            *elements = (size_t)(start - file->bytes);
        if (text_line_starts(&line, "end_header", &rest)) {
            *data = (size_t)(at - file->bytes);
            return binary && *elements > 0;
        }
    }
    return false;
}

ps_result ply_guard_data(struct mesh_file *file, struct error *error)
{
    const size_t guard = sizeof GUARD - 1;
    size_t elements, data;
    if (!find_ply_data(file, &elements, &data) ||
        (file->bytes[data] != '\n' && file->bytes[data] != '\r'))
        return PS_OK;
    char *bytes = malloc(file->length + guard + 2);
    if (!bytes)
        return error_memory(error, file->length, "a mesh file");
    memcpy(bytes, file->bytes, elements);
    memcpy(bytes + elements, GUARD, guard);
    memcpy(bytes + elements + guard, file->bytes + elements, data - elements);
    bytes[data + guard] = 'g';
    memcpy(bytes + data + guard + 1, file->bytes + data, file->length - data + 1);
    free(file->bytes);
    file->bytes = bytes;
    file->length += guard + 1;
    return PS_OK;
}
