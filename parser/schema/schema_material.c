/* schema_material.c: the tables of materials, pigments and textures; see schema.h. */
#include "parser/schema/schema_rows.h"

static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
static const char *const encodings[] = {"auto", "srgb", "linear", NULL};
static const char *const interpolations[] = {"bilinear", "nearest", NULL};
static const char *const channels[] = {"rgb", "r", "g", "b", "a", NULL};

#define TEXTURE_ROWS(base)                                                                         \
    ROW(SCHEMA_FILE, "file", (base) + offsetof(struct texture_keys, file), PS_PARAM_STRING, "",    \
        "the picture", ANY),                                                                       \
        ROW(SCHEMA_LAYER, "layer", (base) + offsetof(struct texture_keys, layer), PS_PARAM_STRING, \
            "", "which layer of an OpenEXR file", ANY, .absent = "its picture"),                   \
        ROW(SCHEMA_VALUE, "wrap", (base) + offsetof(struct texture_keys, wrap), PS_PARAM_CHOICE,   \
            "", "what is outside of the picture", DEFAULT("repeat"), .param.choices = wraps),      \
        ROW(SCHEMA_VALUE, "encoding", (base) + offsetof(struct texture_keys, encoding),            \
            PS_PARAM_CHOICE, "", "what the file's numbers mean", DEFAULT("auto"),                  \
            .param.choices = encodings),                                                           \
        ROW(SCHEMA_VALUE, "interpolate", (base) + offsetof(struct texture_keys, interpolate),      \
            PS_PARAM_CHOICE, "", "what is between the picture's points", DEFAULT("bilinear"),      \
            .param.choices = interpolations)

#define PIGMENT(member) offsetof(struct pigment_keys, member)
#define PATTERN_PLACEMENT PLACEMENT_ROWS(PIGMENT(placement)), TRANSFORM_ROW
#define COLORS_ROW(help_)                                                                          \
    ROW(SCHEMA_COLORS, "colors", PIGMENT(colors), PS_PARAM_COLOR, "", help_, ANY, LENGTH(2, 2))

static const struct schema_row checker_rows[] = {
    COLORS_ROW("of the cubes in turn"),
    PATTERN_PLACEMENT,
};

static const struct schema_row gradient_rows[] = {
    COLORS_ROW("at the start and at the end"),
    VALUE(PS_VEC3(struct pigment_keys, axis, "[0, 1, 0]", "",
                  "the direction in which the colour changes, over a length of 1")),
    VALUE(PS_NUMBER(struct pigment_keys, turbulence, "0", 0, INFINITY, 0, "",
                    "how far noise displaces the pattern")),
    PATTERN_PLACEMENT,
};

static const struct schema_row noise_rows[] = {
    COLORS_ROW("where the noise is low and where it is high"),
    VALUE(PS_INT(struct pigment_keys, octaves, "4", 1, 16, "",
                 "levels of detail, each half as large as the one before")),
    VALUE(PS_NUMBER(struct pigment_keys, turbulence, "0", 0, INFINITY, 0, "",
                    "how far noise displaces the pattern")),
    PATTERN_PLACEMENT,
};

static const struct schema_row image_rows[] = {
    TEXTURE_ROWS(PIGMENT(texture)),
    ROW(SCHEMA_PAIR, "repeat", PIGMENT(repeat), PS_PARAM_NUMBER, "",
        "how often the picture stands side by side over the surface's u and v from 0 to 1", ANY,
        DEFAULT("1")),
    ROW(SCHEMA_PAIR, "offset", PIGMENT(offset), PS_PARAM_NUMBER, "",
        "displacement in u and v, in widths and heights of the picture", ANY, DEFAULT("0")),
    VALUE(PS_COLOR(struct pigment_keys, color, "1", -INFINITY, INFINITY, "",
                   "factor on the picture's colours")),
    VALUE(PS_CHOICE(struct pigment_keys, channel, "rgb", channels,
                    "which of the picture's numbers count")),
};

#define MATERIAL(member) offsetof(struct material_keys, material.member)
#define PIGMENT_ROW(name_, member_, range_, unit_, help_, ...)                                     \
    ROW(SCHEMA_PIGMENT, name_, MATERIAL(member_.colors[0]), PS_PARAM_COLOR, unit_, help_,          \
        .family = "pigments", range_, __VA_ARGS__)
#define SCALAR_ROW(name_, member_, unit_, help_, default_, ...)                                    \
    ROW(SCHEMA_SCALAR_PIGMENT, name_, MATERIAL(member_.colors[0]), PS_PARAM_COLOR, unit_, help_,   \
        .family = "pigments", DEFAULT(default_), __VA_ARGS__)
#define UNIT_RANGE .param.maximum = 1
#define UNLIMITED .param.maximum = INFINITY

/* A material is one of these. */
#define KIND(number) CHOICE(1, number), .demanded = true, .absent = "it is of another kind"
#define KIND_PART(form_, name_, number, help_)                                                     \
    ROW(form_, name_, 0, PS_PARAM_STRING, "", help_, ANY, .family = (name_), KIND(number))

static const struct schema_row material_rows[] = {
    PIGMENT_ROW("diffuse", color, UNIT_RANGE, "",
                "share of the light that the surface reflects diffusely", KIND(1)),
    PIGMENT_ROW("mirror", color, UNIT_RANGE, "",
                "share of the light that a perfect mirror reflects", KIND(2)),
    KIND_PART(SCHEMA_MAP, "metal", 3, "a mirror whose reflections can be rough"),
    KIND_PART(SCHEMA_MAP, "glossy", 4, "a diffuse surface under a clear coat"),
    KIND_PART(SCHEMA_MAP, "dielectric", 5, "the border of glass or water"),
    KIND_PART(SCHEMA_ITEMS, "mix", 6, "other materials, each with a share"),
    PIGMENT_ROW("emission", emission, UNLIMITED, "W/(m^2 sr)",
                "radiance that leaves the front of the surface", DEFAULT("0")),
    BOOL("emission_both", offsetof(struct material_keys, emission_both), "no",
         "whether the back shines too"),
    SCALAR_ROW("opacity", opacity, "", "below 1/2 there is a hole", "1", FROM_0_TO_1),
    SCALAR_ROW("bump", bump, "scene units", "height, which tilts the normals", "0", ANY),
    PART(SCHEMA_MAP, "normal_map", "normal_map", "none", "picture of normals in tangent space"),
};

static const struct schema_row metal_rows[] = {
    PIGMENT_ROW("color", color, UNIT_RANGE, "", "share of light from straight ahead that returns",
                .absent = NULL),
    SCALAR_ROW("roughness", roughness, "", "square root of alpha of the GGX distribution", "0",
               FROM_0_TO_1),
};

static const struct schema_row glossy_rows[] = {
    PIGMENT_ROW("diffuse", color, UNIT_RANGE, "",
                "share of the light below the coat that is reflected diffusely", .absent = NULL),
    PIGMENT_ROW("specular", specular, UNIT_RANGE, "",
                "share of light from straight ahead that the coat reflects", DEFAULT("0.04")),
    SCALAR_ROW("roughness", roughness, "", "square root of alpha of the GGX distribution", "0.2",
               FROM_0_TO_1),
};

static const struct schema_row dielectric_rows[] = {
    ROW(SCHEMA_VALUE, "ior", MATERIAL(ior), PS_PARAM_NUMBER, "",
        "index of refraction inside, relative to outside", .param.minimum = 0.1,
        .param.maximum = 10, DEFAULT("1.5")),
    ROW(SCHEMA_VALUE, "absorption", MATERIAL(absorption), PS_PARAM_COLOR, "1/scene unit",
        "light that gets lost on the way through, as exp(-absorption length)", FROM_0,
        DEFAULT("0")),
    PIGMENT_ROW("color", color, UNIT_RANGE, "", "share of what goes through the border that passes",
                DEFAULT("1")),
};

static const struct schema_row mix_rows[] = {
    ROW(SCHEMA_MATERIAL, "material", offsetof(struct component_keys, material), PS_PARAM_STRING, "",
        "a name in materials", ANY),
    ROW(SCHEMA_VALUE, "weight", offsetof(struct component_keys, weight), PS_PARAM_NUMBER, "",
        "its share; what is missing to 1 in all is black", .param.minimum = 0, .param.maximum = 1,
        .param.flags = PS_PARAM_OPEN_MIN),
};

static const struct schema_row normal_map_rows[] = {TEXTURE_ROWS(0)};

static const struct schema_section sections[] = {
    ONLY(material, "a surface; it is of exactly one kind"),
    SECTION(metal, "metal", MATERIAL_METAL, "a mirror whose reflections can be rough"),
    SECTION(glossy, "glossy", MATERIAL_GLOSSY, "a diffuse surface under a clear coat"),
    SECTION(dielectric, "dielectric", MATERIAL_DIELECTRIC, "the border of glass or water"),
    SECTION(mix, "mix", MATERIAL_MIX, "a material with its share of a mixed one"),
    ONLY(normal_map, "a picture of normals in tangent space"),
    SECTION(checker, "pigments", PIGMENT_CHECKER, "cubes of side 1 that take turns"),
    SECTION(gradient, "pigments", PIGMENT_GRADIENT, "a change over a length of 1, again and again"),
    SECTION(noise, "pigments", PIGMENT_NOISE, "clouds with features about 1 wide"),
    SECTION(image, "pigments", PIGMENT_IMAGE, "a picture on the surface's u and v"),
};

const struct schema_part schema_material_part = {sections, COUNT(sections)};
