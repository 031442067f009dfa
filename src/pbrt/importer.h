/* importer.h: what the parts of the converter share: the state of the scene that is read, and what
 * came of it.
 *
 * One thread at a time. Everything is owned by the importer, which pbrt_convert makes and releases.
 */
#ifndef PBRT_IMPORTER_H
#define PBRT_IMPORTER_H

#include "base/arena.h"
#include "parser/yaml/diagnostic.h"
#include "pbrt/pbrt.h"
#include "pbrt/statement.h"
#include "writer/name_index.h"
#include "writer/scene_text.h"
#include "writer/transform.h"
#include <stdio.h>

enum attribute_target {
    TARGET_SHAPE,
    TARGET_LIGHT,
    TARGET_MATERIAL,
    TARGET_MEDIUM,
    TARGET_TEXTURE,
    TARGETS
};

/* pbrt's graphics state. */
struct graphics_state {
    struct transform ctm;               /* object to world; before WorldBegin world to camera */
    bool reverse;                       /* ReverseOrientation */
    const struct statement *material;   /* NULL: pbrt's default; kept */
    const char *material_name;          /* of NamedMaterial, or NULL */
    const struct statement *area_light; /* NULL: none; kept */
    const struct attributes *attributes[TARGETS];
    bool only_end_time; /* ActiveTransform EndTime: transforms are not of the shutter's opening */
    size_t texture_count, material_count; /* where it was saved */
    char mark; /* what opened the level that it was saved for (state.h) */
};

/* Names of one sort, in a list. */
struct named_transform {
    const char *name;
    struct transform transform;
};

/* What psd(5) limits of a material. */
struct mix_extent {
    int height; /* mixes in each other, itself included */
    int parts;  /* materials that are no mixes */
};

struct named_statement {
    const char *name;
    const struct statement *statement;
    const char *written; /* its name in the scene, once it is in a mix; or NULL */
    struct mix_extent extent;
};

struct pattern;
struct named_pattern {
    const char *name;
    bool of_numbers; /* of the type float */
    const struct pattern *pattern;
};

struct object_definition {
    const char *name;  /* as in the file */
    const char *group; /* its name in the scene */
    size_t shapes;     /* how many it holds */
};

struct importer {
    const struct pbrt_options *options;
    struct diagnostics *sink;
    int version;  /* 3 or 4 */
    bool stopped; /* by an error after which nothing can be read, or for lack of memory */
    bool no_memory;

    struct graphics_state state, *stack;
    size_t depth, stack_capacity;

    bool in_world;
    double mirror;           /* world's z in the scene, times this: -1 or 1 (camera.h) */
    struct transform camera; /* world to camera */
    const struct statement *camera_statement, *film, *filter;

    struct named_transform *coordinates;
    size_t coordinate_count, coordinate_capacity;
    struct named_statement *materials;
    struct named_pattern *textures;
    size_t material_count, material_capacity, texture_count, texture_capacity;
    struct name_index materials_by_name, textures_by_name;
    struct mix_extent extent; /* of the material that was written last */
    struct object_definition *objects;
    size_t object_count, object_capacity;
    struct object_definition *current_object; /* between ObjectBegin and ObjectEnd */

    struct statement **kept; /* statements that the state refers to */
    size_t kept_count, kept_capacity;
    struct warnings warnings;

    struct arena arena; /* of names and patterns, which stay */
    struct scene_text scene;
};

void importer_error(struct importer *importer, const struct origin *origin, int width,
                    const char *format, ...) PRINTF_LIKE(4, 5);
/* Once for each text. */
void importer_warn(struct importer *importer, const struct origin *origin, int width,
                   const char *format, ...) PRINTF_LIKE(4, 5);
/* Reports, once, that there is no memory. */
void importer_report_memory(struct importer *importer);
/* The same, as a result. */
static inline bool importer_no_memory(struct importer *importer)
{
    importer_report_memory(importer);
    return false;
}

/* Room for `wanted` items; false: reported. */
bool importer_grow(struct importer *importer, void **items, size_t *capacity, size_t wanted,
                   size_t size);

/* Takes the statement over, which is emptied; NULL: reported. */
const struct statement *importer_keep(struct importer *importer, struct statement *statement);

/* The map from an object's space into the scene's, of which the world's z axis may be mirrored.
 * False, reported, where it has no inverse. */
bool importer_placement(struct importer *importer, const struct transform *ctm,
                        const struct origin *origin, int width, struct transform *placement);

/* Where objects are written: the current object's group, or the scene. */
FILE *importer_objects(struct importer *importer);

/* The path under which the scene names a file that the pbrt scene names; to be freed. NULL:
 * reported. */
char *importer_file_name(struct importer *importer, const char *name);
/* The path under which that file is opened now, which is not to be overwritten; to be freed. NULL:
 * reported. */
char *importer_file_path(struct importer *importer, const char *name);
/* For a file that only the new scene opens: warns where it is not there. With a folder to read
 * from, one that does not lie there is an error. */
void importer_check_file(struct importer *importer, const struct place *place, const char *path);

#endif
