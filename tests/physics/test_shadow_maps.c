/* test_shadow_maps.c: direct light by shadow maps against shadow rays: it converges to them, slopes
 * do not shadow themselves, and area lights stay with rays.
 */
#include "support/lit_room.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* A room of lit_room.h, larger and without indirect light, with these settings. */
static struct rendering render_room(const char *room, const char *render, uint32_t threads)
{
    static const char small[] = "{width: 16, height: 9}";
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    const char *image = strstr(room, small);
    char text[8192];
    assert_non_null(image);
    snprintf(text, sizeof text, "%.*s{width: 96, height: 54}%srender: {%s}\n", (int)(image - room),
             room, image + strlen(small), render);
    return render_text(text, threads, choices);
}

#define RAYS(passes) "passes: " passes ", direct: rays"
#define MAPS(passes, side) "passes: " passes ", direct: shadowmap, direct_resolution: " side

/* Mean of |a - b| over the mean of b. */
static double difference(const struct image *a, const struct image *b)
{
    const float *x = image_channel(a, "direct.G"), *y = image_channel(b, "direct.G");
    double apart = 0, sum = 0;
    for (size_t i = 0; i < a->width * a->height; i++) {
        apart += fabs((double)(x[i] - y[i]));
        sum += (double)y[i];
    }
    assert_true(sum > 0);
    return apart / sum;
}

/* Expects that both settings give the same light. */
static void expect_same(const char *room, const char *render_a, uint32_t threads_a,
                        const char *render_b, uint32_t threads_b)
{
    struct rendering a = render_room(room, render_a, threads_a);
    struct rendering b = render_room(room, render_b, threads_b);
    assert_true(difference(&a.image, &b.image) == 0.0);
    rendering_release(&a);
    rendering_release(&b);
}

#define GLOSSY_SPOT SCENE_HEAD LIGHTS SPOT GLOSSY_OBJECTS
#define GLOSSY_OBJECTS                                                                             \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: gloss}\n"     \
    "  - sphere: {center: [0.2, 0.6, 0.2], radius: 0.4, material: gloss}\n"

static void test_converges_to_rays(void **state)
{
    (void)state;
    static const struct lit_scene rooms[] = {
        {"spotlight", SCENE_HEAD LIGHTS SPOT ROOM_OBJECTS},
        {"spotlight, wide", SCENE_HEAD LIGHTS WIDE_SPOT ROOM_OBJECTS},
        {"point", SCENE_HEAD LIGHTS POINT ROOM_OBJECTS},
        {"sun", SCENE_HEAD LIGHTS SUN ROOM_OBJECTS},
        {"two", SCENE_HEAD LIGHTS SPOT SUN ROOM_OBJECTS},
        {"gloss", GLOSSY_SPOT},
    };
    static const char *const finer[] = {MAPS("4", "16"), MAPS("4", "64"), MAPS("4", "256"),
                                        MAPS("4", "1024")};
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        struct rendering rays = render_room(rooms[i].text, RAYS("4"), 2);
        double apart[4];
        for (int step = 0; step < 4; step++) {
            struct rendering maps = render_room(rooms[i].text, finer[step], 2);
            apart[step] = difference(&maps.image, &rays.image);
            rendering_release(&maps);
        }
        rendering_release(&rays);
        print_message("%-16s %.5f %.5f %.5f %.5f\n", rooms[i].name, apart[0], apart[1], apart[2],
                      apart[3]);
        assert_true(apart[0] > 0.005); /* the maps are looked at */
        for (int step = 1; step < 4; step++)
            assert_true(apart[step] < 0.6 * apart[step - 1]);
        assert_true(apart[3] < 0.001);
    }
}

/* On surfaces that nothing shadows coarse maps leave all of the light, however flat it comes in. */
static void test_slopes_do_not_shadow_themselves(void **state)
{
    (void)state;
    static const char steep_spotlight[] =
        "spotlight: {location: [1.9, 0.3, 0], point_at: [-1, 0, 0], "
        "radius: 60, falloff: 60, intensity: 5}";
    static const char *const lights[] = {
        steep_spotlight,
        "point: {location: [0.4, 0.2, -0.3], intensity: 5}",
        "sun: {direction: [9, -1, 3], irradiance: 5, angle: 0}",
    };
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; i++)
        for (int fine = 0; fine < 2; fine++) {
            char text[1024];
            snprintf(text, sizeof text,
                     SCENE_HEAD LIGHTS
                     "  - %s\n"
                     "objects:\n"
                     "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]],"
                     " material: white}\n",
                     lights[i]);
            expect_same(text, fine ? MAPS("1", "80") : MAPS("1", "5"), 2, RAYS("1"), 2);
        }
}

static void test_lights_with_a_size_stay_on_rays(void **state)
{
    (void)state;
    static const char *const rooms[] = {
        SCENE_HEAD LIGHTS RECTANGLE ROOM_OBJECTS,
        SCENE_HEAD LIGHTS BALL ROOM_OBJECTS,
        SCENE_HEAD LIGHTS SKY ROOM_OBJECTS,
        SCENE_HEAD LIGHTS WIDE_SUN ROOM_OBJECTS,
        SCENE_HEAD LIGHTS WIDE_SUN SKY BALL ROOM_OBJECTS,
    };
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++)
        expect_same(rooms[i], MAPS("1", "8"), 2, RAYS("1"), 2);
}

static void test_any_threads(void **state)
{
    (void)state;
    static const char room[] = SCENE_HEAD LIGHTS SPOT POINT SUN BALL ROOM_OBJECTS;
    expect_same(room, MAPS("1", "50"), 1, MAPS("1", "50"), 3);
    struct rendering maps = render_room(room, MAPS("1", "50"), 2);
    assert_true(statistics_bytes(&maps.statistics, "direct maps") == (1 + 6 + 1) * 50 * 50 * 4);
    rendering_release(&maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_converges_to_rays),
        cmocka_unit_test(test_slopes_do_not_shadow_themselves),
        cmocka_unit_test(test_lights_with_a_size_stay_on_rays),
        cmocka_unit_test(test_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
