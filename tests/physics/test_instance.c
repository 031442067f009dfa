/* test_instance.c: an instance is what its objects would be where it stands.
 *
 * A group of objects of every kind of surface, one of which shines in a pattern, placed by an
 * instance, against the same objects in a group of their own, whose patterns are placed by hand.
 * Random numbers are the same, so that the pictures are too, but for paths that rounding sends
 * another way. There is one light: among several, paths choose by what a pilot finds
 * (importance.h), which such a path changes for all others.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* Patterns are scaled by PATTERN and placed by `placed`. */
#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 2, 3.5], look_at: [0, 0.6, 0], angle: 50}\n"                           \
    "image: {width: 32, height: 24}\n"                                                             \
    "materials:\n"                                                                                 \
    "  floor: {diffuse: 0.5}\n"                                                                    \
    "  checked: {diffuse: {checker: {colors: [0.2, 0.8], scale: [=%g*0.3, 0.3, 0.3]%s}}}\n"        \
    "  metal: {metal: {color: 0.9, roughness: 0.4}}\n"                                             \
    "  glass: {dielectric: {ior: 1.5, absorption: 0.5}}\n"                                         \
    "  lamp: {diffuse: 0, emission: {checker: {colors: [1, 60], scale: [=%g*0.21, 0.21, "          \
    "0.21]%s}}}"                                                                                   \
    "\n"                                                                                           \
    "  bumpy: {diffuse: 0.7, bump: {noise: {colors: [0, 0.1], scale: [=%g*0.3, 0.3, 0.3]%s}}}\n"   \
    "groups: {things: %s}\n"                                                                       \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], material: floor}\n"     \
    "  - %s\n"                                                                                     \
    "render: {seed: 1, passes: 2, light_samples: 4}\n"

#define PARTS                                                                                      \
    "[{box: {corners: [[-0.5, 0, -0.5], [0.5, 0.7, 0.5]], rotate: [0, 30, 0],"                     \
    " material: checked}},"                                                                        \
    " {sphere: {center: [-0.7, 0.3, 0.5], radius: 0.3, material: metal}},"                         \
    " {sphere: {center: [0.8, 0.35, 0.6], radius: 0.3, material: glass}},"                         \
    " {torus: {radius: 0.4, minor_radius: 0.12, translate: [0.1, 0.85, 0], material: bumpy}},"     \
    " {quad: {corners: [[-0.3, 1.5, -0.2], [0.5, 1.5, -0.2], [0.5, 1.5, 0.2], [-0.3, 1.5, 0.2]],"  \
    " material: lamp}}]"

static const char *const methods[][5] = {
    {"estimator=pathtrace:samples=32", "bounces=all", NULL},
    {"estimator=bdpt:samples=16", "bounces=all", NULL},
    {"estimator=splat", "injection=photon:count=20000", "bounces=all",
     "visibility=shadowmap:radius=0.1", NULL},
    {"estimator=photonmap:neighbours=50", "injection=photon:count=20000", "bounces=all", NULL},
    {"estimator=photonmap:neighbours=50,gather=8", "injection=photon:count=20000", "bounces=all",
     NULL},
};

/* `side`: -1 where it mirrors; `placed`: ", rotate: ..., translate: ...". */
static void write_scene(char text[4096], int side, const char *placed, bool instance)
{
    char object[2048];
    const char *by_hand = instance ? "" : placed;
    int pattern = instance ? 1 : side;
    if (instance)
        snprintf(object, sizeof object, "instance: {of: things, scale: [%d, 1, 1]%s}", side,
                 placed);
    else
        snprintf(object, sizeof object, "group: {objects: %s, scale: [%d, 1, 1]%s}", PARTS, side,
                 placed);
    int length = snprintf(text, 4096, SCENE, (double)pattern, by_hand, (double)pattern, by_hand,
                          (double)pattern, by_hand, PARTS, object);
    assert_true(length < 4096);
}

/* RMS of the difference of two layers by the mean of the first. */
static double difference(const struct image *a, const struct image *b, const char *channel)
{
    const float *x = image_channel(a, channel), *y = image_channel(b, channel);
    double squares = 0;
    size_t count = a->width * a->height;
    for (size_t i = 0; i < count; i++)
        squares += pow((double)x[i] - (double)y[i], 2);
    return sqrt(squares / (double)count) / mean_of_all(a, channel);
}

static void compare(const char *name, int side, const char *placed)
{
    char direct[4096], instance[4096];
    write_scene(direct, side, placed, false);
    write_scene(instance, side, placed, true);
    for (size_t i = 0; i < COUNT(methods); i++) {
        struct rendering a = render_text(direct, 2, methods[i]);
        struct rendering b = render_text(instance, 2, methods[i]);
        double lit = difference(&a.image, &b.image, "direct.G");
        double indirect = difference(&a.image, &b.image, "indirect.G");
        double ratio = mean_of_all(&b.image, "indirect.G") / mean_of_all(&a.image, "indirect.G");
        print_message("%s, %.24s: direct differs by %.3f %%, indirect by %.3f %%, means %.5f\n",
                      name, methods[i][0], 100 * lit, 100 * indirect, ratio);
        assert_true(lit < 0.02);
        assert_true(indirect < 0.1);
        assert_true(fabs(ratio - 1) < 0.005);
        rendering_release(&a);
        rendering_release(&b);
    }
}

static void test_placed(void **state)
{
    (void)state;
    compare("placed", 1, ", rotate: [0, 40, 0], translate: [0.21, 0, 0.1]");
}

static void test_tilted(void **state)
{
    (void)state;
    compare("tilted", 1, ", rotate: [8, 0, -5], translate: [0.2, 0.2, 0]");
}

static void test_mirrored(void **state)
{
    (void)state;
    compare("mirrored", -1, ", rotate: [0, 20, 0], translate: [0.21, 0, -0.1]");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_placed),
        cmocka_unit_test(test_tilted),
        cmocka_unit_test(test_mirrored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
