/* schema.c: the tables of the scene language; see schema.h. */
#include "parser/schema.h"

#include "parser/schema_language.h"
#include "scene/description.h"
#include <stdio.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define LARGEST_SEED 9007199254740992.0 /* 2^53: any double counts up to it in ones */

/* A row that a ps_param says all about. */
#define VALUE(...)                                                                                 \
    {                                                                                              \
        .param = __VA_ARGS__, .form = SCHEMA_VALUE                                                 \
    }

/* A row whose key is not the name of the member that it fills, or whose form is another. */
#define FORM(form_, name_, offset_, type_, default_, absent_, fewest_, most_, unit_, help_)        \
    {                                                                                              \
        .param = {.name = (name_),                                                                 \
                  .type = (type_),                                                                 \
                  .offset = (offset_),                                                             \
                  .default_value = (default_),                                                     \
                  .minimum = -INFINITY,                                                            \
                  .maximum = INFINITY,                                                             \
                  .unit = (unit_),                                                                 \
                  .help = (help_)},                                                                \
        .form = (form_), .absent = (absent_), .fewest = (fewest_), .most = (most_)                 \
    }

#define PART(form_, name_, absent_, help_)                                                         \
    FORM(form_, name_, 0, PS_PARAM_STRING, NULL, absent_, 0, 0, "", help_)

static const struct schema_row scene_rows[] = {
    VALUE(PS_INT(struct schema_scene, psd, NULL, 1, 1, "",
                 "version of the format that the file is written in")),
    SCHEMA_OTHER_ROW("include", "path of a file, or list of them", "none",
                     "files that belong to the scene"),
    PART(SCHEMA_NAMED, "parameters", "none", "names for formulas that the command line can set"),
    SCHEMA_OTHER_ROW("define", "map of values by name", "none", "names for formulas"),
    PART(SCHEMA_MAP, "camera", NULL, "from where the scene is seen"),
    PART(SCHEMA_MAP, "image", "its defaults", "size and exposure of the picture"),
    PART(SCHEMA_NAMED, "materials", "none", "surfaces, by names that objects refer to"),
    PART(SCHEMA_LIST, "lights", "none", "what shines"),
    PART(SCHEMA_LIST, "objects", "none", "what is lit"),
    PART(SCHEMA_MAP, "render", "its defaults", "settings, which the command line overrides"),
};

static const struct schema_row camera_rows[] = {
    VALUE(PS_VEC3(struct camera_description, location, NULL, "scene units", "where the camera is")),
    VALUE(PS_VEC3(struct camera_description, look_at, NULL, "scene units",
                  "the point in the middle of the picture")),
    VALUE(PS_VEC3(struct camera_description, up, "[0, 1, 0]", "",
                  "the direction that points upwards in the picture")),
    {.param = PS_NUMBER(struct camera_description, angle, NULL, 0, 180,
                        PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX, "degrees",
                        "horizontal field of view; excludes vertical_angle"),
     .absent = "67.38, unless vertical_angle is given"},
    {.param = PS_NUMBER(struct camera_description, vertical_angle, NULL, 0, 180,
                        PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX, "degrees",
                        "vertical field of view; excludes angle"),
     .absent = "follows from angle"},
};

static const struct schema_row image_rows[] = {
    VALUE(
        PS_INT(struct image_description, width, "800", 1, 65536, "pixels", "width of the picture")),
    VALUE(PS_INT(struct image_description, height, "450", 1, 65536, "pixels",
                 "height of the picture")),
    VALUE(PS_NUMBER(struct image_description, exposure, "0", -20, 20, 0, "stops",
                    "brightness of the PNG preview: each stop doubles it")),
};

static const struct schema_row material_rows[] = {
    {.param = {.name = "diffuse",
               .type = PS_PARAM_COLOR,
               .offset = offsetof(struct material_description, color.colors[0]),
               .maximum = 1,
               .unit = "",
               .help = "share of the light that the surface reflects diffusely"},
     .form = SCHEMA_VALUE},
};

#define LOCATION_ROW                                                                               \
    VALUE(PS_VEC3(struct light_description, location, NULL, "scene units", "where the light is"))
#define INTENSITY_ROW                                                                              \
    {                                                                                              \
        .param = {.name = "intensity",                                                             \
                  .type = PS_PARAM_COLOR,                                                          \
                  .offset = offsetof(struct light_description, amount),                            \
                  .maximum = INFINITY,                                                             \
                  .unit = "W/sr",                                                                  \
                  .help = "power that is sent into a unit of solid angle"},                        \
        .form = SCHEMA_VALUE                                                                       \
    }

static const struct schema_row point_rows[] = {LOCATION_ROW, INTENSITY_ROW};

static const struct schema_row spotlight_rows[] = {
    LOCATION_ROW,
    VALUE(PS_VEC3(struct light_description, point_at, NULL, "scene units",
                  "the point that the light is aimed at")),
    VALUE(PS_NUMBER(struct light_description, radius, "30", 0, 90, PS_PARAM_OPEN_MIN, "degrees",
                    "half angle of the cone of full intensity; at most falloff")),
    VALUE(PS_NUMBER(struct light_description, falloff, "45", 0, 90, PS_PARAM_OPEN_MIN, "degrees",
                    "half angle of the cone outside of which there is no light")),
    INTENSITY_ROW,
};

#define OBJECT_OFFSET(member) offsetof(struct object_description, member)
#define MATERIAL_ROW                                                                               \
    FORM(SCHEMA_MATERIAL, "material", OBJECT_OFFSET(material), PS_PARAM_STRING, NULL, NULL, 0, 0,  \
         "", "the surface, a name in materials")
#define TRANSFORM_ROWS                                                                             \
    FORM(SCHEMA_SCALE, "scale", OBJECT_OFFSET(transform.scale), PS_PARAM_VEC3, "[1, 1, 1]", NULL,  \
         0, 0, "", "factors along the axes, not 0; applied first"),                                \
        FORM(SCHEMA_VALUE, "rotate", OBJECT_OFFSET(transform.rotate), PS_PARAM_VEC3, "[0, 0, 0]",  \
             NULL, 0, 0, "degrees", "rotation about x, then y, then z; applied second"),           \
        FORM(SCHEMA_VALUE, "translate", OBJECT_OFFSET(transform.translate), PS_PARAM_VEC3,         \
             "[0, 0, 0]", NULL, 0, 0, "scene units", "displacement; applied last")
#define POINTS_ROW(name_, fewest_, most_, help_)                                                   \
    FORM(SCHEMA_POINTS, name_, OBJECT_OFFSET(vertices), PS_PARAM_VEC3, NULL, NULL, fewest_, most_, \
         "scene units", help_)

static const struct schema_row quad_rows[] = {
    POINTS_ROW("corners", 4, 4, "the corners, in order around the quadrilateral"),
    MATERIAL_ROW,
    TRANSFORM_ROWS,
};

static const struct schema_row box_rows[] = {
    POINTS_ROW("corners", 2, 2, "two opposite corners of a box along the axes"),
    MATERIAL_ROW,
    TRANSFORM_ROWS,
};

static const struct schema_row triangles_rows[] = {
    POINTS_ROW("vertices", 3, SIZE_MAX, "points that triangles refer to"),
    FORM(SCHEMA_TRIANGLES, "triangles", OBJECT_OFFSET(triangles), PS_PARAM_INT, NULL, NULL, 1,
         SIZE_MAX, "", "three vertices each, counted from 0"),
    MATERIAL_ROW,
    TRANSFORM_ROWS,
};

static const struct schema_row sphere_rows[] = {
    VALUE(PS_VEC3(struct object_description, center, NULL, "scene units",
                  "the middle of the sphere")),
    VALUE(PS_NUMBER(struct object_description, radius, NULL, 0, INFINITY, PS_PARAM_OPEN_MIN,
                    "scene units", "radius of the sphere")),
    MATERIAL_ROW,
    TRANSFORM_ROWS,
};

#define STRATEGY_ROW(kind_, name_, help_)                                                          \
    FORM(SCHEMA_STRATEGY, name_, offsetof(struct render_description, strategies[kind_]),           \
         PS_PARAM_STRING, NULL, "psplat's default", 0, 0, "", help_)

static const struct schema_row render_rows[] = {
    STRATEGY_ROW(0, "injection", "plugin that makes indirect light sources"),
    STRATEGY_ROW(1, "stratification", "plugin that merges neighbouring sources"),
    STRATEGY_ROW(2, "visibility", "plugin that decides what a source lights"),
    STRATEGY_ROW(3, "filter", "plugin that weighs a splat by distance from its axis"),
    STRATEGY_ROW(4, "estimator", "plugin that turns sources into light on the picture"),
    STRATEGY_ROW(5, "normalization", "plugin that turns what was gathered into radiance"),
    STRATEGY_ROW(6, "denoiser", "plugin that smooths the indirect light"),
    VALUE(PS_INT(struct render_description, passes, "1", 1, 1e6, "",
                 "how many independent passes are added up")),
    VALUE(PS_INT(struct render_description, seed, "0", 0, LARGEST_SEED, "",
                 "start of the random numbers")),
    VALUE(PS_NUMBER(struct render_description, indirect_exposure, "1", 0, INFINITY, 0, "",
                    "factor on the indirect light when it joins the direct light")),
    VALUE(PS_COLOR(struct render_description, ambient, "0", 0, INFINITY, "W/(m^2 sr)",
                   "radiance of pixels that no indirect light reached")),
};

#define SECTION(name_, parent_, kind_, summary_)                                                   \
    {                                                                                              \
        .name = #name_, .parent = (parent_), .summary = (summary_), .rows = name_##_rows,          \
        .row_count = COUNT(name_##_rows), .kind = (kind_)                                          \
    }

static const struct schema_section sections[] = {
    SECTION(scene, NULL, 0, "the whole file"),
    SECTION(camera, NULL, 0, "a perspective camera"),
    SECTION(image, NULL, 0, "size and exposure of the picture"),
    SECTION(material, "materials", 0, "a surface that reflects diffusely"),
    SECTION(point, "lights", LIGHT_POINT, "a light that shines equally in all directions"),
    SECTION(spotlight, "lights", LIGHT_SPOT, "a light that shines into a cone"),
    SECTION(quad, "objects", OBJECT_QUAD, "a quadrilateral"),
    SECTION(box, "objects", OBJECT_BOX, "a box along the axes, before it is transformed"),
    SECTION(triangles, "objects", OBJECT_TRIANGLES, "a triangle mesh"),
    SECTION(sphere, "objects", OBJECT_SPHERE, "a sphere"),
    SECTION(render, NULL, 0, "how the picture is made"),
};

size_t schema_section_count(void)
{
    return COUNT(sections) + schema_language_count;
}

const struct schema_section *schema_section(size_t index)
{
    return index < COUNT(sections) ? &sections[index] : &schema_language[index - COUNT(sections)];
}

const struct schema_section *schema_find(const char *parent, const char *name)
{
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        bool same_parent = parent && section->parent ? strcmp(parent, section->parent) == 0
                                                     : !parent && !section->parent;
        if (same_parent && strcmp(name, section->name) == 0)
            return section;
    }
    return NULL;
}

struct param_table schema_table(const struct schema_section *section)
{
    return (struct param_table){.rows = &section->rows[0].param,
                                .count = section->row_count,
                                .stride = sizeof section->rows[0]};
}

bool schema_is_required(const struct schema_row *row)
{
    return !row->param.default_value && !row->absent;
}

static void describe_list(const struct schema_row *row, const char *item, char *text, size_t size)
{
    if (row->fewest == row->most)
        snprintf(text, size, "list of %zu %s", row->fewest, item);
    else
        snprintf(text, size, "list of %zu or more %s", row->fewest, item);
}

void schema_describe(const struct schema_row *row, char *text, size_t size)
{
    switch (row->form) {
    case SCHEMA_VALUE:
        param_describe_domain(&row->param, text, size);
        break;
    case SCHEMA_SCALE:
        snprintf(text, size, "[x, y, z] or one number");
        break;
    case SCHEMA_POINTS:
        describe_list(row, "[x, y, z]", text, size);
        break;
    case SCHEMA_TRIANGLES:
        describe_list(row, "[i, j, k]", text, size);
        break;
    case SCHEMA_MATERIAL:
        snprintf(text, size, "name of a material");
        break;
    case SCHEMA_STRATEGY:
        snprintf(text, size, "NAME or {NAME: {PARAMETER: VALUE, ...}}");
        break;
    case SCHEMA_MAP:
        snprintf(text, size, "map");
        break;
    case SCHEMA_NAMED:
        snprintf(text, size, "map of maps by name");
        break;
    case SCHEMA_LIST:
        snprintf(text, size, "list of maps of one key each");
        break;
    case SCHEMA_OTHER:
        snprintf(text, size, "%s", row->domain);
        break;
    }
}
