/* schema_light.c: the tables of lights; see schema.h. */
#include "parser/schema/schema_rows.h"

#define LIGHT(member) offsetof(struct light_keys, light.member)

#define LOCATION_ROW(help_)                                                                        \
    ROW(SCHEMA_VALUE, "location", LIGHT(location), PS_PARAM_VEC3, "scene units", help_, ANY)
#define DIRECTION_ROW(help_)                                                                       \
    ROW(SCHEMA_VALUE, "direction", LIGHT(direction), PS_PARAM_VEC3, "", help_, ANY)
#define RADIUS_ROW(help_)                                                                          \
    ROW(SCHEMA_VALUE, "radius", LIGHT(radius), PS_PARAM_NUMBER, "scene units", help_, ABOVE_0)

/* A light has one of the units that fit it. */
#define AMOUNT_ROW(member, alternative, unit_, absent_, help_)                                     \
    ROW(SCHEMA_VALUE, #member, offsetof(struct light_keys, member), PS_PARAM_COLOR, unit_, help_,  \
        FROM_0, CHOICE(1, alternative), .demanded = true, .absent = absent_ " is given")
#define INTENSITY_ROW                                                                              \
    AMOUNT_ROW(intensity, 1, "W/sr", "power", "power that is sent into a unit of solid angle")
#define POWER_ROW(other) AMOUNT_ROW(power, 2, "W", other, "what the light sends out in all")
#define RADIANCE_ROW(other)                                                                        \
    AMOUNT_ROW(radiance, 3, "W/(m^2 sr)", other, "how bright the light looks")

#define SIDES_ROW                                                                                  \
    BOOL("both_sides", offsetof(struct light_keys, both_sides), "no", "whether the back shines too")
#define VISIBLE_ROW                                                                                \
    BOOL("visible", offsetof(struct light_keys, visible), "yes", "whether the camera sees it")

static const struct schema_row point_rows[] = {
    LOCATION_ROW("where the light is"),
    INTENSITY_ROW,
    POWER_ROW("intensity"),
};

static const struct schema_row spotlight_rows[] = {
    LOCATION_ROW("where the light is"),
    ROW(SCHEMA_VALUE, "point_at", LIGHT(point_at), PS_PARAM_VEC3, "scene units",
        "the point that the light is aimed at", ANY),
    ROW(SCHEMA_VALUE, "radius", LIGHT(radius), PS_PARAM_NUMBER, "degrees",
        "half angle of the cone of full intensity; at most falloff", .param.minimum = 0,
        .param.maximum = 90, .param.flags = PS_PARAM_OPEN_MIN, DEFAULT("30")),
    ROW(SCHEMA_VALUE, "falloff", LIGHT(falloff), PS_PARAM_NUMBER, "degrees",
        "half angle of the cone outside of which there is no light", .param.minimum = 0,
        .param.maximum = 90, .param.flags = PS_PARAM_OPEN_MIN, DEFAULT("45")),
    ROW(SCHEMA_VALUE, "tightness", LIGHT(tightness), PS_PARAM_NUMBER, "",
        "exponent of the cosine to the axis, which dims what is off it", FROM_0, DEFAULT("0")),
    INTENSITY_ROW,
    POWER_ROW("intensity"),
};

static const struct schema_row sun_rows[] = {
    DIRECTION_ROW("in which the light travels"),
    ROW(SCHEMA_VALUE, "angle", LIGHT(angle), PS_PARAM_NUMBER, "degrees",
        "diameter in the sky; 0: a point", .param.minimum = 0, .param.maximum = 180,
        DEFAULT("0.53")),
    AMOUNT_ROW(irradiance, 4, "W/m^2", "radiance", "power on a unit of area across the light"),
    RADIANCE_ROW("irradiance"),
};

static const struct schema_row rectangle_rows[] = {
    ROW(SCHEMA_POINTS, "corners", offsetof(struct light_keys, corners), PS_PARAM_VEC3,
        "scene units", "in order around, counter-clockwise seen from where it shines", ANY,
        LENGTH(3, 4)),
    POWER_ROW("radiance"),
    RADIANCE_ROW("power"),
    SIDES_ROW,
    VISIBLE_ROW,
};

static const struct schema_row disc_rows[] = {
    LOCATION_ROW("the middle of the disc"),
    DIRECTION_ROW("to which it shines, across the disc"),
    RADIUS_ROW("radius of the disc"),
    POWER_ROW("radiance"),
    RADIANCE_ROW("power"),
    SIDES_ROW,
    VISIBLE_ROW,
};

static const struct schema_row sphere_rows[] = {
    LOCATION_ROW("the middle of the sphere"),
    RADIUS_ROW("radius of the sphere"),
    POWER_ROW("radiance"),
    RADIANCE_ROW("power"),
    VISIBLE_ROW,
};

static const struct schema_row sky_rows[] = {
    ROW(SCHEMA_VALUE, "radiance", offsetof(struct light_keys, radiance), PS_PARAM_COLOR,
        "W/(m^2 sr)", "of the sky, or a factor on the file's", FROM_0,
        .absent = "1 where a file is given"),
    ROW(SCHEMA_FILE, "file", offsetof(struct light_keys, file), PS_PARAM_STRING, "",
        "picture of the sky by longitude and latitude", ANY, .absent = "the sky is uniform"),
    ROW(SCHEMA_LAYER, "layer", offsetof(struct light_keys, layer), PS_PARAM_STRING, "",
        "which layer of an OpenEXR file", ANY, .absent = "its picture"),
    ROW(SCHEMA_VALUE, "rotate", LIGHT(rotate), PS_PARAM_NUMBER, "degrees",
        "turn of the picture about y", ANY, DEFAULT("0")),
    VISIBLE_ROW,
};

static const struct schema_section sections[] = {
    SECTION(point, "lights", LIGHT_POINT, "a light that shines equally in all directions"),
    SECTION(spotlight, "lights", LIGHT_SPOT, "a light that shines into a cone"),
    SECTION(sun, "lights", LIGHT_SUN, "a light from so far away that its rays are parallel"),
    SECTION(rectangle, "lights", LIGHT_RECTANGLE, "a rectangle that shines"),
    SECTION(disc, "lights", LIGHT_DISC, "a disc that shines"),
    SECTION(sphere, "lights", LIGHT_SPHERE, "a sphere that shines"),
    SECTION(sky, "lights", LIGHT_SKY, "light from all around"),
};

const struct schema_part schema_light_part = {sections, COUNT(sections)};
