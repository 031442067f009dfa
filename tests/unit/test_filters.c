/* test_filters.c: filters share the energy, and differ in shape. */
#include "splat/kernel.h"
#include "support/one_strategy.h"
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A floor seen from straight above, and a narrow light that shines at the ceiling: what a single
 * photon makes is one disc on the floor. */
static const char floor_text[] =
    "psd: 1\n"
    "camera: {location: [0, 3.9, 0], look_at: [0, 0, 0], up: [0, 0, 1], angle: 110}\n"
    "image: {width: 96, height: 96}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 3.95, 0], point_at: [0, 4, 0], radius: 5, falloff: 5,\n"
    "                intensity: 100}\n"
    "objects:\n"
    "  - quad: {corners: [[-50, 0, -50], [50, 0, -50], [50, 0, 50], [-50, 0, 50]], material: "
    "white}\n"
    "  - quad: {corners: [[-5, 4, -5], [5, 4, -5], [5, 4, 5], [-5, 4, 5]], material: white}\n";

static struct rendering render(const char *text, const char *filter)
{
    const char *const choices[] = {"injection=photon:count=20000", filter, NULL};
    return render_text(text, 2, choices);
}

static void expect_same_mean_other_picture(const char *text, const char *one, const char *other)
{
    struct rendering a = render(text, one), b = render(text, other);
    double ratio = mean_of_all(&a.image, "indirect.G") / mean_of_all(&b.image, "indirect.G");
    const float *p = image_channel(&a.image, "indirect.G");
    const float *q = image_channel(&b.image, "indirect.G");
    double difference = 0, sum = 0;
    for (size_t i = 0; i < a.image.width * a.image.height; i++) {
        difference += fabsf(p[i] - q[i]);
        sum += p[i];
    }
    print_message("%s, %s: means %.4f, mean difference %.3f\n", one, other, ratio,
                  difference / sum);
    assert_true(fabs(ratio - 1) < 0.02);
    assert_true(difference > 0.01 * sum);
    rendering_release(&a);
    rendering_release(&b);
}

static void test_filters_share_the_mean(void **state)
{
    (void)state;
    char *cornell = cornell_text(96, 54);
    expect_same_mean_other_picture(cornell, "filter=box", "filter=tent");
    expect_same_mean_other_picture(cornell, "filter=tent", "filter=gaussian");
    expect_same_mean_other_picture(cornell, "filter=gaussian:sigma=0.3", "filter=gaussian:sigma=1");
    expect_same_mean_other_picture(cornell, "filter=gaussian", "filter=epanechnikov");
    expect_same_mean_other_picture(cornell, "filter=epanechnikov", "filter=cone:k=5");
    free(cornell);
}

struct spot {
    double sum, peak, largest_step; /* of the indirect light; steps between neighbours in a row */
    size_t pixels;                  /* with weight */
};

/* The disc that one photon makes. */
static struct spot spot_of(const char *filter)
{
    const char *const choices[] = {"injection=photon:count=1", filter,
                                   "visibility=none:radius=1.5,bandwidth_scale=0",
                                   "estimator=splat:interleave=1", NULL};
    struct rendering rendering = render_text(floor_text, 1, choices);
    const float *green = image_channel(&rendering.image, "indirect.G");
    const float *weight = image_channel(&rendering.image, "weight");
    struct spot spot = {0};
    for (size_t i = 1; i < rendering.image.width * rendering.image.height; i++) {
        spot.sum += green[i];
        spot.peak = fmax(spot.peak, green[i]);
        spot.largest_step = fmax(spot.largest_step, fabsf(green[i] - green[i - 1]));
        spot.pixels += weight[i] > 0;
    }
    rendering_release(&rendering);
    print_message("one photon, %s: sum %.4f, peak %.4f, largest step %.4f, %zu pixels\n", filter,
                  spot.sum, spot.peak, spot.largest_step, spot.pixels);
    assert_true(spot.pixels > 100);
    return spot;
}

/* The disc's flux is the same; its edge is sharpest with the box, its peak highest with the tent.
 */
static void test_shapes_of_one_splat(void **state)
{
    (void)state;
    struct spot box = spot_of("filter=box"), tent = spot_of("filter=tent");
    struct spot gaussian = spot_of("filter=gaussian:sigma=0.5");
    struct spot epanechnikov = spot_of("filter=epanechnikov"), cone = spot_of("filter=cone:k=2");
    assert_true(fabs(tent.sum / box.sum - 1) < 0.02);
    assert_true(fabs(gaussian.sum / box.sum - 1) < 0.02);
    assert_true(fabs(epanechnikov.sum / box.sum - 1) < 0.02);
    assert_true(fabs(cone.sum / box.sum - 1) < 0.02);
    assert_int_equal(tent.pixels, box.pixels);
    assert_int_equal(gaussian.pixels, box.pixels);
    assert_true(box.largest_step > 1.5 * tent.largest_step);
    assert_true(box.largest_step > 1.5 * gaussian.largest_step);
    assert_true(box.largest_step > 0.999 * box.peak); /* all or nothing */
    assert_true(epanechnikov.largest_step < cone.largest_step);
    /* Peaks over a disc of radius 1: 1/pi, 3/pi, 2/(pi (1 - exp(-2))), 2/pi, 3/(2 pi). */
    assert_true(fabs(tent.peak / box.peak / 3 - 1) < 0.1);
    assert_true(fabs(gaussian.peak / box.peak / 2.313 - 1) < 0.05);
    assert_true(fabs(epanechnikov.peak / box.peak / 2 - 1) < 0.05);
    assert_true(fabs(cone.peak / box.peak / 1.5 - 1) < 0.05);
}

/* --- the weights themselves --- */

static struct kernel_profile profile_of(const char *text)
{
    struct strategy filter = strategy_of(text);
    const ps_filter_vtable *vtable = &filter.type->table.filter;
    struct kernel_profile profile;
    float radius2[KERNEL_PROFILE_SIZE];
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        radius2[i] = kernel_profile_radius2(i);
    vtable->weigh(filter.state, radius2, profile.weights, KERNEL_PROFILE_SIZE);
    strategy_release(&filter);
    assert_true(kernel_profile_normalize(&profile));
    return profile;
}

/* 1 / scale is the weights' integral over the unit disc. */
static void test_integrals_are_those_of_the_formulas(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    static const struct {
        const char *filter;
        double volume; /* over pi */
    } cases[] = {
        {"filter=box", 1},
        {"filter=tent", 1.0 / 3},
        {"filter=epanechnikov", 0.5},
        {"filter=cone:k=1", 1.0 / 3},
        {"filter=cone:k=2", 2.0 / 3},
        {"filter=cone:k=4", 1 - 2.0 / 12},
        {"filter=gaussian:sigma=0.5", 0.43233}, /* (1 - exp(-2)) / 2 */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct kernel_profile profile = profile_of(cases[i].filter);
        double volume = 1 / (pi * profile.scale);
        print_message("%s: volume %.5f pi\n", cases[i].filter, volume);
        assert_true(fabs(volume / cases[i].volume - 1) < 1e-4);
    }
}

static void test_weights_fall_outwards(void **state)
{
    (void)state;
    static const char *const filters[] = {"filter=tent", "filter=epanechnikov", "filter=cone:k=1",
                                          "filter=cone:k=3", "filter=gaussian"};
    for (size_t k = 0; k < sizeof filters / sizeof filters[0]; k++) {
        struct kernel_profile profile = profile_of(filters[k]);
        assert_true(profile.weights[0] > 0.95f && profile.weights[0] <= 1.0f);
        for (size_t i = 1; i < KERNEL_PROFILE_SIZE; i++)
            assert_true(profile.weights[i] < profile.weights[i - 1]);
    }
}

/* What the cone keeps at the rim: 1 - 1/k; nothing at k = 1, where it is the tent to the bit. */
static void test_cone_between_tent_and_box(void **state)
{
    (void)state;
    struct kernel_profile tent = profile_of("filter=tent"), same = profile_of("filter=cone:k=1");
    struct kernel_profile wide = profile_of("filter=cone:k=4"),
                          box = profile_of("filter=cone:k=1000");
    assert_memory_equal(tent.weights, same.weights, sizeof tent.weights);
    assert_true(fabsf(wide.weights[KERNEL_PROFILE_SIZE - 1] - 0.75f) < 1e-3f);
    assert_true(box.weights[KERNEL_PROFILE_SIZE - 1] > 0.998f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_filters_share_the_mean),
        cmocka_unit_test(test_shapes_of_one_splat),
        cmocka_unit_test(test_integrals_are_those_of_the_formulas),
        cmocka_unit_test(test_weights_fall_outwards),
        cmocka_unit_test(test_cone_between_tent_and_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
