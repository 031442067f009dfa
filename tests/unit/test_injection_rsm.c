/* test_injection_rsm.c: reflective shadow maps: the light is all there, chosen as it should be. */
#include "support/chi_squared.h"
#include "support/inject.h"
#include "support/lit_room.h"
#include <math.h>
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

static void test_power_is_that_of_photons(void **state)
{
    (void)state;
    for (size_t i = 0; i < LIT_ROOMS; i++) {
        struct total_power photons = mean_power(lit_rooms[i].text, "photon:count=200000", 1);
        expect_power(lit_rooms[i].name, mean_power(lit_rooms[i].text, "rsm:count=50000", 2),
                     photons, 0.01);
    }
}

static const char mirrors_and_glass[] = SCENE_HEAD LIGHTS SPOT ROOM_OBJECTS
    "  - sphere: {center: [0.2, 0.4, 1.2], radius: 0.4, material: mirror}\n"
    "  - sphere: {center: [0, 1.8, 0.5], radius: 0.3, material: glass}\n"
    "  - sphere: {center: [-0.7, 1.5, 1], radius: 0.5, material: gloss}\n";

/* Photons of one bounce and lobe. */
static struct total_power part_of(const struct injected *injected, int bounce, int lobe)
{
    struct injected part = {.count = 0};
    part.photons = malloc((injected->count + 1) * sizeof *part.photons);
    assert_non_null(part.photons);
    for (size_t i = 0; i < injected->count; i++)
        if (injected->photons[i].bounce == bounce && injected->photons[i].lobe == lobe)
            part.photons[part.count++] = injected->photons[i];
    struct total_power power = power_of(&part);
    print_message("%zu photons: ", part.count);
    assert_true(part.count > 4000);
    free(part.photons);
    return power;
}

static void test_mirrors_and_glass_are_as_for_photons(void **state)
{
    (void)state;
    static const char *const names[2][3] = {
        {NULL, "gloss, from the lamp", "mirrors and glass, from the lamp"},
        {"diffuse", "gloss, from a diffuse surface", "mirrors and glass, from a diffuse surface"}};
    struct injected photons = inject_text(mirrors_and_glass, "photon:count=600000 bounces=1", 0, 2);
    struct injected pixels = inject_text(mirrors_and_glass, "rsm:count=300000", 0, 2);
    for (int bounce = 0; bounce < 2; bounce++)
        for (int lobe = bounce ? PS_DIFFUSE : PS_GLOSSY; lobe <= PS_SPECULAR; lobe++)
            expect_power(names[bounce][lobe], part_of(&pixels, bounce, lobe),
                         part_of(&photons, bounce, lobe), lobe == PS_DIFFUSE ? 0.01 : 0.06);
    injected_release(&photons);
    injected_release(&pixels);
}

/* The mean over passes has no error of a coarse map; one pass of a fine one has little. */
static void test_convergence(void **state)
{
    (void)state;
    static const char *const lights[] = {"spotlight", "point", "sun"};
    static const size_t rooms[] = {0, 3, 4};
    for (int i = 0; i < 3; i++) {
        const char *text = lit_rooms[rooms[i]].text;
        struct total_power photons = mean_power(text, "photon:count=200000", 1);
        double worst[2] = {0, 0};
        for (uint32_t pass = 0; pass < 6; pass++)
            for (int fine = 0; fine < 2; fine++) {
                const char *choice =
                    fine ? "rsm:count=20000,resolution=256" : "rsm:count=20000,resolution=8";
                struct injected injected = inject_text(text, choice, pass, 2);
                struct total_power power = power_of(&injected);
                worst[fine] = fmax(worst[fine], fabs(power.r / photons.r - 1));
                injected_release(&injected);
            }
        print_message("%s: off by at most %.3f %% at 8 pixels, %.3f %% at 256\n", lights[i],
                      100 * worst[0], 100 * worst[1]);
        assert_true(worst[0] > 4 * worst[1] && worst[1] < 0.005);
        expect_power("mean of 64 passes at 8 pixels",
                     mean_power(text, "rsm:count=2000,resolution=8", 64), photons, 0.01);
    }
}

/* A lamp 2 above a floor whose halves reflect 0.8 and 0.2. */
static const char two_halves[] = SCENE_HEAD
    "  bright: {diffuse: 0.8}\n  dark: {diffuse: 0.2}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 50, falloff: 50, "
    "intensity: 3}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [0, 0, 9], [0, 0, -9], [-9, 0, -9]], material: bright}\n"
    "  - quad: {corners: [[0, 0, 9], [9, 0, 9], [9, 0, -9], [0, 0, -9]], material: dark}\n";

#define SIDE 16

/* Pixels of the map are equal areas of the floor, which get cos^3 theta and reflect 0.8 or 0.2. How
 * often each was chosen shows in the places of the photons. */
static void test_choice_goes_by_flux(void **state)
{
    (void)state;
    struct injected injected = inject_text(two_halves, "rsm:count=40000,resolution=16", 3, 2);
    double observed[SIDE * SIDE] = {0}, expected[SIDE * SIDE] = {0}, sum = 0;
    double places[SIDE * SIDE][2];
    double width = 2 * 2 * tan(50 * 3.14159265358979 / 180) / SIDE;
    size_t cells = 0;
    for (size_t i = 0; i < injected.count; i++) {
        const ps_photon *photon = &injected.photons[i];
        size_t k = 0;
        while (k < cells && (fabs(places[k][0] - photon->position.x) > 0.01 * width ||
                             fabs(places[k][1] - photon->position.z) > 0.01 * width))
            k++;
        assert_true(k < SIDE * SIDE);
        cells = k == cells ? cells + 1 : cells;
        places[k][0] = photon->position.x;
        places[k][1] = photon->position.z;
        observed[k]++;
    }
    for (size_t k = 0; k < cells; k++) {
        double x = places[k][0], z = places[k][1];
        expected[k] = pow(2 / sqrt(4 + x * x + z * z), 3) * (x < 0 ? 0.8 : 0.2);
        sum += expected[k];
    }
    for (size_t k = 0; k < cells; k++)
        expected[k] *= (double)injected.count / sum;
    double fit = chi_squared_probability(observed, expected, cells);
    print_message("%zu candidates, chi-squared %.3f\n", cells, fit);
    /* Of the square's pixels those in the circle. */
    assert_true(cells > 0.7 * SIDE * SIDE && cells < 0.87 * SIDE * SIDE);
    assert_true((double)cells == statistics_counter(injected.statistics, "candidates"));
    assert_true(fit > 0.001);
    injected_release(&injected);
}

/* So the photons all carry the same power, but for its colour. */
static void test_photons_are_even(void **state)
{
    (void)state;
    struct injected injected = inject_text(lit_rooms[LIT_ROOMS - 1].text, "rsm:count=5000", 0, 1);
    struct total_power power = power_of(&injected);
    double mean = (power.r + power.g + power.b) / 5000;
    assert_int_equal(injected.count, 5000);
    for (size_t i = 0; i < injected.count; i++) {
        const ps_photon *photon = &injected.photons[i];
        double sum = (double)photon->power.r + photon->power.g + photon->power.b;
        assert_true(fabs(sum / mean - 1) < 1e-4);
        assert_true(ps_dot(photon->normal, photon->direction) >= 0);
        assert_true(photon->bounce == 1 && photon->merged == 1 && photon->path == i);
    }
    injected_release(&injected);
}

/* Cosine-distributed: the mean cosine is 2/3. */
static void test_directions(void **state)
{
    (void)state;
    struct injected injected = inject_text(lit_rooms[0].text, "rsm:count=20000", 1, 1);
    double sum = 0;
    for (size_t i = 0; i < injected.count; i++)
        sum += (double)ps_dot(injected.photons[i].normal, injected.photons[i].direction);
    assert_true(fabs(sum / (double)injected.count - 2.0 / 3.0) < 0.003);
    injected_release(&injected);
}

static void test_threads_change_nothing(void **state)
{
    (void)state;
    static const char choice[] = "rsm:count=5000,resolution=100";
    for (size_t i = 0; i < LIT_ROOMS; i++) {
        struct injected one = inject_text(lit_rooms[i].text, choice, 2, 1);
        struct injected three = inject_text(lit_rooms[i].text, choice, 2, 3);
        struct injected next = inject_text(lit_rooms[i].text, choice, 3, 1);
        assert_int_equal(one.count, 5000);
        assert_int_equal(three.count, 5000);
        assert_memory_equal(one.photons, three.photons, 5000 * sizeof *one.photons);
        size_t moved = 0;
        for (size_t k = 0; k < 5000; k++)
            moved += one.photons[k].position.x != next.photons[k].position.x;
        assert_true(moved > 4000);
        assert_int_equal(next.photons[0].path, 15000);
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
        SCENE_HEAD LIGHTS "  - point: {location: [0, 1, 0], intensity: 0}\n" ROOM_OBJECTS,
        SCENE_HEAD LIGHTS
        "  - spotlight: {location: [0, 5, 0], point_at: [0, 9, 0], intensity: 1}\n" ROOM_OBJECTS,
        SCENE_HEAD LIGHTS POINT
        "objects: [{sphere: {center: [0, 0, 0], radius: 0.5, material: black}}]\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct injected injected = inject_text(texts[i], "rsm", 0, 1);
        assert_int_equal(injected.count, 0);
        assert_true(statistics_counter(injected.statistics, "candidates") == 0);
        injected_release(&injected);
    }
}

/* 16 bytes a pixel: one map for a spotlight, six for a point; none for a dark lamp. */
static void test_memory(void **state)
{
    (void)state;
    struct injected spot = inject_text(lit_rooms[0].text, "rsm:resolution=512", 0, 2);
    struct injected point = inject_text(
        SCENE_HEAD LIGHTS POINT "  - point: {location: [0, 1, 0], intensity: 0}\n" ROOM_OBJECTS,
        "rsm:resolution=512", 0, 2);
    double one = statistics_bytes(spot.statistics, "shadow maps");
    double six = statistics_bytes(point.statistics, "shadow maps");
    assert_true(one > 16 * 512 * 512 && one < 1.01 * 16 * 512 * 512);
    assert_true(six > 6 * 16 * 512 * 512 && six < 6.01 * 16 * 512 * 512);
    injected_release(&spot);
    injected_release(&point);
}

static void test_too_many_pixels(void **state)
{
    (void)state;
    char *message = injection_refusal(SCENE_HEAD LIGHTS POINT POINT POINT POINT POINT POINT POINT
                                          POINT POINT POINT POINT ROOM_OBJECTS,
                                      "rsm:resolution=8192");
    assert_non_null(strstr(message, "66 maps of 67108864 pixels are too many"));
    free(message);
}

static void look_at_lights(const ps_host *host)
{
    ps_light light = {.size = sizeof light};
    assert_int_equal(host->light_count(host), 5);
    host->light(host, 0, &light);
    assert_int_equal(light.kind, PS_LIGHT_POINT);
    assert_true(fabsf(light.cos_cone - cosf(50 * PS_PI / 180)) < 1e-6f);
    assert_true(light.position.y == 2.8f && light.axis.y < -0.9f);
    host->light(host, 1, &light);
    assert_true(light.kind == PS_LIGHT_POINT && light.cos_cone == -1);
    assert_true(fabsf(light.power.r - 36 * PS_PI) < 1e-3f);
    host->light(host, 2, &light);
    assert_int_equal(light.kind, PS_LIGHT_SUN);
    assert_true(fabsf(light.axis.y + 2 / sqrtf(6)) < 1e-6f && light.axis.x < 0);
    host->light(host, 3, &light);
    assert_int_equal(light.kind, PS_LIGHT_SKY);
    host->light(host, 4, &light);
    assert_true(light.kind == PS_LIGHT_SURFACE && fabsf(light.power.b - 10) < 1e-4f);
    static const ps_vec3 up = {0, 1, 0};
    ps_rgb intensity;
    host->light_intensity(host, 1, &up, 1, &intensity);
    assert_true(intensity.r == 9 && intensity.g == 8);
    host->light_intensity(host, 0, &up, 1, &intensity);
    assert_true(intensity.r == 0);
    host->light_intensity(host, 2, &up, 1, &intensity);
    assert_true(intensity.r == 0);
    static const float samples[1][4] = {{0.3f, 0.4f, 0.5f, 0.6f}};
    ps_ray ray;
    host->emit_from(host, 2, samples, 1, &ray, &intensity);
    host->light(host, 2, &light);
    assert_true(ray.direction.y == light.axis.y && intensity.r == light.power.r);
}

static void test_host_tells_of_lights(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD LIGHTS SPOT POINT SUN SKY BALL ROOM_OBJECTS, look_at_lights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_power_is_that_of_photons),
        cmocka_unit_test(test_mirrors_and_glass_are_as_for_photons),
        SLOW_TEST(test_convergence),
        cmocka_unit_test(test_choice_goes_by_flux),
        cmocka_unit_test(test_photons_are_even),
        cmocka_unit_test(test_directions),
        cmocka_unit_test(test_threads_change_nothing),
        cmocka_unit_test(test_no_light),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_too_many_pixels),
        cmocka_unit_test(test_host_tells_of_lights),
    };
    return RUN_TESTS(tests);
}
