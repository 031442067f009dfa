/* ply_text.c: pieces of the text, three walks over each, in parallel: how many elements they hold;
 * how many bytes those take, which for a face depends on its first numbers; and then the numbers,
 * into place. So what is read does not depend on the threads, and only the third walk reads all
 * numbers.
 */
#include "import/ply_text.h"

#include "base/decimal.h"
#include "base/parallel.h"
#include "import/text.h"
#include <stdlib.h>
#include <string.h>

#define PIECE ((size_t)1 << 20) /* bytes of text */

struct piece {
    uint64_t lines, elements; /* in it; then before it */
    size_t bytes;             /* likewise, of packed data */
    size_t wrong;             /* the first line that lacks a number, from 1 in the piece; 0: none */
};

struct packing {
    const struct ply_header *header;
    const char *text;
    size_t length;
    struct piece *pieces;
    size_t piece_count;
    unsigned char *packed;
};

/* --- lines
 * ----------------------------------------------------------------------------------------- */

/* Where the first line begins that begins in a piece. */
static const char *start_of(const struct packing *packing, size_t index)
{
    size_t from = index * PIECE;
    if (from >= packing->length)
        return packing->text + packing->length;
    if (from == 0)
        return packing->text;
    const char *before = packing->text + from - 1;
    const char *stop = memchr(before, '\n', packing->length - from + 1);
    return stop ? stop + 1 : packing->text + packing->length;
}

/* The elements of a piece, which are the lines that are not empty; `number` is that of the first
 * one. */
struct walk {
    const char *at, *end;
    uint64_t line; /* in the piece, from 1 */
    uint64_t number;
};

static struct walk walk_of(const struct packing *packing, size_t index)
{
    return (struct walk){.at = start_of(packing, index),
                         .end = start_of(packing, index + 1),
                         .number = packing->pieces[index].elements};
}

static bool next_element(struct walk *walk, struct text_line *line)
{
    while (text_next_line(&walk->at, walk->end, line)) {
        walk->line++;
        if (line->start < line->end)
            return true;
    }
    return false;
}

/* --- numbers
 * --------------------------------------------------------------------------------------- */

static bool take_number(struct text_line *line, double *number)
{
    while (line->start < line->end && (*line->start == ' ' || *line->start == '\t'))
        line->start++;
    return decimal_read(&line->start, line->end, number);
}

static double clamp(double number, double least, double most)
{
    return number < least ? least : number > most ? most : number;
}

/* As the type has it; ply_number reads it back. */
static uint64_t bits_of(enum ply_type type, double number)
{
    float narrow = (float)number;
    uint32_t bits = 0;
    uint64_t wide = 0;
    switch (type) {
    case PLY_CHAR:
        return (uint8_t)(int8_t)clamp(number, INT8_MIN, INT8_MAX);
    case PLY_UCHAR:
        return (uint8_t)clamp(number, 0, UINT8_MAX);
    case PLY_SHORT:
        return (uint16_t)(int16_t)clamp(number, INT16_MIN, INT16_MAX);
    case PLY_USHORT:
        return (uint16_t)clamp(number, 0, UINT16_MAX);
    case PLY_INT:
        return (uint32_t)(int32_t)clamp(number, INT32_MIN, INT32_MAX);
    case PLY_UINT:
        return (uint32_t)clamp(number, 0, UINT32_MAX);
    case PLY_FLOAT:
        memcpy(&bits, &narrow, sizeof bits);
        return bits;
    case PLY_DOUBLE:
    case PLY_NO_TYPE:
        memcpy(&wide, &number, sizeof wide);
        return wide;
    }
    return 0;
}

static unsigned char *store(unsigned char *to, enum ply_type type, double number)
{
    uint64_t bits = bits_of(type, number);
    for (size_t i = 0; i < ply_type_size(type); i++)
        *to++ = (unsigned char)(bits >> 8 * i);
    return to;
}

/* --- elements
 * -------------------------------------------------------------------------------------- */

static const struct ply_element *element_of(const struct ply_header *header, uint64_t number)
{
    if (number < header->vertices.count)
        return &header->vertices;
    return number - header->vertices.count < header->faces.count ? &header->faces : NULL;
}

/* How many numbers a list has that is next in the line. */
static bool take_count(struct text_line *line, size_t *count)
{
    double number;
    bool good = take_number(line, &number) && number >= 0 &&
                number <= (double)(line->end - line->start); /* a number takes a character */
    *count = good ? (size_t)number : 0;
    return good;
}

/* The bytes of an element. Only what stands before its list is read. */
static bool measure(const struct ply_element *element, struct text_line line, size_t *bytes)
{
    size_t count = 0;
    double number;
    *bytes = element->size;
    for (size_t i = 0; i < element->property_count; i++) {
        const struct ply_property *property = &element->properties[i];
        if (property->count_type == PLY_NO_TYPE) {
            if (!take_number(&line, &number))
                return false;
            continue;
        }
        if (!take_count(&line, &count))
            return false;
        *bytes += ply_type_size(property->count_type) + count * ply_type_size(property->type);
        return true; /* of what follows, the third walk finds out */
    }
    return true;
}

/* Where the next element goes; NULL: a number is missing. */
static unsigned char *pack(const struct ply_element *element, struct text_line line,
                           unsigned char *to)
{
    double number;
    for (size_t i = 0; i < element->property_count; i++) {
        const struct ply_property *property = &element->properties[i];
        bool is_list = property->count_type != PLY_NO_TYPE;
        size_t count = 1;
        if (is_list && !take_count(&line, &count))
            return NULL;
        if (is_list)
            to = store(to, property->count_type, (double)count);
        for (size_t k = 0; k < count; k++) {
            if (!take_number(&line, &number))
                return NULL;
            to = store(to, property->type, number);
        }
    }
    return to;
}

/* --- walks
 * ----------------------------------------------------------------------------------------- */

static void count_piece(void *user, uint64_t index, uint32_t worker)
{
    const struct packing *packing = user;
    struct piece *piece = &packing->pieces[index];
    struct walk walk = walk_of(packing, index);
    struct text_line line;
    (void)worker;
    uint64_t elements = 0;
    while (next_element(&walk, &line))
        elements++;
    piece->elements = elements;
    piece->lines = walk.line;
}

static void measure_piece(void *user, uint64_t index, uint32_t worker)
{
    const struct packing *packing = user;
    struct piece *piece = &packing->pieces[index];
    struct walk walk = walk_of(packing, index);
    const struct ply_element *element;
    struct text_line line;
    size_t bytes;
    (void)worker;
    while (next_element(&walk, &line) && (element = element_of(packing->header, walk.number))) {
        bool fixed = element == &packing->header->vertices;
        bytes = element->size;
        if (!fixed && !measure(element, line, &bytes)) {
            piece->wrong = walk.line;
            return;
        }
        piece->bytes += bytes;
        walk.number++;
    }
}

static void pack_piece(void *user, uint64_t index, uint32_t worker)
{
    const struct packing *packing = user;
    struct piece *piece = &packing->pieces[index];
    struct walk walk = walk_of(packing, index);
    unsigned char *to = packing->packed + piece->bytes;
    const struct ply_element *element;
    struct text_line line;
    (void)worker;
    while (next_element(&walk, &line) && (element = element_of(packing->header, walk.number))) {
        to = pack(element, line, to);
        if (!to) {
            piece->wrong = walk.line;
            return;
        }
        walk.number++;
    }
}

/* Makes of what is in each piece what is before it. */
static void add_up_elements(struct packing *packing)
{
    struct piece sum = {0};
    for (size_t i = 0; i < packing->piece_count; i++) {
        struct piece own = packing->pieces[i];
        packing->pieces[i] = sum;
        sum.lines += own.lines;
        sum.elements += own.elements;
    }
}

/* The same; returns those of all. */
static size_t add_up_bytes(struct packing *packing)
{
    size_t sum = 0;
    for (size_t i = 0; i < packing->piece_count; i++) {
        size_t own = packing->pieces[i].bytes;
        packing->pieces[i].bytes = sum;
        sum += own;
    }
    return sum;
}

static size_t lines_of(const char *text, size_t length)
{
    size_t lines = 0;
    for (size_t i = 0; i < length; i++)
        lines += text[i] == '\n';
    return lines;
}

/* What the walks found to be wrong. */
static ps_result judge(const struct packing *packing, const struct mesh_file *file,
                       struct error *error)
{
    for (size_t i = 0; i < packing->piece_count; i++) {
        const struct piece *piece = &packing->pieces[i];
        if (piece->wrong > 0)
            return error_set(error, PS_ERROR_INVALID, "%s:%zu: a number is missing", file->path,
                             lines_of(file->bytes, packing->header->data) + (size_t)piece->lines +
                                 piece->wrong);
    }
    return PS_OK;
}

static ps_result pack_all(struct packing *packing, const struct mesh_file *file,
                          struct workers *workers, struct mesh_file *packed, struct error *error)
{
    parallel_for(workers, packing->piece_count, count_piece, packing);
    add_up_elements(packing);
    parallel_for(workers, packing->piece_count, measure_piece, packing);
    ps_result result = judge(packing, file, error);
    if (result != PS_OK)
        return result;
    packed->length = add_up_bytes(packing);
    packed->bytes = malloc(packed->length + 1);
    if (!packed->bytes)
        return error_memory(error, packed->length, "a mesh file");
    packing->packed = (unsigned char *)packed->bytes;
    parallel_for(workers, packing->piece_count, pack_piece, packing);
    return judge(packing, file, error);
}

ps_result ply_text_pack(const struct mesh_file *file, const struct ply_header *header,
                        struct workers *workers, struct mesh_file *packed, struct error *error)
{
    struct packing packing = {.header = header,
                              .text = file->bytes + header->data,
                              .length = file->length - header->data};
    *packed = (struct mesh_file){.path = file->path};
    packing.piece_count = packing.length / PIECE + 1;
    packing.pieces = calloc(packing.piece_count, sizeof *packing.pieces);
    if (!packing.pieces)
        return error_memory(error, packing.piece_count * sizeof *packing.pieces, "a mesh file");
    ps_result result = pack_all(&packing, file, workers, packed, error);
    free(packing.pieces);
    return result;
}
