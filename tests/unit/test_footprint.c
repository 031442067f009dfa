/* test_footprint.c: radii, and the boxes around first hits, against values worked out by hand. */
#include "placement/footprint.h"
#include "placement/radius.h"

#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define RADIUS 40.0f /* of the scene */

/* Pixels of no size, unless a test says otherwise. */
static struct camera camera = {.orthographic = true, .location = {0, 0, -99}, .forward = {0, 0, 1}};

static const struct placement_scene scene = {.radius = RADIUS,
                                             .surface_offset = 0.001f,
                                             .automatic_radius = 2,
                                             .automatic_gather_distance = 2,
                                             .seed = 7,
                                             .camera = &camera,
                                             .interleave = 4};

static void expect_near(double value, double expected)
{
    if (fabs(value - expected) > 1e-4 * fmax(1, fabs(expected)))
        fail_msg("%.7g, expected %.7g", value, expected);
}

static struct splat place_one(const struct placement_scene *own,
                              const struct footprint_params *settings, const ps_photon *photon,
                              const ps_hit *hit)
{
    float largest = radius_largest(own, settings, photon, hit);
    float radius = radius_at(own, settings, photon, largest, hit->distance);
    return footprint_place(own, settings, photon, hit, largest, radius);
}

/* A photon at the origin on a surface that faces up, whose light goes along w and arrives after
 * `distance` where the cosine is `cosine`. */
static struct splat place_along(ps_vec3 w, struct footprint_params settings, float distance,
                                float cosine)
{
    ps_vec3 u, v;
    ps_frame(w, &u, &v);
    ps_vec3 normal = ps_scale(w, -cosine);
    normal = ps_add_scaled(normal, sqrtf(1 - cosine * cosine), u);
    ps_photon photon = {
        .normal = {0, 1, 0}, .direction = w, .power = {1, 2, 3}, .bounce = 1, .path = 55};
    ps_hit hit = {.position = ps_scale(w, distance), .distance = distance, .normal = normal};
    return place_one(&scene, &settings, &photon, &hit);
}

static struct splat place(struct footprint_params settings, float distance, float cosine)
{
    return place_along((ps_vec3){0, 1, 0}, settings, distance, cosine);
}

static void test_carries_the_photon(void **state)
{
    (void)state;
    struct splat splat = place((struct footprint_params){.radius.number = 2}, 10, 1);
    expect_near(splat.bundle.centre.y, 10);
    assert_true(splat.power.r == 1 && splat.power.g == 2 && splat.power.b == 3);
    assert_true(splat.path == 55);
    assert_true(splat.bundle.axis_w.y == 1);
}

static void test_size(void **state)
{
    (void)state;
    expect_near(place((struct footprint_params){.radius.number = 3}, 10, 1).bundle.radius, 3);
    expect_near(place((struct footprint_params){.radius.number = 0}, 10, 1).bundle.radius, 2);
}

/* By the fourth root of few paths, the fifth root of many, the sixth root of the passes; never a
 * large part of the scene. */
static void test_automatic_size(void **state)
{
    (void)state;
    float size = radius_automatic(RADIUS, 0, 100000, 0);
    assert_true(size > 0.13f * RADIUS && size < 0.15f * RADIUS);
    expect_near(radius_automatic(2 * RADIUS, 0, 100000, 0), 2 * (double)size);
    expect_near(radius_automatic(RADIUS, 0, 6250, 0), fmin(2 * (double)size, 0.25 * RADIUS));
    expect_near(radius_automatic(RADIUS, 0, 3200000, 0), (double)size / 2);
    expect_near(radius_automatic(RADIUS, 0, 100000, 63), (double)size / 2);
    expect_near(radius_automatic(RADIUS, 0, 1, 0), 0.25 * RADIUS);
    expect_near(radius_automatic(RADIUS, 0, 0, 0), 0.25 * RADIUS);
}

/* Light that lands close together makes smaller splats, in proportion; but not without end, and
 * wide light makes none larger. */
static void test_size_by_the_spread_of_light(void **state)
{
    (void)state;
    float size = radius_automatic(RADIUS, 0, 100000, 0);
    float narrow = radius_automatic(RADIUS, 0.2f * RADIUS, 100000, 0);
    assert_true(narrow < 0.9f * size);
    expect_near(radius_automatic(RADIUS, 0.16f * RADIUS, 100000, 0), 0.8 * (double)narrow);
    expect_near(radius_automatic(RADIUS, 0.2f * RADIUS, 3200000, 0), (double)narrow / 2);
    expect_near(radius_automatic(RADIUS, RADIUS, 100000, 0), size);
    expect_near(radius_automatic(RADIUS, 1e-6f, 100000, 0), 0.4 * (double)size);
}

/* R = min(size, follow * d), but no less than three tenths of size. */
static void test_size_follows_distance(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 3, .bandwidth_scale = 0.25};
    expect_near(place(settings, 100, 1).bundle.radius, 3);
    expect_near(place(settings, 12.1f, 1).bundle.radius, 3);
    expect_near(place(settings, 8, 1).bundle.radius, 2);
    expect_near(place(settings, 4, 1).bundle.radius, 1);
    expect_near(place(settings, 2, 1).bundle.radius, 0.9);
    expect_near(place(settings, 0.001f, 1).bundle.radius, 0.9);
    const struct footprint_params automatic = {.bandwidth_scale = 0.25};
    expect_near(place(automatic, 4, 1).bundle.radius, 1);
    expect_near(place(automatic, 0.1f, 1).bundle.radius, 0.6);
    const struct footprint_params unlimited = {.radius.number = 3};
    expect_near(place(unlimited, 0.001f, 1).bundle.radius, 3);
}

/* Surfaces that others light have no shadows' edges to keep sharp. */
static void test_size_follows_less_far_after_the_first_bounce(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 3, .bandwidth_scale = 0.25};
    ps_photon photon = {.normal = {0, 1, 0}, .direction = {0, 1, 0}, .power = {1, 1, 1}};
    ps_hit hit = {.position = {0, 2, 0}, .distance = 2, .normal = {0, -1, 0}};
    const double half_widths[3] = {0.9, 1.8, 1.8}; /* of bounce 1, 2, 3 */
    for (uint16_t i = 0; i < 3; i++) {
        photon.bounce = (uint16_t)(i + 1);
        expect_near(place_one(&scene, &settings, &photon, &hit).bundle.radius, half_widths[i]);
    }
}

static struct splat place_near(struct footprint_params settings, uint16_t bounce, uint8_t specular)
{
    struct placement_scene own = scene;
    own.gather_distance = radius_gather_distance(&own, &settings, 100000);
    ps_photon photon = {
        .normal = {0, 1, 0}, .direction = {0, 1, 0}, .bounce = bounce, .specular = specular};
    ps_hit hit = {.position = {0, 0.01f, 0}, .distance = 0.01f, .normal = {0, -1, 0}};
    return place_one(&own, &settings, &photon, &hit);
}

/* Many paths make smaller splats, and leave short-range light as near as it was. */
static void test_short_range_light_stays_as_near(void **state)
{
    (void)state;
    const struct footprint_params by_hand = {
        .radius.number = 3, .bandwidth_scale = 0.25, .step_back.choice = 1};
    expect_near(radius_gather_distance(&scene, &by_hand, 6250), 2.5 * 3);
    expect_near(radius_gather_distance(&scene, &by_hand, 3200000), 2.5 * 6);
    double size = radius_automatic(RADIUS, 0, 100000, 0);
    expect_near(radius_automatic_gather_distance(RADIUS, 0, 100000), 2.5 * size);
    expect_near(radius_automatic_gather_distance(RADIUS, 0, 3200000), 2.5 * size);
    double large = radius_automatic(RADIUS, 0, 50000, 0);
    expect_near(radius_automatic_gather_distance(RADIUS, 0, 50000), 2.5 * large);
}

/* As far as splats are wide, and more, where the light was reflected once, and diffusely; splats
 * may be wide then. */
static void test_short_range_light_is_left(void **state)
{
    (void)state;
    const struct footprint_params full = {
        .radius.number = 3, .bandwidth_scale = 0.25, .step_back.choice = 1};
    expect_near(place_near(full, 1, 0).blend_distance, 2.5 * 3);
    expect_near(place_near(full, 1, 0).bundle.radius, 0.6 * 3);
    expect_near(place_near(full, 1, 1).blend_distance, 0);
    expect_near(place_near(full, 1, 1).bundle.radius, 0.3 * 3);
    expect_near(place_near(full, 2, 0).blend_distance, 0);
    const struct footprint_params automatic = {.bandwidth_scale = 0.25, .step_back.choice = 1};
    expect_near(place_near(automatic, 1, 0).blend_distance, 2);
    const struct footprint_params sloped = {.radius.number = 3, .bandwidth_scale = 0.25},
                                  still = {.radius.number = 3, .step_back.choice = 1};
    expect_near(place_near(sloped, 1, 0).blend_distance, 0);
    expect_near(place_near(still, 1, 0).blend_distance, 0);
}

/* Nor less than the pixels that are averaged in the end, of which these settings have 4x4. */
static void test_size_follows_no_further_than_pixels(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 3, .bandwidth_scale = 0.25};
    camera.across = (ps_vec3){0.3f, 0, 0};
    expect_near(place(settings, 8, 1).bundle.radius, 2);
    expect_near(place(settings, 0.001f, 1).bundle.radius, 1.2);
    camera.across = (ps_vec3){5, 0, 0};
    expect_near(place(settings, 0.001f, 1).bundle.radius, 3);
    camera.orthographic = false;
    camera.across = (ps_vec3){0.003f, 0, 0};
    expect_near(place(settings, 0.001f, 1).bundle.radius, 0.003 * 99 * 4);
    camera.orthographic = true;
    camera.across = (ps_vec3){0, 0, 0};
}

static double half_width_of(float merged, struct footprint_params settings, float distance)
{
    ps_photon photon = {
        .normal = {0, 1, 0}, .direction = {0, 1, 0}, .merged = merged, .power = {1, 1, 1}};
    ps_hit hit = {.position = {0, distance, 0}, .distance = distance, .normal = {0, -1, 0}};
    return place_one(&scene, &settings, &photon, &hit).bundle.radius;
}

/* By the square root of what was merged, up to a limit; then the distance limits as ever. */
static void test_size_grows_with_what_was_merged(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 2, .max_merge_scale = 3};
    expect_near(half_width_of(4, settings, 100), 4);
    expect_near(half_width_of(2, settings, 100), 2 * sqrt(2));
    expect_near(half_width_of(9, settings, 100), 6);
    expect_near(half_width_of(1000, settings, 100), 6);
    assert_true(half_width_of(1, settings, 100) == 2);
    assert_true(half_width_of(0.5f, settings, 100) == 2);
    const struct footprint_params none = {.radius.number = 2, .max_merge_scale = 1};
    assert_true(half_width_of(9, none, 100) == 2);
    const struct footprint_params follows = {
        .radius.number = 2, .max_merge_scale = 3, .bandwidth_scale = 0.25};
    expect_near(half_width_of(9, follows, 100), 6);
    expect_near(half_width_of(9, follows, 16), 4);
    expect_near(half_width_of(9, follows, 0.1f), 1.8);
    const struct footprint_params vast = {.radius.number = 2, .max_merge_scale = INFINITY};
    expect_near(half_width_of(1e12f, vast, 100), 4 * RADIUS);
}

/* b = min(d, R tan + R / 2), depth R tan + R. */
static void test_automatic_step_back(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 2};
    struct splat flat = place(settings, 10, 1);
    expect_near(flat.near_depth, -1);
    expect_near(flat.bundle.far_depth, 2);
    expect_near(flat.bundle.start_depth, -1);
    assert_true(flat.bundle.start_slope_u == 0 && flat.bundle.start_slope_v == 0);
    struct splat sloped = place(settings, 10, 0.6f); /* tan = 4/3 */
    expect_near(sloped.near_depth, -(2 * 4.0 / 3 + 1));
    expect_near(sloped.bundle.far_depth, 2 * 4.0 / 3 + 2);
    struct splat close = place(settings, 0.5f, 0.6f); /* not behind the photon */
    expect_near(close.near_depth, -0.5);
    expect_near(close.bundle.far_depth, 2 * 4.0 / 3 + 2);
}

static void test_steep_slopes_are_limited(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 1};
    struct splat grazing = place(settings, 1000, 1e-3f);
    expect_near(grazing.near_depth, -(10 + 0.5));
    expect_near(grazing.bundle.far_depth, 11);
    struct splat behind = place(settings, 1000, -0.5f); /* rounding may turn a normal away */
    expect_near(behind.bundle.far_depth, 11);
}

static void test_numbers(void **state)
{
    (void)state;
    const struct footprint_params settings = {
        .radius.number = 2, .depth.number = 7, .step_back.number = 3, .step_back.choice = -1};
    struct splat splat = place(settings, 10, 0.6f);
    expect_near(splat.near_depth, -3);
    expect_near(splat.bundle.start_depth, -3);
    expect_near(splat.bundle.far_depth, 7);
    expect_near(place(settings, 2, 0.6f).near_depth, -2); /* the photon is nearer */
    const struct footprint_params none = {
        .radius.number = 2, .step_back.number = 0, .step_back.choice = -1};
    expect_near(place(none, 10, 1).near_depth, 0);
}

/* A bundle straight up from its photon: the start plane lies across it, an eighth of R above. */
static void test_full_beam_straight_up(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 2, .step_back.choice = 1};
    struct splat splat = place(settings, 10, 1);
    expect_near(splat.bundle.start_depth, 0.25 - 10);
    expect_near(splat.bundle.start_slope_u, 0);
    expect_near(splat.bundle.start_slope_v, 0);
    expect_near(splat.near_depth, -10);
    expect_near(splat.photon_depth, -10);
    expect_near(splat.bundle.far_depth, 2);
    /* Never past half of the way. */
    expect_near(place(settings, 0.2f, 1).bundle.start_depth, -0.1);
}

/* Every ray of a slanted bundle starts on one plane parallel to the photon's surface. */
static void test_full_beam_starts_along_the_surface(void **state)
{
    (void)state;
    const struct footprint_params settings = {.radius.number = 2, .step_back.choice = 1};
    struct splat splat = place_along((ps_vec3){0.8f, 0.6f, 0}, settings, 10, 1);
    float earliest = 0;
    for (int i = 0; i < 32; i++) { /* around the edge of the disc */
        float u = 2 * cosf((float)i * PS_PI / 16), v = 2 * sinf((float)i * PS_PI / 16);
        float start = splat.bundle.start_depth + u * splat.bundle.start_slope_u +
                      v * splat.bundle.start_slope_v;
        ps_vec3 origin = ps_add_scaled(splat.bundle.centre, u, splat.bundle.axis_u);
        origin = ps_add_scaled(origin, v, splat.bundle.axis_v);
        origin = ps_add_scaled(origin, start, splat.bundle.axis_w);
        expect_near(origin.y, 0.25); /* R / 8 above the surface */
        earliest = fminf(earliest, start);
    }
    assert_true(splat.near_depth <= earliest - 0.4f && splat.near_depth > earliest - 0.5f);
    expect_near(splat.bundle.start_depth, 0.25 / 0.6 - 10);
}

static void test_a_miss_lights_nothing(void **state)
{
    (void)state;
    for (int rule = -1; rule <= 1; rule++) {
        const struct footprint_params settings = {
            .radius.number = 2, .step_back.number = 1, .step_back.choice = rule};
        ps_photon photon = {.normal = {0, 1, 0}, .direction = {0, 1, 0}, .power = {1, 1, 1}};
        ps_hit hit = {.distance = INFINITY, .object = PS_NO_OBJECT};
        assert_true(place_one(&scene, &settings, &photon, &hit).bundle.radius == 0);
    }
}

static struct splat frame_of(uint64_t seed, uint64_t path, uint32_t bounce, ps_vec3 w)
{
    const struct placement_scene own = {
        .radius = RADIUS, .surface_offset = 0.001f, .seed = seed, .camera = &camera};
    const struct footprint_params settings = {.radius.number = 2};
    ps_photon photon = {.normal = w, .direction = w, .bounce = bounce, .path = path};
    ps_hit hit = {.position = w, .distance = 1, .normal = ps_scale(w, -1)};
    return place_one(&own, &settings, &photon, &hit);
}

static void test_frames_are_orthonormal(void **state)
{
    (void)state;
    struct random random = {8};
    for (uint64_t path = 0; path < 1000; path++) {
        ps_vec3 w = ps_normalize(random_direction(&random));
        struct splat splat = frame_of(1, path, 1, w);
        assert_memory_equal(&splat.bundle.axis_w, &w, sizeof w);
        assert_true(fabsf(ps_length(splat.bundle.axis_u) - 1) < 1e-5f);
        assert_true(fabsf(ps_length(splat.bundle.axis_v) - 1) < 1e-5f);
        assert_true(fabsf(ps_dot(splat.bundle.axis_u, splat.bundle.axis_v)) < 1e-5f);
        assert_true(fabsf(ps_dot(splat.bundle.axis_u, w)) < 1e-5f);
        assert_true(ps_dot(ps_cross(splat.bundle.axis_u, splat.bundle.axis_v), w) > 0.999f);
    }
}

/* The turn is even over the circle, and differs by path, bounce and seed alone. */
static void test_frames_turn(void **state)
{
    (void)state;
    enum { PATHS = 2000 };
    const ps_vec3 up = {0, 1, 0};
    double sum_x = 0, sum_z = 0;
    int quadrants[4] = {0};
    for (uint64_t path = 0; path < PATHS; path++) {
        ps_vec3 u = frame_of(1, path, 1, up).bundle.axis_u;
        sum_x += u.x;
        sum_z += u.z;
        quadrants[(u.x > 0) + 2 * (u.z > 0)]++;
    }
    assert_true(fabs(sum_x) < 0.1 * PATHS && fabs(sum_z) < 0.1 * PATHS);
    for (int i = 0; i < 4; i++)
        assert_in_range(quadrants[i], PATHS / 5, 3 * PATHS / 10);
    ps_vec3 u = frame_of(1, 3, 1, up).bundle.axis_u, again = frame_of(1, 3, 1, up).bundle.axis_u;
    assert_memory_equal(&u, &again, sizeof u);
    assert_true(ps_dot(u, frame_of(2, 3, 1, up).bundle.axis_u) < 0.9999f);
    assert_true(ps_dot(u, frame_of(1, 3, 2, up).bundle.axis_u) < 0.9999f);
    assert_true(ps_dot(u, frame_of(1, 4, 1, up).bundle.axis_u) < 0.9999f);
}

static struct splat uncut(void)
{
    return (struct splat){.bundle.radius = 1,
                          .near_depth = -5,
                          .bundle.far_depth = 5,
                          .bias_constant = 0.1f,
                          .bias_slope = 0.02f}; /* up to 0.2 at the steepest */
}

/* What lies before the map is lit too: only the far end moves. */
static void test_cut(void **state)
{
    (void)state;
    const float depths[4] = {-1, 0.5f, 2, 0};
    struct splat splat = uncut();
    footprint_cut(&splat, depths, 2);
    expect_near(splat.near_depth, -5);
    expect_near(splat.bundle.far_depth, 2.3);
    splat = uncut(); /* never grows */
    splat.bundle.far_depth = 1;
    footprint_cut(&splat, depths, 2);
    expect_near(splat.bundle.far_depth, 1);
}

/* A box stays open to its end where nothing was hit. */
static void test_cut_with_misses(void **state)
{
    (void)state;
    const float some[4] = {-1, INFINITY, 2, 0}, none[1] = {INFINITY};
    struct splat splat = uncut();
    footprint_cut(&splat, some, 2);
    expect_near(splat.bundle.far_depth, 5);
    splat = uncut();
    footprint_cut(&splat, none, 1);
    expect_near(splat.bundle.far_depth, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_carries_the_photon),
        cmocka_unit_test(test_size),
        cmocka_unit_test(test_automatic_size),
        cmocka_unit_test(test_size_by_the_spread_of_light),
        cmocka_unit_test(test_size_follows_distance),
        cmocka_unit_test(test_size_follows_less_far_after_the_first_bounce),
        cmocka_unit_test(test_short_range_light_stays_as_near),
        cmocka_unit_test(test_short_range_light_is_left),
        cmocka_unit_test(test_size_follows_no_further_than_pixels),
        cmocka_unit_test(test_size_grows_with_what_was_merged),
        cmocka_unit_test(test_automatic_step_back),
        cmocka_unit_test(test_steep_slopes_are_limited),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_full_beam_straight_up),
        cmocka_unit_test(test_full_beam_starts_along_the_surface),
        cmocka_unit_test(test_a_miss_lights_nothing),
        cmocka_unit_test(test_frames_are_orthonormal),
        cmocka_unit_test(test_frames_turn),
        cmocka_unit_test(test_cut),
        cmocka_unit_test(test_cut_with_misses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
