/* schema_object.c: the tables of objects and their transforms; see schema.h. */
#include "parser/schema/schema_rows.h"

#define KEYS(member) offsetof(struct object_keys, member)
#define OBJECT(member) KEYS(object.member)

static const char *const seen_sides[] = {"both", "front", NULL};

#define PLACED_ROWS                                                                                \
    BOOL("camera", KEYS(camera), "yes", "whether the camera sees it; the light always does"),      \
        VALUE(PS_CHOICE(struct object_keys, sides, "both", seen_sides,                             \
                        "from which sides the camera sees it; light meets both")),                 \
        PLACEMENT_ROWS(KEYS(placement)), TRANSFORM_ROW

/* What all shapes have. */
#define SHAPE_ROWS                                                                                 \
    ROW(SCHEMA_MATERIAL, "material", OBJECT(material), PS_PARAM_STRING, "",                        \
        "the surface, a name in materials", ANY),                                                  \
        PLACED_ROWS

#define OVERRIDE_ROW(absent_)                                                                      \
    ROW(SCHEMA_MATERIAL, "material", OBJECT(material), PS_PARAM_STRING, "",                        \
        "the surface of all of it, a name in materials", ANY, .absent = (absent_))

#define POINT_ROW(name_, member, help_)                                                            \
    ROW(SCHEMA_VALUE, name_, OBJECT(member), PS_PARAM_VEC3, "scene units", help_, ANY)
#define DIRECTION_ROW(name_, member, help_)                                                        \
    ROW(SCHEMA_VALUE, name_, OBJECT(member), PS_PARAM_VEC3, "", help_, ANY)
#define LENGTH_ROW(name_, member, help_, ...)                                                      \
    ROW(SCHEMA_VALUE, name_, OBJECT(member), PS_PARAM_NUMBER, "scene units", help_, __VA_ARGS__)
#define SEGMENTS_ROW                                                                               \
    ROW(SCHEMA_VALUE, "segments", OBJECT(segments), PS_PARAM_INT, "",                              \
        "flat pieces that it is made of, around", .param.minimum = 3, .param.maximum = 8192,       \
        DEFAULT("64"))
#define OPEN_ROW BOOL("open", KEYS(open), "no", "whether its ends are left out")
#define CORNERS_ROW(count_, help_)                                                                 \
    ROW(SCHEMA_POINTS, "corners", KEYS(vertices), PS_PARAM_VEC3, "scene units", help_, ANY,        \
        LENGTH(count_, count_))

static const struct schema_row quad_rows[] = {
    CORNERS_ROW(4, "the corners, in order around the quadrilateral"),
    SHAPE_ROWS,
};

static const struct schema_row box_rows[] = {
    CORNERS_ROW(2, "two opposite corners of a box along the axes"),
    SHAPE_ROWS,
};

static const struct schema_row triangles_rows[] = {
    ROW(SCHEMA_POINTS, "vertices", KEYS(vertices), PS_PARAM_VEC3, "scene units",
        "points that triangles refer to", ANY, LENGTH(3, SIZE_MAX)),
    ROW(SCHEMA_TRIANGLES, "triangles", KEYS(triangles), PS_PARAM_INT, "",
        "three vertices each, counted from 0", ANY, LENGTH(1, SIZE_MAX)),
    ROW(SCHEMA_POINTS, "normals", KEYS(normals), PS_PARAM_VEC3, "",
        "of the vertices, for a smooth look", ANY, LENGTH(3, SIZE_MAX),
        .absent = "the triangles are flat"),
    ROW(SCHEMA_PAIRS, "uv", KEYS(uv), PS_PARAM_NUMBER, "",
        "of the vertices, for pictures; v runs upwards", ANY, LENGTH(3, SIZE_MAX),
        .absent = "u and v are 0"),
    SHAPE_ROWS,
};

static const struct schema_row sphere_rows[] = {
    POINT_ROW("center", center, "the middle of the sphere"),
    LENGTH_ROW("radius", radius, "radius of the sphere", ABOVE_0),
    SHAPE_ROWS,
};

static const struct schema_row cylinder_rows[] = {
    POINT_ROW("from", points[0], "the middle of one end"),
    POINT_ROW("to", points[1], "the middle of the other end"),
    LENGTH_ROW("radius", radius, "radius of the cylinder", ABOVE_0),
    OPEN_ROW,
    SEGMENTS_ROW,
    SHAPE_ROWS,
};

static const struct schema_row cone_rows[] = {
    POINT_ROW("from", points[0], "the middle of one end"),
    LENGTH_ROW("from_radius", radius, "radius there; 0: a tip", FROM_0),
    POINT_ROW("to", points[1], "the middle of the other end"),
    LENGTH_ROW("to_radius", to_radius, "radius there; 0: a tip", FROM_0),
    OPEN_ROW,
    SEGMENTS_ROW,
    SHAPE_ROWS,
};

static const struct schema_row disc_rows[] = {
    POINT_ROW("center", center, "the middle of the disc"),
    DIRECTION_ROW("normal", normal, "direction across the disc, on its front"),
    LENGTH_ROW("radius", radius, "radius of the disc", ABOVE_0),
    LENGTH_ROW("hole", hole_radius, "radius of the hole in it", FROM_0, DEFAULT("0")),
    SEGMENTS_ROW,
    SHAPE_ROWS,
};

static const char *const automatic[] = {AUTO_WORD, NULL};

static const struct schema_row plane_rows[] = {
    DIRECTION_ROW("normal", normal, "direction across the plane, on its front"),
    VALUE(PS_NUMBER_OR(struct object_keys, distance, "0", -INFINITY, INFINITY, 0, automatic,
                       "scene units",
                       "from the origin, along the normal; auto: just below all else")),
    VALUE(PS_NUMBER_OR(struct object_keys, extent, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN,
                       automatic, "scene units",
                       "half of its side; auto: as far as the scene needs")),
    SHAPE_ROWS,
};

static const struct schema_row torus_rows[] = {
    LENGTH_ROW("radius", radius, "from the middle of the torus to that of its tube", ABOVE_0),
    LENGTH_ROW("minor_radius", minor_radius, "radius of the tube", ABOVE_0),
    SEGMENTS_ROW,
    SHAPE_ROWS,
};

static const struct schema_row height_field_rows[] = {
    ROW(SCHEMA_FILE, "file", KEYS(file), PS_PARAM_STRING, "", "picture whose brightness is height",
        ANY),
    BOOL("smooth", KEYS(smooth), "yes", "whether its normals hide its triangles"),
    SHAPE_ROWS,
};

static const char *const mesh_parts[] = {"geometry", "materials", "camera", "lights", NULL};
static const char *const mtl_colors[] = {"linear", "srgb", NULL};
static const char *const axes[] = {"x", "y", "z", NULL};

static const struct schema_row mesh_rows[] = {
    ROW(SCHEMA_FILE, "file", KEYS(file), PS_PARAM_STRING, "", "the mesh: glTF, OBJ, PLY, ...", ANY),
    ROW(SCHEMA_WORDS, "use", KEYS(use), PS_PARAM_STRING, "", "what is taken from the file",
        LENGTH(1, 4), DEFAULT("[geometry, materials]"), .param.choices = mesh_parts),
    VALUE(PS_NUMBER(struct object_keys, unit, "1", 0, INFINITY, PS_PARAM_OPEN_MIN, "scene units",
                    "length of the file's unit")),
    VALUE(PS_CHOICE(struct object_keys, up, "y", axes, "which axis of the file points upwards")),
    OVERRIDE_ROW("those of the file"),
    ROW(SCHEMA_MATERIALS, "materials", KEYS(materials), PS_PARAM_STRING, "",
        "surfaces for some of the file's materials, by their names there", ANY, .absent = "none"),
    BOOL("diffuse_only", KEYS(diffuse_only), "no",
         "whether the gloss of the file's materials is left out"),
    VALUE(PS_CHOICE(struct object_keys, colors, "linear", mtl_colors,
                    "what numbers for reflectance in MTL mean")),
    VALUE(PS_NUMBER(struct object_keys, bump_scale, "1", 0, INFINITY, 0, "",
                    "factor on the heights of MTL's bump maps; 0: none")),
    VALUE(PS_NUMBER(struct object_keys, smooth_angle, "0", 0, 180, 0, "degrees",
                    "edges up to which parts without normals are smooth; 0: they are flat")),
    PLACED_ROWS,
};

static const struct schema_row group_rows[] = {
    PART(SCHEMA_LIST, "objects", "objects", NULL, "what is placed together"),
    PLACED_ROWS,
};

static const struct schema_row instance_rows[] = {
    ROW(SCHEMA_GROUP, "of", KEYS(of), PS_PARAM_STRING, "", "a name in groups", ANY),
    OVERRIDE_ROW("those of the group's objects"),
    PLACED_ROWS,
};

static const struct schema_section sections[] = {
    SECTION(quad, "objects", OBJECT_QUAD, "a quadrilateral"),
    SECTION(box, "objects", OBJECT_BOX, "a box along the axes, before it is transformed"),
    SECTION(triangles, "objects", OBJECT_TRIANGLES, "a triangle mesh"),
    SECTION(sphere, "objects", OBJECT_SPHERE, "a sphere"),
    SECTION(cylinder, "objects", OBJECT_CYLINDER, "a cylinder"),
    SECTION(cone, "objects", OBJECT_CONE, "a cone, or a part of one"),
    SECTION(disc, "objects", OBJECT_DISC, "a disc"),
    SECTION(plane, "objects", OBJECT_PLANE, "a large square"),
    SECTION(torus, "objects", OBJECT_TORUS, "a ring about the y axis"),
    SECTION(height_field, "objects", OBJECT_HEIGHT_FIELD, "a landscape from a picture"),
    SECTION(mesh, "objects", KEYS_MESH_FILE, "what a mesh file holds"),
    SECTION(group, "objects", KEYS_GROUP, "objects that are transformed together"),
    SECTION(instance, "objects", KEYS_INSTANCE, "a group that has a name, placed once more"),
};

const struct schema_part schema_object_part = {sections, COUNT(sections)};

/* --- transforms ------------------------------------------------------------------------------ */

static const struct schema_row placement_rows[] = {PLACEMENT_ROWS(0), TRANSFORM_ROW};

static const struct schema_row transform_rows[] = {PLACEMENT_ROWS(0)};

static const struct schema_row look_at_rows[] = {
    VALUE(PS_VEC3(struct look_at_keys, from, NULL, "scene units", "where the origin goes")),
    VALUE(PS_VEC3(struct look_at_keys, to, NULL, "scene units",
                  "the point that the positive z axis goes through")),
    VALUE(PS_VEC3(struct look_at_keys, up, "[0, 1, 0]", "",
                  "the direction that the y axis leans to")),
};

static const struct schema_section placement_sections[] = {
    ONLY(placement, "where something stands: keys of all objects and patterns"),
    ONLY(transform, "one step of several transforms; it has one of these keys"),
    ONLY(look_at, "a placement by two points"),
};

const struct schema_part schema_placement_part = {placement_sections, COUNT(placement_sections)};
