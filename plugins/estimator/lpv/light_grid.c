#include "light_grid.h"

#include <string.h>

/* Solid angles of the faces of the cell beside, from a cell's middle: the one across, and four
 * along. */
#define FRONT_ANGLE 0.40066968f
#define SIDE_ANGLE 0.42344135f

/* The mean way of light through a cube, all directions alike, over its side: 4 V / S (Cauchy). */
#define MEAN_CHORD (2.0f / 3.0f)

static size_t cell_number(const struct voxel_grid *grid, const uint32_t cell[3])
{
    return ((size_t)cell[2] * grid->across + cell[1]) * grid->across + cell[0];
}

static size_t cell_count(const struct voxel_grid *grid)
{
    return (size_t)grid->across * grid->across * grid->across;
}

ps_result light_grid_create(const ps_host *host, const struct voxel_grid *grid,
                            struct light_grid *light)
{
    *light = (struct light_grid){.host = host, .grid = *grid};
    size_t count = cell_count(grid);
    light->field = host->allocate(host, count * sizeof *light->field, LPV_MEMORY);
    light->now = host->allocate(host, count * sizeof *light->now, LPV_MEMORY);
    light->next = host->allocate(host, count * sizeof *light->next, LPV_MEMORY);
    light->shares = host->allocate(host, count * sizeof *light->shares, LPV_MEMORY);
    if (!light->field || !light->now || !light->next || !light->shares)
        return PS_ERROR_MEMORY;
    memset(light->now, 0, count * sizeof *light->now);
    return PS_OK;
}

void light_grid_release(struct light_grid *light)
{
    light->host->release(light->host, light->field);
    light->host->release(light->host, light->now);
    light->host->release(light->host, light->next);
    light->host->release(light->host, light->shares);
    *light = (struct light_grid){.host = light->host};
}

void light_grid_inject(struct light_grid *light, ps_vec3 position, ps_vec3 axis, ps_rgb power)
{
    uint32_t cell[3];
    struct sh lobe = sh_clamped_cosine(axis);
    if (voxel_grid_cell(&light->grid, position, cell))
        sh_rgb_add_scaled(&light->now[cell_number(&light->grid, cell)],
                          ps_rgb_scale(power, 1.0f / PS_PI), &lobe);
}

/* --- one step
 * ---------------------------------------------------------------------------------------------- */

/* The cell beside, along an axis one way or the other. */
struct neighbour {
    uint32_t axis;
    float sign;
};

/* Flux through the five faces of a neighbour that are seen from the middle of a cell: the front,
 * then two along each of the two other axes, first against it. */
static void find_fluxes(const struct sh *light, const struct neighbour *beside, float fluxes[5])
{
    const float slant = 0.89442719f; /* 1 / sqrt(1 + 1/4) */
    float even = light->c[0] * SH_Y0;
    float along = beside->sign * light->c[1 + beside->axis] * SH_Y1;
    fluxes[0] = FRONT_ANGLE * ps_max(even + along, 0.0f);
    for (uint32_t i = 0; i < 2; i++) {
        float aside = 0.5f * light->c[1 + (beside->axis + 1 + i) % 3] * SH_Y1;
        fluxes[1 + 2 * i] = SIDE_ANGLE * ps_max(even + slant * (along - aside), 0.0f);
        fluxes[2 + 2 * i] = SIDE_ANGLE * ps_max(even + slant * (along + aside), 0.0f);
    }
}

/* What the flux of a cell, after the clamp, is to be multiplied by to be all of it. */
static float share_of(const struct sh *light)
{
    float sum = 0.0f, fluxes[5];
    for (uint32_t i = 0; i < 6; i++) {
        find_fluxes(light, &(struct neighbour){i % 3, i < 3 ? 1.0f : -1.0f}, fluxes);
        sum += fluxes[0] + fluxes[1] + fluxes[2] + fluxes[3] + fluxes[4];
    }
    float whole = sh_integral(light);
    return whole > 0.0f && sum > whole ? whole / sum : 1.0f;
}

struct step {
    struct light_grid *light;
    const struct blockers *blockers;
};

static void find_shares(void *user, uint64_t slice, uint32_t worker)
{
    (void)worker;
    const struct step *step = user;
    struct light_grid *light = step->light;
    size_t n = (size_t)light->grid.across * light->grid.across;
    for (size_t i = slice * n; i < (slice + 1) * n; i++) {
        const struct sh_rgb *now = &light->now[i];
        light->shares[i] = (ps_rgb){share_of(&now->r), share_of(&now->g), share_of(&now->b)};
    }
}

/* Adds what comes from a cell through the face between, of one channel. `beside`: the way that the
 * light goes. */
static void receive(const struct sh *from, const struct neighbour *beside, float share,
                    struct sh *sum)
{
    float fluxes[5];
    find_fluxes(from, beside, fluxes);
    share *= 1.0f / PS_PI;
    struct sh lobe = sh_clamped_cosine((ps_vec3){0, 0, 1});
    float order0 = lobe.c[0] * share, order1 = lobe.c[3] * share;
    sum->c[0] += order0 * (fluxes[0] + fluxes[1] + fluxes[2] + fluxes[3] + fluxes[4]);
    sum->c[1 + beside->axis] += order1 * beside->sign * fluxes[0];
    for (uint32_t i = 0; i < 2; i++)
        sum->c[1 + (beside->axis + 1 + i) % 3] += order1 * (fluxes[2 + 2 * i] - fluxes[1 + 2 * i]);
}

static void receive_all(const struct step *step, const uint32_t cell[3], struct sh_rgb *sum)
{
    const struct light_grid *light = step->light;
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t axis = i % 3, from[3] = {cell[0], cell[1], cell[2]}, behind[3];
        memcpy(behind, cell, sizeof behind);
        bool forwards = i < 3; /* the light goes along the axis */
        if (forwards ? cell[axis] == 0 : cell[axis] + 1 == light->grid.across)
            continue;
        from[axis] += forwards ? -1u : 1u;
        behind[axis] += forwards ? 0 : 1;
        size_t source = cell_number(&light->grid, from);
        const struct sh_rgb *now = &light->now[source];
        if (!(now->r.c[0] > 0.0f || now->g.c[0] > 0.0f || now->b.c[0] > 0.0f))
            continue;
        float open = 1.0f - step->blockers->faces[axis][blockers_face(&light->grid, axis, behind)];
        const struct neighbour beside = {axis, forwards ? 1.0f : -1.0f};
        receive(&now->r, &beside, open * light->shares[source].r, &sum->r);
        receive(&now->g, &beside, open * light->shares[source].g, &sum->g);
        receive(&now->b, &beside, open * light->shares[source].b, &sum->b);
    }
}

static void step_slice(void *user, uint64_t slice, uint32_t worker)
{
    (void)worker;
    const struct step *step = user;
    struct light_grid *light = step->light;
    uint32_t cell[3] = {0, 0, (uint32_t)slice};
    for (cell[1] = 0; cell[1] < light->grid.across; cell[1]++) {
        for (cell[0] = 0; cell[0] < light->grid.across; cell[0]++) {
            size_t i = cell_number(&light->grid, cell);
            struct sh_rgb *next = &light->next[i];
            memset(next, 0, sizeof *next);
            receive_all(step, cell, next);
            sh_add_scaled(&light->field[i].r, 1.0f, &next->r);
            sh_add_scaled(&light->field[i].g, 1.0f, &next->g);
            sh_add_scaled(&light->field[i].b, 1.0f, &next->b);
        }
    }
}

/* What is under way, up to a factor. */
static double power_of(const struct light_grid *light)
{
    double sum = 0.0;
    for (size_t i = 0; i < cell_count(&light->grid); i++)
        sum += (double)light->now[i].r.c[0] + (double)light->now[i].g.c[0] +
               (double)light->now[i].b.c[0];
    return sum;
}

ps_result light_grid_propagate(struct light_grid *light, const struct blockers *blockers,
                               uint64_t steps, double least)
{
    const ps_host *host = light->host;
    struct step step = {light, blockers};
    memcpy(light->field, light->now, cell_count(&light->grid) * sizeof *light->field);
    double first = power_of(light);
    for (uint64_t i = 0; i < steps && power_of(light) > least * first; i++) {
        if (host->cancelled(host))
            return PS_CANCELLED;
        host->parallel_for(host, light->grid.across, find_shares, &step);
        host->parallel_for(host, light->grid.across, step_slice, &step);
        struct sh_rgb *spare = light->now;
        light->now = light->next;
        light->next = spare;
    }
    return PS_OK;
}

/* --- the field
 * ---------------------------------------------------------------------------------------------- */

/* Where a point looks into a grid: the eight cells around, of which it takes some. */
struct light_lookup {
    size_t cells[8];
    float weights[8], total;
    int count;
};

static void find_cells(const struct voxel_grid *grid, ps_vec3 position, ps_vec3 normal,
                       struct light_lookup *lookup)
{
    float place[3], share[3], n[3], surface = 0.0f;
    int first[3];
    *lookup = (struct light_lookup){.total = 0.0f};
    voxel_components(normal, n);
    voxel_grid_place(grid, position, place);
    for (int k = 0; k < 3; k++) {
        surface += place[k] * n[k];
        place[k] += 0.5f * n[k];
        if (!(place[k] >= 0.0f && place[k] <= (float)grid->across))
            return;
        first[k] = voxel_between(place[k], &share[k]);
    }
    for (int corner = 0; corner < 8; corner++) {
        uint32_t cell[3];
        float weight = 1.0f, height = -surface;
        for (int k = 0; k < 3; k++) {
            int second = corner >> k & 1;
            cell[k] = (uint32_t)(first[k] + second);
            weight *= second ? share[k] : 1.0f - share[k];
            height += ((float)(first[k] + second) + 0.5f) * n[k];
        }
        if (cell[0] >= grid->across || cell[1] >= grid->across || cell[2] >= grid->across ||
            height <= 0.0f)
            continue;
        lookup->cells[lookup->count] = cell_number(grid, cell);
        lookup->weights[lookup->count++] = weight;
        lookup->total += weight;
    }
}

/* I is the light of a whole cell; light that passes it, over a way of MEAN_CHORD cells, is radiance
 * I chord / side^2. */
ps_rgb light_grid_irradiance(const struct light_grid *light, ps_vec3 position, ps_vec3 normal)
{
    struct light_lookup lookup;
    ps_rgb sum = {0, 0, 0};
    struct sh facing = sh_clamped_cosine(ps_scale(normal, -1.0f));
    find_cells(&light->grid, position, normal, &lookup);
    for (int i = 0; i < lookup.count; i++) {
        ps_rgb seen = sh_rgb_dot(&light->field[lookup.cells[i]], &facing);
        sum = ps_rgb_add(sum, ps_rgb_scale(seen, lookup.weights[i]));
    }
    if (!(lookup.total > 0.0f))
        return sum;
    float scale = MEAN_CHORD / lookup.total / light->grid.side / light->grid.side;
    return (ps_rgb){ps_max(scale * sum.r, 0.0f), ps_max(scale * sum.g, 0.0f),
                    ps_max(scale * sum.b, 0.0f)};
}
