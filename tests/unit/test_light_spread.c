/* test_light_spread.c: how far apart light lands that comes straight from the lights, and that
 * splats of automatic size follow it. */
#include "host/photons.h"
#include "placement/radius.h"
#include "render/state.h"
#include "support/inject.h"
#include "support/lit_room.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A spotlight 2 above a floor, 50 degrees to each side, and a ceiling that it does not reach. */
#define LAMP                                                                                       \
    "lights:\n"                                                                                    \
    "  - spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 50, falloff: 50, "          \
    "intensity: 3}\n"
#define ROOM                                                                                       \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: white}\n"     \
    "  - quad: {corners: [[-9, 3, 9], [9, 3, 9], [9, 3, -9], [-9, 3, -9]], material: white}\n"

static float spread_of(const char *text, const char *choice)
{
    struct injected injected = inject_text(text, choice, 0, 2);
    float spread = injected.spread;
    injected_release(&injected);
    return spread;
}

/* The mean of (2 tan(theta))^2 over the cone's solid angle is 4 (1 - c) / c, with c = cos(50
 * degrees). */
static double spread_of_pool(void)
{
    double c = cos(50 * 3.14159265358979 / 180);
    return sqrt(4 * (1 - c) / c);
}

static void test_a_pool_of_light(void **state)
{
    (void)state;
    double expected = spread_of_pool();
    float spread = spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096");
    print_message("spread %.4f, expected %.4f\n", (double)spread, expected);
    assert_true(fabs((double)spread - expected) < 0.01 * expected);
}

/* Other surfaces do not count that the light goes on to. */
static void test_the_first_surfaces_count(void **state)
{
    (void)state;
    float one = spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096,split=1 bounces=1");
    assert_true(spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096,split=1 bounces=4") == one);
}

static void test_darkness(void **state)
{
    (void)state;
    assert_true(spread_of(SCENE_HEAD ROOM, "photon:count=4096") == 0);
}

static ps_result check_size(void *user, struct render *render, struct error *error)
{
    const ps_photon *photons;
    size_t n;
    struct splat splat;
    (void)user;
    assert_int_equal(photon_stream_next(&render->photons, &photons, &n, error), PS_OK);
    assert_true(n > 0);
    photons_place(render, photons, 1, &splat);
    float radius = render->scene->radius;
    float expected = radius_automatic(radius, (float)spread_of_pool(), 4096, 0);
    assert_true(expected < 0.8f * radius_automatic(radius, 0, 4096, 0));
    assert_true(fabsf(splat.bundle.radius - expected) < 0.01f * expected);
    return PS_OK;
}

static void test_splats_follow_it(void **state)
{
    (void)state;
    static const char *const choices[] = {"injection=photon:count=4096",
                                          "visibility=none:bandwidth_scale=0", NULL};
    inspect_text(SCENE_HEAD LAMP ROOM, choices, check_size, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_pool_of_light),
        cmocka_unit_test(test_the_first_surfaces_count),
        cmocka_unit_test(test_darkness),
        cmocka_unit_test(test_splats_follow_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
