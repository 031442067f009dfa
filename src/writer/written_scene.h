/* written_scene.h: what a converter of another renderer's scenes makes: a .psd text and the files
 * beside it.
 *
 * Owned by the caller; no state elsewhere.
 */
#ifndef WRITER_WRITTEN_SCENE_H
#define WRITER_WRITTEN_SCENE_H

#include <stddef.h>

/* A file beside the scene. */
struct side_file {
    char *name;  /* owned */
    void *bytes; /* owned; NULL where it is a picture */
    size_t size;
    struct image *picture; /* owned; or NULL */
};

/* Zeroed: empty. */
struct written_scene {
    char *text; /* owned; the .psd */
    size_t length;
    struct side_file *files; /* owned */
    size_t file_count;
    char **named; /* owned, each too; paths of files that the scene that was read names */
    size_t named_count;
};

void written_scene_release(struct written_scene *scene);

#endif
