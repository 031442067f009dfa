/* input_file.h: opens the files that a scene names: scenes it includes, meshes, pictures.
 *
 * Only regular files: a scene must not make the program wait for a pipe or read a device. Scenes
 * are passed around, so a program that renders other people's can name a folder (psplat --restrict)
 * outside of which no file is opened, whatever paths and symbolic links the scene comes with.
 */
#ifndef BASE_INPUT_FILE_H
#define BASE_INPUT_FILE_H

#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Owned by the caller, who closes the descriptor. `device` and `serial` name the file to the
 * system: two paths with the same pair are one file. */
struct input_file {
    int descriptor;
    uint64_t size, device, serial;
};

/* Opens a regular file for reading. `folder`: NULL, or what input_folder_resolve returned; then a
 * file outside of it and one that is not there give the same message, so that a scene can't ask
 * what files there are. PS_ERROR_IO, or PS_ERROR_INVALID where the folder forbids it, with a reason
 * that starts in lower case and does not name the path. */
ps_result input_file_open(const char *path, const char *folder, struct input_file *file,
                          struct error *error);

/* Reads from where the file was left: `*size` bytes, or as many as there are up to its end, which
 * `*size` then becomes. PS_ERROR_IO with a reason as above. */
ps_result input_file_read(const struct input_file *file, void *bytes, size_t *size,
                          struct error *error);

/* Whether input_file_open would find a regular file there. */
bool input_file_exists(const char *path, const char *folder);

/* Whether `path` is the folder, or lies in it, links resolved; `folder` as above, and any path does
 * where it is NULL. */
bool input_folder_has(const char *folder, const char *path);

/* The folder's absolute path without symbolic links, to be freed; NULL, with PS_ERROR_IO's message,
 * where there is no such folder. */
char *input_folder_resolve(const char *path, struct error *error);

#endif
