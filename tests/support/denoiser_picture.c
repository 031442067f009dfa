#include "support/denoiser_picture.h"

#include "support/one_strategy.h"
#include "support/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

void set_vector(float (*planes)[PIXELS], int pixel, ps_vec3 v)
{
    planes[0][pixel] = v.x;
    planes[1][pixel] = v.y;
    planes[2][pixel] = v.z;
}

ps_vec3 vector_at(const float (*planes)[PIXELS], int pixel)
{
    return (ps_vec3){planes[0][pixel], planes[1][pixel], planes[2][pixel]};
}

struct picture *level_floor(void)
{
    struct picture *picture = calloc(1, sizeof *picture);
    assert_non_null(picture);
    for (int i = 0; i < PIXELS; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        set_vector(picture->light, i, (ps_vec3){1, 1, 1});
        set_vector(picture->albedo, i, (ps_vec3){1, 1, 1});
        set_vector(picture->normal, i, (ps_vec3){0, 0, 1});
        set_vector(picture->position, i, (ps_vec3){0.1f * (float)x, 0.1f * (float)y, 0});
        picture->depth[i] = 5;
    }
    return picture;
}

struct picture *bent_floor(float degrees, float step)
{
    struct picture *picture = level_floor();
    float angle = degrees * PS_PI / 180;
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2) {
            set_vector(picture->normal, i, (ps_vec3){sinf(angle), 0, cosf(angle)});
            picture->position[2][i] = step;
        }
    return picture;
}

struct picture *wild_picture(uint64_t seed)
{
    struct random random = {seed};
    struct picture *picture = level_floor();
    for (int i = 0; i < PIXELS; i++) {
        float x = picture->position[0][i], y = picture->position[1][i];
        ps_vec3 normal = {-0.8f * cosf(2 * x), 0.6f * sinf(3 * y), 1};
        picture->position[2][i] = 0.4f * sinf(2 * x) + 0.2f * cosf(3 * y);
        /* Means of several passes are shorter than 1. */
        float length = random_between(&random, 0.7f, 1.0f);
        set_vector(picture->normal, i, ps_scale(ps_normalize(normal), length));
        for (int c = 0; c < 3; c++) {
            picture->albedo[c][i] = random_unit(&random) < 0.1f ? 0 : random_unit(&random);
            picture->light[c][i] = picture->albedo[c][i] * random_between(&random, 0.5f, 3.0f);
        }
        if (random_unit(&random) < 0.05f) {
            picture->depth[i] = INFINITY;
            set_vector(picture->normal, i, (ps_vec3){0, 0, 0});
            set_vector(picture->position, i, (ps_vec3){0, 0, 0});
            set_vector(picture->light, i, (ps_vec3){0, 0, 0});
        }
    }
    return picture;
}

static ps_image_view view_of(struct picture *picture, float coverage[PIXELS])
{
    for (int i = 0; i < PIXELS; i++)
        coverage[i] = picture->depth[i] < INFINITY ? 1.0f : 0.0f;
    return (ps_image_view){
        .size = sizeof(ps_image_view),
        .width = WIDTH,
        .height = HEIGHT,
        .passes = picture->halves ? 2 : 1,
        .r = picture->light[0],
        .g = picture->light[1],
        .b = picture->light[2],
        .albedo_r = picture->albedo[0],
        .albedo_g = picture->albedo[1],
        .albedo_b = picture->albedo[2],
        .normal_x = picture->normal[0],
        .normal_y = picture->normal[1],
        .normal_z = picture->normal[2],
        .position_x = picture->position[0],
        .position_y = picture->position[1],
        .position_z = picture->position[2],
        .depth = picture->depth,
        .coverage = coverage,
        .gloss = picture->gloss,
        .even_r = picture->halves ? picture->halves[0][0] : NULL,
        .even_g = picture->halves ? picture->halves[0][1] : NULL,
        .even_b = picture->halves ? picture->halves[0][2] : NULL,
        .odd_r = picture->halves ? picture->halves[1][0] : NULL,
        .odd_g = picture->halves ? picture->halves[1][1] : NULL,
        .odd_b = picture->halves ? picture->halves[1][2] : NULL,
        .odd_share = 0.5f,
        .edge_samples = picture->edge_samples,
        .variance = picture->variance,
    };
}

static void run(struct picture *const pictures[], uint32_t count, const char *choice,
                uint32_t threads, bool cancelled)
{
    struct bare_host bare;
    static float coverage[PIXELS];
    ps_image_view views[PS_DENOISER_IMAGES];
    for (uint32_t i = 0; i < count; i++)
        views[i] = view_of(pictures[i], coverage);
    bare_host_create(&bare, threads);
    bare.cancelled = cancelled;
    struct strategy strategy = strategy_of(choice);
    const ps_denoiser_vtable *vtable = &strategy.type->table.denoiser;
    assert_int_equal(strategy_start(&strategy, &bare.host), PS_OK);
    ps_result result = count == 1 ? vtable->filter(strategy.state, &bare.host, views)
                                  : vtable->filter_all(strategy.state, &bare.host, views, count);
    assert_int_equal(result, cancelled ? PS_CANCELLED : PS_OK);
    assert_int_equal(bare.live_allocations, 0);
    strategy_release(&strategy);
    bare_host_release(&bare);
}

void denoise(struct picture *picture, const char *choice, uint32_t threads)
{
    run(&picture, 1, choice, threads, false);
}

void denoise_cancelled(struct picture *picture, const char *choice, uint32_t threads)
{
    run(&picture, 1, choice, threads, true);
}

void denoise_together(struct picture *const pictures[], uint32_t count, const char *choice,
                      uint32_t threads)
{
    run(pictures, count, choice, threads, false);
}
