/* texture_cache.h: decoded pictures in a folder, for the next time, and so that not all of them have to lie in memory.
 *
 * An entry's name stands for the bytes of the picture's file, its layer and encoding, and the code that decodes. In the
 * entry are the samples of all levels (mip_map.h), in tiles: what a look-up and its neighbours need lies in a few pages of memory. It is
 * mapped (mapped_file.h). Entries are whole or not there (output_file.h), and any number of processes can use one folder. What
 * lies in it is believed, so the folder has to be one's own.
 *
 * Not OpenImageIO, which has tiles, MIP maps and a cache of them: its interface is C++ alone.
 */
#ifndef SCENE_TEXTURE_CACHE_H
#define SCENE_TEXTURE_CACHE_H

#include "scene/texture.h"

/* The entry's name, to be freed, for what is said of a picture, and the bytes of its file. NULL when out of memory. */
char *texture_cache_path(const char *folder, const struct texture_description *description,
                         const unsigned char *bytes, size_t size);

/* The texels from the entry: `texture` refers to them, whatever it referred to. PS_ERROR_IO leaves it as it was. */
ps_result texture_cache_load(const char *path, struct mapped_budget *budget,
                             struct texture *texture, struct error *error);

/* Makes the entry of texels that lie in memory. PS_ERROR_IO or _MEMORY, with a reason in lower case. */
ps_result texture_cache_store(const char *path, struct texture *texture, struct error *error);

#endif
