/* mesh_text.c: lines and words of OBJ, MTL and PLY. */
#include "parser/mesh_text.h"

#include <stdlib.h>
#include <string.h>

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
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

/* --- MTL -------------------------------------------------------------------------------------------- */

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

/* --- PLY ---------------------------------------------------------------------------------------- */

#define PLY_ELEMENTS 16

struct ply_header {
    struct text_line names[PLY_ELEMENTS];
    size_t count;
};

static ps_result complain(const struct mesh_file *file, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s: PLY: %s", file->path, what);
}

static bool is_word(const struct text_line *line, const char *word)
{
    struct text_line rest;
    return text_line_starts(line, word, &rest);
}

/* Two names of one meaning to assimp count as the same. */
static bool is_same_element(const struct text_line *a, const struct text_line *b)
{
    static const char *const faces[] = {"face", "tristrips"};
    size_t length = (size_t)(a->end - a->start);
    bool faces_both = (is_word(a, faces[0]) || is_word(a, faces[1])) &&
                      (is_word(b, faces[0]) || is_word(b, faces[1]));
    return faces_both ||
           (length == (size_t)(b->end - b->start) && memcmp(a->start, b->start, length) == 0);
}

static ps_result add_element(const struct mesh_file *file, struct ply_header *header,
                             const struct text_line *element, struct error *error)
{
    const char *space = memchr(element->start, ' ', (size_t)(element->end - element->start));
    if (!space || header->count == PLY_ELEMENTS)
        return complain(file, "an element without a count, or too many elements", error);
    struct text_line name = {element->start, space};
    char *after;
    unsigned long long count = strtoull(space + 1, &after, 10);
    if (space[1] < '0' || space[1] > '9' || after != element->end || count > file->length)
        return complain(file, "an element's count is wrong, or the file is cut short", error);
    for (size_t i = 0; i < header->count; i++)
        if (is_same_element(&header->names[i], &name))
            return complain(file, "an element is declared twice", error);
    header->names[header->count++] = name;
    return PS_OK;
}

ps_result ply_check_header(const struct mesh_file *file, struct error *error)
{
    const char *at = file->bytes, *end = file->bytes + file->length;
    struct ply_header header = {.count = 0};
    struct text_line line, rest;
    if (!text_next_line(&at, end, &line) || !is_word(&line, "ply"))
        return complain(file, "the file does not start with \"ply\"", error);
    ps_result result = PS_OK;
    while (result == PS_OK && text_next_line(&at, end, &line)) {
        if (is_word(&line, "end_header"))
            return PS_OK;
        if (text_line_starts(&line, "element", &rest))
            result = add_element(file, &header, &rest, error);
    }
    return result == PS_OK ? complain(file, "the header has no end", error) : result;
}
