/* obj_text.c: two walks over the pieces of an OBJ text (Wavefront, "Object files", Advanced
 * Visualizer appendix B1).
 *
 * Not by assimp: it keeps some 250 bytes a triangle and a vertex for each corner, reads 40 MB a
 * second by one thread, and leaves out smoothing groups.
 */
#include "import/obj_line.h"

#include "base/parallel.h"
#include <stdlib.h>
#include <string.h>

#define MOST_ELEMENTS ((size_t)200 * 1000 * 1000) /* of each kind */

struct reading {
    struct obj_text *text;
    struct obj_piece *pieces;
    size_t piece_count;
};

/* --- walks
 * ------------------------------------------------------------------------------------------ */

static void count_piece(void *user, uint64_t index, uint32_t worker)
{
    struct obj_piece *piece = &((struct reading *)user)->pieces[index];
    const char *at = piece->start;
    struct text_line line;
    (void)worker;
    while (text_next_line(&at, piece->end, &line))
        obj_count_line(&piece->counts, &line);
}

static void add(struct obj_counts *sum, const struct obj_counts *counts)
{
    sum->places += counts->places;
    sum->uv += counts->uv;
    sum->normals += counts->normals;
    sum->triangles += counts->triangles;
    sum->polygons += counts->polygons;
    sum->statements += counts->statements;
}

static void read_piece(void *user, uint64_t index, uint32_t worker)
{
    struct reading *reading = user;
    struct obj_piece *piece = &reading->pieces[index];
    struct obj_counts now = piece->before;
    const char *at = piece->start;
    struct text_line line;
    (void)worker;
    while (!piece->wrong_at && text_next_line(&at, piece->end, &line))
        obj_read_line(reading->text, piece, &line, &now);
}

/* --- both
 * ------------------------------------------------------------------------------------------ */

/* A byte order mark becomes blanks, and so do ends of lines behind a backslash, which still count
 * as lines. */
static void blank_what_is_no_text(struct mesh_file *file)
{
    char *at = file->bytes, *end = file->bytes + file->length;
    if (file->length >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0)
        memset(at, ' ', 3);
    while ((at = memchr(at, '\\', (size_t)(end - at))) != NULL) {
        char *next = at + 1 + (at + 1 < end && at[1] == '\r');
        if (next < end && *next == '\n') {
            *at = ' ';
            *next = '\v';
        }
        at++;
    }
}

static bool cut_into_pieces(struct reading *reading, const struct mesh_file *file)
{
    const char *at = file->bytes, *end = at + file->length;
    reading->pieces = calloc(file->length / OBJ_PIECE + 1, sizeof *reading->pieces);
    while (reading->pieces && at < end) {
        struct obj_piece *piece = &reading->pieces[reading->piece_count++];
        const char *stop = (size_t)(end - at) > OBJ_PIECE
                               ? memchr(at + OBJ_PIECE, '\n', (size_t)(end - at) - OBJ_PIECE)
                               : NULL;
        piece->start = at;
        at = piece->end = stop ? stop + 1 : end;
    }
    return reading->pieces != NULL;
}

static bool is_colored(const struct mesh_file *file)
{
    const char *at = file->bytes, *end = at + file->length;
    struct text_line line, words;
    while (text_next_line(&at, end, &line))
        if (text_line_starts(&line, "v", &words))
            return obj_count_words(&words) >= 6;
    return false;
}

static bool allocate(struct obj_text *text, const struct obj_counts *all, bool colored)
{
    text->places = malloc((all->places + 1) * sizeof *text->places);
    text->colors = colored ? malloc((all->places + 1) * sizeof *text->colors) : NULL;
    text->uv = malloc((all->uv + 1) * sizeof *text->uv);
    text->normals = malloc((all->normals + 1) * sizeof *text->normals);
    text->triangles = malloc((all->triangles + 1) * sizeof *text->triangles);
    text->triangle_uv =
        all->uv > 0 ? malloc((all->triangles + 1) * sizeof *text->triangle_uv) : NULL;
    text->triangle_normals =
        all->normals > 0 ? malloc((all->triangles + 1) * sizeof *text->triangle_normals) : NULL;
    text->polygons = malloc((all->polygons + 1) * sizeof *text->polygons);
    text->statements = malloc((all->statements + 1) * sizeof *text->statements);
    text->place_count = all->places;
    text->uv_count = all->uv;
    text->normal_count = all->normals;
    text->triangle_count = all->triangles;
    text->polygon_count = all->polygons;
    text->statement_count = all->statements;
    return text->places && (text->colors || !colored) && text->uv && text->normals &&
           text->triangles && (text->triangle_uv || all->uv == 0) &&
           (text->triangle_normals || all->normals == 0) && text->polygons && text->statements;
}

static ps_result out_of_memory(const struct mesh_file *file, struct error *error)
{
    return error_memory(error, file->length, "a mesh file");
}

/* The first in the file. */
static ps_result check(const struct reading *reading, const struct mesh_file *file,
                       struct error *error)
{
    bool colored = false, uncolored = false;
    for (size_t i = 0; i < reading->piece_count; i++) {
        const struct obj_piece *piece = &reading->pieces[i];
        size_t line = 1;
        for (const char *c = file->bytes; piece->wrong_at && c < piece->wrong_at; c++)
            line += *c == '\n' || *c == '\v';
        if (piece->wrong_at)
            return error_set(error, PS_ERROR_INVALID, "%s:%zu: %s", file->path, line, piece->wrong);
        colored |= piece->colored;
        uncolored |= piece->uncolored;
    }
    reading->text->partly_colored = colored && uncolored;
    return PS_OK;
}

static ps_result read_pieces(struct reading *reading, const struct mesh_file *file,
                             struct workers *workers, struct error *error)
{
    struct obj_counts all = {0};
    if (!cut_into_pieces(reading, file))
        return out_of_memory(file, error);
    parallel_for(workers, reading->piece_count, count_piece, reading);
    for (size_t i = 0; i < reading->piece_count; i++) {
        reading->pieces[i].before = all;
        add(&all, &reading->pieces[i].counts);
    }
    if (all.places > MOST_ELEMENTS || all.uv > MOST_ELEMENTS || all.normals > MOST_ELEMENTS ||
        all.triangles > MOST_ELEMENTS)
        return error_set(error, PS_ERROR_INVALID, "%s: more than 200 million vertices or triangles",
                         file->path);
    if (!allocate(reading->text, &all, is_colored(file)))
        return out_of_memory(file, error);
    parallel_for(workers, reading->piece_count, read_piece, reading);
    return check(reading, file, error);
}

ps_result obj_text_read(struct mesh_file *file, struct workers *workers, struct obj_text *text,
                        struct error *error)
{
    struct reading reading = {.text = text};
    *text = (struct obj_text){0};
    blank_what_is_no_text(file);
    ps_result result = read_pieces(&reading, file, workers, error);
    free(reading.pieces);
    return result;
}

void obj_text_release(struct obj_text *text)
{
    free(text->places);
    free(text->colors);
    free(text->uv);
    free(text->normals);
    free(text->triangles);
    free(text->triangle_uv);
    free(text->triangle_normals);
    free(text->polygons);
    free(text->statements);
    *text = (struct obj_text){0};
}
