/* test_thin_posts.c: a post before nothing gets as much light as a wall in its place.
 *
 * The sun shines on a floor, whose light meets a post a tenth as wide as splats are, seen from
 * before. The axes of most bundles that light it pass by and meet nothing, and so do the few rays
 * that look for what stands beside them (src/splat/extent.h). A mullion before the sky is such a
 * post.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 0.7, 3], look_at: [0, 0.7, 0], projection: orthographic, width: 0.06}\n"
    "image: {width: 4, height: 20}\n"
    "materials: {floor: {diffuse: 0.5}, wall: {diffuse: 0.6}}\n"
    "lights:\n"
    "  - sun: {direction: [0, -1, 0], irradiance: 2, angle: 0}\n"
    "objects:\n"
    "  - quad: {corners: [[-4, 0, 0.12], [-4, 0, 5], [4, 0, 5], [4, 0, 0.12]], material: floor}\n"
    "  - quad: {corners: [[%g, 0.2, 0], [%g, 0.2, 0], [%g, 1.2, 0], [%g, 1.2, 0]], material: "
    "wall}\n";

static double light_of(double half_width, const char *visibility)
{
    const char *const choices[] = {"injection=photon:count=400000", visibility,
                                   "estimator=splat:gather_rays=0", NULL};
    char text[1024];
    snprintf(text, sizeof text, scene, -half_width, half_width, half_width, -half_width);
    struct rendering rendering = render_text(text, 2, choices);
    double light = mean_of_all(&rendering.image, "indirect.G");
    rendering_release(&rendering);
    return light;
}

static void expect_as_bright(const char *visibility)
{
    double post = light_of(0.03, visibility), wall = light_of(2, visibility);
    print_message("%s: post %.4f, wall %.4f\n", visibility, post, wall);
    assert_true(wall > 0);
    assert_true(fabs(post / wall - 1) < 0.03);
}

static void test_maps(void **state)
{
    (void)state;
    expect_as_bright("visibility=shadowmap:radius=0.3,resolution=16");
}

static void test_rays(void **state)
{
    (void)state;
    expect_as_bright("visibility=raycast:radius=0.3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_maps),
        cmocka_unit_test(test_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
