/* test_sides.c: objects of which the camera sees the front alone.
 *
 * A wall between camera and room whose back is hidden (`sides: front`) is as one that is hidden
 * altogether (`camera: no`): the light in the room is the same, sample by sample, as a wall, as an
 * instance, and as one that mirrors. From its front it is seen.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1, 6], look_at: [0, 1, 0], angle: 20}\n"
    "image: {width: 24, height: 24}\n"
    "materials: {white: {diffuse: 0.7}, red: {diffuse: [0.7, 0.1, 0.1]}}\n"
    "lights:\n"
    "  - rectangle: {corners: [[-0.3, 1.99, -0.3], [0.3, 1.99, -0.3], [0.3, 1.99, 0.3]],\n"
    "                radiance: 10}\n"
    "groups:\n"
    "  wall: [quad: {corners: [[-1, 0, 0], [1, 0, 0], [1, 2, 0], [-1, 2, 0]], material: red}]\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 2, 1], [-1, 2, -1], [1, 2, -1], [1, 2, 1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]], material: white}\n"
    "  - quad: {corners: [[1, 0, 1], [1, 2, 1], [1, 2, -1], [1, 0, -1]], material: white}\n"
    "  - %s\n";

/* The wall at z = 1, whose front is inside, and the same from outside. */
#define INWARDS "quad: {corners: [[-1, 0, 1], [-1, 2, 1], [1, 2, 1], [1, 0, 1]], material: red"
#define OUTWARDS "quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 2, 1], [-1, 2, 1]], material: red"

/* Means of light and of albedo over the picture. */
struct seen {
    double light, indirect, albedo;
};

static struct seen look(const char *wall, const char *estimator)
{
    const char *const choices[] = {estimator, "bounces=all", NULL};
    char text[4096];
    snprintf(text, sizeof text, room, wall);
    struct rendering rendering = render_text(text, 2, choices);
    struct seen seen = {mean_of_all(&rendering.image, "G"),
                        mean_of_all(&rendering.image, "indirect.G"),
                        mean_of_all(&rendering.image, "albedo.G")};
    rendering_release(&rendering);
    return seen;
}

static void test_back_is_looked_through(void **state)
{
    /* Hits of instances are rounded otherwise, so that some paths part. */
    static const struct {
        const char *text;
        double tolerance;
    } walls[] = {
        {INWARDS ", sides: front}", 1e-6},
        {"instance: {of: wall, rotate: [0, 180, 0], translate: [0, 0, 1], sides: front}", 4e-3},
        {"instance: {of: wall, scale: [-1, 1, 1], rotate: [0, 180, 0], translate: [0, 0, 1],\n"
         "               sides: front}",
         4e-3},
        {"group: {sides: front, objects: [" INWARDS "}]}", 1e-6},
    };
    static const char *const estimators[] = {
        "estimator=pathtrace:samples=16", "estimator=gather:samples=4", "estimator=bdpt:samples=4"};
    (void)state;
    for (size_t e = 0; e < COUNT(estimators); e++) {
        struct seen hidden = look(INWARDS ", camera: no}", estimators[e]);
        assert_true(hidden.indirect > 0.01 && hidden.albedo > 0.6);
        for (size_t i = 0; i < COUNT(walls); i++) {
            struct seen front = look(walls[i].text, estimators[e]);
            print_message("%s, wall %zu: %.6f of the light\n", estimators[e], i,
                          front.light / hidden.light);
            assert_true(fabs(front.light / hidden.light - 1) < walls[i].tolerance);
            assert_true(fabs(front.albedo - hidden.albedo) < 1e-4);
        }
    }
}

static void test_front_is_seen(void **state)
{
    (void)state;
    struct seen seen = look(OUTWARDS ", sides: front}", "estimator=ambient:irradiance=1");
    assert_true(fabs(seen.albedo - 0.1) < 1e-4);
    seen = look(INWARDS ", sides: both}", "estimator=ambient:irradiance=1");
    assert_true(fabs(seen.albedo - 0.1) < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_back_is_looked_through),
        cmocka_unit_test(test_front_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
