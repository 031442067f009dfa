/* test_radiosity.c: what the elements of radiosity exchange is neither lost nor made.
 *
 * In a closed scene all that a lamp sends out is absorbed in the end, whatever stands in the way of
 * it. In an open one it is absorbed or leaves. A point lamp of intensity I sends out 4 pi I in each
 * channel.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define PI 3.14159265358979323846

#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0.5, 0.5, 0.2], look_at: [0.5, 0.4, 1], angle: 90}\n"                     \
    "image: {width: 32, height: 18}\n"                                                             \
    "materials: {wall: {diffuse: [0.8, 0.5, 0.3]}, block: {diffuse: 0.7}}\n"                       \
    "lights: [{point: {location: [0.3, 0.8, 0.6], intensity: [1, 2, 3]}}]\n"                       \
    "objects:\n"                                                                                   \
    "  - box: {corners: [[0.55, 0, 0.4], [0.8, 0.6, 0.65]], rotate: [0, 10, 0], material: "        \
    "block}\n"                                                                                     \
    "  - sphere: {center: [0.3, 0.2, 0.5], radius: 0.15, material: block}\n"

#define CLOSED "  - box: {corners: [[0, 0, 0], [1, 1, 1]], material: wall}\n"
#define OPEN "  - quad: {corners: [[0, 0, 1], [1, 0, 1], [1, 0, 0], [0, 0, 0]], material: wall}\n"

struct balance {
    double arrived, absorbed, escaped;
};

static struct balance balance_of(const char *scene, const char *bounces, const char *estimator)
{
    const char *choices[] = {bounces, estimator, NULL};
    struct rendering rendering = render_text(scene, 2, choices);
    struct balance balance = {statistics_counter(&rendering.statistics, "flux of direct light"),
                              statistics_counter(&rendering.statistics, "flux absorbed"),
                              statistics_counter(&rendering.statistics, "flux escaped")};
    rendering_release(&rendering);
    print_message("%-9s %-36s direct %.4f, absorbed %.4f, escaped %.4f\n", bounces, estimator,
                  balance.arrived, balance.absorbed, balance.escaped);
    return balance;
}

static void test_closed_scene_absorbs_all(void **state)
{
    (void)state;
    static const char *const estimators[] = {"estimator=radiosity",
                                             "estimator=radiosity:epsilon=1e-3"};
    double sent = 4 * PI * (1 + 2 + 3);
    for (size_t i = 0; i < 2; i++) {
        struct balance balance = balance_of(SCENE CLOSED, "bounces=all", estimators[i]);
        assert_true(fabs(balance.arrived - sent) < 1e-3 * sent);
        assert_true(fabs(balance.absorbed - sent) < 1e-3 * sent);
        assert_true(fabs(balance.escaped) < 1e-3 * sent);
    }
}

/* Triangles of a sphere that is a point to single precision have no area. */
static void test_what_is_too_small_is_left_out(void **state)
{
    (void)state;
    double sent = 4 * PI * (1 + 2 + 3);
    struct balance balance = balance_of(
        SCENE CLOSED "  - sphere: {center: [0.9, 0.9, 0.9], radius: 1e-9, material: block}\n",
        "bounces=all", "estimator=radiosity:epsilon=1e-3");
    assert_true(fabs(balance.absorbed - sent) < 1e-3 * sent);
}

static void test_open_scene_absorbs_or_loses(void **state)
{
    (void)state;
    struct balance balance = balance_of(SCENE OPEN, "bounces=all", "estimator=radiosity");
    assert_true(balance.escaped > 0.1 * balance.arrived);
    assert_true(fabs(balance.absorbed + balance.escaped - balance.arrived) <
                1e-3 * balance.arrived);
}

/* Light of n bounces alone leaves a rest, which falls by the albedo at most. */
static void test_bounces_are_counted(void **state)
{
    (void)state;
    struct balance one = balance_of(SCENE CLOSED, "bounces=1", "estimator=radiosity:epsilon=1e-3");
    struct balance two = balance_of(SCENE CLOSED, "bounces=2", "estimator=radiosity:epsilon=1e-3");
    double first = one.arrived - one.absorbed, second = two.arrived - two.absorbed;
    assert_true(first > 0 && second > 0.2 * first && second < 0.8 * first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_scene_absorbs_all),
        cmocka_unit_test(test_what_is_too_small_is_left_out),
        cmocka_unit_test(test_open_scene_absorbs_or_loses),
        cmocka_unit_test(test_bounces_are_counted),
    };
    return RUN_TESTS(tests);
}
