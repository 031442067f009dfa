/* texture.h: pbrt's textures as psplat's patterns.
 *
 * A texture becomes one pattern where it is defined. Patterns can be multiplied by colours, but not
 * by each other: what combines several that vary keeps the one that counts most, with a warning.
 */
#ifndef PBRT_TEXTURE_H
#define PBRT_TEXTURE_H

#include "pbrt/importer.h"

enum pattern_kind {
    PATTERN_CONSTANT,
    PATTERN_IMAGE,
    PATTERN_CHECKER,
    PATTERN_NOISE,
    PATTERN_GRADIENT
};

struct pattern {
    enum pattern_kind kind;
    double colors[2][3];         /* linear; the first of a constant, and the factor on an image */
    const char *file;            /* as the scene names it; the importer's */
    const char *wrap, *encoding; /* psd(5)'s words; NULL: its default */
    bool nearest;
    double repeat[2], offset[2]; /* of u and v */
    struct transform placement;  /* pattern to scene */
    long octaves;
    double turbulence;
};

/* Whether all three are that. */
bool color_is(const double rgb[3], double value);

struct pattern pattern_constant(const double rgb[3]);
void pattern_multiply(struct pattern *pattern, const double rgb[3]);
/* Colours on average; of images, which are not looked at, half of the factor. */
void pattern_mean(const struct pattern *pattern, double rgb[3]);
bool pattern_is_constant(const struct pattern *pattern);
/* Whether it is black all over. */
bool pattern_is_black(const struct pattern *pattern);

/* Limits the colours to 0..most, and says so where that changes one. */
void pattern_clamp(struct importer *importer, const struct place *place, const char *what,
                   double most, struct pattern *pattern);

/* Writes the pattern as a value of psd(5); as a number where `is_number`. */
void put_pattern(FILE *out, const struct pattern *pattern, bool is_number);

/* Adds what a statement `Texture "NAME" "TYPE" "CLASS" ...` defines. */
void texture_define(struct importer *importer, const struct statement *statement, const char *name,
                    const char *type);

/* The parameter of that name: a texture's name, a number, or a spectrum; `otherwise` where it is
 * absent. Returns whether it is there. Errors are reported. */
bool texture_parameter(struct importer *importer, const struct statement *statement,
                       const char *name, const double otherwise[3], struct pattern *pattern);

/* An image of the file that the scene names, by u and v. */
struct pattern texture_image(struct importer *importer, const struct place *place,
                             const char *name);

/* Of a texture statement of the class imagemap. */
struct pattern texture_image_map(struct importer *importer, const struct statement *statement);

/* The mapping of u and v; others are said. */
void texture_mapping(struct importer *importer, const struct statement *statement,
                     struct pattern *pattern);

#endif
