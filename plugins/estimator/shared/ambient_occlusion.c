#include "ambient_occlusion.h"

float ambient_occlusion_radius(const ps_host *host, ps_number_or_choice radius)
{
    ps_vec3 center;
    float scene_radius;
    host->scene_bounds(host, &center, &scene_radius);
    return radius.choice >= 0 ? 0.2f * scene_radius : (float)radius.number;
}

static struct screen_point point_of(const ps_tile *tile, uint32_t lane)
{
    return (struct screen_point){
        ps_tile_position(tile, lane),
        ps_tile_normal(tile, lane),
        tile->depth[lane],
    };
}

int screen_look(const struct screen *screen, float x, float y, struct screen_point *point)
{
    if (!(x >= 0.0f && y >= 0.0f && x < (float)screen->width && y < (float)screen->height))
        return 0;
    uint32_t place = screen->places[(size_t)y * screen->width + (size_t)x];
    const ps_tile *tile = screen->host->tile(screen->host, place / PS_TILE_PIXELS);
    *point = point_of(tile, place % PS_TILE_PIXELS);
    return tile->object[place % PS_TILE_PIXELS] != PS_NO_OBJECT;
}

/* Width of a pixel. Neighbours far off, across a silhouette, count little. */
static float pixel_width(const struct screen *screen, const struct screen_point *point, uint32_t x,
                         uint32_t y)
{
    static const float offsets[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    float across = 0.0f, weight = 0.0f;
    for (int i = 0; i < 4; i++) {
        struct screen_point next;
        if (!screen_look(screen, (float)x + offsets[i][0], (float)y + offsets[i][1], &next))
            continue;
        ps_vec3 v = ps_subtract(next.position, point->position);
        float length2 = ps_dot(v, v), along = next.depth - point->depth;
        if (!(length2 > 0.0f))
            continue;
        across += 1.0f - along * along / length2;
        weight += 1.0f / length2;
    }
    return weight > 0.0f ? sqrtf(fmaxf(0.0f, across / weight)) : 0.0f;
}

float screen_extent(const struct screen *screen, const struct screen_point *point, uint32_t x,
                    uint32_t y, float length)
{
    float width = pixel_width(screen, point, x, y);
    float across = (float)screen->width + (float)screen->height; /* all of the picture */
    return width > 0.0f ? fminf(length / width, across) : 0.0f;
}

struct work {
    const ps_pass *pass;
    struct screen screen;
    ps_rgb irradiance;
    screen_visibility visibility;
    const void *user;
};

static void place_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct screen *screen = user;
    uint32_t tile = (uint32_t)index, x, y;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (screen->host->pixel(screen->host, tile, lane, &x, &y))
            screen->places[(size_t)y * screen->width + x] = tile * PS_TILE_PIXELS + lane;
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->screen.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        float numbers[1][4];
        uint64_t sample = ps_sample_block(index, lane) + work->pass->number;
        if (tile->object[lane] == PS_NO_OBJECT || !host->pixel(host, (uint32_t)index, lane, &x, &y))
            continue;
        host->samples(host, PS_STREAM_ESTIMATOR, 0, &sample, 1, numbers);
        struct screen_point point = point_of(tile, lane);
        float visible = work->visibility(work->user, &work->screen, &point, x, y, numbers[0]);
        ps_add_irradiance(tile, lane, ps_rgb_scale(work->irradiance, visible));
    }
}

ps_result ambient_occlusion_light(const ps_host *host, const ps_pass *pass, ps_rgb irradiance,
                                  screen_visibility visibility, const void *user)
{
    size_t pixels = (size_t)pass->width * pass->height;
    struct work work = {
        .pass = pass,
        .screen = {host, pass->width, pass->height,
                   host->allocate(host, pixels * sizeof *work.screen.places, "pixel places")},
        .irradiance = irradiance,
        .visibility = visibility,
        .user = user,
    };
    if (!work.screen.places)
        return PS_ERROR_MEMORY;
    host->parallel_for(host, pass->tile_count, place_tile, &work.screen);
    ps_result result = host->for_each_tile(host, light_tile, &work);
    host->release(host, work.screen.places);
    return result;
}
