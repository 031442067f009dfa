/* obj.c: parts of an OBJ file, and its outline. */
#include "import/obj.h"

#include "base/parallel.h"
#include "scene/description.h"
#include <stdlib.h>
#include <string.h>

/* --- parts
 * ----------------------------------------------------------------------------------------- */

static bool is_same_text(const struct text_line *a, const struct text_line *b)
{
    size_t length = (size_t)(a->end - a->start);
    return length == (size_t)(b->end - b->start) && memcmp(a->start, b->start, length) == 0;
}

static int compare_words(const void *a, const void *b)
{
    const struct obj_statement *p = *(const struct obj_statement *const *)a;
    const struct obj_statement *q = *(const struct obj_statement *const *)b;
    size_t m = (size_t)(p->words.end - p->words.start), n = (size_t)(q->words.end - q->words.start);
    int order = memcmp(p->words.start, q->words.start, m < n ? m : n);
    if (order != 0 || m != n)
        return order != 0 ? order : m < n ? -1 : 1;
    return p < q ? -1 : p > q;
}

/* The first statement of the same material, for each statement of a material. False: out of
 * memory. */
static bool find_first_mentions(const struct obj_text *text, size_t *firsts)
{
    const struct obj_statement **sorted = calloc(text->statement_count + 1, sizeof(void *));
    size_t count = 0;
    if (!sorted)
        return false;
    for (size_t i = 0; i < text->statement_count; i++)
        if (text->statements[i].kind == OBJ_MATERIAL)
            sorted[count++] = &text->statements[i];
    qsort(sorted, count, sizeof(void *), compare_words);
    for (size_t i = 0; i < count; i++) {
        size_t own = (size_t)(sorted[i] - text->statements);
        bool again = i > 0 && is_same_text(&sorted[i]->words, &sorted[i - 1]->words);
        firsts[own] = again ? firsts[sorted[i - 1] - text->statements] : own;
    }
    free(sorted);
    return true;
}

/* "3", "on" or "off". */
static uint32_t read_group(const struct text_line *words)
{
    bool has_number = words->start < words->end && *words->start >= '0' && *words->start <= '9';
    if (has_number)
        return (uint32_t)strtoul(words->start, NULL, 10);
    return words->end - words->start == 2 && memcmp(words->start, "on", 2) == 0;
}

/* What triangles belong to. */
struct place_in_file {
    struct text_line section;
    size_t mention; /* the first statement of the material, or NO_INDEX */
};

struct state {
    struct place_in_file now, of_part; /* for triangles to come; for those of the last part */
};

/* The number of a material, which gets one with its first part. */
static size_t number_material(struct obj *obj, size_t mention, size_t *numbers)
{
    if (mention == NO_INDEX)
        return NO_INDEX;
    if (numbers[mention] == NO_INDEX) {
        numbers[mention] = obj->material_count;
        obj->materials[obj->material_count++] = obj->text.statements[mention].words;
    }
    return numbers[mention];
}

static bool is_same_place(const struct place_in_file *a, const struct place_in_file *b)
{
    return is_same_text(&a->section, &b->section) && a->mention == b->mention;
}

/* Triangles between two statements go to the last part, or begin one. */
static void end_stretch(struct obj *obj, struct state *state, size_t from, size_t to,
                        size_t *numbers)
{
    if (from == to)
        return;
    if (obj->part_count == 0 || !is_same_place(&state->now, &state->of_part))
        obj->parts[obj->part_count++] =
            (struct obj_part){from, 0, number_material(obj, state->now.mention, numbers)};
    obj->parts[obj->part_count - 1].count += to - from;
    state->of_part = state->now;
}

static void add_run(struct obj *obj, size_t first, uint32_t group)
{
    if (obj->run_count > 0 && obj->runs[obj->run_count - 1].first == first)
        obj->run_count--;
    obj->runs[obj->run_count++] = (struct obj_run){first, group};
}

static void apply(struct obj *obj, struct state *state, const struct obj_statement *statement,
                  size_t first_mention)
{
    switch (statement->kind) {
    case OBJ_SECTION:
        state->now.section = statement->words;
        return;
    case OBJ_MATERIAL:
        state->now.mention = first_mention;
        return;
    case OBJ_SMOOTHING:
        add_run(obj, statement->triangle, read_group(&statement->words));
        return;
    case OBJ_LIBRARY:
        return;
    }
}

static void make_parts(struct obj *obj, const size_t *firsts, size_t *numbers)
{
    static const char nothing[] = "";
    struct state state = {.now = {{nothing, nothing}, NO_INDEX}};
    size_t from = 0;
    add_run(obj, 0, 0);
    for (size_t i = 0; i < obj->text.statement_count; i++) {
        const struct obj_statement *statement = &obj->text.statements[i];
        numbers[i] = NO_INDEX;
        end_stretch(obj, &state, from, statement->triangle, numbers);
        from = statement->triangle;
        apply(obj, &state, statement, firsts[i]);
    }
    end_stretch(obj, &state, from, obj->text.triangle_count, numbers);
}

static bool find_parts(struct obj *obj)
{
    size_t count = obj->text.statement_count + 1;
    size_t *firsts = calloc(count, sizeof *firsts), *numbers = calloc(count, sizeof *numbers);
    obj->parts = calloc(count, sizeof *obj->parts);
    obj->runs = calloc(count, sizeof *obj->runs);
    obj->materials = calloc(count, sizeof *obj->materials);
    bool good = firsts && numbers && obj->parts && obj->runs && obj->materials &&
                find_first_mentions(&obj->text, firsts);
    if (good)
        make_parts(obj, firsts, numbers);
    free(firsts);
    free(numbers);
    return good;
}

/* --- outline
 * --------------------------------------------------------------------------------------- */

static void write_line(struct obj *obj, const char *keyword, const struct text_line *words)
{
    char *to = obj->outline.bytes + obj->outline.length;
    size_t length = words ? (size_t)(words->end - words->start) : 0,
           keyword_length = strlen(keyword);
    memcpy(to, keyword, keyword_length);
    if (length > 0)
        memcpy(to + keyword_length, words->start, length);
    to[keyword_length + length] = '\n';
    obj->outline.length += keyword_length + length + 1;
}

/* Libraries come first, as if they stood at the head of the file. */
static bool write_outline(struct obj *obj)
{
    static const char head[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\no plain\nf 1 2 3\no materials";
    static const char face[] = "f 1 2 3", use[] = "usemtl ", library[] = "mtllib ";
    size_t size = sizeof head + sizeof face;
    for (size_t i = 0; i < obj->text.statement_count; i++) {
        const struct text_line *words = &obj->text.statements[i].words;
        size += sizeof use + sizeof face + (size_t)(words->end - words->start);
    }
    obj->outline.bytes = malloc(size + 1);
    if (!obj->outline.bytes)
        return false;
    for (size_t i = 0; i < obj->text.statement_count; i++)
        if (obj->text.statements[i].kind == OBJ_LIBRARY)
            write_line(obj, library, &obj->text.statements[i].words);
    write_line(obj, head, NULL);
    for (size_t i = 0; i < obj->material_count; i++) {
        write_line(obj, use, &obj->materials[i]);
        write_line(obj, face, NULL);
    }
    obj->outline.bytes[obj->outline.length] = '\0';
    return true;
}

/* --- the file
 * -------------------------------------------------------------------------------------- */

static ps_result read_text(struct obj *obj, struct mesh_file *file, struct error *error)
{
    struct workers *workers;
    ps_result result = mesh_file_workers(file, &workers, error);
    if (result != PS_OK)
        return result;
    result = obj_text_read(file, workers, &obj->text, error);
    workers_destroy(workers);
    return result;
}

ps_result obj_open(struct obj *obj, struct mesh_file *file, struct error *error)
{
    *obj = (struct obj){.outline.path = file->path};
    ps_result result = read_text(obj, file, error);
    if (result != PS_OK)
        return result;
    if (obj->text.triangle_count == 0)
        return error_set(error, PS_ERROR_INVALID, "%s: the file has no triangles", file->path);
    if (!obj_cut_polygons(&obj->text) || !find_parts(obj) || !write_outline(obj))
        return error_memory(error, file->length, "a mesh file");
    return PS_OK;
}

void obj_release(struct obj *obj)
{
    obj_text_release(&obj->text);
    free(obj->parts);
    free(obj->runs);
    free(obj->materials);
    free(obj->outline.bytes);
    *obj = (struct obj){.parts = NULL};
}
