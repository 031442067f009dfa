#include "cascades.h"

#define FADE_FROM 1.0f /* cells from the border: no light of this grid */
#define FADE_TO 3.0f   /* all of it; nearer in a grid that is not so wide */

/* The focus, moved so that a grid of half the width `half` lies inside of that of the scene. */
static ps_vec3 middle_of(ps_vec3 focus, ps_vec3 center, float radius, float half)
{
    ps_vec3 away = ps_subtract(focus, center);
    float most = radius - half;
    return (ps_vec3){
        center.x + ps_min(ps_max(away.x, -most), most),
        center.y + ps_min(ps_max(away.y, -most), most),
        center.z + ps_min(ps_max(away.z, -most), most),
    };
}

static ps_result create_cascade(const struct cascades_setting *setting,
                                const struct voxel_grid *grid, bool is_finest,
                                struct cascade *cascade)
{
    const ps_host *host = setting->host;
    const struct surface_lines lines = {host, *grid, setting->lines_per_cell,
                                        setting->pass->surface_offset};
    *cascade = (struct cascade){{.host = host}, {.host = host}, {.host = host}};
    ps_result result = blockers_create(&lines, &cascade->blockers);
    if (result == PS_OK)
        result = light_grid_create(host, grid, &cascade->own);
    if (result == PS_OK && !is_finest)
        result = light_grid_create(host, grid, &cascade->finer);
    return result;
}

ps_result cascades_create(const struct cascades_setting *setting, struct cascades *cascades)
{
    ps_vec3 center;
    float radius;
    setting->host->scene_bounds(setting->host, &center, &radius);
    *cascades = (struct cascades){.host = setting->host};
    ps_result result = PS_OK;
    if (!(radius > 0.0f)) /* no surfaces */
        return result;
    while (result == PS_OK && cascades->count < setting->count) {
        float half = ldexpf(radius, (int)cascades->count - (int)setting->count + 1);
        ps_vec3 middle = middle_of(setting->focus, center, radius, half);
        const struct voxel_grid grid =
            voxel_grid_around(middle, half, setting->across, setting->shift);
        result =
            create_cascade(setting, &grid, cascades->count == 0, &cascades->items[cascades->count]);
        cascades->count++;
    }
    return result;
}

void cascades_release(struct cascades *cascades)
{
    for (uint32_t i = 0; i < cascades->count; i++) {
        blockers_release(&cascades->items[i].blockers);
        light_grid_release(&cascades->items[i].own);
        light_grid_release(&cascades->items[i].finer);
    }
    *cascades = (struct cascades){.host = cascades->host};
}

bool cascades_inject(struct cascades *cascades, const ps_photon *photon)
{
    ps_vec3 axis = photon->lobe == PS_DIFFUSE ? photon->normal : photon->direction;
    bool is_held = false;
    for (uint32_t i = 0; i < cascades->count; i++) {
        struct cascade *cascade = &cascades->items[i];
        struct light_grid *light = is_held ? &cascade->finer : &cascade->own;
        uint32_t cell[3];
        if (!is_held && !voxel_grid_cell(&light->grid, photon->position, cell))
            continue;
        light_grid_inject(light,
                          ps_add_scaled(photon->position, 0.5f * light->grid.side, photon->normal),
                          axis, photon->power);
        is_held = true;
    }
    return is_held;
}

ps_result cascades_propagate(struct cascades *cascades, uint64_t steps, double least)
{
    ps_result result = PS_OK;
    for (uint32_t i = 0; result == PS_OK && i < cascades->count; i++) {
        struct cascade *cascade = &cascades->items[i];
        result = light_grid_propagate(&cascade->own, &cascade->blockers, steps, least);
        if (result == PS_OK && i > 0)
            result = light_grid_propagate(&cascade->finer, &cascade->blockers, steps, least);
        cascades->host->progress(cascades->host, (double)(i + 1) / (double)(cascades->count + 1));
    }
    return result;
}

/* How much of the light at a position comes from a grid rather than from the next one, 0..1. */
static float share_of(const struct voxel_grid *grid, ps_vec3 position)
{
    float place[3], nearest = INFINITY;
    voxel_grid_place(grid, position, place);
    for (int k = 0; k < 3; k++)
        nearest = ps_min(nearest, ps_min(place[k], (float)grid->across - place[k]));
    float to = ps_min(FADE_TO, 0.5f * (float)grid->across);
    return ps_min(ps_max((nearest - FADE_FROM) / (to - FADE_FROM), 0.0f), 1.0f);
}

ps_rgb cascades_irradiance(const struct cascades *cascades, ps_vec3 position, ps_vec3 normal)
{
    ps_rgb sum = {0, 0, 0};
    for (uint32_t i = 0; i < cascades->count; i++) {
        const struct cascade *cascade = &cascades->items[i];
        bool is_last = i + 1 == cascades->count;
        float share = is_last ? 1.0f : share_of(&cascade->own.grid, position);
        if (share > 0.0f)
            sum = ps_rgb_add(sum, light_grid_irradiance(&cascade->own, position, normal));
        if (share < 1.0f)
            sum = ps_rgb_add(
                ps_rgb_scale(sum, share),
                ps_rgb_scale(light_grid_irradiance(&cascades->items[i + 1].finer, position, normal),
                             1.0f - share));
    }
    return sum;
}
