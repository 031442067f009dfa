/* test_area_lights.c: the direct light of area lights, against closed forms.
 *
 * E of a floor point under radiance L (form factors: Siegel and Howell; Modest, appendix D):
 *
 *     rectangle   parallel, of sides a h and b h at height h, a corner right above the point:
 *                 L / 2 (a / p atan(b / p) + b / q atan(a / q)), p^2 = 1 + a^2, q^2 = 1 + b^2;
 *                 other places are sums and differences of corners
 *     disc        coaxial: pi L r^2 / (h^2 + r^2); at distance x from the axis
 *                 pi L / 2 (1 - (1 + H^2 - R^2) / sqrt((1 + H^2 + R^2)^2 - 4 R^2)),
 *                 H = h / x, R = r / x
 *     sphere      all of it above the horizon, at distance d: pi L (r / d)^2 cos(t)
 *     sun         given by its irradiance across the beam: E cos(t), if all is above the horizon
 *     sky         pi L
 *
 * Radiance is a / pi E. The shadow of a straight edge at height e under a lamp of width w at height
 * h has a penumbra from full light to none of width w e / (h - e).
 */
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define ALBEDO 0.6
#define SEEDS 4

static const char scene[] =
    "psd: 1\n"
    "camera: {location: [%.6f, 1.5, 1], look_at: [%.6f, 0, 0], angle: 0.01}\n"
    "image: {width: 8, height: 8}\n"
    "materials: {floor: {diffuse: 0.6}, lamp: {diffuse: 0, emission: 2}}\n"
    "lights: [%s]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor}\n"
    "%s"
    "render: {light_samples: 256, seed: %%d}\n";

/* Direct radiance of the floor at distance x. */
static struct estimate floor_radiance(const char *light, double x, const char *objects)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, x, x, light, objects);
    return estimate_channel(text, choices, "direct.G", SEEDS);
}

static void expect_irradiance(const char *light, double x, double irradiance)
{
    char what[160];
    snprintf(what, sizeof what, "x = %g: %.100s", x, light);
    expect_estimate(what, floor_radiance(light, x, ""), ALBEDO / PI * irradiance, 1e-3);
}

/* --- rectangle ------------------------------------------------------------------------------ */

static double corner_irradiance(double a, double b)
{
    double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return 0.5 * (a / p * atan(b / p) + b / q * atan(a / q));
}

/* Of the rectangle from x0 to x1 and z0 to z1 at height 1 and radiance 1, seen from the origin. */
static double rectangle_irradiance(double x0, double x1, double z0, double z1)
{
    return corner_irradiance(x1, z1) - corner_irradiance(x0, z1) - corner_irradiance(x1, z0) +
           corner_irradiance(x0, z0);
}

#define RECTANGLE                                                                                  \
    "{rectangle: {corners: [[0, 2, 0], [2, 2, 0], [2, 2, 1]], radiance: 2, visible: no}}"

static void test_rectangle(void **state)
{
    (void)state;
    expect_irradiance(RECTANGLE, 0, 2 * rectangle_irradiance(0, 1, 0, 0.5));
    expect_irradiance(RECTANGLE, 1, 2 * rectangle_irradiance(-0.5, 0.5, 0, 0.5));
    expect_irradiance(RECTANGLE, 5, 2 * rectangle_irradiance(-2.5, -1.5, 0, 0.5));
}

static void test_rectangle_by_power(void **state)
{
    (void)state;
    expect_irradiance("{rectangle: {corners: [[0, 2, 0], [2, 2, 0], [2, 2, 1]], power: 10}}", 1,
                      10 / (2 * PI) * rectangle_irradiance(-0.5, 0.5, 0, 0.5));
}

/* The same lamp as an object; it shines from its front alone. */
static void test_emissive_quad(void **state)
{
    (void)state;
    static const char down[] = "  - quad: {corners: [[0, 2, 0], [2, 2, 0], [2, 2, 1], [0, 2, 1]],"
                               " material: lamp, camera: no}\n";
    static const char up[] = "  - quad: {corners: [[0, 2, 1], [2, 2, 1], [2, 2, 0], [0, 2, 0]],"
                             " material: lamp, camera: no}\n";
    expect_estimate("emissive quad", floor_radiance("", 1, down),
                    ALBEDO / PI * 2 * rectangle_irradiance(-0.5, 0.5, 0, 0.5), 1e-3);
    assert_true(floor_radiance("", 1, up).mean == 0);
}

/* --- others --------------------------------------------------------------------------------- */

static double disc_irradiance(double radius, double height, double x)
{
    double h = height / x, r = radius / x, z = 1 + h * h + r * r;
    return PI / 2 * (1 - (1 + h * h - r * r) / sqrt(z * z - 4 * r * r));
}

static void test_disc(void **state)
{
    (void)state;
    static const char light[] = "{disc: {location: [0, 2, 0], direction: [0, -1, 0], radius: 1.5,"
                                " radiance: 2, visible: no}}";
    expect_irradiance(light, 0, 2 * PI * 2.25 / 6.25);
    expect_irradiance(light, 1, 2 * disc_irradiance(1.5, 2, 1));
    expect_irradiance(light, 4, 2 * disc_irradiance(1.5, 2, 4));
}

static void test_sphere(void **state)
{
    (void)state;
    static const char light[] =
        "{sphere: {location: [0, 2, 0], radius: 1.2, radiance: 2, visible: no}}";
    static const double places[] = {0, 1, 4};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        double d2 = 4 + places[i] * places[i];
        expect_irradiance(light, places[i], 2 * PI * 1.44 / d2 * 2 / sqrt(d2));
    }
}

static void test_sun(void **state)
{
    (void)state;
    expect_irradiance("{sun: {direction: [1, -2, 0], irradiance: 3}}", 1, 3 * 2 / sqrt(5));
    expect_irradiance("{sun: {direction: [1, -2, 0], angle: 0, irradiance: 3}}", 1,
                      3 * 2 / sqrt(5));
    expect_irradiance("{sun: {direction: [1, -2, 0], angle: 50, irradiance: 3}}", 1,
                      3 * 2 / sqrt(5));
    double sine = sin(25 * PI / 180);
    expect_irradiance("{sun: {direction: [1, -2, 0], angle: 50, radiance: 3}}", 1,
                      3 * PI * sine * sine * 2 / sqrt(5));
}

static void test_sky(void **state)
{
    (void)state;
    expect_irradiance("{sky: {radiance: 2}}", 1, 2 * PI);
}

static void test_lights_add(void **state)
{
    (void)state;
    expect_irradiance("{disc: {location: [0, 2, 0], direction: [0, -1, 0], radius: 1.5,"
                      " radiance: 2, visible: no}}, " RECTANGLE
                      ", {sun: {direction: [2, -1, 0], angle: 0, irradiance: 3}}",
                      1,
                      2 * disc_irradiance(1.5, 2, 1) + 2 * rectangle_irradiance(-0.5, 0.5, 0, 0.5) +
                          3 / sqrt(5));
}

/* --- shadows -------------------------------------------------------------------------------- */

/* A narrow lamp across a long edge: the floor along x, seen from above without the edge. */
static struct rendering render_penumbra(int light_samples, const char *join)
{
    static const char text[] =
        "psd: 1\n"
        "camera: {location: [0, 3, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"
        "         projection: orthographic, width: 3.2}\n"
        "image: {width: 64, height: 16}\n"
        "materials: {floor: {diffuse: 0.6}, screen: {diffuse: 0}}\n"
        "lights: [{rectangle: {corners: [[-0.4, 4, -0.01], [0.4, 4, -0.01], [0.4, 4, 0.01]],\n"
        "                      radiance: 100, visible: no}}]\n"
        "objects:\n"
        "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor}\n"
        "  - quad: {corners: [[-9, 2, 9], [0, 2, 9], [0, 2, -9], [-9, 2, -9]], material: screen,\n"
        "           camera: no}\n"
        "render: {light_samples: %d, discontinuity_buffer: %s}\n";
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    char with[sizeof text + 16];
    snprintf(with, sizeof with, text, light_samples, join);
    return render_text(with, 2, choices);
}

/* Direct radiance where the whole lamp is seen from right below. */
static const double full_light = ALBEDO / PI * 100 * 0.02 * 0.8 / 16;

static double penumbra_x(size_t column)
{
    return ((double)column + 0.5) * 0.05 - 1.6;
}

/* The lamp's part that is seen, from where the line over the edge meets its plane. */
static double penumbra_radiance(double x)
{
    double from = fmin(fmax(-x, -0.4), 0.4), sum = 0;
    for (int i = 0; i < 1000; i++) {
        double u = from + (0.4 - from) * (i + 0.5) / 1000 - x;
        sum += (0.4 - from) / 1000 * 16 / pow(16 + u * u, 2);
    }
    return ALBEDO / PI * 100 * 0.02 * sum;
}

static void test_penumbra(void **state)
{
    (void)state;
    struct rendering rendering = render_penumbra(1024, "no");
    double worst = 0;
    for (size_t column = 0; column < 64; column++) {
        double x = penumbra_x(column);
        double got = mean_of(&rendering.image, "direct.G", column, 7, 1, 2);
        if (x < -0.4)
            assert_true(got == 0);
        worst = fmax(worst, fabs(got - penumbra_radiance(x)) / full_light);
    }
    print_message("penumbra: worst column off by %.3f %% of full light\n", 100 * worst);
    assert_true(worst < 0.01);
    rendering_release(&rendering);
}

/* RMS of the differences of single pixels, over full light. */
static double difference(const struct rendering *a, const struct rendering *b)
{
    const float *one = image_channel(&a->image, "direct.G");
    const float *other = image_channel(&b->image, "direct.G");
    double sum = 0;
    for (size_t i = 0; i < 64 * 16; i++)
        sum += pow((double)one[i] - (double)other[i], 2) / (64 * 16);
    return sqrt(sum) / full_light;
}

static void test_joined_light(void **state)
{
    (void)state;
    struct rendering truth = render_penumbra(1024, "no");
    struct rendering alone = render_penumbra(16, "no"), joined = render_penumbra(16, "yes");
    double error_alone = difference(&alone, &truth), error_joined = difference(&joined, &truth);
    double mean = mean_of_all(&joined.image, "direct.G") / mean_of_all(&truth.image, "direct.G");
    print_message("16 rays: off by %.4f of full light, joined %.4f, their mean %.4f\n", error_alone,
                  error_joined, mean);
    assert_true(error_joined < 0.4 * error_alone);
    assert_true(fabs(mean - 1) < 0.005);
    rendering_release(&truth);
    rendering_release(&alone);
    rendering_release(&joined);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle),     cmocka_unit_test(test_rectangle_by_power),
        cmocka_unit_test(test_emissive_quad), cmocka_unit_test(test_disc),
        cmocka_unit_test(test_sphere),        cmocka_unit_test(test_sun),
        cmocka_unit_test(test_sky),           cmocka_unit_test(test_lights_add),
        cmocka_unit_test(test_penumbra),      cmocka_unit_test(test_joined_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
