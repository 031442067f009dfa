/* voxel.c: photons by voxels: the scene in cubes, each of which reflects the light that it gets.
 *
 * The surfaces in a cubic cell are simplified into at most six voxels, one for each side that they
 * may face: a place on a real surface with its normal and albedo, and an area (Hoet 2014, section
 * 4.2, third method, after the injection of Kaplanyan and Dachsbacher 2010, Cascaded light
 * propagation volumes). Each voxel that a light reaches leaves one photon in each pass, with a
 * direction w around the normal by the cosine, and the power pi L(w) A, where L is the radiance
 * that the place reflects there of light straight from the lights: shadow rays decide what is lit.
 *
 * A plugin gets no geometry, so lines find the surfaces: a grid of lines, s apart, along each axis,
 * both ways, for a surface is met from the side that it is seen from. A unit of area with normal n
 * is met by |n_k| / s^2 of the lines along axis k (Cauchy and Crofton), so a crossing may stand for
 * the area s^2 / |n_k|, which has no bound. Weighed over the three axes by the balance heuristic
 * (Veach and Guibas 1995) each crossing stands for
 *
 *     s^2 / (|n_x| + |n_y| + |n_z|),
 *
 * between s^2 / sqrt(3) and s^2. A voxel's area is the sum over the crossings in it, and its place
 * is one of them, by chance in proportion to area. As the grids are shifted in each pass, the mean
 * of the photons' power is right at any resolution; what a fine one improves is noise, and places.
 *
 * Voxels are sorted by key rather than kept in a grid, so memory goes by surfaces and not by the
 * cube of the resolution. Mirrors and glass leave no photons, nor do surfaces outside of the sphere
 * around the scene (planes go on for ever).
 */
#include <psplat/plugin.h>

#include <stdio.h>
#include <string.h>

#define STREAM_SHIFT PS_STREAM_PLUGIN       /* of the lines; set: the axis, index: the pass */
#define STREAM_PLACE (PS_STREAM_PLUGIN + 1) /* which crossing is a voxel's place */
#define STREAM_LIGHT (PS_STREAM_PLUGIN + 2) /* places on area lights */

#define MEMORY "voxels"

/* A line met a surface: the first one past `tnear` along the line. */
struct crossing {
    uint64_t key; /* of the voxel */
    uint32_t line;
    float tnear;
    float area;
    uint32_t reserved;
};

struct crossings {
    struct crossing *items; /* the host's memory */
    size_t count, capacity;
    ps_result result;
};

/* Lines along one axis: `across` by `across`, `step` apart. */
struct lines {
    ps_vec3 corner; /* where the first one of each axis would begin, without a shift */
    float step, length;
    float shift[3][2]; /* of an axis's lines, 0..1 */
    uint32_t across;
};

struct state {
    int64_t resolution, rays;
    const ps_cells *cells;
    /* Of the pass that is prepared: */
    struct lines lines;
    ps_lattice lattice;
    float offset;            /* ps_pass.surface_offset */
    struct crossing *voxels; /* the places, with the whole area */
    size_t count;
};

static float *component(ps_vec3 *vector, uint32_t axis)
{
    return axis == 0 ? &vector->x : (axis == 1 ? &vector->y : &vector->z);
}

/* --- lines
 * ---------------------------------------------------------------------------------------------- */

/* Lines are numbered by way (0: along an axis, 1: against it), axis, row, column. */
static uint32_t line_number(const struct lines *lines, uint32_t row, uint32_t column)
{
    return row * lines->across + column;
}

static ps_ray line_ray(const struct lines *lines, uint32_t line, float tnear)
{
    uint32_t column = line % lines->across, row = line / lines->across % lines->across;
    uint32_t group = line / lines->across / lines->across, axis = group % 3;
    ps_ray ray = {lines->corner, tnear, {0, 0, 0}, lines->length};
    *component(&ray.origin, (axis + 1) % 3) +=
        ((float)column + lines->shift[axis][0]) * lines->step;
    *component(&ray.origin, (axis + 2) % 3) += ((float)row + lines->shift[axis][1]) * lines->step;
    *component(&ray.direction, axis) = 1.0f;
    if (group >= 3) {
        *component(&ray.origin, axis) += lines->length;
        *component(&ray.direction, axis) = -1.0f;
    }
    return ray;
}

static void set_lines(struct state *state, const ps_host *host, const ps_pass *pass)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    radius *= 1.001f; /* what touches the sphere is inside */
    struct lines *lines = &state->lines;
    lines->across = radius > 0.0f ? (uint32_t)(state->resolution * state->rays) : 0;
    lines->corner = ps_subtract(center, (ps_vec3){radius, radius, radius});
    lines->length = 2.0f * radius;
    lines->step = 2.0f * radius / (float)(state->resolution * state->rays);
    for (uint32_t axis = 0; axis < 3; axis++) {
        uint64_t index = pass->number;
        float numbers[1][4];
        host->samples(host, STREAM_SHIFT, axis, &index, 1, numbers);
        memcpy(lines->shift[axis], numbers[0], sizeof lines->shift[axis]);
    }
    double side = 2.0 * (double)radius / (double)state->resolution;
    state->lattice = (ps_lattice){lines->corner, side};
    state->offset = pass->surface_offset;
}

/* --- crossings
 * -------------------------------------------------------------------------------------------- */

static ps_result append(const ps_host *host, struct crossings *list, const struct crossing *item)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 64;
        struct crossing *items = host->allocate(host, capacity * sizeof *items, MEMORY);
        if (!items)
            return PS_ERROR_MEMORY;
        if (list->count)
            memcpy(items, list->items, list->count * sizeof *items);
        host->release(host, list->items);
        list->items = items;
        list->capacity = capacity;
    }
    list->items[list->count++] = *item;
    return PS_OK;
}

/* The side that a surface faces: an axis, or 3 + it where the normal points against it. */
static uint32_t side_of(ps_vec3 n)
{
    float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    uint32_t axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    return *component(&n, axis) < 0.0f ? 3 + axis : axis;
}

static struct crossing crossing_of(const struct state *state, const ps_hit *hit, uint32_t line,
                                   float tnear)
{
    ps_vec3 n = hit->geometric_normal;
    float step = state->lines.step;
    return (struct crossing){
        .key = state->cells->key(&state->lattice, side_of(n), hit->position),
        .line = line,
        .tnear = tnear,
        .area = step * step / (fabsf(n.x) + fabsf(n.y) + fabsf(n.z)),
    };
}

/* Whether light that meets the surface may leave it again: lights are black. */
static int reflects(const ps_hit *hit)
{
    return hit->flags & PS_HIT_SPECULAR || ps_rgb_maximum(hit->albedo) > 0.0f;
}

struct voxelization {
    const struct state *state;
    const ps_host *host;
    struct crossings *rows; /* one for each row of lines */
};

/* Follows the lines [first, first + n) through everything that they meet. */
static ps_result follow(const struct voxelization *work, uint32_t first, size_t n,
                        struct crossings *list)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    uint32_t numbers[PS_PATH_CHUNK];
    for (size_t i = 0; i < n; i++) {
        numbers[i] = first + (uint32_t)i;
        rays[i] = line_ray(&work->state->lines, numbers[i], 0.0f);
    }
    while (n > 0) {
        size_t alive = 0;
        work->host->intersect(work->host, rays, n, hits);
        for (size_t i = 0; i < n; i++) {
            if (!(hits[i].distance < INFINITY))
                continue;
            struct crossing crossing =
                crossing_of(work->state, &hits[i], numbers[i], rays[i].tnear);
            if (reflects(&hits[i]) && append(work->host, list, &crossing) != PS_OK)
                return PS_ERROR_MEMORY;
            rays[alive] = rays[i];
            rays[alive].tnear = hits[i].distance + work->state->offset;
            numbers[alive] = numbers[i];
            alive += rays[alive].tnear < rays[alive].tfar;
        }
        n = alive;
    }
    return PS_OK;
}

static void follow_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct voxelization *work = user;
    struct crossings *list = &work->rows[row];
    uint32_t across = work->state->lines.across;
    if (work->host->cancelled(work->host))
        list->result = PS_CANCELLED;
    for (uint32_t column = 0; column < across && list->result == PS_OK; column += PS_PATH_CHUNK) {
        uint32_t left = across - column;
        list->result = follow(work, line_number(&work->state->lines, (uint32_t)row, column),
                              left < PS_PATH_CHUNK ? left : PS_PATH_CHUNK, list);
    }
}

/* All crossings in one array, in the order of the rows; releases the rows' own. */
static ps_result join(const ps_host *host, struct crossings *rows, size_t row_count,
                      struct crossings *all)
{
    for (size_t i = 0; i < row_count; i++) {
        all->capacity += rows[i].count;
        if (rows[i].result != PS_OK)
            all->result = rows[i].result;
    }
    if (all->result == PS_OK) {
        all->items = host->allocate(host, all->capacity * sizeof *all->items, MEMORY);
        all->result = all->items ? PS_OK : PS_ERROR_MEMORY;
    }
    for (size_t i = 0; i < row_count; i++) {
        if (all->result == PS_OK && rows[i].count) {
            memcpy(all->items + all->count, rows[i].items, rows[i].count * sizeof *all->items);
            all->count += rows[i].count;
        }
        host->release(host, rows[i].items);
    }
    return all->result;
}

static ps_result find_crossings(const struct state *state, const ps_host *host,
                                struct crossings *all)
{
    size_t row_count = 6 * (size_t)state->lines.across;
    struct crossings *rows = host->allocate(host, row_count * sizeof *rows, MEMORY);
    if (!rows)
        return PS_ERROR_MEMORY;
    memset(rows, 0, row_count * sizeof *rows);
    struct voxelization work = {state, host, rows};
    host->parallel_for(host, row_count, follow_row, &work);
    ps_result result = join(host, rows, row_count, all);
    host->release(host, rows);
    return result;
}

/* --- voxels
 * ---------------------------------------------------------------------------------------------- */

/* One of the crossings of a voxel, by chance, with the area of them all. */
static struct crossing simplify(const struct crossing *crossings, const ps_key_entry *entries,
                                size_t n, float number)
{
    double sum = 0.0, before = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)crossings[entries[i].index].area;
    size_t chosen = 0;
    while (chosen + 1 < n) {
        before += (double)crossings[entries[chosen].index].area;
        if ((double)number * sum < before)
            break;
        chosen++;
    }
    struct crossing voxel = crossings[entries[chosen].index];
    voxel.area = (float)sum;
    return voxel;
}

static uint64_t sample_index(const ps_pass *pass, size_t voxel)
{
    return (uint64_t)pass->number << 32 | voxel;
}

static size_t run_length(const ps_key_entry *entries, size_t n)
{
    size_t length = 1;
    while (length < n && entries[length].key == entries[0].key)
        length++;
    return length;
}

/* Crossings, sorted, to voxels. */
static ps_result gather(struct state *state, const ps_host *host, const ps_pass *pass,
                        const struct crossing *crossings, const ps_key_entry *sorted, size_t n)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i += run_length(sorted + i, n - i))
        count++;
    state->voxels = host->allocate(host, count * sizeof *state->voxels, MEMORY);
    if (!state->voxels)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < n;) {
        size_t length = run_length(sorted + i, n - i);
        uint64_t index = sample_index(pass, state->count);
        float numbers[1][4];
        host->samples(host, STREAM_PLACE, 0, &index, 1, numbers);
        state->voxels[state->count++] = simplify(crossings, sorted + i, length, numbers[0][0]);
        i += length;
    }
    return PS_OK;
}

static ps_result sort_and_gather(struct state *state, const ps_host *host, const ps_pass *pass,
                                 const struct crossings *all)
{
    ps_key_entry *entries = host->allocate(host, 2 * all->count * sizeof *entries, MEMORY);
    if (!entries)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < all->count; i++)
        entries[i] = (ps_key_entry){all->items[i].key, i};
    ps_key_entry *sorted = state->cells->sort(entries, entries + all->count, all->count);
    ps_result result = gather(state, host, pass, all->items, sorted, all->count);
    host->release(host, entries);
    return result;
}

static void destroy(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    host->release(host, state->voxels);
    state->voxels = NULL;
    state->count = 0;
}

static ps_result prepare(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    ps_warn_of_single_bounce(host, pass,
                             "injection voxel makes indirect light of one bounce alone");
    struct crossings all = {.items = NULL};
    destroy(state, host);
    set_lines(state, host, pass);
    ps_result result = find_crossings(state, host, &all);
    if (result == PS_OK)
        result = sort_and_gather(state, host, pass, &all);
    host->release(host, all.items);
    host->count(host, "voxels", (double)state->count);
    return result;
}

/* --- photons
 * ---------------------------------------------------------------------------------------------- */

static uint64_t path_count(const void *opaque)
{
    return ((const struct state *)opaque)->count;
}

/* Looks at glossy places out of the direction that their light leaves to, which their base's albedo
 * depends on. Where something else is in between, they stay as the line saw them. */
static void look_back(const ps_host *host, const ps_ray *rays, ps_hit *hits, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        ps_hit seen;
        if (!(hits[i].flags & PS_HIT_SPECULAR))
            continue;
        host->intersect(host, &rays[i], 1, &seen);
        if (seen.object == hits[i].object && seen.material == hits[i].material &&
            ps_dot(seen.geometric_normal, hits[i].geometric_normal) > 0.0f)
            hits[i] = seen;
    }
}

/* Directions that the voxels' light leaves to, and rays against them. */
static void choose_directions(const struct state *state, const ps_host *host,
                              const uint64_t *indices, const ps_hit *hits, size_t n, ps_ray *rays)
{
    float numbers[PS_PATH_CHUNK][4];
    host->samples(host, PS_STREAM_EMISSION, 0, indices, n, numbers);
    for (size_t i = 0; i < n; i++) {
        ps_vec3 normal = hits[i].geometric_normal;
        ps_vec3 out = ps_cosine_direction(normal, numbers[i][0], numbers[i][1]);
        float away = 4.0f * state->offset / fmaxf(ps_dot(out, normal), 0.1f);
        rays[i] = (ps_ray){ps_add_scaled(hits[i].position, away, out), 0.0f, ps_scale(out, -1.0f),
                           2.0f * away};
    }
}

/* The places of voxels; that of one which rounding lost has no distance. */
static void find_places(const struct state *state, const ps_host *host, uint64_t first, size_t n,
                        ps_hit *hits)
{
    ps_ray rays[PS_PATH_CHUNK] = {{.tnear = 0.0f}};
    for (size_t i = 0; i < n; i++) {
        const struct crossing *voxel = &state->voxels[first + i];
        rays[i] = line_ray(&state->lines, voxel->line, voxel->tnear);
    }
    host->intersect(host, rays, n, hits);
}

static uint64_t greatest_common_divisor(uint64_t a, uint64_t b)
{
    while (b > 0) {
        uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* The path number of a voxel. Voxels are sorted by place, but any run of paths has to be a fair
 * part of all: steps of about the golden section, prime to their number, spread neighbours
 * evenly. */
static uint64_t fair_path(const struct state *state, const ps_pass *pass, uint64_t voxel)
{
    uint64_t count = state->count, step = (uint64_t)(0.6180339887 * (double)count) + 1;
    while (greatest_common_divisor(step, count) > 1)
        step++;
    return pass->number * count + voxel * step % count;
}

static ps_result emit(const void *opaque, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink)
{
    const struct state *state = opaque;
    uint64_t indices[PS_PATH_CHUNK] = {0};
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    ps_rgb radiance[PS_PATH_CHUNK];
    ps_photon photons[PS_PATH_CHUNK];
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        indices[i] = sample_index(pass, first + i);
    find_places(state, host, first, n, hits);
    choose_directions(state, host, indices, hits, n, rays);
    look_back(host, rays, hits, n);
    host->direct_radiance(host, rays, hits, STREAM_LIGHT, 0, indices, n, radiance);
    for (size_t i = 0; i < n; i++) {
        if (!(ps_rgb_maximum(radiance[i]) > 0.0f))
            continue;
        photons[count++] = (ps_photon){
            .position = hits[i].position,
            .normal = hits[i].geometric_normal,
            .direction = ps_scale(rays[i].direction, -1.0f),
            .power = ps_rgb_scale(radiance[i], PS_PI * state->voxels[first + i].area),
            .bounce = 1,
            .lobe = PS_DIFFUSE,
            .merged = 1.0f,
            .path = fair_path(state, pass, first + i),
        };
    }
    return sink->append(sink->core, photons, count);
}

/* --- the plugin
 * ------------------------------------------------------------------------------------------- */

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    char why[100];
    state->cells = host->extension(host, PS_CELLS_EXTENSION);
    int64_t across = state->resolution * state->rays;
    if (6 * across * across <= (int64_t)UINT32_MAX)
        return PS_OK;
    snprintf(why, sizeof why, "resolution %lld with %lld rays makes too many lines",
             (long long)state->resolution, (long long)state->rays);
    return host->fail(host, PS_ERROR_INVALID, why);
}

static const ps_param params[] = {
    PS_INT(struct state, resolution, "128", 1, 16384, "cells",
           "cells across the sphere around the scene, along each axis"),
    PS_ROW(struct state, rays, PS_PARAM_INT, "2", 1, 64, PS_PARAM_EXPERT, NULL, "rays",
           "rays across a cell, in rows and columns, that find its surfaces"),
};

static const ps_injection_vtable vtable = {
    .size = sizeof vtable,
    .path_count = path_count,
    .emit = emit,
    .prepare = prepare,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_INJECTION,
    .name = "voxel",
    .version = "1.0",
    .summary = "simplifies the scene into voxels; those that a light reaches become photons",
    .paper = "Kaplanyan and Dachsbacher 2010, Cascaded light propagation volumes; Hoet 2014, "
             "section 4.2",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .destroy = destroy,
    .vtable = &vtable,
};

PS_MODULE(injection, voxel, &descriptor)
