/* mesh.h: triangle meshes on their way into the scene.
 *
 * In the space of the object; the front of a triangle is where its vertices run counter-clockwise
 * in right-handed coordinates: (p1 - p0) x (p2 - p0).
 */
#ifndef WRITER_MESH_H
#define WRITER_MESH_H

#include "writer/scene_text.h"

#define MESH_TRIANGLES_LIMIT ((size_t)1 << 25)

/* Zeroed: empty. Owns its arrays. */
struct mesh {
    struct vector *points, *normals; /* normals: NULL: flat triangles */
    double (*uv)[2];                 /* NULL: none */
    size_t vertex_count;
    uint32_t (*triangles)[3];
    size_t triangle_count;
};

/* Room for vertices, with normals and uv or without, and triangles. False: out of memory. */
bool mesh_allocate(struct mesh *mesh, size_t vertices, bool normals, bool uv, size_t triangles);
void mesh_release(struct mesh *mesh);

/* Turns the front to the other side. */
void mesh_reverse(struct mesh *mesh);

/* Turns each triangle to the side of its normals, where there are some. */
void mesh_turn_to_normals(struct mesh *mesh);

/* Of all triangles, placed. */
double mesh_area(const struct mesh *mesh, const struct transform *placement);

/* Writes the beginning of an object, up to its material: small meshes as text, large ones as a PLY
 * file beside the scene, whose name begins with `base`. False: out of memory. */
bool mesh_put(struct scene_text *scene, const char *base, FILE *out, const struct mesh *mesh);

/* The file's bytes, to be freed; NULL: out of memory. Binary little-endian PLY (G. Turk, "The PLY
 * polygon file format", 1994): x y z, nx ny nz, u v as floats, faces of three indices. */
void *mesh_to_ply(const struct mesh *mesh, size_t *size);

/* A surface by two parameters, each 0..1; the front is along d/du cross d/dv. */
struct surface_function {
    struct vector (*point)(const void *user, double u, double v);
    const void *user;
    size_t columns, rows; /* pieces along u and v */
};

/* Its points and normals, with the parameters as u and v. False: out of memory. */
bool mesh_from_surface(const struct surface_function *surface, struct mesh *mesh);

#endif
