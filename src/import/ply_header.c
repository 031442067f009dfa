#include "import/ply_header.h"

#include "import/text.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    enum ply_type type;
} types[] = {
    {"char", PLY_CHAR},   {"int8", PLY_CHAR},     {"uchar", PLY_UCHAR},   {"uint8", PLY_UCHAR},
    {"short", PLY_SHORT}, {"int16", PLY_SHORT},   {"ushort", PLY_USHORT}, {"uint16", PLY_USHORT},
    {"int", PLY_INT},     {"int32", PLY_INT},     {"uint", PLY_UINT},     {"uint32", PLY_UINT},
    {"float", PLY_FLOAT}, {"float32", PLY_FLOAT}, {"double", PLY_DOUBLE}, {"float64", PLY_DOUBLE},
};

/* The names that assimp knows. */
static const struct {
    const char *name;
    enum ply_role role;
} roles[] = {
    {"x", PLY_X},
    {"y", PLY_Y},
    {"z", PLY_Z},
    {"nx", PLY_NX},
    {"ny", PLY_NY},
    {"nz", PLY_NZ},
    {"u", PLY_U},
    {"s", PLY_U},
    {"tx", PLY_U},
    {"texture_u", PLY_U},
    {"v", PLY_V},
    {"t", PLY_V},
    {"ty", PLY_V},
    {"texture_v", PLY_V},
    {"red", PLY_RED},
    {"r", PLY_RED},
    {"green", PLY_GREEN},
    {"g", PLY_GREEN},
    {"blue", PLY_BLUE},
    {"b", PLY_BLUE},
    {"alpha", PLY_ALPHA},
    {"vertex_index", PLY_INDICES},
    {"vertex_indices", PLY_INDICES},
};

/* --- numbers
 * --------------------------------------------------------------------------------------- */

size_t ply_type_size(enum ply_type type)
{
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
    return sizes[type];
}

/* Compilers make one load of each of these. */
static uint32_t load_2(const unsigned char *b, bool big_endian)
{
    return big_endian ? (uint32_t)b[0] << 8 | b[1] : (uint32_t)b[1] << 8 | b[0];
}

static uint32_t load_4(const unsigned char *b, bool big_endian)
{
    return big_endian ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
                      : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
}

static uint64_t load_8(const unsigned char *b, bool big_endian)
{
    uint64_t first = load_4(b, big_endian), second = load_4(b + 4, big_endian);
    return big_endian ? first << 32 | second : second << 32 | first;
}

static double float_of(uint32_t bits)
{
    float number;
    memcpy(&number, &bits, sizeof number);
    return (double)number;
}

static double double_of(uint64_t bits)
{
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

double ply_number(const char *at, enum ply_type type, bool big_endian)
{
    const unsigned char *bytes = (const unsigned char *)at;
    switch (type) {
    case PLY_CHAR:
        return (double)(int8_t)bytes[0];
    case PLY_UCHAR:
        return (double)bytes[0];
    case PLY_SHORT:
        return (double)(int16_t)(uint16_t)load_2(bytes, big_endian);
    case PLY_USHORT:
        return (double)load_2(bytes, big_endian);
    case PLY_INT:
        return (double)(int32_t)load_4(bytes, big_endian);
    case PLY_UINT:
        return (double)load_4(bytes, big_endian);
    case PLY_FLOAT:
        return float_of(load_4(bytes, big_endian));
    case PLY_DOUBLE:
        return double_of(load_8(bytes, big_endian));
    case PLY_NO_TYPE:
        break;
    }
    assert(0);
    return 0;
}

/* --- lines
 * ----------------------------------------------------------------------------------------- */

/* The first word of a line, and what follows. */
static struct text_line take_word(struct text_line *line)
{
    struct text_line word = *line;
    const char *at = line->start;
    while (at < line->end && *at != ' ' && *at != '\t')
        at++;
    word.end = at;
    while (at < line->end && (*at == ' ' || *at == '\t'))
        at++;
    line->start = at;
    return word;
}

static bool is_word(const struct text_line *word, const char *text)
{
    size_t length = (size_t)(word->end - word->start);
    return length == strlen(text) && memcmp(word->start, text, length) == 0;
}

static enum ply_type type_of(struct text_line word)
{
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (is_word(&word, types[i].name))
            return types[i].type;
    return PLY_NO_TYPE;
}

static enum ply_role role_of(struct text_line word)
{
    for (size_t i = 0; i < sizeof roles / sizeof roles[0]; i++)
        if (is_word(&word, roles[i].name))
            return roles[i].role;
    return PLY_OTHER;
}

static bool read_property(struct text_line line, struct ply_element *element)
{
    struct ply_property *property = &element->properties[element->property_count];
    struct text_line word = take_word(&line);
    if (element->property_count == PLY_PROPERTIES)
        return false;
    bool is_list = is_word(&word, "list");
    property->count_type = is_list ? type_of(take_word(&line)) : PLY_NO_TYPE;
    property->type = type_of(is_list ? take_word(&line) : word);
    property->role = role_of(take_word(&line));
    property->offset = element->size;
    element->size += is_list ? 0 : ply_type_size(property->type);
    element->property_count++;
    return property->type != PLY_NO_TYPE && (!is_list || property->count_type != PLY_NO_TYPE);
}

/* Vertices come first, then faces, and nothing else. */
static struct ply_element *read_element(struct text_line line, struct ply_header *header,
                                        const struct ply_element *before)
{
    struct text_line word = take_word(&line);
    struct ply_element *element = NULL;
    char *end;
    if (!before && is_word(&word, "vertex"))
        element = &header->vertices;
    else if (before == &header->vertices && is_word(&word, "face"))
        element = &header->faces;
    if (!element || line.start == line.end || *line.start < '0' || *line.start > '9')
        return NULL;
    element->count = strtoull(line.start, &end, 10);
    return end == line.end && element->count < UINT32_MAX ? element : NULL;
}

/* --- which files
 * ----------------------------------------------------------------------------------- */

const struct ply_property *ply_property_of(const struct ply_element *element, enum ply_role role)
{
    for (size_t i = 0; i < element->property_count; i++)
        if (element->properties[i].role == role)
            return &element->properties[i];
    return NULL;
}

static bool has_all_or_none(const struct ply_element *element, enum ply_role first, int count)
{
    int found = 0;
    for (int i = 0; i < count; i++)
        found += ply_property_of(element, (enum ply_role)(first + i)) != NULL;
    return found == 0 || found == count;
}

static bool is_color_type(enum ply_type type)
{
    return type == PLY_UCHAR || type == PLY_USHORT || type == PLY_FLOAT || type == PLY_DOUBLE;
}

static bool are_plain_vertices(const struct ply_element *vertices)
{
    bool plain = ply_property_of(vertices, PLY_X) && has_all_or_none(vertices, PLY_X, 3) &&
                 has_all_or_none(vertices, PLY_NX, 3) && has_all_or_none(vertices, PLY_U, 2) &&
                 has_all_or_none(vertices, PLY_RED, 3);
    for (size_t i = 0; i < vertices->property_count; i++) {
        const struct ply_property *property = &vertices->properties[i];
        plain = plain && property->count_type == PLY_NO_TYPE;
        if (property->role >= PLY_RED && property->role <= PLY_ALPHA)
            plain = plain && is_color_type(property->type);
    }
    return plain;
}

/* A list of floats may be texture coordinates. */
static bool are_plain_faces(const struct ply_element *faces)
{
    size_t lists = 0;
    for (size_t i = 0; i < faces->property_count; i++) {
        const struct ply_property *property = &faces->properties[i];
        bool is_list = property->count_type != PLY_NO_TYPE;
        if (is_list != (property->role == PLY_INDICES) ||
            (is_list && (property->type >= PLY_FLOAT || property->count_type >= PLY_FLOAT)))
            return false;
        lists += is_list;
    }
    return lists == 1;
}

bool ply_header_ends(const struct mesh_file *file)
{
    const char *at = file->bytes, *end = at + file->length;
    struct text_line line, rest;
    while (text_next_line(&at, end, &line))
        if (text_line_starts(&line, "end_header", &rest))
            return true;
    return false;
}

bool ply_header_read(const struct mesh_file *file, struct ply_header *header)
{
    const char *at = file->bytes, *end = at + file->length;
    struct text_line line, rest;
    struct ply_element *element = NULL;
    bool has_format = false;
    *header = (struct ply_header){.data = 0};
    if (!text_next_line(&at, end, &line) || !is_word(&line, "ply"))
        return false;
    while (text_next_line(&at, end, &line)) {
        bool good = true;
        if (text_line_starts(&line, "format", &rest)) {
            header->big_endian = is_word(&rest, "binary_big_endian 1.0");
            header->is_text = is_word(&rest, "ascii 1.0");
            good = has_format =
                header->big_endian || header->is_text || is_word(&rest, "binary_little_endian 1.0");
        } else if (text_line_starts(&line, "element", &rest)) {
            element = read_element(rest, header, element);
            good = element != NULL;
        } else if (text_line_starts(&line, "property", &rest)) {
            good = element && read_property(rest, element);
        } else if (text_line_starts(&line, "end_header", &rest)) {
            header->data = (size_t)(at - file->bytes);
            return has_format && are_plain_vertices(&header->vertices) &&
                   are_plain_faces(&header->faces);
        } else {
            good = text_line_starts(&line, "comment", &rest) ||
                   text_line_starts(&line, "obj_info", &rest);
        }
        if (!good)
            return false;
    }
    return false;
}
