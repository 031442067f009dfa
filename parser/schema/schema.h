/* schema.h: every key of the scene language.
 *
 * The tables (schema_*.c) are the only statement of the language: the parser fills descriptions by
 * them, and the manual page is tested against them. A section is a map of keys. Sections that can
 * stand in the same place are a family, and a row whose value holds sections names their family.
 * To walk them all:
 *
 *     for (size_t i = 0; i < schema_section_count(); i++)
 *         for (size_t j = 0; j < schema_section(i)->row_count; j++)
 *             use(schema_section(i), &schema_section(i)->rows[j]);
 *
 * What other sections fill is in keys.h, and in scene/description.h.
 */
#ifndef PARSER_SCHEMA_SCHEMA_H
#define PARSER_SCHEMA_SCHEMA_H

#include "base/param.h"
#include <stdbool.h>
#include <stddef.h>

/* How the value of a key is written, where its ps_param type does not say all. */
enum schema_form {
    SCHEMA_VALUE,         /* as its ps_param says */
    SCHEMA_SCALE,         /* [x, y, z], or one number for all three */
    SCHEMA_POINT_OR_AUTO, /* [x, y, z], or auto: struct point_or_auto */
    SCHEMA_PAIR,          /* [u, v], or one number for both: double[2] */
    SCHEMA_MATRIX,        /* 12 numbers: double[12] */
    SCHEMA_WORDS,     /* list of choices of its ps_param: int32_t, a bit for each in their order */
    SCHEMA_POINTS,    /* list of [x, y, z]: struct point_list */
    SCHEMA_PAIRS,     /* list of [u, v]: struct pair_list */
    SCHEMA_TRIANGLES, /* list of [i, j, k], indices from 0 of the points before it in the table:
                         struct triangle_list */
    SCHEMA_COLORS,    /* list of `most` colours: ps_rgb[most] */
    SCHEMA_PIGMENT,   /* colour, or {kind: {...}}, of the sections of the family: the offset is
                         that of colors[0] of a struct pigment_description */
    SCHEMA_SCALAR_PIGMENT, /* the same, but a number rather than a colour */
    SCHEMA_MATERIAL,       /* name of a material: size_t, its index */
    SCHEMA_MATERIALS,      /* map from names in a mesh file to names of materials: node */
    SCHEMA_GROUP,          /* name of a group: node */
    SCHEMA_FILE,           /* path of a file: node */
    SCHEMA_LAYER,          /* name of a layer of a picture: node */
    SCHEMA_STRATEGY,       /* plugin's name, or {name: {parameter: value, ...}} */

    /* These hold sections of the family, which who fills the description reads. */
    SCHEMA_MAP,         /* one map */
    SCHEMA_NAMED,       /* map from names of the user's choice to maps */
    SCHEMA_ITEMS,       /* list of maps */
    SCHEMA_STEPS,       /* list of maps, each with one of the section's keys */
    SCHEMA_LIST,        /* list of {section: {...}} */
    SCHEMA_NAMED_LISTS, /* map from names of the user's choice to such lists */

    SCHEMA_OTHER /* as `domain` says; read before the tables are (psd.h) */
};

struct schema_row {
    ps_param param; /* first, so that a param_table can step from row to row */
    enum schema_form form;
    const char *family;  /* of the sections that the value holds, or NULL */
    const char *absent;  /* what happens without the key, where there is no default; NULL: the key
                            is required if it has no default either */
    const char *shared;  /* section under which the manual has the row once for all that have it, or
                            NULL */
    size_t fewest, most; /* of lists */
    const char *domain;  /* of SCHEMA_OTHER: what the value may be */

    /* Rows of a section with the same choice, not 0, exclude each other, but for those with the
     * same alternative. One of them must be given where the choice is demanded. */
    int choice, alternative;
    bool demanded;
};

struct schema_section {
    const char *name;    /* the key that it stands under; "scene": the whole file; in a family that
                            is named by the user ("material", "camera"): any name */
    const char *family;  /* as the rows that hold it say; of one section: its name */
    const char *summary; /* one line, no full stop */
    const char *word;    /* that may stand in place of the map, or NULL */
    const struct schema_row *rows;
    size_t row_count;
    int kind; /* of lights: enum light_kind; of objects: enum object_kind, or one of keys.h; of
                 pigments: enum pigment_kind; of what a material is: enum material_kind */
};

/* What the section "scene" fills. */
struct schema_scene {
    int64_t psd;
};

size_t schema_section_count(void);
const struct schema_section *schema_section(size_t index);

/* The section of that family and name, or NULL. */
const struct schema_section *schema_find(const char *family, const char *name);

/* The only section of a family. */
const struct schema_section *schema_only(const char *family);

/* The section's name, with its family where another section has the same: "sphere in lights". */
void schema_heading(const struct schema_section *section, char *text, size_t size);

struct param_table schema_table(const struct schema_section *section);
bool schema_is_required(const struct schema_row *row);

/* "number > 0", "list of 4 [x, y, z]", "name of a material", ... */
void schema_describe(const struct schema_row *row, char *text, size_t size);

#endif
