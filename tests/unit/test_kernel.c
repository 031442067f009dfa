/* test_kernel.c: the inner loop in all its instruction sets, against the formulas of kernel.h
 * written out in double precision, pixel by pixel. For profiles see test_kernel_profile.c.
 *
 * Float and double may part ways where a pixel lies within rounding of a limit: those pixels are
 * found by the reference and left out, and must be few. */
#include "splat/kernel.h"

#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SPLATS 24
#define TILES 12
#define MOST_TEXELS (64 * 64)
#define STEEPEST 10.0 /* slope to which the bias grows, see box.h */

struct bench {
    _Alignas(64) struct interleaved_tile tile;
    struct splat splats[SPLATS];
    float depths[SPLATS][MOST_TEXELS];
    uint32_t indices[SPLATS];
    struct kernel_profile profile;
    uint32_t resolution;
};

struct sums {
    double r, g, b, weight, lit;
    bool borderline;
};

static void gaussian_profile(struct kernel_profile *profile)
{
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile->weights[i] = expf(-2.0f * kernel_profile_radius2(i));
    assert_true(kernel_profile_normalize(profile));
}

static bool sees_surface(const struct interleaved_tile *tile, uint32_t lane)
{
    return tile->position_x[lane] < BOUNDS_NOWHERE;
}

static void bound_block(struct interleaved_tile *tile, uint32_t block)
{
    struct bound bound = bound_empty();
    for (uint32_t i = INTERLEAVED_BLOCK * block; i < INTERLEAVED_BLOCK * (block + 1); i++)
        if (sees_surface(tile, i))
            bound_add_point(
                &bound, (ps_vec3){tile->position_x[i], tile->position_y[i], tile->position_z[i]},
                (ps_vec3){tile->normal_x[i], tile->normal_y[i], tile->normal_z[i]});
    bounds_set(&tile->blocks, block, &bound);
}

/* A bumpy surface around the origin, some of whose pixels see nothing. */
static void fill_tile(struct interleaved_tile *tile, struct random *random)
{
    memset(tile, 0, sizeof *tile);
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 normal = random_direction(random);
        bool seen = random_unit(random) > 0.1f;
        uint32_t column = i / 16 % 4 * 4 + i % 4, row = i / 64 * 4 + i / 4 % 4;
        tile->position_x[i] = seen ? (float)column / 8 - 1 : BOUNDS_NOWHERE;
        tile->position_y[i] = seen ? (float)row / 8 - 1 : BOUNDS_NOWHERE;
        tile->position_z[i] = seen ? random_between(random, -0.5f, 0.5f) : BOUNDS_NOWHERE;
        tile->normal_x[i] = seen ? normal.x : 0;
        tile->normal_y[i] = seen ? normal.y : 0;
        tile->normal_z[i] = seen ? normal.z : 0;
    }
    for (uint32_t block = 0; block < BOUNDS_WIDTH; block++)
        bound_block(tile, block);
}

/* No wall, one or two; some beside the disc's middle, some past its rim. */
static void add_walls(struct splat *splat, struct random *random)
{
    splat->bundle.boundary_count = (uint32_t)random_between(random, 0, 2.999f);
    for (uint32_t i = 0; i < splat->bundle.boundary_count; i++) {
        ps_vec3 direction = random_direction(random);
        float length = sqrtf(direction.x * direction.x + direction.y * direction.y);
        splat->bundle.boundaries[i] = (ps_boundary){direction.x / length, direction.y / length,
                                                    random_between(random, 0.0f, 1.2f)};
    }
}

/* Every other splat's pixels choose how much of the disc they take. */
static void add_width(struct splat *splat, struct random *random)
{
    if (random_unit(random) < 0.5f)
        return;
    splat->photon_depth = splat->bundle.start_depth - random_between(random, 0.01f, 0.3f);
    splat->bandwidth_scale = random_between(random, 0.2f, 2.0f);
    splat->narrowest = random_between(random, 0.1f, 0.5f) * splat->bundle.radius;
    splat->widest = random_between(random, 0.5f, 1.5f) * splat->bundle.radius;
    splat->blend_distance = random_between(random, -0.3f, 0.6f);
}

static struct splat random_splat(struct random *random)
{
    struct splat splat = {
        .bundle.centre = ps_scale(random_direction(random), 0.7f),
        .bundle.radius = random_between(random, 0.2f, 1.5f),
        .bundle.axis_w = ps_normalize(random_direction(random)),
        .near_depth = random_between(random, -1.0f, 0.0f),
        .bundle.far_depth = random_between(random, 0.1f, 1.0f),
        .bundle.start_depth = random_between(random, -0.8f, 0.0f),
        .bundle.start_slope_u = random_between(random, -1.0f, 1.0f),
        .bundle.start_slope_v = random_between(random, -1.0f, 1.0f),
        .bias_constant = random_between(random, 0.0f, 0.1f),
        .bias_slope = random_between(random, 0.0f, 0.1f),
        .power = {random_unit(random), random_unit(random), random_unit(random)},
    };
    ps_frame(splat.bundle.axis_w, &splat.bundle.axis_u, &splat.bundle.axis_v);
    add_walls(&splat, random);
    add_width(&splat, random);
    return splat;
}

static struct bench *make_bench(uint32_t resolution, uint64_t seed)
{
    static struct bench bench;
    struct random random = {seed};
    fill_tile(&bench.tile, &random);
    gaussian_profile(&bench.profile);
    bench.resolution = resolution;
    for (uint32_t s = 0; s < SPLATS; s++) {
        bench.splats[s] = random_splat(&random);
        bench.indices[s] = SPLATS - 1 - s;
        for (uint32_t i = 0; i < resolution * resolution; i++)
            bench.depths[s][i] =
                random_unit(&random) < 0.2f ? INFINITY : random_between(&random, -0.6f, 0.6f);
    }
    return &bench;
}

static double dot(ps_vec3 a, const double b[3])
{
    return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

/* Whether a < b, noting where that depends on rounding. */
static bool below(double a, double b, double margin, bool *borderline)
{
    *borderline |= fabs(a - b) < margin;
    return a < b;
}

static size_t texel(double across, uint32_t resolution, bool *borderline)
{
    double place = 0.5 * (across + 1) * resolution;
    *borderline |=
        fabs(place - floor(place + 0.5)) < 1e-4 && place > 0.5 && place < resolution - 0.5;
    return (size_t)fmin(fmax(place, 0), resolution - 1);
}

/* The half-width of the disc that a pixel takes, in those of the splat; see bandwidth.h. n: its
 * normal; `above`: its distance from the photon's plane. */
static double width_of(const struct splat *splat, const double n[3], double cosine, double above)
{
    if (!(splat->bandwidth_scale > 0))
        return 1;
    double across = dot(splat->bundle.axis_u, n) / cosine - splat->bundle.start_slope_u;
    double down = dot(splat->bundle.axis_v, n) / cosine - splat->bundle.start_slope_v;
    double h = splat->bandwidth_scale * above / (1 + splat->bandwidth_scale * hypot(across, down));
    return fmax(splat->narrowest, fmin(h, splat->widest)) / splat->bundle.radius;
}

/* What the walls beside a splat make of its weight. */
static double made_up(const struct bench *bench, const struct splat *splat, double u, double v,
                      double width, bool *borderline)
{
    double beyond[2] = {0, 0};
    for (uint32_t i = 0; i < splat->bundle.boundary_count; i++) {
        const ps_boundary *wall = &splat->bundle.boundaries[i];
        double distance = wall->distance - (u * wall->normal_u + v * wall->normal_v);
        if (!(distance > 0))
            return 0;
        double place = distance / width * (KERNEL_BOUNDARY_SIZE - 1);
        *borderline |= fabs(place - floor(place + 0.5)) < 1e-3;
        beyond[i] = bench->profile.beyond[(size_t)fmin(fmax(place, 0), KERNEL_BOUNDARY_SIZE - 1)];
    }
    const ps_boundary *walls = splat->bundle.boundaries;
    double cosine = walls[0].normal_u * walls[1].normal_u + walls[0].normal_v * walls[1].normal_v;
    double likeness = 2 / 3.14159265358979 * asin(fmax(-1, fmin(cosine, 1)));
    double product = beyond[0] * beyond[1];
    double both =
        product + likeness * (likeness < 0 ? product : fmin(beyond[0], beyond[1]) - product);
    return 1 / fmax(1 - beyond[0] - beyond[1] + both, KERNEL_LEAST_LEFT);
}

static double smooth_step(double x)
{
    double s = fmax(fmin(x, 1), 0);
    return s * s * (3 - 2 * s);
}

/* One splat's light on one pixel. */
static void add_reference(const struct bench *bench, uint32_t s, uint32_t pixel, struct sums *sums)
{
    const struct splat *splat = &bench->splats[s];
    const struct interleaved_tile *tile = &bench->tile;
    const double d[3] = {(double)tile->position_x[pixel] - splat->bundle.centre.x,
                         (double)tile->position_y[pixel] - splat->bundle.centre.y,
                         (double)tile->position_z[pixel] - splat->bundle.centre.z};
    const double n[3] = {tile->normal_x[pixel], tile->normal_y[pixel], tile->normal_z[pixel]};
    double u = dot(splat->bundle.axis_u, d) / splat->bundle.radius;
    double v = dot(splat->bundle.axis_v, d) / splat->bundle.radius;
    double t = dot(splat->bundle.axis_w, d), cosine = -dot(splat->bundle.axis_w, n),
           r2 = u * u + v * v;
    bool borderline = false;
    if (!sees_surface(tile, pixel))
        return;
    /* All of them, so that each notes its borderline. */
    bool inside = below(r2, 1, 1e-5, &borderline);
    inside = below(0, cosine, 1e-6, &borderline) && inside;
    inside = below(splat->near_depth, t, 1e-5, &borderline) && inside;
    inside = below(t, splat->bundle.far_depth, 1e-5, &borderline) && inside;
    double before = splat->bandwidth_scale > 0 ? splat->photon_depth : splat->bundle.start_depth;
    double above =
        t - before -
        splat->bundle.radius * (u * splat->bundle.start_slope_u + v * splat->bundle.start_slope_v);
    double width = width_of(splat, n, cosine, above);
    inside = below(r2, width * width, 1e-5, &borderline) && inside;
    inside =
        below((splat->bundle.start_depth - before) * fmin(width, 1), above, 1e-5, &borderline) &&
        inside;
    if (!inside) {
        sums->borderline |= borderline;
        return;
    }
    double slope = sqrt(fmax(0, 1 - cosine * cosine)) / cosine;
    double bias = splat->bias_constant + splat->bias_slope * fmin(slope, STEEPEST);
    double map = bench->depths[s][texel(v, bench->resolution, &borderline) * bench->resolution +
                                  texel(u, bench->resolution, &borderline)];
    bool lit = below(t - map, bias, 1e-4, &borderline);
    sums->borderline |= borderline;
    if (!lit)
        return;
    double disc = width * splat->bundle.radius;
    double entry = fmin(r2 / (width * width) * KERNEL_PROFILE_SIZE, KERNEL_PROFILE_SIZE - 1);
    double k = bench->profile.weights[(size_t)entry] * (double)bench->profile.scale / (disc * disc);
    k *= made_up(bench, splat, u, v, width, &sums->borderline);
    sums->borderline |= fabs(entry - floor(entry + 0.5)) < 2e-3;
    sums->weight += k;
    sums->lit++;
    if (splat->bandwidth_scale > 0 && splat->blend_distance > 0)
        k *= smooth_step(above / (double)splat->blend_distance);
    sums->r += splat->power.r * k * cosine;
    sums->g += splat->power.g * k * cosine;
    sums->b += splat->power.b * k * cosine;
}

static void expect_close(double value, double expected)
{
    if (fabs(value - expected) > 1e-5 * fabs(expected) + 1e-7)
        fail_msg("%.9g, expected %.9g", value, expected);
}

static void expect_pixel(const struct interleaved_tile *tile, uint32_t i, const struct sums *sums)
{
    expect_close(tile->irradiance_r[i], sums->r);
    expect_close(tile->irradiance_g[i], sums->g);
    expect_close(tile->irradiance_b[i], sums->b);
    expect_close(tile->weight[i], sums->weight);
}

static struct kernel_count run(const struct kernel_variant *variant, struct bench *bench,
                               struct interleaved_tile *tile)
{
    struct kernel_splat prepared[SPLATS];
    for (uint32_t s = 0; s < SPLATS; s++)
        prepared[s] = kernel_prepare(&bench->splats[s], &bench->profile, bench->depths[s]);
    *tile = bench->tile;
    return variant->accumulate(tile, prepared, bench->indices, SPLATS, bench->resolution,
                               &bench->profile);
}

/* Compares all pixels; returns how many were too close to a limit to tell. */
static uint32_t compare(const struct kernel_variant *variant, struct bench *bench, double *lit)
{
    static _Alignas(64) struct interleaved_tile tile;
    struct kernel_count count = run(variant, bench, &tile);
    uint32_t borderline = 0;
    double expected_useful = 0;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        struct sums sums = {0};
        for (uint32_t s = 0; s < SPLATS; s++)
            add_reference(bench, s, i, &sums);
        expected_useful += sums.lit;
        borderline += sums.borderline;
        if (!sums.borderline)
            expect_pixel(&tile, i, &sums);
    }
    assert_true(fabs((double)count.lit - expected_useful) <= 2.0 * borderline);
    /* Bounds leave something out, and keep whole blocks. */
    assert_true(count.tests >= count.lit && count.tests < SPLATS * PS_TILE_PIXELS * 9 / 10);
    assert_int_equal(count.tests % INTERLEAVED_BLOCK, 0);
    *lit += expected_useful;
    return borderline;
}

static void test_variants_agree_with_the_formulas(void **state)
{
    (void)state;
    static const uint32_t resolutions[] = {1, 3, 8, 64};
    struct kernel_variant variants[4];
    size_t count = kernel_variants(variants);
    assert_in_range(count, 1, 3);
    assert_string_equal(variants[count - 1].name, "baseline");
    for (size_t v = 0; v < count; v++)
        for (size_t r = 0; r < 4; r++) {
            uint32_t borderline = 0;
            double lit = 0;
            for (uint64_t seed = 1; seed <= TILES; seed++)
                borderline += compare(&variants[v], make_bench(resolutions[r], seed), &lit);
            print_message("%s, resolution %u: %.0f pairs lit, %u pixels of %u left out\n",
                          variants[v].name, resolutions[r], lit, borderline,
                          TILES * PS_TILE_PIXELS);
            assert_true(borderline < TILES * PS_TILE_PIXELS / 20);
            assert_true(lit > TILES * PS_TILE_PIXELS / 10.0);
        }
}

static void test_pixels_without_surface_get_nothing(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile tile;
    struct kernel_variant variants[4];
    size_t count = kernel_variants(variants);
    for (size_t v = 0; v < count; v++) {
        struct bench *bench = make_bench(8, 5);
        for (uint32_t s = 0; s < SPLATS; s++) {
            bench->splats[s].bundle.far_depth = INFINITY;
            bench->splats[s].near_depth = bench->splats[s].bundle.start_depth = -INFINITY;
            bench->splats[s].bundle.radius = s % 2 ? 1e-6f : 1e6f;
        }
        assert_true(run(&variants[v], bench, &tile).lit > 0);
        for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
            if (!sees_surface(&tile, i))
                assert_true(tile.weight[i] == 0 && tile.irradiance_r[i] == 0 &&
                            tile.irradiance_g[i] == 0 && tile.irradiance_b[i] == 0);
            else
                assert_true(isfinite(tile.weight[i]) && isfinite(tile.irradiance_r[i]));
    }
}

/* What lies in a tile already stays; only the splats named are added, in the order named. */
static void test_adds_to_what_is_there(void **state)
{
    (void)state;
    static _Alignas(64) struct interleaved_tile whole, halves;
    struct kernel_variant variants[4];
    size_t count = kernel_variants(variants);
    struct bench *bench = make_bench(3, 6);
    struct kernel_splat prepared[SPLATS];
    for (uint32_t s = 0; s < SPLATS; s++)
        prepared[s] = kernel_prepare(&bench->splats[s], &bench->profile, bench->depths[s]);
    for (size_t v = 0; v < count; v++) {
        uint64_t useful = run(&variants[v], bench, &whole).lit, parts = 0;
        halves = bench->tile;
        for (uint32_t first = 0; first < SPLATS; first += SPLATS / 3)
            parts += variants[v]
                         .accumulate(&halves, prepared, bench->indices + first, SPLATS / 3,
                                     bench->resolution, &bench->profile)
                         .lit;
        assert_true(parts == useful);
        assert_memory_equal(&whole, &halves, sizeof whole);
        assert_true(variants[v].accumulate(&halves, prepared, NULL, 0, 3, &bench->profile).tests ==
                    0);
        assert_memory_equal(&whole, &halves, sizeof whole);
    }
}

/* Splats from straight above a floor whose maps hold `depth`. Its normals are a little longer than
 * 1, as by rounding, and so is their cosine with the light. */
static struct bench *bench_from_above(float depth)
{
    struct bench *bench = make_bench(1, 7);
    const struct splat ahead = {
        .bundle.axis_u = {1, 0, 0},
        .bundle.axis_v = {0, 1, 0},
        .bundle.axis_w = {0, 0, -1},
        .bundle.radius = 4,
        .near_depth = -1,
        .bundle.start_depth = -1,
        .bundle.far_depth = 1,
        .bias_slope = 0.1f,
        .power = {1, 1, 1},
    };
    for (uint32_t s = 0; s < SPLATS; s++) {
        bench->splats[s] = ahead;
        bench->depths[s][0] = depth;
    }
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        bench->tile.normal_x[i] = bench->tile.normal_y[i] = 0;
        bench->tile.normal_z[i] = 1.000001f;
    }
    for (uint32_t block = 0; block < BOUNDS_WIDTH; block++)
        bound_block(&bench->tile, block);
    return bench;
}

static void expect_from_above(float depth, bool lit)
{
    static _Alignas(64) struct interleaved_tile tile;
    struct kernel_variant variants[4];
    size_t count = kernel_variants(variants);
    struct bench *bench = bench_from_above(depth);
    for (size_t v = 0; v < count; v++) {
        run(&variants[v], bench, &tile);
        for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
            assert_true((tile.weight[i] > 0) == (lit && sees_surface(&tile, i)));
    }
}

static void test_light_from_straight_ahead_is_seen(void **state)
{
    (void)state;
    expect_from_above(1, true);
    expect_from_above(INFINITY, true);
    expect_from_above(-1, false);
}

/* Maps are what plugins say. */
static void test_maps_that_hold_no_number_hide(void **state)
{
    (void)state;
    expect_from_above(NAN, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_from_straight_ahead_is_seen),
        cmocka_unit_test(test_maps_that_hold_no_number_hide),
        cmocka_unit_test(test_variants_agree_with_the_formulas),
        cmocka_unit_test(test_pixels_without_surface_get_nothing),
        cmocka_unit_test(test_adds_to_what_is_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
