/* version.c: see version.h.
 *
 * Words that one version alone has: directives, kinds, names of parameters, and bools without
 * quotes.
 */
#include "pbrt/version.h"

#include "pbrt/lexer.h"
#include <string.h>

static const char *const words_3[] = {
    /* film and samplers */
    "image",
    "02sequence",
    "lowdiscrepancy",
    "random",
    "maxmindist",
    /* integrators */
    "directlighting",
    "whitted",
    /* materials and their parameters */
    "matte",
    "plastic",
    "metal",
    "glass",
    "mirror",
    "substrate",
    "uber",
    "translucent",
    "disney",
    "fourier",
    "kdsubsurface",
    "color Kd",
    "rgb Kd",
    "texture Kd",
    "spectrum Kd",
    "color Ks",
    "rgb Ks",
    "color L",
    "color I",
    "color value",
    "string mapname",
    "string namedmaterial1",
    "texture bumpmap",
    "point from",
    "point to",
};

static const char *const words_4[] = {
    "Attribute",
    "Option",
    "ColorSpace",
    "Import",
    "true",
    "false",
    /* film, samplers and integrators */
    "gbuffer",
    "spectral",
    "zsobol",
    "paddedsobol",
    "pmj02bn",
    "independent",
    "volpath",
    "simplepath",
    "lightpath",
    "simplevolpath",
    "randomwalk",
    "function",
    /* shapes, materials and their parameters */
    "bilinearmesh",
    "diffuse",
    "coateddiffuse",
    "conductor",
    "coatedconductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "interface",
    "measured",
    "rgb reflectance",
    "texture reflectance",
    "spectrum reflectance",
    "string normalmap",
    "texture displacement",
    "float power",
    "float illuminance",
    "string materials",
    "point3 from",
    "point3 to",
    "point3 P",
    "vector3 N",
    "point2 uv",
};

static bool holds(const char *const *words, size_t count, const char *word)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], word) == 0)
            return true;
    return false;
}

int version_guess(const char *text, size_t length)
{
    struct lexer lexer = lexer_start("", text, length);
    int version = 0;
    /* pbrt-v4's area lights are "diffuse" in both, and its film is "rgb" as a type is in both. */
    bool after_area_light = false, after_film = false;
    while (version == 0) {
        struct token token = lexer_next(&lexer);
        if (token.kind == TOKEN_END || token.kind == TOKEN_BAD)
            break;
        bool is_text = token.kind == TOKEN_STRING || token.kind == TOKEN_WORD;
        if (is_text && after_film)
            version = strcmp(token.text, "rgb") == 0 ? 4 : strcmp(token.text, "image") == 0 ? 3 : 0;
        if (is_text && !after_area_light && version == 0)
            version = holds(words_4, sizeof words_4 / sizeof words_4[0], token.text)   ? 4
                      : holds(words_3, sizeof words_3 / sizeof words_3[0], token.text) ? 3
                                                                                       : 0;
        after_area_light = token.kind == TOKEN_WORD && strcmp(token.text, "AreaLightSource") == 0;
        after_film = token.kind == TOKEN_WORD && strcmp(token.text, "Film") == 0;
    }
    lexer_release(&lexer);
    return version;
}
