/* cache.h: what was made of mesh files, kept in a folder for the next time.
 *
 * An entry's name stands for the file's bytes, for the request, and for the code that imports. In
 * the entry are the content, as transfer.c moves it, and all that the import asked of the disk
 * (looks.h): libraries, buffers, whether textures are there. It counts while the disk says the
 * same. Entries are whole or not there (output_file.h), and any number of processes can use one
 * folder. What lies in it is believed, so the folder has to be one's own.
 */
#ifndef IMPORT_CACHE_H
#define IMPORT_CACHE_H

#include "import/transfer.h"

struct mesh_cache_entry {
    char *path;    /* owned; NULL: there can be none */
    uint64_t file; /* the mesh file's digest */
};

/* Of a request. There is none where it names no cache, or where the file cannot be read. */
struct mesh_cache_entry mesh_cache_entry(const struct mesh_request *request);

/* Whether the entry was there, and gave the outcome; else `outcome` stays zeroed. */
bool mesh_cache_load(const struct mesh_cache_entry *entry, const struct mesh_request *request,
                     struct mesh_outcome *outcome);

/* Makes the entry from a transfer file, whose outcome has come. PS_ERROR_IO or _MEMORY. */
ps_result mesh_cache_store(const struct mesh_cache_entry *entry, int transfer, struct error *error);

#endif
