/* schema_placement.c: the tables of transforms; see schema.h. */
#include "parser/schema_rows.h"

static const struct schema_row placement_rows[] = {PLACEMENT_ROWS(0), TRANSFORM_ROW};

static const struct schema_row transform_rows[] = {PLACEMENT_ROWS(0)};

static const struct schema_row look_at_rows[] = {
    VALUE(PS_VEC3(struct look_at_keys, from, NULL, "scene units", "where the origin goes")),
    VALUE(PS_VEC3(struct look_at_keys, to, NULL, "scene units",
                  "the point that the positive z axis goes through")),
    VALUE(PS_VEC3(struct look_at_keys, up, "[0, 1, 0]", "",
                  "the direction that the y axis leans to")),
};

static const struct schema_section sections[] = {
    ONLY(placement, "where something stands: keys of all objects and patterns"),
    ONLY(transform, "one step of several transforms; it has one of these keys"),
    ONLY(look_at, "a placement by two points"),
};

const struct schema_part schema_placement_part = {sections, COUNT(sections)};
