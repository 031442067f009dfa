/* test_direct.c: direct light against closed forms: a lamp of intensity I over a floor of albedo a,
 * at height h.
 *
 * A floor point at horizontal distance x has E = I f cos(t) / (h^2 + x^2), cos(t) = h / sqrt(h^2 +
 * x^2), f the spotlight's edge: 1 inside radius, 0 outside falloff, a smooth cubic of the cosine in
 * between. Radiance is a / pi E.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define HEIGHT 2.0
#define INTENSITY 10.0
#define ALBEDO 0.6

/* Radiance of the floor at distance x, seen through a lens so narrow that it is one point. */
static double floor_radiance(const char *light, double x, const char *more)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "psd: 1\n"
        "camera: {location: [%.6f, 1.5, 1], look_at: [%.6f, 0, 0], angle: 0.01}\n"
        "image: {width: 4, height: 4}\n"
        "materials: {floor: {diffuse: 0.6}}\n"
        "lights: [%s]\n"
        "objects:\n"
        "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], material: floor}\n"
        "%s",
        x, x, light, more);
    const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    struct rendering rendering = render_text(text, 2, choices);
    double radiance = mean_of_all(&rendering.image, "direct.G");
    rendering_release(&rendering);
    return radiance;
}

static double expected(double x, double edge)
{
    double distance2 = HEIGHT * HEIGHT + x * x;
    return ALBEDO / PI * INTENSITY * edge * HEIGHT / sqrt(distance2) / distance2;
}

static void expect_radiance(double got, double wanted)
{
    print_message("radiance %.6f, expected %.6f\n", got, wanted);
    assert_true(fabs(got - wanted) <= 1e-3 * wanted + 1e-9);
}

static void test_point_light(void **state)
{
    (void)state;
    static const char light[] = "{point: {location: [0, 2, 0], intensity: 10}}";
    static const double places[] = {0, 1, 3.5};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++)
        expect_radiance(floor_radiance(light, places[i], ""), expected(places[i], 1));
}

static void test_spotlight_edge(void **state)
{
    (void)state;
    static const char light[] = "{spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 20,"
                                " falloff: 40, intensity: 10}}";
    double inner = cos(20 * PI / 180), outer = cos(40 * PI / 180);
    double between = tan(31 * PI / 180) * HEIGHT;
    double t = (cos(31 * PI / 180) - outer) / (inner - outer);
    expect_radiance(floor_radiance(light, 0, ""), expected(0, 1));
    expect_radiance(floor_radiance(light, tan(19 * PI / 180) * HEIGHT, ""),
                    expected(tan(19 * PI / 180) * HEIGHT, 1));
    expect_radiance(floor_radiance(light, between, ""), expected(between, t * t * (3 - 2 * t)));
    expect_radiance(floor_radiance(light, tan(41 * PI / 180) * HEIGHT, ""), 0);
}

static void test_shadow(void **state)
{
    (void)state;
    static const char light[] = "{point: {location: [0, 2, 0], intensity: 10}}";
    static const char ball[] = "  - sphere: {center: [0, 1, 0], radius: 0.2, material: floor}\n";
    expect_radiance(floor_radiance(light, 0.3, ball), 0);
    expect_radiance(floor_radiance(light, 1, ball), expected(1, 1));
}

/* Neither shadow rays nor light paths of a lamp that lies on a surface may meet that surface. */
static void test_lamp_on_a_surface(void **state)
{
    (void)state;
    static const char light[] = "{spotlight: {location: [0, 2, 0], point_at: [0, 0, 0], radius: 60,"
                                " falloff: 60, intensity: 10}}";
    static const char ceiling[] =
        "  - quad: {corners: [[-9, 2, -9], [9, 2, -9], [9, 2, 9], [-9, 2, 9]],"
        " material: floor}\n";
    expect_radiance(floor_radiance(light, 1, ceiling), expected(1, 1));
    static const char scene[] =
        "psd: 1\n"
        "camera: {location: [0, 1, 4], look_at: [0, 1, 0]}\n"
        "image: {width: 16, height: 9}\n"
        "materials: {floor: {diffuse: 0.6}}\n"
        "lights: [%s]\n"
        "objects:\n"
        "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]],"
        " material: floor}\n%s";
    static const char *const choices[] = {"injection=photon:count=2000", NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, light, ceiling);
    struct rendering rendering = render_text(text, 2, choices);
    assert_true(mean_of_all(&rendering.image, "indirect.G") > 0.01);
    rendering_release(&rendering);
}

static void test_two_lights_add(void **state)
{
    (void)state;
    static const char lights[] = "{point: {location: [0, 2, 0], intensity: 4}},"
                                 "{point: {location: [0, 2, 0], intensity: 6}}";
    expect_radiance(floor_radiance(lights, 1, ""), expected(1, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_point_light),    cmocka_unit_test(test_spotlight_edge),
        cmocka_unit_test(test_shadow),         cmocka_unit_test(test_lamp_on_a_surface),
        cmocka_unit_test(test_two_lights_add),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
