#include "import/cache.h"

#include "base/input_file.h"
#include "base/output_file.h"
#include "base/version.h"
#include <assimp/version.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#define BLOCK ((size_t)1 << 20)

/* Before the content. */
struct header {
    char magic[8];
    uint64_t size, digest; /* of the content */
};

static const char magic[8] = "psplatM";

/* --- names
 * ----------------------------------------------------------------------------------------- */

static void add(XXH3_state_t *key, const void *bytes, size_t size)
{
    (void)XXH3_64bits_update(key, bytes, size);
}

/* PSPLAT_IMPORTER is a digest of the sources that fill descriptions. Structs are stored as they are
 * in memory. */
static void add_program(XXH3_state_t *key)
{
    const uint64_t numbers[] = {
        sizeof(struct mesh_outcome),
        sizeof(struct mesh_description),
        sizeof(struct object_description),
        sizeof(struct material_description),
        sizeof(struct texture_description),
        sizeof(struct camera_description),
        sizeof(struct light_description),
        sizeof(struct mesh_look),
        aiGetVersionMajor(),
        aiGetVersionMinor(),
        aiGetVersionPatch(),
        aiGetVersionRevision(),
    };
    static const char program[] = PSPLAT_VERSION " " PSPLAT_IMPORTER;
    add(key, program, sizeof program);
    add(key, numbers, sizeof numbers);
}

static void add_request(XXH3_state_t *key, const struct mesh_request *request)
{
    const uint64_t digest = mesh_request_digest(request);
    const unsigned char used[] = {request->geometry, request->materials, request->camera,
                                  request->lights};
    add(key, &digest, sizeof digest);
    add(key, used, sizeof used);
}

static char *entry_path(const char *folder, uint64_t key)
{
    size_t size = strlen(folder) + sizeof "/0123456789abcdef.mesh";
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%016" PRIx64 ".mesh", folder, key);
    return path;
}

struct mesh_cache_entry mesh_cache_entry(const struct mesh_request *request)
{
    struct mesh_cache_entry entry = {.path = NULL};
    if (!request->cache || !mesh_file_digest(request->path, request->folder, &entry.file))
        return entry;
    XXH3_state_t *key = XXH3_createState();
    if (key && XXH3_64bits_reset(key) == XXH_OK) {
        add_program(key);
        add_request(key, request);
        add(key, &entry.file, sizeof entry.file);
        entry.path = entry_path(request->cache, XXH3_64bits_digest(key));
    }
    XXH3_freeState(key);
    return entry;
}

/* --- loading
 * --------------------------------------------------------------------------------------- */

static bool is_whole(int file)
{
    const struct input_file input = {.descriptor = file};
    struct header header;
    struct error ignored;
    size_t length = sizeof header;
    uint64_t size, digest;
    return input_file_read(&input, &header, &length, &ignored) == PS_OK &&
           length == sizeof header && memcmp(header.magic, magic, sizeof magic) == 0 &&
           mesh_digest_rest(file, &size, &digest) && size == header.size &&
           digest == header.digest && lseek(file, sizeof header, SEEK_SET) == sizeof header;
}

bool mesh_cache_load(const struct mesh_cache_entry *entry, const struct mesh_request *request,
                     struct mesh_outcome *outcome)
{
    struct input_file input;
    struct error ignored;
    if (input_file_open(entry->path, NULL, &input, &ignored) != PS_OK)
        return false;
    bool came = is_whole(input.descriptor) && mesh_outcome_receive(outcome, input.descriptor);
    bool holds =
        came && mesh_looks_hold(&outcome->looks, request->folder, request->path, entry->file);
    close(input.descriptor);
    if (came && !holds)
        mesh_outcome_release(outcome);
    if (holds)
        mesh_fragment_set_origins(&outcome->fragment, request->origin);
    else
        *outcome = (struct mesh_outcome){.result = PS_OK};
    return holds;
}

/* --- storing
 * --------------------------------------------------------------------------------------- */

static ps_result copy(int transfer, struct output_file *file, struct error *error)
{
    const struct input_file input = {.descriptor = transfer};
    unsigned char *block = malloc(BLOCK);
    uint64_t at = sizeof(struct header);
    size_t length = BLOCK;
    ps_result result = block ? PS_OK : error_memory(error, BLOCK, "a mesh cache");
    while (result == PS_OK && length == BLOCK) {
        result = input_file_read(&input, block, &length, error);
        if (result == PS_OK && length > 0)
            result = output_file_write(file, at, block, length, error);
        at += length;
    }
    free(block);
    return result;
}

static ps_result write_entry(int transfer, struct output_file *file, struct error *error)
{
    struct header header = {.size = 0};
    memcpy(header.magic, magic, sizeof magic);
    if (lseek(transfer, 0, SEEK_SET) != 0 ||
        !mesh_digest_rest(transfer, &header.size, &header.digest) ||
        lseek(transfer, 0, SEEK_SET) != 0)
        return error_set(error, PS_ERROR_IO, "a file in memory cannot be read");
    ps_result result = output_file_write(file, 0, &header, sizeof header, error);
    return result == PS_OK ? copy(transfer, file, error) : result;
}

ps_result mesh_cache_store(const struct mesh_cache_entry *entry, int transfer, struct error *error)
{
    struct output_file file;
    ps_result result = output_file_open(&file, entry->path, error);
    if (result != PS_OK)
        return result;
    result = write_entry(transfer, &file, error);
    if (result == PS_OK)
        return output_file_commit(&file, error);
    output_file_discard(&file);
    return result;
}
