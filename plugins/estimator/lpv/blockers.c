#include "light_grid.h"

#include <string.h>

/* Lines along one axis, one at a time. */
struct marking {
    struct blockers *blockers;
    uint32_t per_cell;
    uint32_t *last_faces; /* of each line of a row: the face that it was counted at */
};

static size_t face_count(const struct voxel_grid *grid)
{
    return (size_t)grid->across * grid->across * (grid->across + 1);
}

/* A surface_lines_take. */
static void mark(void *user, struct surface_crossings *crossings)
{
    const struct marking *marking = user;
    const struct voxel_grid *grid = &marking->blockers->grid;
    uint32_t axis = surface_axis(crossings->way);
    float share = 1.0f / (float)(marking->per_cell * marking->per_cell);
    for (size_t i = 0; i < crossings->n; i++) {
        uint32_t column = crossings->columns[i], cell[3];
        float place[3];
        voxel_grid_place(grid, crossings->hits[i].position, place);
        float nearest = ps_min(ps_max(place[axis] + 0.5f, 0.0f), (float)grid->across);
        cell[axis] = (uint32_t)nearest;
        cell[(axis + 1) % 3] = column / marking->per_cell;
        cell[(axis + 2) % 3] = crossings->row / marking->per_cell;
        if (crossings->round > 0 && marking->last_faces[column] == cell[axis])
            continue;
        marking->last_faces[column] = cell[axis];
        float *face = &marking->blockers->faces[axis][blockers_face(grid, axis, cell)];
        *face = ps_min(*face + share, 1.0f);
    }
}

ps_result blockers_create(const struct surface_lines *lines, struct blockers *blockers)
{
    const ps_host *host = lines->host;
    *blockers = (struct blockers){.host = host, .grid = lines->grid};
    uint32_t across = surface_lines_across(lines);
    size_t bytes = face_count(&lines->grid) * sizeof *blockers->faces[0];
    struct marking marking = {
        .blockers = blockers,
        .per_cell = lines->per_cell,
        .last_faces = host->allocate(host, across * sizeof *marking.last_faces, LPV_MEMORY),
    };
    ps_result result = marking.last_faces ? PS_OK : PS_ERROR_MEMORY;
    for (uint32_t axis = 0; axis < 3; axis++) {
        blockers->faces[axis] = host->allocate(host, bytes, LPV_MEMORY);
        if (!blockers->faces[axis])
            result = PS_ERROR_MEMORY;
        else
            memset(blockers->faces[axis], 0, bytes);
    }
    for (uint32_t i = 0; result == PS_OK && i < 3 * across; i++) {
        if (host->cancelled(host))
            result = PS_CANCELLED;
        else
            surface_lines_follow(lines, i / across, i % across, mark, &marking);
    }
    host->release(host, marking.last_faces);
    return result;
}

void blockers_release(struct blockers *blockers)
{
    for (uint32_t axis = 0; axis < 3; axis++)
        blockers->host->release(blockers->host, blockers->faces[axis]);
    *blockers = (struct blockers){.host = blockers->host};
}
