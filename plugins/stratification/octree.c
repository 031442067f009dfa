/* octree.c: the photons of each leaf of an octree become one.
 *
 * A node splits while it holds more than `capacity` photons, down to `depth`. So cells are small
 * where light is dense and large where it is not, and the power of the photons that are left
 * differs little: Hoet 2014 (section 5.1) names the octree as what a grid of fixed cells lacks.
 *
 * No tree is built. Sorted by Morton code (see cells.h), a node is a run of photons that share the
 * leading bits (Warren and Salmon 1993, "A parallel hashed oct-tree N-body algorithm").
 */
#include <psplat/plugin.h>

struct state {
    const ps_cells *cells;
    int64_t capacity;
    int64_t depth;
};

/* Cells of the deepest level; the root is the cube around the scene's sphere. */
static ps_lattice lattice_of(const ps_host *host)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return (ps_lattice){ps_subtract(center, (ps_vec3){radius, radius, radius}),
                        2.0 * (double)radius / PS_CELLS_ACROSS};
}

/* Whether the two lie in the same node of that depth. */
static int share_node(const ps_strata *strata, size_t a, size_t b, unsigned depth)
{
    unsigned shift = 3 * (PS_CELL_BITS - depth);
    return strata->entries[a].key >> shift == strata->entries[b].key >> shift;
}

/* The depth of the leaf that begins at entry `first`: the highest node that begins there and holds
 * no more than the capacity. */
static unsigned leaf_depth(const struct state *state, const ps_strata *strata, size_t first)
{
    size_t capacity = (size_t)state->capacity, left = strata->entry_count - first;
    for (unsigned depth = 0; depth < (unsigned)state->depth; depth++) {
        int begins = first == 0 || !share_node(strata, first - 1, first, depth);
        if (begins && (left <= capacity || !share_node(strata, first, first + capacity, depth)))
            return depth;
    }
    return (unsigned)state->depth;
}

static void split_into_leaves(const struct state *state, ps_strata *strata)
{
    for (size_t first = 0, end; first < strata->entry_count; first = end) {
        unsigned depth = leaf_depth(state, strata, first);
        for (end = first + 1; end < strata->entry_count && share_node(strata, first, end, depth);)
            end++;
        ps_strata_end_at(strata, end);
    }
}

static ps_result stratify(const void *opaque, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata)
{
    (void)pass;
    const struct state *state = opaque;
    ps_lattice lattice = lattice_of(host);
    for (size_t i = 0; i < n; i++)
        ps_strata_add(strata, i, state->cells->key(&lattice, 0, photons[i].position));
    ps_strata_sort(state->cells, strata);
    split_into_leaves(state, strata);
    return PS_OK;
}

/* The leaf that a cell of the deepest level lies in, whether it holds photons or not: its path from
 * the root, behind a leading 1. */
static uint64_t leaf_around(const struct state *state, const ps_strata *strata, uint64_t key)
{
    for (unsigned depth = 0;; depth++) {
        unsigned shift = 3 * (PS_CELL_BITS - depth);
        uint64_t node = key >> shift;
        size_t held =
            ps_strata_find(strata, (node + 1) << shift) - ps_strata_find(strata, node << shift);
        if (held <= (size_t)state->capacity || depth >= (unsigned)state->depth)
            return UINT64_C(1) << 3 * depth | node;
    }
}

static ps_result find_strata(const void *opaque, const ps_host *host, const ps_strata *strata,
                             const ps_vec3 *points, size_t count, uint64_t *numbers)
{
    const struct state *state = opaque;
    ps_lattice lattice = lattice_of(host);
    for (size_t i = 0; i < count; i++)
        numbers[i] = leaf_around(state, strata, state->cells->key(&lattice, 0, points[i]));
    return PS_OK;
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    state->cells = host->extension(host, PS_CELLS_EXTENSION);
    return PS_OK;
}

static const ps_param params[] = {
    PS_INT(struct state, capacity, "8", 1, 1000000000, "photons",
           "a node of more photons is split into eight"),
    PS_ROW(struct state, depth, PS_PARAM_INT, "10", 0, 20, PS_PARAM_EXPERT, NULL, "levels",
           "how often nodes are split at most"),
};

static const ps_stratification_vtable vtable = {
    .size = sizeof vtable,
    .whole_pass = 1,
    .stratify = stratify,
    .find_strata = find_strata,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_STRATIFICATION,
    .name = "octree",
    .version = "1.0",
    .summary = "the photons of each leaf of an octree become one",
    .paper = "Hoet 2014, section 5.1; Warren and Salmon 1993, A parallel hashed oct-tree N-body "
             "algorithm",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(stratification, octree, &descriptor)
