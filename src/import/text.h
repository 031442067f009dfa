/* text.h: checks of text files that assimp's readers need done for them. */
#ifndef IMPORT_TEXT_H
#define IMPORT_TEXT_H

#include "import/files.h"

/* The next line of [*at, end): from its first character that is no blank; false at the end. */
struct text_line {
    const char *start, *end;
};
bool text_next_line(const char **at, const char *end, struct text_line *line);

/* Whether the line's first word is `word`; `rest` is then what follows it, blanks skipped. */
bool text_line_starts(const struct text_line *line, const char *word, struct text_line *rest);

/* In place: what an URI writes as %20 is a blank. */
void mesh_decode_percent(char *text);

/* assimp writes through a null pointer where an MTL file sets something before its first `newmtl`:
 * those lines become blanks. */
void mtl_blank_preamble(struct mesh_file *file);

/* Whether an MTL text defines the material. */
bool mtl_has_material(const struct mesh_file *file, const char *name);

/* assimp takes data of a binary PLY file that begin like the end of a line for a part of the
 * header: an element of one byte comes before such data. PS_ERROR_MEMORY. */
ps_result ply_guard_data(struct mesh_file *file, struct error *error);

#endif
