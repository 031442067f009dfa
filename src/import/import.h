/* import.h: takes geometry, materials, cameras and lights from a mesh file.
 *
 * assimp reads the file (OBJ with MTL, glTF 2, PLY, STL and a few more; format.h lists them), but
 * for the geometry of OBJ and of binary PLY (obj.h, ply.h), in a child process: a file on which it
 * crashes, or takes too long, is an error like any other. Texture coordinates come with v upwards;
 * normals are the file's, or those of its smoothing groups, or by the angle of edges, or none.
 * Cameras and lights are carried into the scene. Where request maps change lengths by a factor s,
 * intensities change by s^2, so that the picture stays the same; radiances and a sun's irradiance
 * stay. Colours are linear, those of textures as their encoding says. No state outside of the
 * arguments; may run in several threads at once.
 */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "base/error.h"
#include "scene/description.h"

/* What to take from a mesh file, and how to carry it into the scene. */
struct mesh_request {
    const char *path;
    const char *folder;  /* the only one to read from (input_file.h), or NULL */
    const char *cache;   /* a folder for what was made of files (cache.h), or NULL */
    double memory_limit; /* bytes that reading may take; 0: half of the machine's */
    bool geometry, materials, camera, lights; /* what to use */
    double unit;                              /* scene units for each unit of the file */
    int32_t up;        /* which axis of the file points upwards: 0 x, 1 y, 2 z */
    bool diffuse_only; /* leave out the gloss of the file's materials */
    bool srgb_colors;  /* MTL's Kd, Ks and Tf are codes of sRGB; else they are linear */
    double bump_scale; /* times the heights of MTL's bump maps; 0: none */
    /* Degrees: parts without normals or smoothing groups are smooth across flatter edges; 0:
     * flat. */
    double smooth_angle;
    struct affine placement; /* applied last */
    /* Of processor time beyond what the files' size allows; 0: as many as usual. */
    unsigned seconds;
    struct origin origin;
};

/* A number for what is read, and how: requests that differ in it read other files, or the same ones
 * another way, but for a chance of one in 2^64. What to use of them, the folder of a cache, limits
 * and origin are left out. */
uint64_t mesh_request_digest(const struct mesh_request *request);

/* What parts are made of for which neither the file nor the scene has a material: diffuse grey.
 * Without a name; it owns nothing. */
#define MESH_PLAIN_REFLECTANCE 0.5
struct material_description mesh_material_plain(struct origin origin);

#define MESH_MISSING_NAMES 20
#define MESH_MISSING_LENGTH 100 /* bytes, beyond which a name is cut */

/* What was mended, for warnings. */
struct mesh_report {
    size_t dropped_triangles, dropped_lights;
    size_t missing_textures; /* each once; of the first the names, with ", " between them: */
    char missing_names[MESH_MISSING_NAMES * (MESH_MISSING_LENGTH + 2)];
    char notes[4096]; /* lines */
};

/* Reads the file into a fragment: meshes, objects (OBJECT_MESH), materials (each with its name in
 * the file), textures, cameras, lights, whose indices refer to the fragment's own arrays. Of a
 * material that the file names and lacks only the name is there (material_is_absent); objects
 * without any, or whose materials were not asked for, have material NO_INDEX. The fragment is
 * released with scene_description_release. PS_ERROR_IO, _INVALID or _MEMORY with a message. */
ps_result mesh_import(const struct mesh_request *request, struct scene_description *fragment,
                      struct mesh_report *report, struct error *error);

/* Whether the file's name ends as that of a format that is read. */
bool mesh_file_is_known(const char *path);

/* How names of such files end, without the dot; NULL for an index beyond the last. */
const char *mesh_file_extension(size_t index);

/* Which axis usually points upwards in files of that format, as mesh_request.up. */
int32_t mesh_file_up(const char *path);

struct mesh_memory_file {
    const char *path; /* as the request, or the mesh file, would name it */
    const void *bytes;
    size_t length;
};

/* mesh_import where these files, and no others, exist; the disk is not looked at. */
ps_result mesh_import_memory(const struct mesh_request *request,
                             const struct mesh_memory_file *files, size_t file_count,
                             struct scene_description *fragment, struct mesh_report *report,
                             struct error *error);

#endif
