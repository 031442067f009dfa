/* write.h: the scene that was read becomes sections of a .psd text (psd(5)).
 *
 * POV-Ray's coordinates are left-handed: z is mirrored, unless the camera's axes are right-handed
 * already. Then the scene stays as it is, and the picture comes out as POV-Ray's.
 */
#ifndef POV_WRITE_H
#define POV_WRITE_H

#include "pov/object.h"

/* As many as psd(5) has. */
#define POV_MOST_OBJECTS 1000000

/* A mesh that several objects have is one file. */
struct pov_mesh_file {
    const struct mesh *mesh;
    const char *name;  /* of the file */
    const char *group; /* once it comes again; or NULL */
};

/* A picture that was looked at. */
struct pov_picture {
    const char *path;  /* where it lies */
    const char *shown; /* the same from the new scene's folder; NULL: it can't be read */
};

/* What is left of the surface of a part of a solid. */
struct pov_piece {
    const struct pov_object *part;
    const struct pov_object *const
        *way; /* the objects from the solid, without it, down to the part */
    size_t way_length;
    const struct mesh *mesh; /* in the space of the solid */
};

/* A solid by boolean operations, for all copies of its object. */
struct pov_solid {
    const struct pov_object *object; /* the first of them */
    struct pov_piece *pieces; /* owned; of none there is nothing to be seen, or it was left out */
    size_t piece_count, capacity;
};

/* Planes times corners when solids are cut, in all of the scene, for each token that may be
 * read. */
#define POV_MOST_CUTTING 100

struct pov_writer {
    struct pov_reader *reader;
    struct transform mirror;  /* from POV-Ray's coordinates to those of the scene */
    struct vector middle;     /* what the camera looks at, in POV-Ray's coordinates */
    double extent;            /* half the side of planes */
    struct name_index meshes; /* the ones below, by their addresses */
    struct pov_mesh_file *mesh_files;
    size_t mesh_file_count, mesh_file_capacity;
    struct name_index picture_index; /* of the pictures, by their paths */
    struct pov_picture *pictures;
    size_t picture_count, picture_capacity;
    struct name_index solid_index; /* of the solids, by what they are made of */
    struct pov_solid *solids;
    size_t solid_count, solid_capacity;
    size_t cutting_left; /* planes times corners */
    int written, depth;  /* objects, and in how many others the present one is */
};

/* An object's surroundings on the way down: what it gets from what it is in. */
struct pov_above {
    struct transform place;
    const struct pov_texture *texture; /* NULL: none yet */
    struct transform texture_place;    /* of the texture, in POV-Ray's coordinates */
    const struct pov_interior *interior;
    bool is_uv, no_image;
    bool is_sphere; /* psplat's shine in one colour alone */
};

/* Camera and image, and what the writer has to know of them (write_camera.c). */
void pov_write_camera(struct pov_writer *writer);
/* background and sky_sphere (write_sky.c). */
void pov_write_sky(struct pov_writer *writer);
void pov_write_light(struct pov_writer *writer, const struct pov_object *object,
                     const struct transform *place);
/* An object and what is in it. */
void pov_write_object(struct pov_writer *writer, const struct pov_object *object,
                      const struct pov_above *above);

/* Warns of what has no counterpart in an object, if anything. */
void pov_warn_of_object(struct pov_writer *writer, const struct pov_object *object);

/* The name of the material that stands for what is above; NULL: reported (write_material.c).
 * `from_scene`: to the space that its patterns are to lie in. */
const char *pov_write_material(struct pov_writer *writer, const struct pov_above *above,
                               const struct transform *from_scene);
/* The end of an object's map: material and, unless it is NULL, placement. */
void pov_end_object(struct pov_writer *writer, const struct pov_above *look,
                    const struct transform *placement, const struct transform *from_scene);
/* A colour of the scene's gamma as a linear one. */
void pov_linear(const struct pov_reader *reader, const double color[3], double linear[3]);

/* From an object's space to the scene's. False, warned: it has no inverse, or too large numbers. */
bool pov_placement(struct pov_writer *writer, const struct pov_object *object,
                   const struct transform *place, struct transform *placement);
/* Meshes (write_mesh.c). Whether a picture lies over x and y. */
bool pov_is_planar(const struct pov_above *look);
/* A shape that such a picture lies on becomes a mesh. False: there is no mesh of it. */
bool pov_write_pictured(struct pov_writer *writer, const struct pov_object *object,
                        const struct pov_above *look);
/* A mesh that stays where it is; its points are in the space of `look->place`. */
void pov_write_mesh(struct pov_writer *writer, const struct pov_object *object,
                    const struct mesh *mesh, const struct pov_above *look);
/* For lists by address. */
uint64_t pov_hash_address(const void *address);
/* The path by which the scene names a picture that the POV-Ray scene names. NULL: reported, or it
 * can't be read, with a warning (write_picture.c). */
const char *pov_write_file_name(struct pov_writer *writer, const char *file,
                                const struct pov_token *token, const char *name);

/* What is above the children of an object. */
struct pov_above pov_below(const struct pov_object *object, const struct pov_above *above);
/* Whether a shape has an extent, in the precision of floats. */
bool pov_has_extent(const struct pov_object *object);

/* Solids by boolean operations, and what clipped_by cuts (write_solid.c). */
void pov_write_solid(struct pov_writer *writer, const struct pov_object *object,
                     const struct pov_above *above);
/* The pieces of a new solid; none, with a warning, where it takes too much (csg.c). */
void pov_make_solid(struct pov_writer *writer, struct pov_solid *solid);

/* A shape as a closed mesh in its own space, to be released; NULL where it is none. False: reported
 * (tessellate.c). */
bool pov_tessellate(struct pov_writer *writer, const struct pov_object *object, struct mesh *mesh);

#endif
