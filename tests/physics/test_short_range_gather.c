/* test_short_range_gather.c: light from nearer than splats are wide, in closed form.
 *
 * The sun shines along a floor onto a wall of height h and half-length L that stands on it, and
 * lights the floor not at all. A floor point before the middle of the wall, at distance d, sees the
 * wall, whose radiosity is albedo times the sun's irradiance S, under the view factor of a
 * rectangle that stands at right angles on its plane (Howell, "A catalog of radiation heat transfer
 * configuration factors", B-4, twice):
 *
 *     F(d) = (atan(L / d) - d / c atan(L / c)) / pi,   c = sqrt(d^2 + h^2)
 *
 * Splats of half-width h and more smear that over the crease; short rays find it.
 */
#include "render/state.h"
#include "short_range/short_range_pilot.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

#define WALL_HEIGHT 0.1
#define WALL_HALF_LENGTH 2.0
#define SUN 2.0
#define WALL_ALBEDO 0.8
#define FLOOR_ALBEDO 0.5

#define COLUMNS 16 /* of the picture, which lies along the wall */
#define ROWS 8
#define PICTURE_LEFT 0.01
#define PICTURE_WIDTH 0.04

#define FLOOR_AND_WALL                                                                             \
    "materials: {floor: {diffuse: 0.5}, wall: {diffuse: 0.8}}\n"                                   \
    "lights:\n"                                                                                    \
    "  - sun: {direction: [-1, 0, 0], irradiance: 2}\n"                                            \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[0, 0, 2], [1, 0, 2], [1, 0, -2], [0, 0, -2]], material: floor}\n"       \
    "  - quad: {corners: [[0, 0, 2], [0, 0.1, 2], [0, 0.1, -2], [0, 0, -2]], material: wall}\n"

static const char crease[] =
    "psd: 1\n"
    "camera: {location: [0.03, 0.09, 0], look_at: [0.03, 0, 0], up: [0, 0, -1],\n"
    "         projection: orthographic, width: 0.04}\n"
    "image: {width: 16, height: 8}\n" FLOOR_AND_WALL;

/* Radiance of the floor before one end of a wall that reaches that far to the side. */
static double radiance_before_end(double d, double height, double length)
{
    double c = hypot(d, height);
    double view_factor = (atan(length / d) - d / c * atan(length / c)) / (2 * PI);
    return SUN * WALL_ALBEDO * view_factor * FLOOR_ALBEDO / PI;
}

static double expected_at(int column)
{
    double d = PICTURE_LEFT + (column + 0.5) * PICTURE_WIDTH / COLUMNS;
    return 2 * radiance_before_end(d, WALL_HEIGHT, WALL_HALF_LENGTH);
}

/* The largest relative error of a column's mean. */
static double worst_column(const char *visibility, const char *estimator)
{
    const char *const choices[] = {"injection=photon:count=400000", visibility, estimator, NULL};
    struct rendering rendering = render_text(crease, 2, choices);
    double worst = 0;
    for (int column = 0; column < COLUMNS; column++) {
        double mean = mean_of(&rendering.image, "indirect.G", (size_t)column, 0, 1, ROWS);
        worst = fmax(worst, fabs(mean / expected_at(column) - 1));
    }
    rendering_release(&rendering);
    print_message("%s, %s: columns off by up to %.3f\n", visibility, estimator, worst);
    return worst;
}

static void test_crease(void **state)
{
    (void)state;
    assert_true(worst_column("visibility=shadowmap:radius=0.4", "estimator=splat:gather_rays=0") >
                0.25);
    assert_true(
        worst_column("visibility=shadowmap:radius=0.4", "estimator=splat:gather_rays=4096") < 0.03);
    assert_true(worst_column("visibility=raycast:radius=0.4", "estimator=splat:gather_rays=4096") <
                0.03);
}

/* As users have it, with nothing set: splats by themselves would be off by more than a quarter. */
static void test_the_defaults(void **state)
{
    (void)state;
    assert_true(worst_column("visibility=shadowmap", "estimator=splat") < 0.06);
}

/* Pixels that share rays with those around them, along the wall. */
static void test_interleaved(void **state)
{
    (void)state;
    assert_true(worst_column("visibility=shadowmap:radius=0.4",
                             "estimator=splat:gather_rays=16384,interleave=2") < 0.08);
}

/* A wall that is two pixels wide and as high, in the middle of the picture. */
#define POST 0.02

static const char post[] =
    "psd: 1\n"
    "camera: {location: [0, 0.5, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"
    "         projection: orthographic, width: 0.32}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {floor: {diffuse: 0.5}, wall: {diffuse: 0.8}}\n"
    "lights:\n"
    "  - sun: {direction: [-1, 0, 0], irradiance: 2, angle: 0}\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: floor}\n"
    "  - quad: {corners: [[0, 0, 0.01], [0, 0.02, 0.01], [0, 0.02, -0.01], [0, 0, -0.01]],\n"
    "           material: wall}\n";

/* Their light stays where it is, even if each pixel shares its rays with the 80 around it; these,
 * of which half lie behind the post, would leave it a few percent of it. */
static void test_small_things(void **state)
{
    (void)state;
    static const char *const choices[] = {"injection=photon:count=1000",
                                          "visibility=shadowmap:radius=0.4",
                                          "estimator=splat:gather_rays=65536,interleave=8", NULL};
    const double d = POST / 4;
    double expected =
        radiance_before_end(d, POST, POST / 2 - d) + radiance_before_end(d, POST, POST / 2 + d);
    struct rendering rendering = render_text(post, 2, choices);
    double before = mean_of(&rendering.image, "indirect.G", 16, 15, 1, 2);
    double behind = mean_of(&rendering.image, "indirect.G", 15, 15, 1, 2);
    rendering_release(&rendering);
    print_message("beside a post: %.4f, expected %.4f; behind it %.4f\n", before, expected, behind);
    assert_true(fabs(before / expected - 1) < 0.1);
    assert_true(behind < 0.05 * expected);
}

/* Boxes that begin before the first hit cannot tell how near their photon is. */
static void test_boxes_leave_nothing(void **state)
{
    (void)state;
    static const char *const without[] = {"visibility=shadowmap:step_back=auto",
                                          "estimator=splat:gather_rays=0", NULL};
    static const char *const with[] = {"visibility=shadowmap:step_back=auto",
                                       "estimator=splat:gather_rays=64", NULL};
    struct rendering a = render_text(crease, 2, without), b = render_text(crease, 2, with);
    assert_true(mean_of_all(&a.image, "indirect.G") > 0);
    expect_same_image(&a.image, &b.image);
    rendering_release(&a);
    rendering_release(&b);
}

/* Four tiles before the wall, of which the last is too far off to meet it. */
static const char strip[] =
    "psd: 1\n"
    "camera: {location: [0.4, 0.09, 0], look_at: [0.4, 0, 0], up: [0, 0, -1],\n"
    "         projection: orthographic, width: 0.8}\n"
    "image: {width: 64, height: 16}\n" FLOOR_AND_WALL;

static ps_result check_shares(void *user, struct render *render, struct error *error)
{
    (void)user;
    assert_int_equal(render_estimate(render, error), PS_OK);
    assert_int_equal(render->gbuffer.tile_count, 4);
    double shares[4], sum = 0;
    for (uint64_t tile = 0; tile < 4; tile++)
        sum += shares[tile] = gather_pilot_share(&render->gathered_light, tile);
    print_message("shares of the rays: %.2f %.2f %.2f %.2f\n", shares[0], shares[1], shares[2],
                  shares[3]);
    assert_true(shares[0] > 1.5 && shares[0] > shares[1] && shares[1] > shares[2]);
    assert_true(shares[3] == 0.25);
    assert_true(fabs(sum - 4) < 1e-5);
    return PS_OK;
}

static void test_rays_go_where_the_noise_is(void **state)
{
    (void)state;
    static const char *const choices[] = {"injection=photon:count=1000",
                                          "visibility=shadowmap:radius=0.16",
                                          "estimator=splat:gather_rays=64", NULL};
    inspect_text(strip, choices, check_shares, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crease),
        cmocka_unit_test(test_the_defaults),
        cmocka_unit_test(test_interleaved),
        cmocka_unit_test(test_small_things),
        cmocka_unit_test(test_boxes_leave_nothing),
        cmocka_unit_test(test_rays_go_where_the_noise_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
