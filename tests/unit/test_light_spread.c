/* test_light_spread.c: how far apart light lands that comes straight from the lights. */
#include "support/inject.h"
#include "support/lit_room.h"
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

/* The mean of (2 tan(theta))^2 over the cone's solid angle is 4 (1 - c) / c, with c = cos(50 degrees). */
static void test_a_pool_of_light(void **state)
{
    (void)state;
    double c = cos(50 * 3.14159265358979 / 180), expected = sqrt(4 * (1 - c) / c);
    float spread = spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096");
    print_message("spread %.4f, expected %.4f\n", (double)spread, expected);
    assert_true(fabs((double)spread - expected) < 0.01 * expected);
}

/* Other surfaces do not count that the light goes on to. */
static void test_the_first_surfaces_count(void **state)
{
    (void)state;
    float one = spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096,split=1,bounces=1");
    assert_true(spread_of(SCENE_HEAD LAMP ROOM, "photon:count=4096,split=1,bounces=4") == one);
}

static void test_darkness(void **state)
{
    (void)state;
    assert_true(spread_of(SCENE_HEAD ROOM, "photon:count=4096") == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_pool_of_light),
        cmocka_unit_test(test_the_first_surfaces_count),
        cmocka_unit_test(test_darkness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
