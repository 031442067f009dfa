/* schema_rows.h: how the tables of the scene language (schema_*.c) are written. */
#ifndef PARSER_SCHEMA_SCHEMA_ROWS_H
#define PARSER_SCHEMA_SCHEMA_ROWS_H

#include "parser/schema/keys.h"
#include "parser/schema/schema.h"

/* The sections of one file. */
struct schema_part {
    const struct schema_section *sections;
    size_t count;
};

extern const struct schema_part schema_scene_part, schema_language_part, schema_placement_part,
    schema_material_part, schema_light_part, schema_object_part;

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* A row that a ps_param says all about. */
#define VALUE(...)                                                                                 \
    {                                                                                              \
        .param = __VA_ARGS__, .form = SCHEMA_VALUE                                                 \
    }

/* Any other row; what follows the help is a range, and other members. */
#define ROW(form_, name_, offset_, type_, unit_, help_, ...)                                       \
    {                                                                                              \
        .form = (form_), .param.name = (name_), .param.type = (type_), .param.offset = (offset_),  \
        .param.unit = (unit_), .param.help = (help_), __VA_ARGS__                                  \
    }

#define ANY .param.minimum = -INFINITY, .param.maximum = INFINITY
#define FROM_0 .param.minimum = 0, .param.maximum = INFINITY
#define ABOVE_0 FROM_0, .param.flags = PS_PARAM_OPEN_MIN
#define FROM_0_TO_1 .param.minimum = 0, .param.maximum = 1
#define DEFAULT(text) .param.default_value = (text)
#define LENGTH(fewest_, most_) .fewest = (fewest_), .most = (most_)

/* Excludes the rows of the same choice with other alternatives. */
#define CHOICE(choice_, alternative_) .choice = (choice_), .alternative = (alternative_)

/* A row whose value holds sections of a family. */
#define PART(form_, name_, family_, absent_, help_)                                                \
    ROW(form_, name_, 0, PS_PARAM_STRING, "", help_, ANY, .family = (family_), .absent = (absent_))

#define BOOL(name_, offset_, default_, help_)                                                      \
    ROW(SCHEMA_VALUE, name_, offset_, PS_PARAM_BOOL, "", help_, FROM_0_TO_1, DEFAULT(default_))

/* The transforms of objects and patterns; `base` is where their struct placement_keys is. */
#define PLACEMENT_ROWS(base)                                                                       \
    ROW(SCHEMA_SCALE, "scale", (base) + offsetof(struct placement_keys, scale), PS_PARAM_VEC3, "", \
        "factors along the axes, not 0; applied first", ANY, DEFAULT("[1, 1, 1]"), CHOICE(9, 1),   \
        .shared = "placement"),                                                                    \
        ROW(SCHEMA_VALUE, "rotate", (base) + offsetof(struct placement_keys, rotate),              \
            PS_PARAM_VEC3, "degrees", "rotation about x, then y, then z; applied second", ANY,     \
            DEFAULT("[0, 0, 0]"), CHOICE(9, 1), .shared = "placement"),                            \
        ROW(SCHEMA_VALUE, "translate", (base) + offsetof(struct placement_keys, translate),        \
            PS_PARAM_VEC3, "scene units", "displacement; applied last", ANY, DEFAULT("[0, 0, 0]"), \
            CHOICE(9, 1), .shared = "placement"),                                                  \
        ROW(SCHEMA_MATRIX, "matrix", (base) + offsetof(struct placement_keys, matrix),             \
            PS_PARAM_NUMBER, "", "rows of a 3x4 matrix, whose last column is the displacement",    \
            ANY, LENGTH(12, 12), CHOICE(9, 2), .shared = "placement",                              \
            .absent = "scale, rotate, translate"),                                                 \
        ROW(SCHEMA_MAP, "look_at", 0, PS_PARAM_STRING, "",                                         \
            "puts the origin somewhere, and turns the z axis to a point", ANY, CHOICE(9, 3),       \
            .family = "look_at", .shared = "placement", .absent = "scale, rotate, translate")

#define TRANSFORM_ROW                                                                              \
    ROW(SCHEMA_STEPS, "transform", 0, PS_PARAM_STRING, "", "transforms, applied in their order",   \
        ANY, CHOICE(9, 4), .family = "transform", .shared = "placement",                           \
        .absent = "scale, rotate, translate")

#define SECTION(name_, family_, kind_, summary_)                                                   \
    {                                                                                              \
        .name = #name_, .family = (family_), .summary = (summary_), .rows = name_##_rows,          \
        .row_count = COUNT(name_##_rows), .kind = (kind_)                                          \
    }

/* A section that is alone in its family. */
#define ONLY(name_, summary_) SECTION(name_, #name_, 0, summary_)

/* The same, where a word may stand for it. */
#define ONLY_OR_WORD(name_, word_, summary_)                                                       \
    {                                                                                              \
        .name = #name_, .family = #name_, .summary = (summary_), .word = (word_),                  \
        .rows = name_##_rows, .row_count = COUNT(name_##_rows)                                     \
    }

#endif
