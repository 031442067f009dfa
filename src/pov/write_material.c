/* write_material.c: POV-Ray's textures as psplat's materials; see write.h.
 *
 * A pigment times the finish's diffuse is the share of light that is reflected diffusely: POV-Ray's
 * lights light a surface with that times the cosine, as psplat's of irradiance pi do. What shines
 * through by filter and transmit is glass. Highlights become gloss: Blinn's exponent n is a width
 * alpha of sqrt(2 / (n + 2)) (B. Walter et al., "Microfacet models for refraction through rough
 * surfaces", 2007), and Phong's exponent a quarter of Blinn's.
 */
#include "pov/write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LAYERS 16
#define PLASTIC 0.04 /* what a coat reflects straight ahead */

void pov_linear(const struct pov_reader *reader, const double color[3], double linear[3])
{
    for (int i = 0; i < 3; i++) {
        double value = fmin(fmax(color[i], 0.0), 1e6);
        linear[i] = reader->gamma == 1.0 ? value : fmin(pow(value, reader->gamma), 1e20);
    }
}

/* --- patterns
 * ------------------------------------------------------------------------------------- */

struct paint {
    struct pov_writer *writer;
    const struct pov_pigment *pigment;
    struct transform place; /* of the pattern, to the scene */
    bool shines_in_one;     /* its emission has no pattern */
    const char *image;      /* or NULL */
};

static void put_scaled(struct paint *paint, FILE *out, const double color[3],
                       const double factor[3], double most)
{
    double rgb[3];
    pov_linear(paint->writer->reader, color, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = fmin(fmax(rgb[i] * factor[i], 0.0), most);
    put_color(out, rgb);
}

static void put_mean(struct paint *paint, FILE *out, const double factor[3], double most)
{
    double mean[POV_TERMS];
    pov_pigment_mean(paint->pigment, mean);
    put_scaled(paint, out, mean, factor, most);
}

static double within(double factor)
{
    return fmin(fmax(factor, 0.0), 1.0);
}

static void put_image(struct paint *paint, FILE *out, const double factor[3])
{
    fputs("{image: {file: ", out);
    put_path(out, paint->image);
    if (paint->pigment->once)
        fputs(", wrap: clamp", out);
    if (paint->pigment->nearest)
        fputs(", interpolate: nearest", out);
    fputs(", color: ", out);
    put_color(out, (const double[3]){within(factor[0]), within(factor[1]), within(factor[2])});
    fputs("}}", out);
}

/* Whether psplat has the pattern; else its mean stands for it. */
static bool has_pattern(const struct paint *paint)
{
    const struct transform *p = &paint->place;
    double largest = 0.0;
    for (int i = 0; i < 12; i++)
        largest =
            fabs(p->m[i / 4][i % 4]) < 1e9 ? fmax(largest, fabs(p->m[i / 4][i % 4])) : INFINITY;
    switch (paint->pigment->pattern) {
    case POV_PATTERN_CHECKER:
    case POV_PATTERN_GRADIENT:
    case POV_PATTERN_NOISE:
        return largest < 1e9 && fabs(transform_determinant(p)) > 1e-15 &&
               vector_length(paint->pigment->axis) > 1e-6 &&
               vector_length(paint->pigment->axis) < 1e6;
    case POV_PATTERN_IMAGE:
        return paint->image != NULL;
    default:
        return false;
    }
}

/* "COLOUR" or "{PATTERN: {...}}", times a factor, each at most `most`. */
static void put_paint(struct paint *paint, FILE *out, const double factor[3], double most)
{
    static const char *const names[] = {[POV_PATTERN_CHECKER] = "checker",
                                        [POV_PATTERN_GRADIENT] = "gradient",
                                        [POV_PATTERN_NOISE] = "noise"};
    const struct pov_pigment *pigment = paint->pigment;
    double ends[2][POV_TERMS];
    if (!has_pattern(paint)) {
        put_mean(paint, out, factor, most);
        return;
    }
    if (pigment->pattern == POV_PATTERN_IMAGE) {
        put_image(paint, out, factor);
        return;
    }
    pov_pigment_ends(pigment, ends);
    fprintf(out, "{%s: {colors: [", names[pigment->pattern]);
    put_scaled(paint, out, ends[0], factor, most);
    fputs(", ", out);
    put_scaled(paint, out, ends[1], factor, most);
    fputc(']', out);
    if (pigment->pattern == POV_PATTERN_GRADIENT) {
        fputs(", axis: ", out);
        put_vector(out, pigment->axis);
    }
    if (pigment->pattern == POV_PATTERN_NOISE && pigment->word != POV_granite)
        fputs(", octaves: 1", out);
    if (pigment->pattern != POV_PATTERN_CHECKER && pigment->turbulence > 0.0) {
        fputs(", turbulence: ", out);
        put_number(out, fmin(pigment->turbulence, 1e3));
    }
    put_placement(out, &paint->place);
    fputs("}}", out);
}

/* --- kinds of surfaces
 * ------------------------------------------------------------------------------ */

static double largest_of(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

static double roughness_of(const struct pov_finish *f)
{
    double n = f->specular > 0.0 ? 1.0 / fmin(fmax(f->roughness, 1e-6), 1.0)
                                 : 4.0 * fmin(fmax(f->phong_size, 0.1), 1e6);
    return pow(2.0 / (n + 2.0), 0.25);
}

static void put_grey_paint(struct paint *paint, FILE *out, double factor)
{
    put_paint(paint, out, (const double[3]){factor, factor, factor}, 1.0);
}

static void put_metal(struct paint *paint, FILE *out, const struct pov_finish *f)
{
    double shine = fmax(largest_of(f->reflection[0]), fmax(f->specular, f->phong));
    bool is_rough = f->specular > 0.0 || f->phong > 0.0;
    bool is_mirror = largest_of(f->reflection[0]) > 0.3;
    fputs("metal: {color: ", out);
    put_grey_paint(paint, out, fmin(f->diffuse + shine, 1.0));
    if (is_rough && !is_mirror) {
        fputs(", roughness: ", out);
        put_number(out, roughness_of(f));
    }
    fputc('}', out);
}

static void put_glossy(struct paint *paint, FILE *out, const struct pov_finish *f, double specular,
                       double roughness)
{
    fputs("glossy: {diffuse: ", out);
    put_grey_paint(paint, out, f->diffuse);
    fputs(", specular: ", out);
    put_number(out, specular);
    fputs(", roughness: ", out);
    put_number(out, roughness);
    fputc('}', out);
}

/* A diffuse surface that also is a mirror: a mix of the two, whose shares sum to what is reflected
 * in all. */
static void put_mirror(struct paint *paint, FILE *out, const struct pov_finish *f)
{
    double r[3], share, color[3], mean[POV_TERMS];
    struct scene_text *scene = &paint->writer->reader->scene;
    for (int i = 0; i < 3; i++)
        r[i] = fmin(fmax(0.5 * (f->reflection[0][i] + f->reflection[1][i]), 0.0), 1.0);
    share = largest_of(r);
    pov_pigment_mean(paint->pigment, mean);
    if (f->diffuse * largest_of(mean) < 1e-3 || share > 0.999) {
        fputs("mirror: ", out);
        put_color(out, r);
        return;
    }
    for (int i = 0; i < 3; i++)
        color[i] = r[i] / share;
    struct text_buffer mirror = {0}, diffuse = {0};
    if (!text_buffer_open(&mirror) || !text_buffer_open(&diffuse)) {
        free(text_buffer_close(&mirror));
        pov_no_memory(paint->writer->reader);
        return;
    }
    fputs("mirror: ", mirror.stream);
    put_color(mirror.stream, color);
    fputs("diffuse: ", diffuse.stream);
    put_grey_paint(paint, diffuse.stream, f->diffuse / (1.0 - share));
    char *texts[2] = {text_buffer_close(&diffuse), text_buffer_close(&mirror)};
    const char *names[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++)
        names[i] =
            texts[i] ? scene_text_material(scene, i ? "mirror" : "under-mirror", texts[i]) : NULL;
    if (!names[0] || !names[1]) {
        pov_no_memory(paint->writer->reader);
    } else {
        float weight = (float)share;
        for (int i = 0; i < 2; i++) {
            fputs(i ? ", {material: " : "mix: [{material: ", out);
            put_text(out, names[i]);
            fputs(", weight: ", out);
            put_number(out, i ? (double)weight : 1.0 - (double)weight - 1e-6);
            fputc('}', out);
        }
        fputc(']', out);
    }
    free(texts[0]);
    free(texts[1]);
}

static void put_opaque(struct paint *paint, FILE *out, const struct pov_finish *f)
{
    double least = largest_of(f->reflection[0]), most = largest_of(f->reflection[1]);
    bool shines = f->specular > 0.0 || f->phong > 0.0;
    if ((f->metallic > 0.0 && (shines || most > 0.0)) || (f->reflects_metallic && most > 0.5))
        put_metal(paint, out, f);
    else if (f->fresnel || (most > 0.0 && least < 0.2 && most > 1.5 * least))
        put_glossy(paint, out, f, f->fresnel ? PLASTIC : fmin(fmax(least, 0.0), 1.0), 0.0);
    else if (most > 0.0)
        put_mirror(paint, out, f);
    else if (shines)
        put_glossy(paint, out, f, PLASTIC, roughness_of(f));
    else {
        fputs("diffuse: ", out);
        put_grey_paint(paint, out, f->diffuse);
    }
}

/* Half of the light is lost over fade_distance, and the colour's part less. */
static void put_absorption(FILE *out, const struct pov_interior *interior)
{
    double absorption[3];
    if (!(interior->fade_power > 0.0) || !(interior->fade_distance > 0.0))
        return;
    for (int i = 0; i < 3; i++) {
        double left = 0.5 * (1.0 + fmin(fmax(interior->fade_color[i], 0.0), 1.0));
        absorption[i] = fmin(-log(left) / interior->fade_distance, 1e6);
    }
    fputs(", absorption: ", out);
    put_color(out, absorption);
}

static void put_glass(struct paint *paint, FILE *out, const struct pov_interior *interior,
                      const double color[POV_TERMS])
{
    double through[3], linear[3], sum = color[3] + color[4];
    pov_linear(paint->writer->reader, color, linear);
    for (int i = 0; i < 3; i++)
        through[i] = fmin((color[3] * linear[i] + color[4]) / fmax(sum, 1e-6), 1.0);
    fputs("dielectric: {ior: ", out);
    put_number(out, fmin(fmax(interior->ior, 0.1), 10.0));
    put_absorption(out, interior);
    fputs(", color: ", out);
    put_color(out, through);
    fputc('}', out);
}

/* An ambient that says "shines", and not "in shade": psplat finds the light in the shade by
 * itself. */
static bool ambient_shines(const struct pov_finish *f)
{
    double ambient = f->has_ambient ? largest_of(f->ambient) : 0.0;
    bool is_dark =
        f->diffuse < 0.05 && f->specular + f->phong + largest_of(f->reflection[1]) == 0.0;
    return ambient >= 0.8 || (is_dark && ambient > 0.2);
}

/* Light of the surface's own. */
static void put_emission(struct paint *paint, FILE *out, const struct pov_finish *f)
{
    const double *ambient_light = paint->writer->reader->ambient_light;
    double factor[3];
    for (int i = 0; i < 3; i++) {
        factor[i] = fmax(f->emission[i], 0.0);
        if (ambient_shines(f))
            factor[i] += fmax(f->ambient[i] * ambient_light[i], 0.0);
        factor[i] = fmin(factor[i], 1e6);
    }
    if (!(largest_of(factor) > 0.0))
        return;
    fputs(", emission: ", out);
    (paint->shines_in_one ? put_mean : put_paint)(paint, out, factor, 1e20);
    fputs(", emission_both: yes", out);
}

/* --- the whole
 * ------------------------------------------------------------------------------------ */

static void warn_of_note(struct pov_writer *writer, const struct pov_note *note)
{
    if (note->text)
        pov_warn_at(writer->reader, note->file, &note->token, "%s", note->text);
}

static void warn_of(struct paint *paint, const struct pov_finish *f)
{
    const struct pov_pigment *p = paint->pigment;
    struct pov_reader *reader = paint->writer->reader;
    if (p->pattern == POV_PATTERN_OTHER)
        pov_warn_at(reader, p->file, &p->token,
                    "pattern '%.40s' has no counterpart: its mean colour",
                    pov_text(reader, p->word));
    else if (p->pattern == POV_PATTERN_NOISE || p->word == POV_marble)
        pov_warn_at(reader, p->file, &p->token, "pattern '%.40s' becomes %s of two colours",
                    pov_text(reader, p->word), p->word == POV_marble ? "a gradient" : "noise");
    else if (p->pattern == POV_PATTERN_GRADIENT && p->map && p->map->count > 2)
        pov_warn_at(reader, p->file, &p->token,
                    "gradient: two colours stand for the %zu of its map", p->map->count);
    double mean[POV_TERMS];
    pov_pigment_mean(p, mean);
    if (f->diffuse * largest_of(mean) > 1.0 + 1e-9)
        pov_warn_at(reader, p->file, p->file ? &p->token : &(struct pov_token){0},
                    "surfaces that reflect more light than they get are limited to all of it");
}

/* The text of the material; NULL: out of memory. */
static char *material_text(struct paint *paint, const struct pov_finish *finish,
                           const struct pov_interior *interior, bool glass)
{
    struct text_buffer text;
    double mean[POV_TERMS];
    if (!text_buffer_open(&text))
        return NULL;
    pov_pigment_mean(paint->pigment, mean);
    if (glass)
        put_glass(paint, text.stream, interior, mean);
    else
        put_opaque(paint, text.stream, finish);
    put_emission(paint, text.stream, finish);
    return text_buffer_close(&text);
}

static const char *intern(struct pov_writer *writer, const char *wanted, char *text)
{
    const char *name = text ? scene_text_material(&writer->reader->scene, wanted, text) : NULL;
    free(text);
    if (!name)
        pov_no_memory(writer->reader);
    return name;
}

/* Partly opaque: a mix with glass. */
static const char *write_mix(struct paint *paint, const struct pov_finish *finish,
                             const struct pov_interior *interior, double clear, const char *wanted)
{
    struct pov_writer *writer = paint->writer;
    struct pov_finish plain = *finish; /* mixes don't nest here */
    memset(plain.reflection, 0, sizeof plain.reflection);
    plain.fresnel = false;
    const char *names[2];
    names[0] = intern(writer, "opaque", material_text(paint, &plain, interior, false));
    names[1] =
        names[0] ? intern(writer, "clear", material_text(paint, &plain, interior, true)) : NULL;
    struct text_buffer text;
    if (!names[1] || !text_buffer_open(&text))
        return NULL;
    for (int i = 0; i < 2; i++) {
        fputs(i ? ", {material: " : "mix: [{material: ", text.stream);
        put_text(text.stream, names[i]);
        fputs(", weight: ", text.stream);
        put_number(text.stream, i ? clear : 1.0 - (double)(float)clear - 1e-6);
        fputc('}', text.stream);
    }
    fputc(']', text.stream);
    return intern(writer, wanted, text_buffer_close(&text));
}

/* A colour over what is below it, which shines through by its filter and transmit. */
static void lay_over(double color[POV_TERMS], const double below[POV_TERMS])
{
    double filter = fmin(fmax(color[3], 0.0), 1.0), transmit = fmin(fmax(color[4], 0.0), 1.0);
    double opaque = fmax(1.0 - filter - transmit, 0.0);
    for (int i = 0; i < 3; i++)
        color[i] = opaque * color[i] + (filter * color[i] + transmit) * below[i];
    color[3] = (filter + transmit) * below[3];
    color[4] = (filter + transmit) * below[4];
}

/* One layer of several: the highest, over the mean colour of those below it. False: out of
 * memory. */
static bool flatten(struct pov_writer *writer, struct pov_texture *texture, int depth)
{
    struct pov_texture below;
    struct pov_pigment *pigment = &texture->pigment;
    double mean[POV_TERMS];
    if (!texture->below || depth == MOST_LAYERS)
        return true;
    below = *texture->below;
    if (!flatten(writer, &below, depth + 1))
        return false;
    pov_pigment_mean(&below.pigment, mean);
    lay_over(pigment->color, mean);
    for (int i = 0; i < pigment->listed_count; i++)
        lay_over(pigment->listed[i], mean);
    if (pigment->map) {
        struct pov_color_map *map = pov_copy(writer->reader, pigment->map, sizeof *map);
        if (map && map->count > 0)
            map->entries =
                pov_copy(writer->reader, map->entries, map->count * sizeof *map->entries);
        if (!map || (map->count > 0 && !map->entries))
            return false;
        for (size_t i = 0; i < map->count; i++)
            lay_over(map->entries[i].color, mean);
        pigment->map = map;
    }
    if (pigment->file)
        pov_warn_at(writer->reader, pigment->file, &pigment->token,
                    "of layered textures the lower ones count by their mean colours");
    return true;
}

/* Without what rounding leaves of zeros: the same pattern is to be the same text. */
static struct transform without_noise(struct transform map)
{
    for (int i = 0; i < 3; i++) {
        double *row = map.m[i], largest = 0.0;
        for (int k = 0; k < 4; k++)
            largest = fmax(largest, fabs(row[k]));
        for (int k = 0; k < 4; k++)
            row[k] = fabs(row[k]) > 1e-12 * largest ? row[k] : 0.0;
    }
    return map;
}

const char *pov_write_material(struct pov_writer *writer, const struct pov_above *above,
                               const struct transform *from_scene)
{
    const struct pov_look *look = writer->reader->look;
    struct pov_texture flat = above->texture ? *above->texture : look->texture;
    const struct pov_texture *texture = &flat;
    const struct pov_interior *interior = above->interior ? above->interior : &look->interior;
    if (!flatten(writer, &flat, 0))
        return NULL;
    struct transform place = transform_compose(&above->texture_place, &texture->pigment.place);
    place = transform_compose(&writer->mirror, &place);
    place = without_noise(transform_compose(from_scene, &place));
    struct paint paint = {writer, &texture->pigment, place, above->is_sphere, NULL};
    if (texture->pigment.pattern == POV_PATTERN_IMAGE)
        paint.image = pov_write_file_name(writer, texture->pigment.file, &texture->pigment.token,
                                          texture->pigment.image);
    warn_of(&paint, &texture->finish);
    warn_of_note(writer, &texture->note);
    warn_of_note(writer, &texture->pigment.note);
    warn_of_note(writer, &texture->finish.note);
    warn_of_note(writer, &interior->note);
    const char *wanted = texture->name ? pov_text(writer->reader, texture->name) : "texture", *name;
    double mean[POV_TERMS];
    pov_pigment_mean(&texture->pigment, mean);
    double clear = fmin(fmax(mean[3] + mean[4], 0.0), 1.0);
    if (clear > 0.02 && clear < 0.95)
        name = write_mix(&paint, &texture->finish, interior, clear, wanted);
    else
        name = intern(writer, wanted,
                      material_text(&paint, &texture->finish, interior, clear >= 0.95));
    return name;
}
