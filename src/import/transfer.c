#include "import/transfer.h"

#include "base/input_file.h"
#include "scene/transfer.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int mesh_transfer_open(void)
{
#ifdef MFD_CLOEXEC
    return memfd_create("mesh", MFD_CLOEXEC);
#else
    FILE *stream = tmpfile();
    int file = stream ? dup(fileno(stream)) : -1;
    if (stream)
        fclose(stream);
    return file;
#endif
}

/* A transfer.move by way of the open file at `user`. */
static bool write_all(void *user, void *bytes, size_t size)
{
    const int *file = user;
    const char *rest = bytes;
    while (size > 0) {
        ssize_t written = write(*file, rest, size);
        if (written > 0) {
            rest += written;
            size -= (size_t)written;
        } else if (written == 0 || errno != EINTR) {
            return false;
        }
    }
    return true;
}

static bool read_all(void *user, void *bytes, size_t size)
{
    const struct input_file input = {.descriptor = *(const int *)user};
    struct error ignored;
    size_t wanted = size;
    return input_file_read(&input, bytes, &size, &ignored) == PS_OK && size == wanted;
}

static void move_looks(struct transfer *transfer, struct mesh_looks *looks)
{
    transfer_structs(transfer, &looks->items, &looks->count, sizeof *looks->items);
    for (size_t i = 0; i < looks->count; i++)
        transfer_text(transfer, &looks->items[i].path);
}

static void move_outcome(struct transfer *transfer, struct mesh_outcome *outcome)
{
    transfer_bytes(transfer, outcome, sizeof *outcome);
    if (transfer->receives && transfer->failed)
        *outcome = (struct mesh_outcome){.result = PS_ERROR_IO};
    transfer_description(transfer, &outcome->fragment);
    move_looks(transfer, &outcome->looks);
}

bool mesh_outcome_send(struct mesh_outcome *outcome, int file)
{
    struct transfer transfer = {.move = write_all, .user = &file};
    move_outcome(&transfer, outcome);
    return !transfer.failed;
}

bool mesh_outcome_receive(struct mesh_outcome *outcome, int file)
{
    struct transfer transfer = {.move = read_all, .user = &file, .receives = true};
    move_outcome(&transfer, outcome);
    if (!transfer.failed)
        return true;
    mesh_outcome_release(outcome);
    return false;
}

void mesh_outcome_release(struct mesh_outcome *outcome)
{
    scene_description_release(&outcome->fragment);
    mesh_looks_release(&outcome->looks);
}

void mesh_fragment_set_origins(struct scene_description *fragment, struct origin origin)
{
    for (size_t i = 0; i < fragment->object_count; i++)
        fragment->objects[i].origin = origin;
    for (size_t i = 0; i < fragment->material_count; i++)
        fragment->materials[i].origin = origin;
    for (size_t i = 0; i < fragment->texture_count; i++)
        fragment->textures[i].origin = origin;
    for (size_t i = 0; i < fragment->camera_count; i++)
        fragment->cameras[i].origin = origin;
    for (size_t i = 0; i < fragment->light_count; i++)
        fragment->lights[i].origin = origin;
}
