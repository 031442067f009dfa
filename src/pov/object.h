/* object.h: the scene as POV-Ray's words describe it: textures, objects, lights, camera.
 *
 * Coordinates are POV-Ray's, left-handed. All lies in the reader's arena and is shared between
 * copies; who changes something changes a copy.
 */
#ifndef POV_OBJECT_H
#define POV_OBJECT_H

#include "pov/reader.h"
#include "writer/mesh.h"

/* --- textures
 * ----------------------------------------------------------------------------------- */

struct pov_map_entry {
    double at, color[POV_TERMS];
};

struct pov_color_map {
    size_t count;
    struct pov_map_entry *entries; /* by `at` */
};

/* What was left out of something, said where that is used: files of textures define many that are
 * not. */
struct pov_note {
    const char *text; /* NULL: nothing */
    struct pov_token token;
    const char *file;
};

enum pov_pattern {
    POV_PATTERN_PLAIN,
    POV_PATTERN_CHECKER,
    POV_PATTERN_GRADIENT,
    POV_PATTERN_NOISE,
    POV_PATTERN_IMAGE,
    POV_PATTERN_OTHER /* its mean */
};

#define POV_LISTED 3 /* colours of checker, brick, hexagon */

struct pov_pigment {
    enum pov_pattern pattern;
    uint32_t word;           /* POV-Ray's name of the pattern */
    double color[POV_TERMS]; /* POV_PATTERN_PLAIN */
    double listed[POV_LISTED][POV_TERMS];
    int listed_count;
    const struct pov_color_map *map; /* or NULL */
    struct vector axis;              /* of a gradient */
    double turbulence;
    const char *image; /* its file */
    int map_type;      /* 0: planar */
    bool once, nearest, is_uv;
    struct transform place;
    struct pov_token token;
    const char *file; /* of the token */
    struct pov_note note;
};

struct pov_finish {
    struct pov_note note;
    double ambient[3], emission[3], diffuse, brilliance, specular, roughness, phong, phong_size,
        metallic;
    double reflection[2][3]; /* at right angles, and grazing */
    bool fresnel, reflects_metallic, has_ambient;
};

struct pov_interior {
    struct pov_note note;
    double ior, fade_distance, fade_power, fade_color[3];
};

struct pov_texture {
    struct pov_pigment pigment;
    struct pov_finish finish;
    struct pov_note note;
    const struct pov_texture *below; /* the layer under it, or NULL */
    uint32_t name;                   /* a word, or POV_texture */
};

struct pov_material {
    const struct pov_texture *texture;   /* or NULL */
    const struct pov_interior *interior; /* or NULL */
};

/* How objects without one look. */
struct pov_look {
    struct pov_texture texture;
    struct pov_interior interior;
};

/* The first of several stays. */
void pov_note(struct pov_reader *reader, const struct pov_token *token, const char *text,
              struct pov_note *note);

extern const struct pov_finish pov_usual_finish;
extern const struct pov_pigment pov_usual_pigment;
extern const struct pov_interior pov_usual_interior;

/* Between the entries of a map that has some. */
void pov_color_at(const struct pov_color_map *map, double at, double color[POV_TERMS]);
/* The mean colour, and the two colours that stand for a pattern of psplat's. */
void pov_pigment_mean(const struct pov_pigment *pigment, double color[POV_TERMS]);
void pov_pigment_ends(const struct pov_pigment *pigment, double colors[2][POV_TERMS]);

/* Blocks behind their first word and brace, up to the closing brace (pigment.c, finish.c,
 * texture.c). */
struct pov_pigment pov_read_pigment(struct pov_reader *reader, const struct pov_token *token,
                                    struct pov_pigment pigment);
struct pov_finish pov_read_finish(struct pov_reader *reader, struct pov_finish finish);
struct pov_interior pov_read_interior(struct pov_reader *reader, struct pov_interior interior);
struct pov_texture pov_read_texture(struct pov_reader *reader, const struct pov_token *token);
struct pov_material pov_read_material(struct pov_reader *reader);
/* NULL: reported. */
const struct pov_color_map *pov_read_color_map(struct pov_reader *reader);

/* A part of a pattern's description; false: the token is none. */
bool pov_read_pattern_part(struct pov_reader *reader, const struct pov_token *token,
                           struct pov_pigment *pigment);
/* "image_map { png "FILE" ... }" behind its first word (image.c). */
void pov_read_image(struct pov_reader *reader, struct pov_pigment *pigment);

/* --- transforms
 * --------------------------------------------------------------------------------- */

/* About x, then y, then z, by degrees; left-handed. */
struct transform pov_rotation(struct vector degrees);
/* Reads "rotate ..." and the like behind its first word, and applies it after `place`. False: the
 * token is none. */
bool pov_read_transform(struct pov_reader *reader, const struct pov_token *token,
                        struct transform *place);
/* Whether that is one, which is then read into `step`. */
bool pov_read_step(struct pov_reader *reader, const struct pov_token *token,
                   struct transform *step);

/* --- objects
 * ------------------------------------------------------------------------------------- */

enum pov_shape {
    POV_SHAPE_NOTHING,  /* nothing to be seen, or without a counterpart: then `note` says so */
    POV_SHAPE_SPHERE,   /* p[0] centre, r[0] */
    POV_SHAPE_BOX,      /* p[0], p[1] corners */
    POV_SHAPE_CYLINDER, /* p[0], p[1] ends, r[0] */
    POV_SHAPE_CONE,     /* p[0], r[0], p[1], r[1] */
    POV_SHAPE_PLANE,    /* p[0] normal, r[0] distance along it */
    POV_SHAPE_TORUS,    /* r[0], r[1] */
    POV_SHAPE_DISC,     /* p[0], p[1] normal, r[0], r[1] hole */
    POV_SHAPE_MESH,
    POV_SHAPE_HEIGHT_FIELD, /* image */
    POV_SHAPE_UNION,
    POV_SHAPE_INTERSECTION,
    POV_SHAPE_LIGHT /* p[0] location, p[1] point_at; children: looks_like */
};

struct pov_light {
    double color[3];
    bool spot, cylinder, parallel, shadowless, area, circular, orient;
    double radius, falloff, tightness, fade_distance, fade_power;
    struct vector axes[2];
    int sizes[2];
};

struct pov_object {
    enum pov_shape shape;
    struct pov_token token;
    const char *file; /* of the token */
    struct vector p[2];
    double r[2];
    bool open, smooth, inverse, no_image;
    const struct mesh *mesh; /* arrays in the arena */
    const char *image;
    const struct pov_light *light;
    struct pov_object **children; /* each shared */
    size_t child_count;
    struct pov_object **clips; /* what is outside of one of them is cut off */
    size_t clip_count;
    struct transform place;
    const struct pov_texture *texture; /* or NULL */
    struct transform texture_place;    /* of the texture, after its own */
    bool is_own_texture; /* not that of the object it is a copy of: another one is a layer */
    bool is_uv;
    const struct pov_interior *interior; /* or NULL */
    struct pov_note note;
};

/* Whether an object begins with the token. */
bool pov_begins_object(const struct pov_reader *reader, const struct pov_token *token);
/* Reads one behind its first word; NULL: reported. */
struct pov_object *pov_read_object(struct pov_reader *reader, const struct pov_token *token);
/* Reads a modifier; false: the token is none. */
bool pov_read_modifier(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_object *object);
/* Modifiers, up to the closing brace. */
void pov_read_modifiers(struct pov_reader *reader, struct pov_object *object);

/* The shapes that are read in files of their own, behind the open brace: fill in the object
 * (mesh.c, sweep.c, light.c). */
void pov_read_mesh(struct pov_reader *reader, struct pov_object *object);
void pov_read_mesh2(struct pov_reader *reader, struct pov_object *object);
void pov_read_triangle(struct pov_reader *reader, struct pov_object *object, bool smooth);
void pov_read_polygon(struct pov_reader *reader, struct pov_object *object);
void pov_read_bicubic_patch(struct pov_reader *reader, struct pov_object *object);
void pov_read_lathe(struct pov_reader *reader, struct pov_object *object);
void pov_read_sor(struct pov_reader *reader, struct pov_object *object);
void pov_read_prism(struct pov_reader *reader, struct pov_object *object);
void pov_read_superellipsoid(struct pov_reader *reader, struct pov_object *object);
void pov_read_light(struct pov_reader *reader, struct pov_object *object);

/* Moves a mesh to the reader's memory. NULL: reported (surface.c). */
const struct mesh *pov_keep_mesh(struct pov_reader *reader, struct mesh *mesh);

/* --- the rest of the scene
 * -------------------------------------------------------------------------- */

struct pov_camera {
    struct vector location, direction, right, up, sky, look_at, focal_point;
    double angle; /* 0: as direction and right say */
    double aperture;
    bool orthographic, has_look_at, has_focal_point;
    struct transform place;
};

struct pov_camera pov_read_camera(struct pov_reader *reader);
/* global_settings, background, sky_sphere, fog, ...; false: the token is none (surroundings.c). */
bool pov_read_surroundings(struct pov_reader *reader, const struct pov_token *token);
/* "{ pigment {...} ... }" of a sky_sphere: the first pigment. NULL: there is none. */
const struct pov_pigment *pov_read_sky(struct pov_reader *reader);
/* Behind #default. */
void pov_read_default(struct pov_reader *reader);
/* "pigment {...}" and the like as a value; false: the token begins none. */
bool pov_read_declared(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_value *value);
/* Reads the whole scene. */
void pov_read_scene(struct pov_reader *reader);

#endif
