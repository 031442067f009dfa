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
