/* obj_line.h: lines of an OBJ text, counted and read. For obj_text.c. */
#ifndef IMPORT_OBJ_LINE_H
#define IMPORT_OBJ_LINE_H

#include "import/obj_text.h"

/* How many of each a piece has; and, as a sum, how many come before it. */
struct obj_counts {
    size_t places, uv, normals, triangles, polygons, statements;
};

struct obj_piece {
    const char *start, *end;
    struct obj_counts counts, before;
    bool uncolored, colored; /* some of its places */
    const char *wrong_at;    /* where an error is, or NULL */
    char wrong[160];
};

/* Before comments. */
size_t obj_count_words(const struct text_line *words);

/* Adds what the line has. */
void obj_count_line(struct obj_counts *counts, const struct text_line *line);

/* Puts it into the text's arrays, behind what there is `now`, which grows; what is wrong into the
 * piece. */
void obj_read_line(struct obj_text *text, struct obj_piece *piece, const struct text_line *line,
                   struct obj_counts *now);

#endif
