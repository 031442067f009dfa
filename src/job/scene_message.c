#include "job/scene_message.h"

#include "base/file.h"
#include "base/version.h"
#include "scene/transfer.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* All blocks are of one size, which a rank knows before it receives them. */
#define BLOCK_BYTES ((size_t)32 * 1024)

enum block_kind { BLOCK_MORE, BLOCK_LAST };

struct block {
    uint32_t kind; /* enum block_kind */
    uint32_t used; /* bytes */
    unsigned char bytes[BLOCK_BYTES];
};

struct stream {
    const struct transport *transport;
    struct block block;
    size_t at; /* in the block: bytes that were written, or read */
};

/* Whether what comes can be read here. */
struct head {
    char program[32];
    uint64_t sizes[8];
    uint64_t has_scene;
};

static struct head head_of(bool has_scene)
{
    return (struct head){
        .program = PSPLAT_VERSION,
        .sizes = {sizeof(struct scene_description), sizeof(struct mesh_description),
                  sizeof(struct object_description), sizeof(struct material_description),
                  sizeof(struct texture_description), sizeof(struct camera_description),
                  sizeof(struct light_description), sizeof(struct group_description)},
        .has_scene = has_scene,
    };
}

/* --- blocks
 * ---------------------------------------------------------------------------------------- */

/* To ranks that are 1, 2, 4, ... above it, below the lowest bit of its own number; the tree is that
 * of team.c, from its root. */
static void hand_on(const struct transport *transport, const struct block *block)
{
    for (int step = 1; step < transport->size && !(transport->rank & step); step *= 2)
        if (transport->rank + step < transport->size)
            transport->send(transport->rank + step, TAG_SCENE, block, sizeof *block);
}

static void send_block(struct stream *stream, enum block_kind kind)
{
    stream->block.kind = (uint32_t)kind;
    stream->block.used = (uint32_t)stream->at;
    hand_on(stream->transport, &stream->block);
    stream->at = 0;
}

static void receive_block(struct stream *stream)
{
    const struct transport *transport = stream->transport;
    int from = transport->rank & (transport->rank - 1);
    transport->receive(from, TAG_SCENE, &stream->block, sizeof stream->block);
    hand_on(transport, &stream->block);
    stream->at = 0;
}

/* A transfer.move. */
static bool write_bytes(void *user, void *bytes, size_t size)
{
    struct stream *stream = user;
    const unsigned char *rest = bytes;
    while (size > 0) {
        if (stream->at == BLOCK_BYTES)
            send_block(stream, BLOCK_MORE);
        size_t room = BLOCK_BYTES - stream->at, piece = size < room ? size : room;
        memcpy(stream->block.bytes + stream->at, rest, piece);
        stream->at += piece;
        rest += piece;
        size -= piece;
    }
    return true;
}

static bool read_bytes(void *user, void *bytes, size_t size)
{
    struct stream *stream = user;
    unsigned char *rest = bytes;
    while (size > 0) {
        if (stream->at == stream->block.used && stream->block.kind == BLOCK_LAST)
            return false;
        if (stream->at == stream->block.used)
            receive_block(stream);
        size_t left = stream->block.used - stream->at, piece = size < left ? size : left;
        memcpy(rest, stream->block.bytes + stream->at, piece);
        stream->at += piece;
        rest += piece;
        size -= piece;
    }
    return true;
}

/* --- the scene
 * ------------------------------------------------------------------------------------- */

/* Reads those of its pictures that are files. One that cannot be read stays away: rank 0 tells why
 * when it makes the scene. */
static void read_textures(const struct scene_description *description, struct file_text *files)
{
    for (size_t i = 0; i < description->texture_count; i++) {
        struct texture_description *texture = &description->textures[i];
        struct error ignored;
        if (texture->bytes || file_read_regular(texture->path, description->folder, SIZE_MAX / 2,
                                                &files[i], &ignored) != PS_OK)
            continue;
        texture->bytes = (unsigned char *)files[i].bytes;
        texture->byte_count = files[i].length;
    }
}

static void drop_textures(const struct scene_description *description, struct file_text *files)
{
    for (size_t i = 0; i < description->texture_count; i++) {
        struct texture_description *texture = &description->textures[i];
        if (files[i].bytes) {
            texture->bytes = NULL;
            texture->byte_count = 0;
        }
        file_release(&files[i]);
    }
}

static void send_scene(struct stream *stream, struct scene_description *description)
{
    struct file_text *files = calloc(description->texture_count + 1, sizeof *files);
    struct head head = head_of(files != NULL);
    struct transfer transfer = {.move = write_bytes, .user = stream};
    transfer_bytes(&transfer, &head, sizeof head);
    if (!files)
        return;
    read_textures(description, files);
    transfer_bytes(&transfer, description, sizeof *description);
    transfer_bytes(&transfer, description->files,
                   description->file_count * sizeof *description->files);
    transfer_description(&transfer, description);
    drop_textures(description, files);
    free(files);
}

void scene_message_send(const struct transport *transport, struct scene_description *description)
{
    struct stream stream = {.transport = transport};
    struct head none = head_of(false);
    if (transport->size == 1)
        return;
    if (description)
        send_scene(&stream, description);
    else
        write_bytes(&stream, &none, sizeof none);
    send_block(&stream, BLOCK_LAST);
}

static ps_result receive_scene(struct stream *stream, struct scene_description *description,
                               struct error *error)
{
    struct transfer transfer = {.move = read_bytes, .user = stream, .receives = true};
    struct head head, own = head_of(true);
    transfer_bytes(&transfer, &head, sizeof head);
    if (transfer.failed || memcmp(&head, &own, sizeof head) != 0)
        return error_set(error, PS_ERROR_INVALID,
                         "the first process has no scene, or is another psplat");
    transfer_bytes(&transfer, description, sizeof *description);
    if (transfer.failed)
        *description = (struct scene_description){0};
    const char **old = malloc((description->file_count + 1) * sizeof *old);
    if (!old) {
        *description = (struct scene_description){0};
        return error_memory(error, description->file_count * sizeof *old, "a scene");
    }
    transfer_bytes(&transfer, old, description->file_count * sizeof *old);
    transfer_description(&transfer, description);
    if (transfer.failed)
        scene_description_release(description);
    else
        transfer_names(description, old);
    free(old);
    return transfer.failed
               ? error_set(error, PS_ERROR_MEMORY, "out of memory for the first process's scene")
               : PS_OK;
}

static void receive_rest(struct stream *stream)
{
    while (stream->block.kind != BLOCK_LAST)
        receive_block(stream);
}

ps_result scene_message_receive(const struct transport *transport,
                                struct scene_description *description, struct error *error)
{
    struct stream stream = {.transport = transport, .block = {.kind = BLOCK_MORE}};
    *description = (struct scene_description){0};
    ps_result result = receive_scene(&stream, description, error);
    receive_rest(&stream);
    return result;
}

void scene_message_skip(const struct transport *transport)
{
    struct stream stream = {.transport = transport, .block = {.kind = BLOCK_MORE}};
    receive_rest(&stream);
}
