#include "import/looks.h"

#include "base/input_file.h"
#include "import/files.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#define BLOCK ((size_t)1 << 20)

void mesh_looks_add(struct mesh_looks *looks, struct mesh_look look, const char *path)
{
    if (!looks || looks->incomplete)
        return;
    struct mesh_look *items = realloc(looks->items, (looks->count + 1) * sizeof *items);
    look.path = items ? strdup(path) : NULL;
    if (items)
        looks->items = items;
    if (look.path)
        items[looks->count++] = look;
    looks->incomplete = !look.path;
}

void mesh_looks_release(struct mesh_looks *looks)
{
    for (size_t i = 0; i < looks->count; i++)
        free(looks->items[i].path);
    free(looks->items);
    *looks = (struct mesh_looks){.count = 0};
}

uint64_t mesh_digest(const void *bytes, size_t size)
{
    return XXH3_64bits(bytes, size);
}

bool mesh_digest_rest(int file, uint64_t *size, uint64_t *digest)
{
    const struct input_file input = {.descriptor = file};
    unsigned char *block = malloc(BLOCK);
    XXH3_state_t *state = XXH3_createState();
    struct error ignored;
    size_t length = BLOCK;
    bool good = block && state && XXH3_64bits_reset(state) == XXH_OK;
    *size = 0;
    while (good && length == BLOCK) {
        good = input_file_read(&input, block, &length, &ignored) == PS_OK &&
               XXH3_64bits_update(state, block, length) == XXH_OK;
        *size += length;
    }
    *digest = good ? XXH3_64bits_digest(state) : 0;
    XXH3_freeState(state);
    free(block);
    return good;
}

bool mesh_file_digest(const char *path, const char *folder, uint64_t *digest)
{
    struct input_file input;
    struct error ignored;
    uint64_t size;
    *digest = 0;
    if (input_file_open(path, folder, &input, &ignored) != PS_OK)
        return false;
    bool good =
        input.size <= MESH_FILE_LARGEST && mesh_digest_rest(input.descriptor, &size, digest);
    close(input.descriptor);
    return good;
}

static bool first_bytes_hold(const struct mesh_look *look, struct mesh_files *disk)
{
    unsigned char bytes[MESH_PEEK_MOST];
    return look->size <= sizeof bytes &&
           mesh_digest(bytes, mesh_files_peek(disk, look->path, bytes, look->size)) == look->digest;
}

static bool case_holds(const struct mesh_look *look, struct mesh_files *disk)
{
    char *path = strdup(look->path);
    bool holds = path && mesh_files_match_case(disk, path, look->size) == look->there &&
                 mesh_digest(path, strlen(path)) == look->digest;
    free(path);
    return holds;
}

static bool holds(const struct mesh_look *look, struct mesh_files *disk)
{
    uint64_t digest = 0;
    switch ((enum mesh_look_kind)look->kind) {
    case LOOK_WHOLE:
        return mesh_file_digest(look->path, disk->folder, &digest) == look->there &&
               digest == look->digest;
    case LOOK_EXISTS:
        return mesh_files_exist(disk, look->path) == look->there;
    case LOOK_FIRST:
        return first_bytes_hold(look, disk);
    case LOOK_CASE:
        return case_holds(look, disk);
    }
    return false;
}

bool mesh_looks_hold(const struct mesh_looks *looks, const char *folder, const char *known,
                     uint64_t known_digest)
{
    struct mesh_files disk = {.folder = folder};
    bool all = !looks->incomplete;
    for (size_t i = 0; all && i < looks->count; i++) {
        const struct mesh_look *look = &looks->items[i];
        if (look->kind == LOOK_WHOLE && strcmp(look->path, known) == 0)
            all = look->there && look->digest == known_digest;
        else
            all = holds(look, &disk);
    }
    return all;
}
