/* ply.c: the header of a PLY file, line by line (G. Turk, "The PLY polygon file format", 1994). */
#include "import/text.h"

#include <stdlib.h>
#include <string.h>

#define ELEMENTS 16
#define WORDS 5
#define LONGEST_LINE 1000

struct header {
    struct text_line names[ELEMENTS]; /* of the elements so far */
    size_t count;
    bool has_format;
};

struct words {
    struct text_line word[WORDS];
    size_t count; /* may be more than WORDS */
};

static ps_result complain(const struct mesh_file *file, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s: PLY: %s", file->path, what);
}

static struct words split(const struct text_line *line)
{
    struct words words = {.count = 0};
    const char *at = line->start;
    while (at < line->end) {
        const char *start = at;
        while (at < line->end && *at != ' ' && *at != '\t')
            at++;
        if (words.count < WORDS)
            words.word[words.count] = (struct text_line){start, at};
        words.count++;
        while (at < line->end && (*at == ' ' || *at == '\t'))
            at++;
    }
    return words;
}

static bool is_word(const struct text_line *word, const char *expected)
{
    size_t length = strlen(expected);
    return (size_t)(word->end - word->start) == length &&
           memcmp(word->start, expected, length) == 0;
}

static bool is_any_of(const struct text_line *word, const char *const list[])
{
    for (size_t i = 0; list[i]; i++)
        if (is_word(word, list[i]))
            return true;
    return false;
}

static bool is_type(const struct text_line *word)
{
    static const char *const types[] = {"char",   "int8",    "uchar",  "uint8",   "short", "int16",
                                        "ushort", "uint16",  "int",    "int32",   "uint",  "uint32",
                                        "float",  "float32", "double", "float64", NULL};
    return is_any_of(word, types);
}

/* Two names of one meaning to assimp count as the same. */
static bool is_same_element(const struct text_line *a, const struct text_line *b)
{
    static const char *const faces[] = {"face", "tristrips", NULL};
    size_t length = (size_t)(a->end - a->start);
    return (is_any_of(a, faces) && is_any_of(b, faces)) ||
           (length == (size_t)(b->end - b->start) && memcmp(a->start, b->start, length) == 0);
}

static ps_result add_element(const struct mesh_file *file, struct header *header,
                             const struct words *words, struct error *error)
{
    const struct text_line *name = &words->word[1], *number = &words->word[2];
    char *after;
    if (words->count != 3 || header->count == ELEMENTS)
        return complain(file, "an element without a count, or too many elements", error);
    unsigned long long count = strtoull(number->start, &after, 10);
    if (*number->start < '0' || *number->start > '9' || after != number->end ||
        count > file->length)
        return complain(file, "an element's count is wrong, or the file is cut short", error);
    for (size_t i = 0; i < header->count; i++)
        if (is_same_element(&header->names[i], name))
            return complain(file, "an element is declared twice", error);
    header->names[header->count++] = *name;
    return PS_OK;
}

static bool is_property(const struct words *words)
{
    const struct text_line *word = words->word;
    if (words->count == 3)
        return is_type(&word[1]);
    return words->count == 5 && is_word(&word[1], "list") && is_type(&word[2]) && is_type(&word[3]);
}

static bool is_format(const struct words *words)
{
    static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian",
                                          NULL};
    return words->count == 3 && is_any_of(&words->word[1], formats);
}

static ps_result check_line(const struct mesh_file *file, struct header *header,
                            const struct words *words, struct error *error)
{
    /* Old Blenders left out the word "comment". */
    static const char *const notes[] = {"comment", "obj_info", "Created", NULL};
    const struct text_line *first = &words->word[0];
    bool is_first = !header->has_format;
    header->has_format = true;
    if (is_word(first, "format") && is_first)
        return is_format(words) ? PS_OK : complain(file, "an unknown format", error);
    if (is_first)
        return complain(file, "its second line does not state the format", error);
    if (is_any_of(first, notes))
        return PS_OK;
    if (is_word(first, "element"))
        return add_element(file, header, words, error);
    if (is_word(first, "property") && header->count > 0 && is_property(words))
        return PS_OK;
    return complain(file, "a line of the header makes no sense", error);
}

static bool is_printable(const struct text_line *line)
{
    for (const char *c = line->start; c < line->end; c++)
        if (((unsigned char)*c < ' ' && *c != '\t') || *c == 127)
            return false;
    return line->end > line->start && line->end - line->start < LONGEST_LINE;
}

ps_result ply_check_header(const struct mesh_file *file, struct error *error)
{
    const char *at = file->bytes, *end = file->bytes + file->length;
    struct header header = {.count = 0};
    struct text_line line;
    if (!text_next_line(&at, end, &line) || !is_word(&line, "ply"))
        return complain(file, "the file does not start with \"ply\"", error);
    ps_result result = PS_OK;
    while (result == PS_OK && text_next_line(&at, end, &line)) {
        struct words words = split(&line);
        if (!is_printable(&line))
            return complain(file, "a line of the header makes no sense", error);
        if (is_word(&line, "end_header"))
            return PS_OK;
        result = check_line(file, &header, &words, error);
    }
    return result == PS_OK ? complain(file, "the header has no end", error) : result;
}
