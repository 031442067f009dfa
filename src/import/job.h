/* job.h: one mesh import under way, shared by its steps (source.h, check.h, steps.h). */
#ifndef IMPORT_JOB_H
#define IMPORT_JOB_H

#include "import/format.h"
#include "import/gltf.h"
#include "import/obj.h"
#include "import/ply.h"
#include <assimp/scene.h>

/* Kinds of things that materials have and psplat has not. */
#define MESH_OMISSIONS 16

struct mesh_omission {
    const char *what;            /* a literal; NULL: none */
    char material[64], last[64]; /* the first of count, and the last */
    size_t count;
};

/* What is wrong with colours of vertices, each noted once (vertex_colors.c). */
struct mesh_color_faults {
    bool rejected, clamped, alpha_lost;
};

/* Each once. */
struct mesh_names {
    char **names;
    size_t count;
};

#define MESH_TRIANGLES ((size_t)200 * 1000 * 1000) /* and vertices */

/* A node of assimp's tree, with its way to the root of the file. */
struct mesh_node {
    const struct aiNode *node;
    struct affine to_file;
};

struct mesh_job {
    const struct mesh_request *request;
    struct scene_description *fragment;
    struct mesh_report *report;
    struct error *error;
    enum mesh_format format;
    struct mesh_files files;
    struct mesh_file *main_file;
    struct mesh_file *library; /* OBJ: the last MTL file read, or NULL */
    char *missing_library;     /* OBJ: the first that could not be read, or NULL */
    struct gltf gltf;
    struct obj obj; /* OBJ: else zeroed */
    struct ply ply; /* PLY: likewise */
    const struct aiScene *scene;
    struct mesh_node *nodes; /* each before its children */
    size_t node_count;
    struct affine to_scene; /* what the request says, from the file's space */
    double scale;           /* the factor of to_scene on lengths (the mean one) */
    size_t *materials;      /* in the fragment, for each of assimp's; or NO_INDEX */
    struct mesh_omission omissions[MESH_OMISSIONS];
    struct mesh_color_faults colors;
    struct mesh_names lost;       /* textures that are missing, or of an unknown kind */
    struct mesh_names other_case; /* those that are found by another letter case */
    size_t unknown_textures;      /* pictures of a kind that is not read */
    char unknown_name[MESH_MISSING_LENGTH + 1]; /* the first */
    const char *unknown_kind;                   /* of the first, or NULL */
    bool third_uv; /* some texture is laid by a further set of coordinates than the second */
    /* While assimp asked for a file, which it takes for one that is not there. */
    bool out_of_memory;
};

/* Adds a line to the report's notes, where there is room for the whole of it. */
void mesh_note(struct mesh_report *report, const char *format, ...) PRINTF_LIKE(2, 3);

ps_result mesh_out_of_memory(struct mesh_job *job, size_t bytes);

/* All steps; fills the fragment, or leaves it empty. */
ps_result mesh_job_run(struct mesh_job *job);

/* From the node's space into the scene. */
struct affine mesh_node_placement(const struct mesh_job *job, const struct mesh_node *node);

/* The node whose name a camera or light of assimp's bears: the n-th such node for the n-th bearer;
 * NULL where there is none. */
const struct mesh_node *mesh_node_named(const struct mesh_job *job, const char *name, size_t n);

/* The JSON of a node of the list above; NULL for one that assimp made. */
const struct json *mesh_gltf_node(const struct mesh_job *job, size_t index);

static inline ps_vec3 mesh_vector(struct aiVector3D v)
{
    return (ps_vec3){v.x, v.y, v.z};
}

static inline bool mesh_is_finite(ps_vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

#endif
