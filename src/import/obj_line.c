/* obj_line.c: one line of an OBJ text (Wavefront, "Object files", Advanced Visualizer appendix
 * B1). */
#include "import/obj_line.h"

#include "base/decimal.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- words ------------------------------------------------------------------------------ */

enum keyword { OTHER, PLACE, UV, NORMAL, FACE, SECTION, MATERIAL, LIBRARY, SMOOTHING };

static enum keyword keyword_of(const struct text_line *line, struct text_line *words)
{
    static const struct {
        const char *word;
        enum keyword keyword;
    } table[] = {{"v", PLACE},     {"vt", UV},           {"vn", NORMAL},
                 {"f", FACE},      {"o", SECTION},       {"g", SECTION},
                 {"s", SMOOTHING}, {"usemtl", MATERIAL}, {"mtllib", LIBRARY}};
    for (size_t i = 0; line->start < line->end && i < sizeof table / sizeof table[0]; i++)
        if (*line->start == table[i].word[0] && text_line_starts(line, table[i].word, words))
            return table[i].keyword;
    return OTHER;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v';
}

/* Moves to the next word of the line; false at its end, or at a comment. */
static bool find_word(const char **at, const char *end)
{
    while (*at < end && is_blank(**at))
        ++*at;
    return *at < end && **at != '#';
}

static void pass_word(const char **at, const char *end)
{
    while (*at < end && !is_blank(**at))
        ++*at;
}

size_t obj_count_words(const struct text_line *words)
{
    size_t count = 0;
    for (const char *at = words->start; find_word(&at, words->end); count++)
        pass_word(&at, words->end);
    return count;
}

static void complain(struct obj_piece *piece, const char *at, const char *message)
{
    piece->wrong_at = at;
    snprintf(piece->wrong, sizeof piece->wrong, "%s", message);
}

/* Numbers of a line, at most `most`; how many there are. "nan", "inf" and "1.#IND" are none that
 * can be used. */
static size_t read_numbers(struct obj_piece *piece, const struct text_line *words, double *numbers,
                           size_t most)
{
    const char *at = words->start;
    size_t count = 0;
    for (; count < most && find_word(&at, words->end); count++) {
        const char *word = at;
        bool good = decimal_read(&at, words->end, &numbers[count]);
        if (good && (at == words->end || is_blank(*at)))
            continue;
        const char *letter = word + (*word == '-' || *word == '+');
        if (!(good && *at == '#') && (letter == words->end || !strchr("nNiI", *letter)))
            complain(piece, word, "a number is expected");
        numbers[count] = NAN;
        pass_word(&at, words->end);
    }
    return count;
}

/* --- lines
 * ------------------------------------------------------------------------------------------ */

void obj_count_line(struct obj_counts *counts, const struct text_line *line)
{
    struct text_line words;
    size_t corners;
    switch (keyword_of(line, &words)) {
    case PLACE:
        counts->places++;
        return;
    case UV:
        counts->uv++;
        return;
    case NORMAL:
        counts->normals++;
        return;
    case FACE:
        corners = obj_count_words(&words);
        counts->triangles += corners > 2 ? corners - 2 : 0;
        counts->polygons += corners > 3;
        return;
    case OTHER:
        return;
    default:
        counts->statements++;
        return;
    }
}

static void read_place(struct obj_text *text, struct obj_piece *piece,
                       const struct text_line *words, size_t index)
{
    double n[6];
    size_t count = read_numbers(piece, words, n, 6);
    if (count < 3)
        complain(piece, words->start, "v needs three numbers");
    double w = count == 4 && n[3] != 0 ? n[3] : 1.0; /* of a rational curve's point */
    if (count < 3 || piece->wrong_at)
        return;
    text->places[index] = (ps_vec3){(float)(n[0] / w), (float)(n[1] / w), (float)(n[2] / w)};
    piece->colored |= count == 6;
    piece->uncolored |= count < 6;
    for (int i = 0; text->colors && i < 3; i++)
        text->colors[index][i] = count == 6 ? (float)n[3 + i] : 1.0f;
}

static void read_uv(struct obj_text *text, struct obj_piece *piece, const struct text_line *words,
                    size_t index)
{
    double n[2] = {0, 0};
    if (read_numbers(piece, words, n, 2) < 1)
        complain(piece, words->start, "vt needs a number");
    for (int i = 0; i < 2; i++)
        text->uv[index][i] = (float)n[i];
}

static void read_normal(struct obj_text *text, struct obj_piece *piece,
                        const struct text_line *words, size_t index)
{
    double n[3] = {0, 0, 0};
    if (read_numbers(piece, words, n, 3) < 3)
        complain(piece, words->start, "vn needs three numbers");
    text->normals[index] = (ps_vec3){(float)n[0], (float)n[1], (float)n[2]};
}

/* How many of each come before a line, and how many there are in all. */
struct extent {
    size_t so_far, all;
};

/* The index at *at, from 0 on: negative ones count back from the line. */
static uint32_t read_index(struct obj_piece *piece, const char **at, const char *end,
                           const struct extent *extent, const char *what)
{
    const char *word = *at;
    long long index = 0;
    if (!decimal_read_integer(at, end, &index) || index == 0) {
        complain(piece, word, "a face needs numbers from 1 on, as 7, 7/1, 7//2 or 7/1/2");
        return OBJ_NONE;
    }
    index = index > 0 ? index - 1 : (long long)extent->so_far + index;
    if (index >= 0 && index < (long long)extent->all)
        return (uint32_t)index;
    piece->wrong_at = word;
    snprintf(piece->wrong, sizeof piece->wrong, "a face has %s %lld, and there are %zu", what,
             index + 1, extent->all);
    return OBJ_NONE;
}

/* A corner as 7, 7/1, 7//2 or 7/1/2: its place, uv and normal. */
static void read_corner(struct obj_piece *piece, const char **at, const char *end,
                        const struct extent extents[3], uint32_t corner[3])
{
    static const char *const kinds[3] = {"vertex", "texture coordinate", "normal"};
    corner[0] = read_index(piece, at, end, &extents[0], kinds[0]);
    corner[1] = corner[2] = OBJ_NONE;
    for (int i = 1; i < 3 && *at < end && **at == '/' && !piece->wrong_at; i++) {
        ++*at;
        if (*at < end && **at != '/' && !is_blank(**at))
            corner[i] = read_index(piece, at, end, &extents[i], kinds[i]);
    }
    if (!piece->wrong_at && *at < end && !is_blank(**at))
        complain(piece, *at, "a face needs numbers from 1 on, as 7, 7/1, 7//2 or 7/1/2");
}

static void store_corner(struct obj_text *text, size_t triangle, int k, const uint32_t corner[3])
{
    text->triangles[triangle][k] = corner[0];
    if (text->triangle_uv)
        text->triangle_uv[triangle][k] = corner[1];
    if (text->triangle_normals)
        text->triangle_normals[triangle][k] = corner[2];
}

/* As a fan around its first corner. */
static void read_face(struct obj_text *text, struct obj_piece *piece, const struct text_line *words,
                      struct obj_counts *now)
{
    const struct extent extents[3] = {{now->places, text->place_count},
                                      {now->uv, text->uv_count},
                                      {now->normals, text->normal_count}};
    const char *at = words->start;
    uint32_t first[3] = {0}, last[3] = {0}, corner[3];
    size_t count = 0, triangle = now->triangles;
    for (; !piece->wrong_at && find_word(&at, words->end); count++) {
        read_corner(piece, &at, words->end, extents, corner);
        if (count >= 2) {
            store_corner(text, now->triangles, 0, first);
            store_corner(text, now->triangles, 1, last);
            store_corner(text, now->triangles++, 2, corner);
        }
        memcpy(count == 0 ? first : last, corner, sizeof corner);
    }
    if (count > 3 && !piece->wrong_at)
        text->polygons[now->polygons++] = (struct obj_polygon){(uint32_t)triangle, (uint32_t)count};
}

static void read_statement(struct obj_text *text, enum keyword keyword,
                           const struct text_line *words, struct obj_counts *now)
{
    enum obj_statement_kind kind = keyword == SECTION    ? OBJ_SECTION
                                   : keyword == MATERIAL ? OBJ_MATERIAL
                                   : keyword == LIBRARY  ? OBJ_LIBRARY
                                                         : OBJ_SMOOTHING;
    text->statements[now->statements++] = (struct obj_statement){kind, *words, now->triangles};
}

void obj_read_line(struct obj_text *text, struct obj_piece *piece, const struct text_line *line,
                   struct obj_counts *now)
{
    struct text_line words;
    enum keyword keyword = keyword_of(line, &words);
    switch (keyword) {
    case PLACE:
        read_place(text, piece, &words, now->places++);
        return;
    case UV:
        read_uv(text, piece, &words, now->uv++);
        return;
    case NORMAL:
        read_normal(text, piece, &words, now->normals++);
        return;
    case FACE:
        read_face(text, piece, &words, now);
        return;
    case OTHER:
        return;
    default:
        read_statement(text, keyword, &words, now);
        return;
    }
}
