/* test_boundary.c: walls that short rays find beside a photon. The ray tracer is one of planes,
 * written here. */
#include "placement/boundary.h"

#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* A wall without end, or a pole: points x with x.normal = distance, within `half_width` of the
 * origin sideways. */
struct plane {
    ps_vec3 normal;
    float distance, half_width;
};

struct room {
    struct plane planes[4];
    size_t count;
};

static float meet(const struct plane *plane, ps_vec3 origin, ps_vec3 direction, float before)
{
    float toward = ps_dot(direction, plane->normal);
    float t = (plane->distance - ps_dot(origin, plane->normal)) / toward;
    if (!(t > 0 && t < before))
        return before;
    ps_vec3 point = ps_add_scaled(origin, t, direction);
    ps_vec3 sideways = ps_add_scaled(point, -ps_dot(point, plane->normal), plane->normal);
    return ps_dot(sideways, sideways) < plane->half_width * plane->half_width ? t : before;
}

static void trace(const ps_host *host, ps_ray_packet *packets, size_t n, int coherent)
{
    (void)coherent;
    const struct room *room = host->core;
    for (size_t k = 0; k < n; k++)
        for (int i = 0; i < 16; i++) {
            ps_ray_packet *p = &packets[k];
            ps_vec3 origin = {p->origin_x[i], p->origin_y[i], p->origin_z[i]};
            ps_vec3 direction = {p->direction_x[i], p->direction_y[i], p->direction_z[i]};
            for (size_t w = 0; w < room->count; w++)
                p->tfar[i] = meet(&room->planes[w], origin, direction, p->tfar[i]);
        }
}

/* Light from the origin of a floor (y = 0), as much to the side as up, in bundles of half-width
 * 2. */
static struct splat bundle_in(struct room *room)
{
    static const float half = 0.70710678f;
    const ps_photon photon = {.normal = {0, 1, 0}, .direction = {half, half, 0}};
    struct splat splat = {
        .bundle.radius = 2,
        .bundle.axis_u = {half, -half, 0},
        .bundle.axis_v = {0, 0, 1},
        .bundle.axis_w = photon.direction,
        .bundle.start_slope_u = 1, /* points of the floor have y = 0 */
        .photon_depth = -10,
        .bundle.start_depth = 2.0f / 8 / half - 10,
    };
    ps_host host = {.core = room, .intersect_packets = trace};
    boundary_find(&host, 0.001f, &photon, 1, &splat);
    return splat;
}

static void expect_near(float value, double expected)
{
    if (fabs((double)value - expected) > 1e-4)
        fail_msg("%.9g, expected %.9g", (double)value, expected);
}

static void test_no_wall(void **state)
{
    (void)state;
    struct room empty = {.count = 0};
    assert_int_equal(bundle_in(&empty).bundle.boundary_count, 0);
    /* Past twice the way to the rim, which lies at z = 2. */
    struct room far = {{{{0, 0, 1}, 4.1f, 1e9f}}, 1};
    assert_int_equal(bundle_in(&far).bundle.boundary_count, 0);
}

/* Pixels that take in the photon may start as far out as the rim, and look as far again. */
static void test_wall_past_the_rim(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 3.5f, 1e9f}}, 1};
    struct splat splat = bundle_in(&room);
    assert_int_equal(splat.bundle.boundary_count, 1);
    expect_near(splat.bundle.boundaries[0].distance, 1.75);
}

/* A well whose walls lean outwards, as a hollow surface does: the bundle starts an eighth of its
 * half-width above the ground, on flat ground a thirty-second. */
static void test_hollows_raise_the_start(void **state)
{
    (void)state;
    static const float half = 0.70710678f;
    struct room flat = {.count = 0}, hollow = {.count = 4};
    const ps_vec3 leaning[4] = {
        {half, -half, 0}, {-half, -half, 0}, {0, -half, half}, {0, -half, -half}};
    for (size_t i = 0; i < 4; i++)
        hollow.planes[i] = (struct plane){leaning[i], 0.1f, 1e9f};
    expect_near(bundle_in(&flat).bundle.start_depth, 2.0 / 32 / (double)half - 10);
    expect_near(bundle_in(&hollow).bundle.start_depth, 2.0 / 8 / (double)half - 10);
}

/* Across the bundle a distance is what it is on the floor. */
static void test_wall_beside_the_beam(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 0.5f, 1e9f}}, 1};
    struct splat splat = bundle_in(&room);
    assert_int_equal(splat.bundle.boundary_count, 1);
    expect_near(splat.bundle.boundaries[0].normal_u, 0);
    expect_near(splat.bundle.boundaries[0].normal_v, 1);
    expect_near(splat.bundle.boundaries[0].distance, 0.25);
}

/* Along the bundle's slope the disc covers sqrt(2) times as much floor. */
static void test_wall_behind_the_beam(void **state)
{
    (void)state;
    struct room room = {{{{-1, 0, 0}, 1, 1e9f}}, 1};
    struct splat splat = bundle_in(&room);
    assert_int_equal(splat.bundle.boundary_count, 1);
    expect_near(splat.bundle.boundaries[0].normal_u, -1);
    expect_near(splat.bundle.boundaries[0].normal_v, 0);
    expect_near(splat.bundle.boundaries[0].distance, 0.5 / sqrt(2));
}

static void test_corner(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 0.5f, 1e9f}, {{-1, 0, 0}, 1, 1e9f}}, 2};
    struct splat splat = bundle_in(&room);
    assert_int_equal(splat.bundle.boundary_count, 2);
    expect_near(splat.bundle.boundaries[0].distance, 0.25);
    expect_near(splat.bundle.boundaries[1].normal_u, -1);
    expect_near(splat.bundle.boundaries[1].distance, 0.5 / sqrt(2));
}

/* Three walls leave a niche: two of them are taken. */
static void test_niche(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 0.5f, 1e9f}, {{0, 0, -1}, 0.6f, 1e9f}, {{-1, 0, 0}, 1, 1e9f}},
                        3};
    struct splat splat = bundle_in(&room);
    assert_int_equal(splat.bundle.boundary_count, PS_MOST_BOUNDARIES);
    expect_near(splat.bundle.boundaries[0].normal_v, 1);
    expect_near(splat.bundle.boundaries[1].normal_v, -1);
    expect_near(splat.bundle.boundaries[1].distance, 0.3);
}

static void test_a_pole_is_no_wall(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 0.5f, 0.3f}}, 1};
    assert_int_equal(bundle_in(&room).bundle.boundary_count, 0);
}

static void test_leaves_out_splats_that_light_nothing(void **state)
{
    (void)state;
    struct room room = {{{{0, 0, 1}, 0.5f, 1e9f}}, 1};
    ps_host host = {.core = &room, .intersect_packets = trace};
    const ps_photon photon = {.normal = {0, 1, 0}, .direction = {0, 1, 0}};
    struct splat nothing = {.bundle.radius = 0};
    boundary_find(&host, 0.001f, &photon, 1, &nothing);
    assert_int_equal(nothing.bundle.boundary_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_wall),
        cmocka_unit_test(test_wall_past_the_rim),
        cmocka_unit_test(test_hollows_raise_the_start),
        cmocka_unit_test(test_wall_beside_the_beam),
        cmocka_unit_test(test_wall_behind_the_beam),
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_niche),
        cmocka_unit_test(test_a_pole_is_no_wall),
        cmocka_unit_test(test_leaves_out_splats_that_light_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
