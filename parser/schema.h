/* schema.h: every key of the scene language.
 *
 * The tables are the only statement of the language: the parser fills descriptions by them, the
 * manual page is tested against them, and `psplat schema` would print them. A section is a map of
 * keys. To walk them all:
 *
 *     for (size_t i = 0; i < schema_section_count(); i++)
 *         for (size_t j = 0; j < schema_section(i)->row_count; j++)
 *             use(schema_section(i), &schema_section(i)->rows[j]);
 */
#ifndef PARSER_SCHEMA_H
#define PARSER_SCHEMA_H

#include "base/param.h"
#include <stdbool.h>
#include <stddef.h>

/* How the value of a key is written, where its ps_param type does not say all. */
enum schema_form {
    SCHEMA_VALUE,     /* as its ps_param says */
    SCHEMA_SCALE,     /* [x, y, z], or one number for all three */
    SCHEMA_POINTS,    /* list of `fewest` to `most` [x, y, z] */
    SCHEMA_TRIANGLES, /* list of [i, j, k], indices from 0 of the points before it in the table */
    SCHEMA_MATERIAL,  /* name of a material */
    SCHEMA_STRATEGY,  /* plugin's name, or {name: {parameter: value, ...}} */
    SCHEMA_MAP,       /* the section of the same name */
    SCHEMA_NAMED,     /* map from names of the user's choice to sections with this parent */
    SCHEMA_LIST,      /* list of {section: {...}}, of the sections with this parent */
    SCHEMA_OTHER      /* as `domain` says; read before the tables are (psd.h) */
};

struct schema_row {
    ps_param param; /* first, so that a param_table can step from row to row */
    enum schema_form form;
    const char *absent;  /* what happens without the key, where there is no default; NULL: the key
                            is required if it has no default either */
    size_t fewest, most; /* of SCHEMA_POINTS and SCHEMA_TRIANGLES */
    const char *domain;  /* of SCHEMA_OTHER: what the value may be */
};

struct schema_section {
    const char *name;    /* the key that it stands under; "scene": the whole file; "material": any
                            name */
    const char *parent;  /* key of the top level that holds it, or NULL: it is one itself, or is
                            the whole file */
    const char *summary; /* one line, no full stop */
    const struct schema_row *rows;
    size_t row_count;
    int kind; /* of lights: enum light_kind; of objects: enum object_kind */
};

/* What the section "scene" fills. */
struct schema_scene {
    int64_t psd;
};

size_t schema_section_count(void);
const struct schema_section *schema_section(size_t index);

/* The section of that parent (may be NULL) and name, or NULL. */
const struct schema_section *schema_find(const char *parent, const char *name);

struct param_table schema_table(const struct schema_section *section);
bool schema_is_required(const struct schema_row *row);

/* "number > 0", "list of 4 [x, y, z]", "name of a material", ... */
void schema_describe(const struct schema_row *row, char *text, size_t size);

#endif
