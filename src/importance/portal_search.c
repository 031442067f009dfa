#include "importance/portal_search.h"

#include "importance/lit_rectangles.h"
#include <math.h>
#include <psplat/math.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 64

/* Rays from each surface by the cosine, and then into portals. */
#define RAYS 2

#define FEWEST_OPEN 32    /* rays */
#define MOST_OPEN 0.25    /* of the rays: more, and it is no room */
#define LEFT_OUT 0.01     /* of the surfaces, on each side of the box: those beyond a window */
#define MARGIN 0.002f     /* of the box */
#define LEAST_GAIN 4.0    /* how much more often rays into portals have to get out */
#define SURE_OF_CELL 2.0f /* rays by which a part of the box is told from the others */

/* Of PS_STREAM_EMISSION, far from those of light paths and of the pilot. */
#define FIRST_SET 0x280000u

struct search {
    const ps_host *host;
    float offset; /* of surfaces */
    const struct seen_surface *surfaces;
    size_t count;
    const struct portals *portals; /* rays go into these; NULL: by the cosine */
    /* Of each ray, RAYS of each surface. */
    ps_vec3 *directions;
    bool *drawn; /* false: it goes nowhere */
    uint8_t *blocked;
};

/* --- rays --- */

static bool draw(const struct search *search, size_t surface, const float numbers[2],
                 ps_vec3 *direction)
{
    const struct seen_surface *from = &search->surfaces[surface];
    if (!search->portals) {
        *direction = ps_cosine_direction(from->normal, numbers[0], numbers[1]);
        return true;
    }
    return portals_know(search->portals, from->position) &&
           portals_choose(search->portals, from->position, from->normal, numbers, direction) &&
           ps_dot(*direction, from->normal) > 0.0f;
}

static void trace_chunk(void *user, uint64_t chunk, uint32_t worker)
{
    (void)worker;
    const struct search *search = user;
    size_t first = (size_t)chunk * CHUNK, n = 0;
    size_t end = first + CHUNK < search->count ? first + CHUNK : search->count;
    uint64_t indices[CHUNK] = {0};
    float numbers[CHUNK][4];
    ps_ray rays[CHUNK * RAYS];
    uint8_t blocked[CHUNK * RAYS];
    for (size_t i = first; i < end; i++)
        indices[i - first] = i;
    search->host->samples(search->host, PS_STREAM_EMISSION, FIRST_SET + (search->portals ? 1 : 0),
                          indices, end - first, numbers);
    for (size_t i = first; i < end; i++)
        for (int ray = 0; ray < RAYS; ray++) {
            size_t at = i * RAYS + (size_t)ray;
            search->drawn[at] =
                draw(search, i, numbers[i - first] + 2 * ray, &search->directions[at]);
            if (search->drawn[at])
                rays[n++] =
                    ps_leave_surface(search->surfaces[i].position, search->surfaces[i].normal,
                                     search->directions[at], search->offset);
        }
    search->host->occluded(search->host, rays, n, blocked);
    n = 0;
    for (size_t at = first * RAYS; at < end * RAYS; at++)
        search->blocked[at] = search->drawn[at] ? blocked[n++] : 1;
}

static void trace(struct search *search)
{
    search->host->parallel_for(search->host, (search->count + CHUNK - 1) / CHUNK, trace_chunk,
                               search);
}

static size_t count_open(const struct search *search)
{
    size_t open = 0;
    for (size_t ray = 0; ray < search->count * RAYS; ray++)
        open += !search->blocked[ray];
    return open;
}

/* --- the box --- */

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static bool is_within(const struct search *search, size_t surface)
{
    for (size_t ray = 0; ray < RAYS; ray++)
        if (!search->blocked[surface * RAYS + ray])
            return false;
    return true;
}

/* Along one axis, but for the outermost surfaces; `room` is for all of them. */
static void bound(const struct search *search, int axis, float *room, float *low, float *high)
{
    size_t n = 0;
    for (size_t i = 0; i < search->count; i++) {
        const ps_vec3 *at = &search->surfaces[i].position;
        if (is_within(search, i))
            room[n++] = axis == 0 ? at->x : axis == 1 ? at->y : at->z;
    }
    *low = *high = 0.0f;
    if (n == 0)
        return;
    qsort(room, n, sizeof *room, compare_floats);
    size_t left_out = (size_t)(LEFT_OUT * (double)n);
    *low = room[left_out];
    *high = room[n - 1 - left_out];
}

/* False: it is flat. */
static bool bound_room(const struct search *search, float *room, struct portals *portals)
{
    ps_vec3 low, high;
    bound(search, 0, room, &low.x, &high.x);
    bound(search, 1, room, &low.y, &high.y);
    bound(search, 2, room, &low.z, &high.z);
    ps_vec3 size = ps_subtract(high, low);
    float margin = MARGIN * ps_max(size.x, ps_max(size.y, size.z));
    ps_vec3 more = {margin, margin, margin};
    portals_begin(portals, ps_subtract(low, more), ps_add(high, more));
    return size.x > 0.0f && size.y > 0.0f && size.z > 0.0f;
}

/* --- windows --- */

/* Where a ray of the search leaves the box; false where it does not start in there. */
static bool find_exit(const struct search *search, const struct portals *portals, size_t ray,
                      struct portal_exit *exit)
{
    ps_vec3 position = search->surfaces[ray / RAYS].position;
    if (!search->drawn[ray] || !portals_know(portals, position))
        return false;
    *exit = portals_exit(portals, position, search->directions[ray]);
    return true;
}

/* Adds the bins by which rays got out. Returns how many. */
static size_t count_exits(const struct search *search, const struct portals *portals,
                          struct exit_counts *counts)
{
    size_t exits = 0;
    for (size_t ray = 0; ray < search->count * RAYS; ray++) {
        struct portal_exit exit;
        if (search->blocked[ray] || !find_exit(search, portals, ray, &exit))
            continue;
        exit_counts_add(counts, &exit);
        exits++;
    }
    return exits;
}

/* Rays into a portal. */
struct tries {
    float open, all;
};

static void add_try(struct tries *tries, bool blocked)
{
    tries->open += blocked ? 0.0f : 1.0f;
    tries->all += 1.0f;
}

static float share_of(const struct tries *tries, float mean, float rays_of_mean)
{
    return (tries->open + rays_of_mean * mean) / (tries->all + rays_of_mean);
}

/* How much of each portal is seen from each part of the box, by rays that went there. What is known
 * of all parts counts in each as much as SURE_OF_CELL rays. Returns the share of those rays that
 * got out. */
static double learn_visibility(const struct search *search, struct portals *portals,
                               struct tries (*of_cells)[PORTALS_MOST])
{
    struct tries of_portals[PORTALS_MOST] = {{0, 0}}, of_all = {0, 0};
    for (size_t ray = 0; ray < search->count * RAYS; ray++) {
        struct portal_exit exit;
        uint32_t portal = find_exit(search, portals, ray, &exit) ? portals_at(portals, &exit) : 0;
        if (portal == 0)
            continue;
        size_t cell = portals_cell(portals, search->surfaces[ray / RAYS].position);
        bool blocked = search->blocked[ray];
        add_try(&of_cells[cell][portal - 1], blocked);
        add_try(&of_portals[portal - 1], blocked);
        add_try(&of_all, blocked);
    }
    for (size_t portal = 0; portal < portals->count; portal++) {
        float mean = share_of(&of_portals[portal], 0.5f, 2.0f);
        for (size_t cell = 0; cell < PORTAL_CELL_COUNT; cell++)
            portals->visibility[cell][portal] =
                share_of(&of_cells[cell][portal], mean, SURE_OF_CELL);
    }
    return of_all.all > 0.0f ? (double)(of_all.open / of_all.all) : 0.0;
}

/* --- the search --- */

/* Room for the search. */
struct room {
    float *numbers; /* one of each surface */
    struct exit_counts *counts;
    struct tries (*tries)[PORTALS_MOST];
};

/* Whether portals were found that help. First where a few rays by the cosine got out, and then
 * finer, by rays that go there. */
static bool find(struct search *search, const struct room *room, struct portals *portals)
{
    trace(search);
    size_t open = count_open(search);
    double share = (double)open / (double)(search->count * RAYS);
    if (open < FEWEST_OPEN || share > MOST_OPEN || !bound_room(search, room->numbers, portals))
        return false;
    size_t exits = count_exits(search, portals, room->counts);
    if (exits < FEWEST_OPEN || !lit_rectangles(room->counts, exits, portals))
        return false;
    search->portals = portals;
    trace(search);
    exits += count_exits(search, portals, room->counts);
    return lit_rectangles(room->counts, exits, portals) &&
           learn_visibility(search, portals, room->tries) > LEAST_GAIN * share;
}

static void release_room(struct room *room)
{
    free(room->numbers);
    free(room->counts);
    free(room->tries);
}

ps_result portal_search(const ps_host *host, const ps_pass *pass,
                        const struct seen_surface *surfaces, size_t count, struct portals **portals,
                        struct error *error)
{
    *portals = NULL;
    if (count == 0)
        return PS_OK;
    struct search search = {
        .host = host,
        .offset = pass->surface_offset,
        .surfaces = surfaces,
        .count = count,
        .directions = calloc(count * RAYS, sizeof *search.directions),
        .blocked = calloc(count * RAYS, 1),
        .drawn = calloc(count * RAYS, sizeof *search.drawn),
    };
    struct room room = {
        .numbers = calloc(count, sizeof *room.numbers),
        .counts = calloc(1, sizeof *room.counts),
        .tries = calloc(PORTAL_CELL_COUNT, sizeof *room.tries),
    };
    struct portals *found = calloc(1, sizeof *found);
    bool has_room = search.directions && search.blocked && search.drawn && room.numbers &&
                    room.counts && room.tries && found;
    if (has_room && find(&search, &room, found)) {
        *portals = found;
        found = NULL;
    }
    free(search.directions);
    free(search.blocked);
    free(search.drawn);
    release_room(&room);
    free(found);
    return has_room ? PS_OK : error_memory(error, sizeof *found, "portals");
}
