/* test_injection_voxel.c: voxels: valid places, true areas, all of the light and nothing of the
 * dark. */
#include "support/inject.h"
#include "support/lit_room.h"
#include <math.h>
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define PI 3.14159265358979323846

static void test_power_is_that_of_photons(void **state)
{
    (void)state;
    for (size_t i = 0; i < LIT_ROOMS; i++) {
        struct total_power photons = mean_power(lit_rooms[i].text, "photon:count=100000", 1);
        expect_power(lit_rooms[i].name, mean_power(lit_rooms[i].text, "voxel:resolution=64", 6),
                     photons, 0.012);
    }
}

#define SUN_DOWN "  - sun: {direction: [0, -1, 0], irradiance: 10, angle: 0}\n"
#define SUN_SLANTED "  - sun: {direction: [0, -1, -1], irradiance: 10, angle: 0}\n"
#define FLOOR                                                                                      \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: white}\n"

/* Power by hand: irradiance across the beam * area across it * reflectance. */
static void test_areas(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text;
        double power;
    } cases[] = {
        {"floor", SCENE_HEAD LIGHTS SUN_DOWN "objects:\n" FLOOR, 10 * 16 * 0.7},
        {"floor, slanting light", SCENE_HEAD LIGHTS SUN_SLANTED "objects:\n" FLOOR,
         10 * 16 * 0.7 * 0.70710678},
        {"sphere",
         SCENE_HEAD LIGHTS SUN_DOWN
         "objects: [{sphere: {center: [1, 2, 3], radius: 1.5, material: white}}]\n",
         10 * PI * 1.5 * 1.5 * 0.7},
        {"tilted plate",
         SCENE_HEAD LIGHTS SUN_DOWN
         "objects:\n  - quad: {corners: [[0, 0, 0], [1, 2, 0], [1, 3, 2], [0, 1, 2]], material: "
         "white}\n",
         10 * 2 * 0.7},
    };
    for (size_t i = 0; i < 4; i++) {
        struct total_power expected = {cases[i].power, cases[i].power, cases[i].power};
        expect_power(cases[i].name, mean_power(cases[i].text, "voxel:resolution=32", 8), expected,
                     0.006);
    }
}

static void test_gloss(void **state)
{
    (void)state;
    static const char floor_of_gloss[] = SCENE_HEAD LIGHTS SUN_SLANTED
        "objects:\n  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: "
        "gloss}\n";
    expect_power("gloss", mean_power(floor_of_gloss, "voxel:resolution=128", 8),
                 mean_power(floor_of_gloss, "photon:count=300000", 1), 0.004);
}

static void test_places_are_on_surfaces(void **state)
{
    (void)state;
    struct injected injected =
        inject_text(SCENE_HEAD LIGHTS SUN_DOWN
                    "objects: [{sphere: {center: [1, 2, 3], radius: 1.5, material: white}}]\n",
                    "voxel:resolution=20", 1, 2);
    double cosines = 0;
    assert_true(injected.count > 200);
    for (size_t i = 0; i < injected.count; i++) {
        const ps_photon *photon = &injected.photons[i];
        ps_vec3 out = ps_subtract(photon->position, (ps_vec3){1, 2, 3});
        assert_true(fabsf(ps_length(out) - 1.5f) < 1e-4f);
        assert_true(ps_dot(out, photon->normal) > 1.5f * 0.9999f);
        assert_true(photon->normal.y > 0); /* where the sun shines */
        assert_true(ps_dot(photon->normal, photon->direction) >= 0);
        assert_true(fabsf(ps_length(photon->direction) - 1) < 1e-5f);
        cosines += (double)ps_dot(photon->normal, photon->direction);
        assert_true(photon->bounce == 1 && photon->lobe == PS_DIFFUSE && photon->merged == 1);
        for (size_t k = 0; k < i; k++)
            assert_true(injected.photons[k].path != photon->path);
    }
    assert_true(fabs(cosines / (double)injected.count - 2.0 / 3.0) < 0.02);
    injected_release(&injected);
}

/* A floor of 10 by 10 cells in a scene of 16 across: one photon for each cell that the floor
 * covers, and none more where rays are many. The ball makes the scene 16 wide, and shadows
 * nothing. */
static void test_one_photon_a_voxel(void **state)
{
    (void)state;
    static const char text[] = SCENE_HEAD LIGHTS SUN_DOWN
        "objects:\n"
        "  - quad: {corners: [[-5, 0.3, 5], [5, 0.3, 5], [5, 0.3, -5], [-5, 0.3, -5]], material: "
        "white}\n"
        "  - sphere: {center: [0, 0.3, 0], radius: 0.01, material: black}\n";
    struct injected few = inject_text(text, "voxel:resolution=16,rays=2", 0, 2);
    struct injected many = inject_text(text, "voxel:resolution=16,rays=16", 0, 2);
    print_message("%zu and %zu photons\n", few.count, many.count);
    /* Cells are 2 * 7.07 / 16 wide, 11.3 along a side of the floor: 12 are touched. */
    assert_true(few.count >= 11 * 11 && few.count <= 13 * 13);
    assert_true(many.count >= few.count && many.count <= 13 * 13);
    injected_release(&few);
    injected_release(&many);
}

/* A wall is thin: the lit side alone leaves photons; and a roof's shadow leaves none. */
static void test_dark_sides_and_shadows(void **state)
{
    (void)state;
    struct injected injected = inject_text(
        SCENE_HEAD LIGHTS SUN_DOWN
        "objects:\n" FLOOR
        "  - quad: {corners: [[-1, 1, 1], [1, 1, 1], [1, 1, -1], [-1, 1, -1]], material: red}\n",
        "voxel:resolution=40", 0, 2);
    size_t above = 0, below = 0;
    for (size_t i = 0; i < injected.count; i++) {
        const ps_photon *photon = &injected.photons[i];
        assert_true(photon->normal.y > 0.999f);
        bool under = fabsf(photon->position.x) < 0.999f && fabsf(photon->position.z) < 0.999f;
        bool roof = photon->position.y > 0.5f;
        assert_true(roof || !under);
        above += roof;
        below += !roof;
    }
    assert_true(above > 50 && below > 150);
    assert_true(statistics_counter(injected.statistics, "voxels") > 2 * (double)(above + below));
    injected_release(&injected);
}

static void test_finer_is_steadier(void **state)
{
    (void)state;
    double deviation[2] = {0, 0};
    double truth = mean_power(lit_rooms[3].text, "photon:count=300000", 1).g;
    static const char *const choices[2] = {"voxel:resolution=8", "voxel:resolution=64"};
    for (uint32_t pass = 0; pass < 16; pass++)
        for (int fine = 0; fine < 2; fine++) {
            struct injected injected = inject_text(lit_rooms[3].text, choices[fine], pass, 2);
            deviation[fine] += pow(power_of(&injected).g / truth - 1, 2) / 16;
            injected_release(&injected);
        }
    print_message("one pass is off by %.2f %% at 8, %.2f %% at 64\n", 100 * sqrt(deviation[0]),
                  100 * sqrt(deviation[1]));
    assert_true(sqrt(deviation[1]) < 0.02 && deviation[0] > 9 * deviation[1]);
    expect_power("mean of 64 passes at 8 cells",
                 mean_power(lit_rooms[3].text, "voxel:resolution=8", 64),
                 mean_power(lit_rooms[3].text, "photon:count=300000", 1), 0.03);
}

static void test_threads_change_nothing(void **state)
{
    (void)state;
    for (size_t i = 0; i < LIT_ROOMS; i++) {
        struct injected one = inject_text(lit_rooms[i].text, "voxel:resolution=30", 2, 1);
        struct injected three = inject_text(lit_rooms[i].text, "voxel:resolution=30", 2, 3);
        struct injected next = inject_text(lit_rooms[i].text, "voxel:resolution=30", 3, 1);
        assert_true(one.count > 100);
        assert_int_equal(one.count, three.count);
        assert_memory_equal(one.photons, three.photons, one.count * sizeof *one.photons);
        assert_true(next.photons[0].position.y != one.photons[0].position.y);
        injected_release(&one);
        injected_release(&three);
        injected_release(&next);
    }
}

static void test_no_light(void **state)
{
    (void)state;
    static const char *const texts[] = {
        SCENE_HEAD ROOM_OBJECTS,
        SCENE_HEAD LIGHTS
        "  - spotlight: {location: [0, 5, 0], point_at: [0, 9, 0], intensity: 1}\n" ROOM_OBJECTS,
        SCENE_HEAD LIGHTS POINT
        "objects: [{sphere: {center: [0, 0, 0], radius: 0.5, material: black}}]\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct injected injected = inject_text(texts[i], "voxel:resolution=20", 0, 2);
        assert_int_equal(injected.count, 0);
        double voxels = statistics_counter(injected.statistics, "voxels");
        assert_true(i < 2 ? voxels > 1000 : voxels == 0);
        injected_release(&injected);
    }
}

/* Memory goes by surfaces: four times as much for cells half as wide, not eight times. */
static void test_memory(void **state)
{
    (void)state;
    static const char *const choices[2] = {"voxel:resolution=64", "voxel:resolution=128"};
    double bytes[2];
    for (int i = 0; i < 2; i++) {
        struct injected injected = inject_text(lit_rooms[0].text, choices[i], 0, 2);
        bytes[i] = statistics_bytes(injected.statistics, "voxels");
        assert_true(bytes[i] > 24 * statistics_counter(injected.statistics, "voxels"));
        injected_release(&injected);
    }
    print_message("%.2f and %.2f MB\n", bytes[0] / 1e6, bytes[1] / 1e6);
    assert_true(bytes[1] > 3 * bytes[0] && bytes[1] < 5 * bytes[0]);
}

static void test_too_many_lines(void **state)
{
    (void)state;
    char *message = injection_refusal(lit_rooms[0].text, "voxel:resolution=16384,rays=2");
    assert_non_null(strstr(message, "resolution 16384 with 2 rays makes too many lines"));
    free(message);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_power_is_that_of_photons),
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_gloss),
        cmocka_unit_test(test_places_are_on_surfaces),
        cmocka_unit_test(test_one_photon_a_voxel),
        cmocka_unit_test(test_dark_sides_and_shadows),
        SLOW_TEST(test_finer_is_steadier),
        cmocka_unit_test(test_threads_change_nothing),
        cmocka_unit_test(test_no_light),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_too_many_lines),
    };
    return RUN_TESTS(tests);
}
