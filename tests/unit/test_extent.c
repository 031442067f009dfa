/* test_extent.c: how large the footprints of full bundles must be. The ray tracer is one of a
 * single upright board, written here. */
#include "placement/footprint.h"
#include "placement/radius.h"

#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* A board at x = distance, which ends at height `top`. */
struct board {
    float distance, top;
    size_t packets; /* traced */
};

static void trace(const ps_host *host, ps_ray_packet *packets, size_t n, int coherent)
{
    (void)coherent;
    struct board *board = host->core;
    board->packets += n;
    for (size_t k = 0; k < n; k++)
        for (int i = 0; i < 16; i++) {
            ps_ray_packet *p = &packets[k];
            float t = (board->distance - p->origin_x[i]) / p->direction_x[i];
            float y = p->origin_y[i] + t * p->direction_y[i];
            if (t > p->tnear[i] && t < p->tfar[i] && y < board->top)
                p->tfar[i] = t;
        }
}

static const struct camera camera = {.orthographic = true};
static const struct placement_scene scene = {.radius = 100, .camera = &camera, .interleave = 1};

/* A bundle from the origin of a floor, a slope of 1 upwards to the right. */
struct bundle {
    ps_hit hit;
    float radius;
};

static struct bundle find(struct board *board, struct footprint_params settings, ps_hit hit)
{
    const ps_photon photon = {.normal = {0, 1, 0}, .direction = {0.70710678f, 0.70710678f, 0}};
    ps_host host = {.core = board, .intersect_packets = trace};
    const struct placement placement = {.scene = scene, .settings = &settings, .host = &host};
    struct bundle bundle = {hit, radius_largest(&scene, &settings, &photon, &hit)};
    footprint_find_extents(&placement, &photon, 1, &bundle.hit, &bundle.radius);
    return bundle;
}

static const ps_hit nothing = {.distance = INFINITY};

/* The axis passes the board at height 10. */
static void test_a_board_beside_the_axis(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 9};
    struct bundle bundle = find(&board, (struct footprint_params){.radius.number = 2}, nothing);
    assert_true(bundle.radius == 2);
    assert_true(bundle.hit.distance > 12 && bundle.hit.distance < 14.2f);
    assert_true(fabsf(bundle.hit.position.x - bundle.hit.distance * 0.70710678f) < 1e-4f);
    assert_true(fabsf(bundle.hit.position.y - bundle.hit.distance * 0.70710678f) < 1e-4f);
    assert_true(ps_length(bundle.hit.normal) == 0);
}

/* Rays beside the axis miss it as well, but it might be a thin one. */
static void test_a_board_too_far_from_the_axis(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 6};
    struct bundle bundle = find(&board, (struct footprint_params){.radius.number = 2}, nothing);
    assert_true(bundle.radius == 2 && bundle.hit.distance == 2);
    assert_true(board.packets == 1);
}

/* The axis meets something at 3; rays to its side meet a board 14 away, whose pixels take in a disc
 * of half-width 2.8 and thus the axis, or one of 0.7, and thus only rays near the axis. */
static void test_something_near_before_something_far(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 1e9f};
    const ps_hit near = {.distance = 3, .position = {1, 2, 3}, .normal = {0, 0, 1}};
    const struct footprint_params wide = {.radius.number = 2, .bandwidth_scale = 0.2},
                                  narrow = {.radius.number = 2, .bandwidth_scale = 0.05};
    struct bundle bundle = find(&board, wide, near);
    assert_true(bundle.radius == 2);
    assert_true(bundle.hit.distance == 3 && ps_same(bundle.hit.position, near.position));
    bundle = find(&board, narrow, near);
    assert_true(bundle.radius >= 0.4f && bundle.radius < 1.0f);
}

/* One that meets something far away needs no rays, nor one that was left out. */
static void test_leaves_wide_beams_and_none(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 9};
    const ps_hit far = {.distance = 30};
    const struct footprint_params settings = {.radius.number = 2, .bandwidth_scale = 0.2};
    assert_true(find(&board, settings, far).radius == 2);
    assert_true(
        find(&board, (struct footprint_params){.radius.number = 2}, (ps_hit){.distance = 0.1f})
            .radius == 2);
    ps_host host = {.core = &board, .intersect_packets = trace};
    const ps_photon photon = {.normal = {0, 1, 0}, .direction = {0, 1, 0}};
    ps_hit hit = nothing;
    float none = 0;
    const struct placement placement = {.scene = scene, .settings = &settings, .host = &host};
    footprint_find_extents(&placement, &photon, 1, &hit, &none);
    assert_true(none == 0 && board.packets == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_board_beside_the_axis),
        cmocka_unit_test(test_a_board_too_far_from_the_axis),
        cmocka_unit_test(test_something_near_before_something_far),
        cmocka_unit_test(test_leaves_wide_beams_and_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
