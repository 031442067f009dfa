/* test_bin.c: bins against every splat tried on every pixel.
 *
 * The G-buffer is made by hand: hills seen from above, with holes, and tiles that see nothing. */
#include "splat/bin.h"

#include "support/random.h"
#include "support/workers.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define INTERLEAVE 2
#define WIDTH 300 /* in each subset 10 x 7 tiles: two levels of the pyramid */
#define HEIGHT 200
#define SPLATS 400
#define ALTITUDE 5.0f /* away from the origin, where no empty tile may seem to lie */

struct bench {
    struct gbuffer gbuffer;
    struct interleaved interleaved;
    struct pyramid pyramid;
    struct workers *workers;
    struct kernel_variant kernel;
    struct splat splats[SPLATS];
    struct kernel_splat prepared[SPLATS];
};

static bool sees_surface(uint32_t x, uint32_t y)
{
    bool void_corner = x >= 256 && y < 64; /* whole tiles, and a whole group of them */
    return x < WIDTH && y < HEIGHT && !void_corner && (x * 7 + y * 13) % 11 != 0;
}

/* z = ALTITUDE + 0.1 sin(6 x) cos(5 y) over [0, 3] x [0, 2]. */
static void fill_lane(ps_tile *tile, uint32_t lane, uint32_t x, uint32_t y)
{
    bool seen = sees_surface(x, y);
    float px = (float)x * 0.01f, py = (float)y * 0.01f;
    ps_vec3 normal = {-0.6f * cosf(6 * px) * cosf(5 * py), 0.5f * sinf(6 * px) * sinf(5 * py), 1};
    normal = ps_normalize(normal);
    tile->position_x[lane] = seen ? px : 1e18f;
    tile->position_y[lane] = seen ? py : 1e18f;
    tile->position_z[lane] = seen ? ALTITUDE + 0.1f * sinf(6 * px) * cosf(5 * py) : 1e18f;
    tile->normal_x[lane] = seen ? normal.x : 0;
    tile->normal_y[lane] = seen ? normal.y : 0;
    tile->normal_z[lane] = seen ? normal.z : 0;
    tile->object[lane] = seen ? 0 : PS_NO_OBJECT;
    tile->depth[lane] = seen ? 1 : INFINITY;
}

static struct splat random_splat(struct random *random)
{
    struct splat splat = {
        .bundle.centre = {3.2f * random_unit(random) - 0.1f, 2.2f * random_unit(random) - 0.1f,
                          ALTITUDE + random_between(random, -0.15f, 0.15f)},
        .bundle.radius = random_unit(random) < 0.05f ? 0 : random_between(random, 0.01f, 0.3f),
        .bundle.axis_w = random_direction(random),
        .near_depth = -random_between(random, 0.0f, 0.5f),
        .bundle.far_depth = random_between(random, 0.0f, 0.5f),
    };
    splat.bundle.axis_w = ps_normalize(splat.bundle.axis_w);
    ps_frame(splat.bundle.axis_w, &splat.bundle.axis_u, &splat.bundle.axis_v);
    return splat;
}

static struct kernel_splat prepare(const struct splat *splat, uint32_t subset)
{
    static const struct kernel_profile profile = {.scale = 1};
    if (!(splat->bundle.radius > 0))
        return (struct kernel_splat){.kernel_scale = 0};
    struct kernel_splat prepared = kernel_prepare(splat, &profile, NULL);
    prepared.subset = subset;
    return prepared;
}

static int open_bench(void **state)
{
    struct bench *bench = malloc(sizeof *bench);
    struct random random = {9};
    struct error error;
    assert_non_null(bench);
    assert_int_equal(gbuffer_create(gbuffer_layout(WIDTH, HEIGHT), &bench->gbuffer, &error), PS_OK);
    assert_int_equal(bench->gbuffer.tile_count, 19 * 13);
    for (uint32_t tile = 0; tile < bench->gbuffer.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            gbuffer_pixel(&bench->gbuffer, tile, lane, &x, &y);
            fill_lane(&bench->gbuffer.tiles[tile], lane, x, y);
        }
    for (int i = 0; i < SPLATS; i++)
        bench->splats[i] = random_splat(&random);
    for (int i = 0; i < SPLATS; i++)
        bench->prepared[i] = prepare(&bench->splats[i], (uint32_t)i % (INTERLEAVE * INTERLEAVE));
    assert_true(kernel_choose(NULL, &bench->kernel));
    assert_int_equal(interleaved_create(interleaved_layout(&bench->gbuffer, INTERLEAVE),
                                        &bench->interleaved, &error),
                     PS_OK);
    assert_int_equal(bench->interleaved.tile_count, 4 * 10 * 7);
    bench->workers = start_workers(2);
    interleaved_fill(&bench->interleaved, &bench->gbuffer, bench->workers);
    assert_int_equal(pyramid_create(&bench->interleaved, &bench->pyramid, &error), PS_OK);
    pyramid_build(&bench->pyramid, &bench->interleaved, bench->workers);
    *state = bench;
    return 0;
}

static int close_bench(void **state)
{
    struct bench *bench = *state;
    workers_destroy(bench->workers);
    pyramid_release(&bench->pyramid);
    interleaved_release(&bench->interleaved);
    gbuffer_release(&bench->gbuffer);
    free(bench);
    return 0;
}

/* Whether some pixel of the tile is inside of the splat's disc and box, and faces it; `slack`
 * widens all limits. */
static bool lights(const struct interleaved_tile *tile, const struct splat *splat, float slack)
{
    if (!(splat->bundle.radius > 0))
        return false;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        if (!(tile->position_x[i] < BOUNDS_NOWHERE))
            continue;
        ps_vec3 p = {tile->position_x[i], tile->position_y[i], tile->position_z[i]};
        ps_vec3 n = {tile->normal_x[i], tile->normal_y[i], tile->normal_z[i]};
        ps_vec3 d = ps_subtract(p, splat->bundle.centre);
        float u = ps_dot(d, splat->bundle.axis_u), v = ps_dot(d, splat->bundle.axis_v);
        float t = ps_dot(d, splat->bundle.axis_w), reach = splat->bundle.radius + slack;
        if (u * u + v * v < reach * reach && t >= splat->near_depth - slack &&
            t <= splat->bundle.far_depth + slack && ps_dot(n, splat->bundle.axis_w) < slack)
            return true;
    }
    return false;
}

static struct bins sort(const struct bench *bench, size_t n, uint32_t threads)
{
    struct bins bins;
    struct error error;
    struct workers *workers = start_workers(threads);
    assert_int_equal(bins_create(bench->interleaved.tile_count, &bins, &error), PS_OK);
    assert_int_equal(
        bins_sort(&bins, &bench->pyramid, &bench->kernel, bench->prepared, n, workers, &error),
        PS_OK);
    workers_destroy(workers);
    return bins;
}

static bool holds(const struct bins *bins, uint32_t tile, uint32_t splat)
{
    for (uint32_t i = bins->offsets[tile]; i < bins->offsets[tile + 1]; i++)
        if (bins->indices[i] == splat)
            return true;
    return false;
}

static void test_holds_every_lit_pair(void **state)
{
    struct bench *bench = *state;
    struct bins bins = sort(bench, SPLATS, 2);
    size_t lit = 0, pairs = bins.offsets[bins.tile_count];
    for (uint32_t tile = 0; tile < bins.tile_count; tile++)
        for (uint32_t i = tile / (10 * 7); i < SPLATS; i += INTERLEAVE * INTERLEAVE)
            if (lights(&bench->interleaved.tiles[tile], &bench->splats[i], 0)) {
                lit++;
                assert_true(holds(&bins, tile, i));
            }
    print_message("%zu pairs are lit, %zu in the bins, %d possible\n", lit, pairs,
                  (int)bins.tile_count * SPLATS);
    assert_true(lit > 500);
    assert_true(pairs < 4 * lit); /* bounds are tight enough to be of use */
    bins_release(&bins);
}

static void test_is_sorted(void **state)
{
    struct bench *bench = *state;
    struct bins bins = sort(bench, SPLATS, 2);
    assert_int_equal(bins.offsets[0], 0);
    for (uint32_t tile = 0; tile < bins.tile_count; tile++) {
        assert_true(bins.offsets[tile] <= bins.offsets[tile + 1]);
        for (uint32_t i = bins.offsets[tile]; i < bins.offsets[tile + 1]; i++) {
            assert_true(bins.indices[i] < SPLATS);
            assert_int_equal(bench->prepared[bins.indices[i]].subset, tile / (10 * 7));
            if (i > bins.offsets[tile])
                assert_true(bins.indices[i - 1] < bins.indices[i]); /* each once, in order */
        }
    }
    bins_release(&bins);
}

/* Splats without a size, and tiles without a surface, have no pairs. */
static void test_leaves_out_what_lights_nothing(void **state)
{
    struct bench *bench = *state;
    struct bins bins = sort(bench, SPLATS, 1);
    uint32_t empty_splats = 0, empty_tiles = 0;
    for (uint32_t i = 0; i < SPLATS; i++)
        empty_splats += bench->splats[i].bundle.radius == 0;
    assert_true(empty_splats > 5);
    for (uint32_t i = 0; i < bins.offsets[bins.tile_count]; i++)
        assert_true(bench->splats[bins.indices[i]].bundle.radius > 0);
    for (uint32_t tile = 0; tile < bins.tile_count; tile++) {
        bool empty = true;
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
            empty = empty && bench->interleaved.tiles[tile].position_x[lane] >= BOUNDS_NOWHERE;
        empty_tiles += empty;
        if (empty)
            assert_int_equal(bins.offsets[tile], bins.offsets[tile + 1]);
    }
    assert_int_equal(empty_tiles, 4 * 2 * 2);
    bins_release(&bins);
}

static void expect_same(const struct bins *a, const struct bins *b)
{
    size_t first = a->first_tile, count = a->end_tile - first;
    assert_int_equal(b->first_tile, first);
    assert_int_equal(b->end_tile, a->end_tile);
    assert_memory_equal(a->offsets + first, b->offsets + first, (count + 1) * sizeof *a->offsets);
    assert_memory_equal(a->indices, b->indices, a->offsets[a->end_tile] * sizeof *a->indices);
}

static void test_same_for_any_threads(void **state)
{
    struct bench *bench = *state;
    struct bins one = sort(bench, SPLATS, 1);
    for (uint32_t threads = 2; threads <= 5; threads++) {
        struct bins more = sort(bench, SPLATS, threads);
        expect_same(&one, &more);
        bins_release(&more);
    }
    bins_release(&one);
}

/* One structure serves many batches, of any size. */
static void test_batches_do_not_disturb_each_other(void **state)
{
    static const size_t sizes[] = {SPLATS, 0, 1, 31, 33, SPLATS, 7};
    struct bench *bench = *state;
    struct bins bins = sort(bench, 3, 2);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct bins fresh = sort(bench, sizes[i], 2);
        struct error error;
        assert_int_equal(bins_sort(&bins, &bench->pyramid, &bench->kernel, bench->prepared,
                                   sizes[i], bench->workers, &error),
                         PS_OK);
        if (sizes[i])
            expect_same(&bins, &fresh);
        else
            assert_int_equal(bins.offsets[bins.end_tile], 0);
        bins_release(&fresh);
    }
    bins_release(&bins);
}

/* Splats that light few subsets fall into the tiles of these. */
static void test_range_of_the_subsets(void **state)
{
    const struct bench *bench = *state;
    static struct kernel_splat splats[SPLATS];
    for (uint32_t i = 0; i < SPLATS; i++) {
        splats[i] = bench->prepared[i];
        splats[i].subset = 1 + i % 2;
    }
    struct bins bins;
    struct error error;
    assert_int_equal(bins_create(bench->interleaved.tile_count, &bins, &error), PS_OK);
    assert_int_equal(
        bins_sort(&bins, &bench->pyramid, &bench->kernel, splats, SPLATS, bench->workers, &error),
        PS_OK);
    assert_int_equal(bins.first_tile, 10 * 7);
    assert_int_equal(bins.end_tile, 3 * 10 * 7);
    assert_int_equal(bins.offsets[bins.first_tile], 0);
    assert_true(bins.offsets[bins.end_tile] > SPLATS);
    bins_release(&bins);
}

/* The pairs are those whose splat's box meets the box around the tile's points: nothing is lost
 * on the way down the pyramid, and little kept. */
static void test_pyramid_bounds_its_tiles(void **state)
{
    struct bench *bench = *state;
    const struct pyramid *pyramid = &bench->pyramid;
    assert_int_equal(pyramid->levels, 2);
    assert_int_equal(pyramid->across[1], 1);
    assert_int_equal(pyramid->down[1], 1);
    float left = INFINITY, right = -INFINITY;
    const struct bounds *top = &pyramid->nodes[pyramid->first[1]];
    for (uint32_t i = 0; i < BOUNDS_WIDTH; i++) {
        if (!(top->center_x[i] < BOUNDS_NOWHERE))
            continue;
        left = fminf(left, top->center_x[i] - top->extent_x[i]);
        right = fmaxf(right, top->center_x[i] + top->extent_x[i]);
        assert_true(fabsf(top->center_z[i] - ALTITUDE) < 0.05f && top->extent_z[i] < 0.11f);
        assert_true(top->normal_low_z[i] > 0.5f && top->normal_high_z[i] <= 1.0001f);
    }
    assert_true(fabsf(left) < 0.011f && fabsf(right - 2.98f) < 0.011f);
    for (size_t i = 0; i < pyramid->each; i++)
        for (uint32_t k = 0; k < BOUNDS_WIDTH && i < pyramid->first[1]; k++)
            assert_true(pyramid->nodes[i].extent_x[k] < 0.16f);
}

static bool stop_at_once(void *user, uint32_t tile)
{
    (void)tile;
    ++*(int *)user;
    return false;
}

static void test_a_visitor_can_stop(void **state)
{
    struct bench *bench = *state;
    int met = 0, stopped = 0;
    for (int i = 0; i < SPLATS; i++) {
        int visits = 0;
        if (bench->prepared[i].kernel_scale > 0)
            stopped += !pyramid_visit(&bench->pyramid, &bench->kernel, &bench->prepared[i],
                                      stop_at_once, &visits);
        assert_true(visits <= 1);
        met += visits;
    }
    assert_int_equal(met, stopped);
    assert_true(met > SPLATS / 4);
}

static void test_smallest_picture(void **state)
{
    (void)state;
    struct gbuffer gbuffer;
    struct pyramid pyramid;
    struct bins bins;
    struct error error;
    assert_int_equal(gbuffer_create(gbuffer_layout(1, 1), &gbuffer, &error), PS_OK);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        fill_lane(&gbuffer.tiles[0], lane, lane ? WIDTH : 1, 0);
    struct interleaved interleaved;
    struct kernel_variant kernel;
    assert_true(kernel_choose("baseline", &kernel));
    assert_int_equal(interleaved_create(interleaved_layout(&gbuffer, 1), &interleaved, &error),
                     PS_OK);
    interleaved_fill(&interleaved, &gbuffer, NULL);
    assert_int_equal(pyramid_create(&interleaved, &pyramid, &error), PS_OK);
    pyramid_build(&pyramid, &interleaved, NULL);
    assert_int_equal(bins_create(1, &bins, &error), PS_OK);
    struct splat splats[2] = {{.bundle.radius = 0.1f, .near_depth = -1, .bundle.far_depth = 1}};
    splats[0].bundle.axis_u = (ps_vec3){1, 0, 0};
    splats[0].bundle.axis_v = (ps_vec3){0, -1, 0};
    splats[0].bundle.axis_w = (ps_vec3){0, 0, -1};
    splats[0].bundle.centre.z = ALTITUDE;
    splats[1] = splats[0];
    splats[0].bundle.centre.x = 1;
    const struct kernel_splat prepared[2] = {prepare(&splats[0], 0), prepare(&splats[1], 0)};
    assert_int_equal(bins_sort(&bins, &pyramid, &kernel, prepared, 2, NULL, &error), PS_OK);
    assert_int_equal(bins.offsets[1], 1);
    assert_int_equal(bins.indices[0], 1);
    bins_release(&bins);
    pyramid_release(&pyramid);
    interleaved_release(&interleaved);
    gbuffer_release(&gbuffer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_holds_every_lit_pair),
        cmocka_unit_test(test_is_sorted),
        cmocka_unit_test(test_leaves_out_what_lights_nothing),
        cmocka_unit_test(test_same_for_any_threads),
        cmocka_unit_test(test_batches_do_not_disturb_each_other),
        cmocka_unit_test(test_pyramid_bounds_its_tiles),
        cmocka_unit_test(test_range_of_the_subsets),
        cmocka_unit_test(test_a_visitor_can_stop),
        cmocka_unit_test(test_smallest_picture),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
