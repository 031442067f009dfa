/* test_injection_photon.c: light paths that share a walk (`split`): where their photons lie, where
 * they shine, and that all the light is there. */
#include "support/inject.h"
#include "support/lit_room.h"
#include <math.h>
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

/* A floor that reflects a half, all that the lamp lights. */
static const char floor_text[] = SCENE_HEAD
    "  half: {diffuse: 0.5}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 50, falloff: 50, "
    "intensity: 3}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: half}\n";

/* Every path has its own share of the light, also where their number is no multiple, in each
 * pass. */
static void test_all_paths_leave_their_share(void **state)
{
    (void)state;
    double all = 0.5 * 3 * 2 * 3.14159265358979 * (1 - cos(50 * 3.14159265358979 / 180));
    static const char *const choices[] = {"photon:count=1001,split=1", "photon:count=1001,split=3",
                                          "photon:count=1001,split=64"};
    for (int i = 0; i < 3; i++)
        for (uint32_t pass = 0; pass < 2; pass++) {
            struct injected injected = inject_text(floor_text, choices[i], pass, 2);
            assert_int_equal(injected.count, 1001);
            for (size_t k = 0; k < injected.count; k++) {
                assert_true(fabs(injected.photons[k].power.g - all / 1001) < 1e-5 * all / 1001);
                assert_true(injected.photons[k].path == pass * 1001 + k);
            }
            injected_release(&injected);
        }
}

/* Four in a place of their own, and their directions spread: one in each quarter of the light by
 * slope. */
static void test_paths_of_a_walk_share_its_place(void **state)
{
    (void)state;
    struct injected injected = inject_text(floor_text, "photon:count=4000,split=4", 0, 1);
    const ps_photon *photons = injected.photons;
    for (size_t first = 0; first < injected.count; first += 4) {
        int quarters[4] = {0};
        for (size_t k = first; k < first + 4; k++) {
            float height2 =
                photons[k].direction.y * photons[k].direction.y; /* even, by the cosine */
            assert_true(ps_same(photons[k].position, photons[first].position));
            quarters[(int)fminf(4 * height2, 3)]++;
        }
        for (int i = 0; i < 4; i++)
            assert_int_equal(quarters[i], 1);
        assert_true(first == 0 || !ps_same(photons[first].position, photons[first - 1].position));
    }
    injected_release(&injected);
}

/* 256 paths are injected at a time: a walk of 3 may begin in one run and end in the next. */
static void test_walks_that_runs_cut(void **state)
{
    (void)state;
    struct injected injected = inject_text(floor_text, "photon:count=600,split=3", 0, 2);
    for (size_t k = 0; k < injected.count; k++)
        assert_true(ps_same(injected.photons[k].position, injected.photons[k / 3 * 3].position));
    injected_release(&injected);
}

static const char mirror_text[] = SCENE_HEAD
    "lights:\n"
    "  - spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 50, falloff: 50, "
    "intensity: 3}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: mirror}\n"
    "  - quad: {corners: [[-9, 3, 9], [9, 3, 9], [9, 3, -9], [-9, 3, -9]], material: white}\n";

static size_t count_mirrored(const struct injected *injected, uint32_t bounce)
{
    size_t count = 0;
    for (size_t k = 0; k < injected->count; k++)
        count += injected->photons[k].lobe == PS_SPECULAR && injected->photons[k].bounce == bounce;
    return count;
}

/* From the ceiling, which the light reaches by the mirror. */
static void test_a_mirror_leaves_one_photon(void **state)
{
    (void)state;
    struct injected one = inject_text(mirror_text, "photon:count=8000,split=1 bounces=1", 0, 2);
    struct injected four = inject_text(mirror_text, "photon:count=8000,split=4 bounces=1", 0, 2);
    double times = (double)count_mirrored(&one, 1) / (double)count_mirrored(&four, 1);
    assert_true(times > 3.6 && times < 4.4);
    expect_power("behind a mirror", power_of(&four), power_of(&one), 0.02);
    injected_release(&one);
    injected_release(&four);
}

/* Eight walks for each path, which leave nothing else. */
static void test_caustics_have_walks_of_their_own(void **state)
{
    (void)state;
    struct injected few =
        inject_text(mirror_text, "photon:count=1000,split=1,caustics=1 bounces=1", 0, 2);
    struct injected many =
        inject_text(mirror_text, "photon:count=1000,split=1,caustics=8 bounces=1", 0, 2);
    size_t caustics = count_mirrored(&many, 0);
    assert_true(count_mirrored(&few, 0) > 990 && count_mirrored(&few, 0) <= 1000);
    assert_true(caustics > 7920 && caustics <= 8000);
    assert_int_equal(many.count - caustics, few.count - count_mirrored(&few, 0));
    expect_power("of caustics", power_of(&many), power_of(&few), 0.01);
    injected_release(&few);
    injected_release(&many);
}

/* All bounces: where walks end by roulette, too. */
static void test_power_does_not_depend_on_it(void **state)
{
    (void)state;
    for (size_t i = 0; i < LIT_ROOMS; i++)
        expect_power(lit_rooms[i].name,
                     mean_power(lit_rooms[i].text, "photon:count=400000,split=4 bounces=all", 2),
                     mean_power(lit_rooms[i].text, "photon:count=400000,split=1 bounces=all", 2),
                     0.01);
}

/* Bent normals send some directions into the surface; the others of a walk stay. */
static void test_bumps(void **state)
{
    (void)state;
    static const char text[] = SCENE_HEAD
        "  rough: {diffuse: 0.8, bump: {noise: {colors: [0, 0.2], scale: 0.1}}}\n"
        "lights:\n" SPOT "objects:\n"
        "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: rough}\n"
        "  - quad: {corners: [[-9, 3, -9], [9, 3, -9], [9, 3, 9], [-9, 3, 9]], material: rough}\n";
    expect_power("bumps", mean_power(text, "photon:count=400000,split=4 bounces=3", 2),
                 mean_power(text, "photon:count=400000,split=1 bounces=3", 2), 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_paths_leave_their_share),
        cmocka_unit_test(test_paths_of_a_walk_share_its_place),
        cmocka_unit_test(test_walks_that_runs_cut),
        cmocka_unit_test(test_a_mirror_leaves_one_photon),
        cmocka_unit_test(test_caustics_have_walks_of_their_own),
        SLOW_TEST(test_power_does_not_depend_on_it),
        SLOW_TEST(test_bumps),
    };
    return RUN_TESTS(tests);
}
