/* test_rough_gloss.c: what gloss sends from a lamp to a diffuse surface, in a final gather.
 *
 * Smooth gloss makes caustics, which are splatted; what rough gloss reflects is found by rays, and
 * needs no photons. Where both are in a scene, or light meets both in a row, each light path counts
 * once: bidirectional path tracing is the truth.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define SEEDS 3

/* The camera sees the floor alone; a tilted plate of metal and a mirror that stands across it are
 * above. */
static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 1.4, 0.01], look_at: [0, 0, 0], angle: 40}\n"
    "image: {width: 48, height: 32}\n"
    "materials: {white: {diffuse: 0.7}, metal: {metal: {color: 0.8, roughness: %g}},\n"
    "            mirror: {mirror: 0.8}}\n"
    "lights:\n"
    "  - spotlight: {location: [2, 2.2, 0], point_at: [-1.2, 0.8, 0], radius: %g, falloff: %g, "
    "intensity: %g}\n"
    "objects:\n"
    "  - quad: {corners: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: white}\n"
    "  - quad: {corners: [[-1.6, 0.2, 1], [-1.6, 0.2, -1], [-0.9, 1.4, -1], [-0.9, 1.4, 1]], "
    "material: metal, sides: both}\n"
    "  - quad: {corners: [[-3, 0.1, -1.2], [3, 0.1, -1.2], [3, 2, -1.2], [-3, 2, -1.2]], "
    "material: %s}\n"
    "render: {bounces: %d, passes: 1, seed: %d}\n";

struct lamp {
    double radius, falloff, intensity; /* see the scene */
};
static const struct lamp wide = {14, 18, 60}, on_the_plate = {4, 5, 6000};

static struct rendering render(struct lamp lamp, double roughness, const char *wall, int bounces,
                               int seed, const char *estimator, const char *injection)
{
    const char *const strategies[] = {estimator, injection, "denoiser=none", NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, roughness, lamp.radius, lamp.falloff, lamp.intensity, wall,
             bounces, seed);
    return render_text(text, 2, strategies);
}

static double light_by(struct lamp lamp, double roughness, int bounces, const char *injection)
{
    double mean = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        struct rendering rendering = render(lamp, roughness, "white", bounces, seed,
                                            "estimator=gather:samples=256", injection);
        mean += mean_of_all(&rendering.image, "indirect.G") / SEEDS;
        rendering_release(&rendering);
    }
    return mean;
}

/* Whether a few photons bring as much light as many: they guide rays, and bring none. */
static bool needs_no_photons(struct lamp lamp, double roughness, int bounces)
{
    double few = light_by(lamp, roughness, bounces, "injection=photon:count=50");
    double many = light_by(lamp, roughness, bounces, "injection=photon:count=5000");
    print_message("roughness %g, %d bounces: %.3f of the light with few photons\n", roughness,
                  bounces, few / many);
    assert_true(many > 0.01);
    return fabs(few / many - 1) < 0.03;
}

static void test_rough_gloss_needs_no_photons(void **state)
{
    (void)state;
    assert_true(needs_no_photons(wide, 0.3, 1));
    assert_true(needs_no_photons(wide, 0.2, 1));
    assert_false(needs_no_photons(wide, 0.1, 1));
}

/* Nor do the surfels, where all light meets it first. */
static void test_surfels_need_no_photons(void **state)
{
    (void)state;
    assert_true(needs_no_photons(on_the_plate, 0.3, 2));
    assert_false(needs_no_photons(on_the_plate, 0.1, 2));
}

static double mean_by(double roughness, const char *wall, const char *estimator)
{
    double mean = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        struct rendering rendering =
            render(wide, roughness, wall, 2, seed, estimator, "injection=photon:count=200000");
        mean += mean_of_all(&rendering.image, "indirect.G") / SEEDS;
        rendering_release(&rendering);
    }
    return mean;
}

static void test_light_counts_once(void **state)
{
    static const struct {
        double roughness;
        const char *wall;
        double tolerance; /* three standard errors */
    } cases[] = {
        {0.12, "white", 0.07}, {0.2, "white", 0.05}, {0.35, "white", 0.02}, {0.35, "mirror", 0.02}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double truth = mean_by(cases[i].roughness, cases[i].wall, "estimator=bdpt:samples=128");
        double mean = mean_by(cases[i].roughness, cases[i].wall, "estimator=gather:samples=64");
        print_message("roughness %g, %s: %.4f of the light\n", cases[i].roughness, cases[i].wall,
                      mean / truth);
        assert_true(fabs(mean / truth - 1) < cases[i].tolerance);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rough_gloss_needs_no_photons),
        cmocka_unit_test(test_surfels_need_no_photons),
        cmocka_unit_test(test_light_counts_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
