/* test_exact.c: the loop for visibilities that judge points by themselves: one that says yes to all
 * makes the sums of kernel.h with nothing in the way, walls included. */
#include "splat/exact.h"

#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SPLATS 16

struct bench {
    _Alignas(64) struct interleaved_tile tile;
    struct splat splats[SPLATS];
    struct kernel_splat prepared[SPLATS];
    uint32_t indices[SPLATS];
    struct kernel_profile profile;
};

static const float open_map[1] = {INFINITY};

static void prepare(struct bench *bench)
{
    for (uint32_t s = 0; s < SPLATS; s++)
        bench->prepared[s] = kernel_prepare(&bench->splats[s], &bench->profile, open_map);
}

static void fill_tile(struct interleaved_tile *tile, struct random *random)
{
    memset(tile, 0, sizeof *tile);
    struct bound bound = bound_empty();
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 position = {random_between(random, -1, 1), random_between(random, -1, 1), 0};
        ps_vec3 normal = random_direction(random);
        tile->position_x[i] = position.x;
        tile->position_y[i] = position.y;
        tile->normal_x[i] = normal.x;
        tile->normal_y[i] = normal.y;
        tile->normal_z[i] = normal.z;
        bound_add_point(&bound, position, normal);
    }
    for (uint32_t block = 0; block < BOUNDS_WIDTH; block++)
        bounds_set(&tile->blocks, block, &bound);
}

/* Splats on an even floor, with up to two walls. */
static struct bench *make_bench(void)
{
    static struct bench bench;
    struct random random = {7};
    fill_tile(&bench.tile, &random);
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        bench.profile.weights[i] = 1 - 0.5f * kernel_profile_radius2(i);
    assert_true(kernel_profile_normalize(&bench.profile));
    for (uint32_t s = 0; s < SPLATS; s++) {
        float angle = random_between(&random, 0, 6), other = random_between(&random, 0, 6);
        bench.indices[s] = s;
        bench.splats[s] = (struct splat){
            .bundle.centre = {random_between(&random, -0.5f, 0.5f),
                              random_between(&random, -0.5f, 0.5f), 0},
            .bundle.radius = random_between(&random, 0.3f, 1.0f),
            .bundle.axis_w = ps_normalize(random_direction(&random)),
            .near_depth = -0.7f,
            .bundle.far_depth = 0.7f,
            .bundle.start_depth = -0.6f,
            .photon_depth = -0.7f,
            .bandwidth_scale = s % 2 ? 0.6f : 0.0f,
            .narrowest = 0.1f,
            .widest = 0.5f,
            .blend_distance = s % 4 == 1 ? 0.8f : 0.0f,
            .power = {1, 2, 3},
            .bundle.boundary_count = s % 3,
            .bundle.boundaries = {{cosf(angle), sinf(angle), random_unit(&random)},
                                  {cosf(other), sinf(other), random_unit(&random)}},
        };
        ps_frame(bench.splats[s].bundle.axis_w, &bench.splats[s].bundle.axis_u,
                 &bench.splats[s].bundle.axis_v);
    }
    prepare(&bench);
    return &bench;
}

static void see_all(const void *state, const ps_host *host, const ps_bundle *bundle,
                    const ps_vec3 *points, size_t n, uint8_t *lit)
{
    (void)state;
    (void)host;
    (void)bundle;
    (void)points;
    memset(lit, 1, n);
}

static void see_right_half(const void *state, const ps_host *host, const ps_bundle *bundle,
                           const ps_vec3 *points, size_t n, uint8_t *lit)
{
    (void)state;
    (void)host;
    (void)bundle;
    for (size_t i = 0; i < n; i++)
        lit[i] = points[i].x > 0;
}

typedef void visible_test(const void *state, const ps_host *host, const ps_bundle *bundle,
                          const ps_vec3 *points, size_t n, uint8_t *lit);

static struct kernel_count run(const struct bench *bench, visible_test *visible,
                               struct interleaved_tile *tile)
{
    const ps_visibility_vtable vtable = {.size = sizeof vtable, .visible = visible};
    struct kernel_variant kernel;
    assert_true(kernel_choose("baseline", &kernel));
    const struct exact_test test = {&kernel, &vtable, NULL, NULL, 0.0f};
    *tile = bench->tile;
    return exact_accumulate(tile, &test, bench->splats, bench->prepared, bench->indices, SPLATS,
                            &bench->profile);
}

static bool close_to(float value, float expected)
{
    return fabsf(value - expected) <= 1e-5f * fabsf(expected) + 1e-7f;
}

static uint32_t differing(const struct interleaved_tile *a, const struct interleaved_tile *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
        count += !close_to(a->weight[i], b->weight[i]) ||
                 !close_to(a->irradiance_r[i], b->irradiance_r[i]) ||
                 !close_to(a->irradiance_g[i], b->irradiance_g[i]) ||
                 !close_to(a->irradiance_b[i], b->irradiance_b[i]);
    return count;
}

static uint64_t run_kernel(const struct bench *bench, struct interleaved_tile *tile)
{
    struct kernel_variant variant;
    assert_true(kernel_choose("baseline", &variant));
    *tile = bench->tile;
    return variant.accumulate(tile, bench->prepared, bench->indices, SPLATS, 1, &bench->profile)
        .lit;
}

static void test_agrees_with_the_kernel_where_all_is_seen(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile exact, kernel;
    const struct bench *bench = make_bench();
    struct kernel_count count = run(bench, see_all, &exact);
    uint64_t lit = run_kernel(bench, &kernel);
    print_message("%llu pairs lit\n", (unsigned long long)lit);
    assert_true(lit > PS_TILE_PIXELS && count.lit == count.tests);
    assert_true(count.lit <= lit); /* which counts pixels behind walls as well */
    assert_int_equal(differing(&exact, &kernel), 0);
}

static void take_walls_away(struct bench *bench)
{
    for (uint32_t s = 0; s < SPLATS; s++)
        bench->splats[s].bundle.boundary_count = 0;
    prepare(bench);
}

static void test_asks_for_the_pixels_that_the_kernel_lights(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile exact, kernel;
    struct bench *bench = make_bench();
    take_walls_away(bench);
    struct kernel_count count = run(bench, see_all, &exact);
    assert_int_equal(count.tests, run_kernel(bench, &kernel));
    assert_int_equal(count.lit, count.tests);
}

/* Or else the agreement would say nothing of walls: before one splats weigh more, behind it
 * nothing. */
static void test_walls_move_weight_before_them(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile with, without;
    struct bench *bench = make_bench();
    run(bench, see_all, &with);
    take_walls_away(bench);
    run(bench, see_all, &without);
    uint32_t more = 0, less = 0;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        more += with.weight[i] > without.weight[i] * 1.01f;
        less += with.weight[i] < without.weight[i] * 0.99f;
    }
    print_message("%u pixels weigh more, %u less\n", more, less);
    assert_true(more > 0 && less > 0 && more + less > PS_TILE_PIXELS / 4);
}

static void test_points_that_are_not_seen_get_nothing(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile all, half;
    const struct bench *bench = make_bench();
    struct kernel_count whole = run(bench, see_all, &all),
                        right = run(bench, see_right_half, &half);
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
        assert_true(half.weight[i] == (bench->tile.position_x[i] > 0 ? all.weight[i] : 0));
    assert_true(right.tests == whole.tests && right.lit > 0 && right.lit < whole.lit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agrees_with_the_kernel_where_all_is_seen),
        cmocka_unit_test(test_asks_for_the_pixels_that_the_kernel_lights),
        cmocka_unit_test(test_walls_move_weight_before_them),
        cmocka_unit_test(test_points_that_are_not_seen_get_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
