/* test_escape.c: beams whose axis meets nothing. The ray tracer is one of a single upright board,
 * written here. */
#include "splat/escape.h"

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

static void trace(const ps_host *host, ps_packet *packets, size_t n)
{
    struct board *board = host->core;
    board->packets += n;
    for (size_t k = 0; k < n; k++)
        for (int i = 0; i < 16; i++) {
            ps_packet *p = &packets[k];
            float t = (board->distance - p->origin_x[i]) / p->direction_x[i];
            float y = p->origin_y[i] + t * p->direction_y[i];
            if (t > p->tnear[i] && t < p->tfar[i] && y < board->top)
                p->tfar[i] = t;
        }
}

static const struct camera camera = {.orthographic = true};
static const struct box_scene scene = {.radius = 100, .camera = &camera, .interleave = 1};

/* What a beam from the origin of a floor, a slope of 1 upwards to the right, is taken to meet. */
static ps_hit meet(struct board *board, ps_box_settings settings, ps_hit hit)
{
    const ps_source source = {.normal = {0, 1, 0}, .direction = {0.70710678f, 0.70710678f, 0}};
    ps_host host = {.core = board, .intersect_packets = trace};
    escape_find(&host, &scene, &settings, &source, 1, &hit);
    return hit;
}

static const ps_hit nothing = {.distance = INFINITY};

/* The axis passes the board at height 10. */
static void test_a_board_beside_the_axis(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 9};
    ps_hit hit = meet(&board, (ps_box_settings){.size = 2}, nothing);
    assert_true(hit.distance > 12 && hit.distance < 14.2f);
    assert_true(fabsf(hit.position.x - hit.distance * 0.70710678f) < 1e-4f);
    assert_true(fabsf(hit.position.y - hit.distance * 0.70710678f) < 1e-4f);
    assert_true(ps_length(hit.normal) == 0);
}

static void test_a_board_too_far_from_the_axis(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 6};
    assert_true(isinf(meet(&board, (ps_box_settings){.size = 2}, nothing).distance));
    assert_true(board.packets == 1);
}

/* At that distance the beam is half as wide as one that runs to the horizon, and misses the board. */
static void test_a_beam_too_narrow_there(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 8};
    const ps_box_settings wide = {.size = 4}, follows = {.size = 4, .follow = 0.05};
    assert_true(meet(&board, wide, nothing).distance < INFINITY);
    assert_true(isinf(meet(&board, follows, nothing).distance));
}

static void test_leaves_hits_and_grazing_beams(void **state)
{
    (void)state;
    struct board board = {.distance = 10, .top = 9};
    const ps_hit met = {.distance = 3, .position = {1, 2, 3}, .normal = {0, 0, 1}};
    ps_hit kept = meet(&board, (ps_box_settings){.size = 2}, met);
    assert_true(kept.distance == 3 && ps_same(kept.position, met.position) && kept.normal.z == 1);
    const ps_source grazing = {.normal = {0, 1, 0}, .direction = {0.9987492f, 0.05f, 0}};
    ps_host host = {.core = &board, .intersect_packets = trace};
    const ps_box_settings settings = {.size = 2};
    ps_hit hit = nothing;
    escape_find(&host, &scene, &settings, &grazing, 1, &hit);
    assert_true(isinf(hit.distance));
    assert_true(board.packets == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_board_beside_the_axis),
        cmocka_unit_test(test_a_board_too_far_from_the_axis),
        cmocka_unit_test(test_a_beam_too_narrow_there),
        cmocka_unit_test(test_leaves_hits_and_grazing_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
