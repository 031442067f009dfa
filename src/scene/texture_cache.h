/* texture_cache.h: decoded pictures in a folder, for the next time, and so that not all of them
 * have to lie in memory.
 *
 * An entry's name stands for the bytes of the picture's file, its layer and encoding, and the code
 * that decodes. In the entry are the samples of all levels (mip_map.h), in tiles: what a look-up
 * and its neighbours need lies in a few pages of memory. It is mapped (mapped_file.h). Entries are
 * whole or not there (output_file.h), and any number of processes can use one folder. What lies in
 * it is believed, so the folder has to be one's own.
 *
 * Entries are made of a picture's lines, from the top, so that it need not lie in memory: what is
 * kept of each level is a row of tiles.
 *
 * Not OpenImageIO, which has tiles, MIP maps and a cache of them: its interface is C++ alone.
 */
#ifndef SCENE_TEXTURE_CACHE_H
#define SCENE_TEXTURE_CACHE_H

#include "scene/texture.h"

/* The entry's name, to be freed, for what is said of a picture, and the bytes of its file. NULL
 * when out of memory. */
char *texture_cache_path(const char *folder, const struct texture_description *description,
                         const unsigned char *bytes, size_t size);

/* The texels from the entry: `texture` refers to them, whatever it referred to. PS_ERROR_IO leaves
 * it as it was. */
ps_result texture_cache_load(const char *path, struct mapped_budget *budget,
                             struct texture *texture, struct error *error);

/* An entry under way. One thread. */
struct texture_entry;

/* Begins one, for a texture whose raster is known but for samples and what was mended, and which
 * has tables. NULL with a reason in lower case. The texture is borrowed until the end. */
struct texture_entry *texture_entry_begin(const char *path, const struct texture *texture,
                                          struct error *error);

/* Adds a line. PS_ERROR_IO or _MEMORY, with a reason as above. */
ps_result texture_entry_add(struct texture_entry *entry, const void *samples, struct error *error);

/* Puts it in its place when all lines are there, of which so many samples were mended (raster.h);
 * releases it, whatever happens. PS_ERROR_IO. */
ps_result texture_entry_end(struct texture_entry *entry, size_t mended, struct error *error);
void texture_entry_discard(struct texture_entry *entry); /* or NULL */

#endif
