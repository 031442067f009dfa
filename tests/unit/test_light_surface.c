/* test_light_surface.c: triangles that shine: rectangles, discs and emissive meshes. */
#include "scene/light.h"

#include "support/chi_squared.h"
#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define UNLIKELY 1e-4

static const ps_rgb radiance = {6, 3, 2};

/* A lamp of 2 x 1 at the height of 3 that shines down. */
static const struct light_description rectangle = {.kind = LIGHT_RECTANGLE,
                                                   .location = {1, 3, 2},
                                                   .half_edges = {{1, 0, 0}, {0, 0, 0.5f}},
                                                   .amount = {6, 3, 2},
                                                   .unit = UNIT_RADIANCE};

static struct light_mesh rectangle_mesh(void)
{
    static ps_vec3 vertices[4];
    static uint32_t triangles[2][3];
    light_rectangle_triangles(&rectangle, vertices, triangles);
    return (struct light_mesh){
        .vertices = vertices,
        .triangles = (const uint32_t(*)[3])triangles,
        .triangle_count = 2,
    };
}

/* A tetrahedron, seen from outside, of which one face is much larger than the others. */
static struct light_mesh solid_mesh(void)
{
    static const ps_vec3 vertices[] = {{0, 0, 0}, {3, 0, 0}, {0, 0, 2}, {0.2f, 1, 0.2f}};
    static const uint32_t triangles[][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return (struct light_mesh){.vertices = vertices, .triangles = triangles, .triangle_count = 4};
}

static struct light light_of_mesh(const struct light_mesh *mesh, bool both_sides)
{
    struct light light;
    struct error error;
    assert_int_equal(light_create_mesh(mesh, radiance, both_sides, &light, &error), PS_OK);
    return light;
}

/* --- densities --- */

static double fit_mesh(const struct light_mesh *mesh, const struct light *light,
                       const struct light *density, ps_vec3 position, ps_vec3 middle,
                       double degrees)
{
    const struct light_view view = {.light = light,
                                    .density = density,
                                    .position = position,
                                    .axis = ps_normalize(ps_subtract(middle, position)),
                                    .degrees = degrees,
                                    .meet = meet_mesh,
                                    .geometry = mesh};
    if (!density)
        expect_samples_meet_light(&view, radiance);
    return light_view_fit(&view);
}

static void test_directions_have_their_density(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh(), solid = solid_mesh();
    struct light light = light_of_mesh(&lamp, false), both = light_of_mesh(&lamp, true);
    ps_vec3 middle = {1, 3, 2};
    assert_true(fit_mesh(&lamp, &light, NULL, (ps_vec3){1, 1, 2}, middle, 32) > UNLIKELY);
    assert_true(fit_mesh(&lamp, &light, NULL, (ps_vec3){2.5f, 2, 1}, middle, 40) > UNLIKELY);
    assert_true(fit_mesh(&lamp, &both, NULL, (ps_vec3){2, 5, 2.5f}, middle, 36) > UNLIKELY);
    light_release(&light);
    light_release(&both);
    light = light_of_mesh(&solid, false);
    ps_vec3 inside = {1, 0.4f, 0.6f};
    assert_true(fit_mesh(&solid, &light, NULL, (ps_vec3){3, 2, 2.5f}, inside, 45) > UNLIKELY);
    assert_true(fit_mesh(&solid, &light, NULL, (ps_vec3){-1, -1, 0.5f}, inside, 50) > UNLIKELY);
    light_release(&light);
}

/* The test would see a density that is not that of the samples. */
static void test_other_densities_are_rejected(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh(), solid = solid_mesh();
    struct light light = light_of_mesh(&lamp, false);
    struct light tilted = light;
    ps_vec3 moved[4];
    for (int i = 0; i < 4; i++)
        moved[i] = (ps_vec3){lamp.vertices[i].x, lamp.vertices[i].y,
                             lamp.vertices[i].z + 0.02f * lamp.vertices[i].x};
    tilted.surface.mesh.vertices = moved;
    ps_vec3 middle = {1, 3, 2};
    assert_true(fit_mesh(&lamp, &tilted, &light, (ps_vec3){1, 1, 2}, middle, 33) < 1e-6);
    light_release(&light);
    /* Triangles as likely as each other, rather than by area. */
    light = light_of_mesh(&solid, false);
    struct light even = light;
    float shares[] = {0.25f, 0.5f, 0.75f, 1};
    even.surface.by_area.cumulative = shares;
    assert_true(fit_mesh(&solid, &even, &light, (ps_vec3){-1, -1, 0.5f}, (ps_vec3){1, 0.4f, 0.6f},
                         50) < 1e-6);
    light_release(&light);
}

/* --- irradiance in closed form --- */

/* Form factor of a rectangle a x b at height c, from a parallel element under its corner (Siegel
 * and Howell; Lambert). */
static double corner_factor(double a, double b, double c)
{
    double x = a / c, y = b / c, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * PI);
}

static void test_rectangle_over_a_point(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh();
    struct light light = light_of_mesh(&lamp, false), both = light_of_mesh(&lamp, true);
    static const double places[][3] = {{1, 1, 2}, {1.5, 2.5, 2.2}, {0.3, 0, 1.7}};
    for (size_t i = 0; i < 3; i++) {
        ps_vec3 position = {(float)places[i][0], (float)places[i][1], (float)places[i][2]};
        double left = places[i][0] - 0, right = 2 - places[i][0], height = 3 - places[i][1];
        double front = places[i][2] - 1.5, back = 2.5 - places[i][2];
        double factor = corner_factor(left, front, height) + corner_factor(left, back, height) +
                        corner_factor(right, front, height) + corner_factor(right, back, height);
        ps_vec3 up = {0, 1, 0}, down = {0, -1, 0}, above = position;
        above.y = (float)(3 + height);
        expect_close(irradiance_by_samples(&light, position, up), PI * 6 * factor, 1e-3);
        expect_close(irradiance_by_samples(&both, position, up), PI * 6 * factor, 1e-3);
        expect_close(irradiance_by_samples(&both, above, down), PI * 6 * factor, 1e-3);
        assert_true(irradiance_by_samples(&light, above, down) == 0); /* its back */
    }
    light_release(&light);
    light_release(&both);
}

enum { SEGMENTS = 48 };

static struct light_mesh disc_mesh(const struct light_description *description)
{
    static ps_vec3 vertices[SEGMENTS + 1];
    static uint32_t triangles[SEGMENTS][3];
    light_disc_triangles(description, SEGMENTS, vertices, triangles);
    return (struct light_mesh){
        .vertices = vertices,
        .triangles = (const uint32_t(*)[3])triangles,
        .triangle_count = SEGMENTS,
    };
}

/* On its axis at distance h a disc of radius r gives pi L r^2 / (r^2 + h^2). */
static void test_disc_over_its_axis(void **state)
{
    (void)state;
    const struct light_description description = {.kind = LIGHT_DISC,
                                                  .location = {1, 2, 3},
                                                  .direction = {0, -3, 4},
                                                  .radius = 0.7,
                                                  .amount = {6, 3, 2},
                                                  .unit = UNIT_RADIANCE};
    struct light_mesh mesh = disc_mesh(&description);
    struct light light = light_of_mesh(&mesh, false);
    expect_close(light.surface.area, PI * 0.49, 1e-5);
    expect_close(light_power(&light).r, PI * PI * 0.49 * 6, 1e-5);
    static const double heights[] = {0.3, 1, 4};
    for (size_t i = 0; i < 3; i++) {
        double h = heights[i];
        ps_vec3 position = {1, (float)(2 - 0.6 * h), (float)(3 + 0.8 * h)};
        expect_close(irradiance_by_samples(&light, position, (ps_vec3){0, 0.6f, -0.8f}),
                     PI * 6 * 0.49 / (0.49 + h * h), 2e-3);
    }
    assert_true(fit_mesh(&mesh, &light, NULL, (ps_vec3){1, 1, 4}, (ps_vec3){1, 2, 3}, 40) >
                UNLIKELY);
    light_release(&light);
}

/* --- power --- */

static void test_power(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh(), solid = solid_mesh();
    struct light light = light_of_mesh(&lamp, false), both = light_of_mesh(&lamp, true);
    expect_close(light_power(&light).r, PI * 2 * 6, 1e-6);
    expect_close(light_power(&both).g, 2 * PI * 2 * 3, 1e-6);
    expect_flux_is_power(&light, 1e-5);
    expect_flux_is_power(&both, 1e-5);
    light_release(&light);
    light_release(&both);
    light = light_of_mesh(&solid, false);
    expect_flux_is_power(&light, 1e-5);
    light_release(&light);
}

static void test_radiance_from_power(void **state)
{
    (void)state;
    struct light_description description = rectangle;
    assert_true(light_surface_radiance(&description, 2).r == 6);
    description.unit = UNIT_POWER;
    expect_close(light_surface_radiance(&description, 2).r, 6 / (2 * PI), 1e-6);
    assert_true(light_surface_radiance(&description, 0).r == 0);
    description.both_sides = true;
    expect_close(light_surface_radiance(&description, 2).g, 3 / (4 * PI), 1e-6);
    description.kind = LIGHT_SPHERE;
    expect_close(light_surface_radiance(&description, 2).b, 2 / (2 * PI), 1e-6);
}

/* --- emission --- */

/* Positions even over the lamp, directions by the cosine: 4 x 4 places, 4 rings of the squared
 * sine, 4 sectors, and the sides. `repeat` gives the same number twice, which must show. */
static double fit_emission(const struct light *light, int sides, bool repeat)
{
    enum { RAYS = 400000, MOST = 512 };
    double observed[MOST] = {0}, expected[MOST];
    size_t cells = 256 * (size_t)sides;
    struct random random = {7};
    for (int i = 0; i < RAYS; i++) {
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = random_unit(&random);
        if (repeat)
            u[3] = u[0];
        ps_ray ray;
        ps_vec3 normal;
        light_emit(light, u, &ray, &normal);
        assert_true(fabsf(ray.origin.y - 3) < 1e-5f && fabsf(normal.y) == 1);
        assert_true(ps_dot(ray.direction, normal) >= 0);
        double sine2 = 1 - (double)ray.direction.y * ray.direction.y;
        double turn = atan2(ray.direction.z, ray.direction.x) / (2 * PI) + 0.5;
        int place = (int)fmin(fmax(ray.origin.x * 2, 0), 3) * 4 +
                    (int)fmin(fmax((ray.origin.z - 1.5) * 4, 0), 3);
        int way = (int)fmin(fmax(sine2 * 4, 0), 3) * 4 + (int)fmin(turn * 4, 3);
        observed[(normal.y > 0 ? 256 : 0) + place * 16 + way]++;
    }
    for (size_t i = 0; i < cells; i++)
        expected[i] = (double)RAYS / (double)cells;
    return chi_squared_probability(observed, expected, cells);
}

static void test_emission_is_lambertian(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh();
    struct light light = light_of_mesh(&lamp, false), both = light_of_mesh(&lamp, true);
    assert_true(fit_emission(&light, 1, false) > UNLIKELY);
    assert_true(fit_emission(&both, 2, false) > UNLIKELY);
    assert_true(fit_emission(&light, 1, true) < 1e-12);
    light_release(&light);
    light_release(&both);
}

static void test_photons_agree_with_samples(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh(), solid = solid_mesh();
    struct light light = light_of_mesh(&lamp, false), both = light_of_mesh(&lamp, true);
    expect_plate_agrees(&light, (ps_vec3){1.5f, 1.5f, 2}, (ps_vec3){0, 0.8f, 0.6f}, 0.2);
    expect_plate_agrees(&both, (ps_vec3){1.5f, 4.2f, 2}, (ps_vec3){0, -1, 0}, 0.25);
    light_release(&light);
    light_release(&both);
    light = light_of_mesh(&solid, false);
    expect_plate_agrees(&light, (ps_vec3){2, 2, 1.5f}, (ps_vec3){-0.48f, -0.8f, -0.36f}, 0.4);
    light_release(&light);
}

/* A grid of numbers gives points that are all over the rectangle: 4 in a cell on average, and none
 * empty. */
static void test_a_rectangle_stays_stratified(void **state)
{
    (void)state;
    enum { EDGE = 16 };
    struct light_mesh lamp = rectangle_mesh();
    struct light light = light_of_mesh(&lamp, false);
    int counts[EDGE / 2][EDGE / 2] = {{0}};
    ps_vec3 position = {1, 0, 2};
    for (int i = 0; i < EDGE; i++)
        for (int k = 0; k < EDGE; k++) {
            struct light_sample sample;
            assert_true(
                sample_light(&light, position, (i + 0.5f) / EDGE, (k + 0.5f) / EDGE, &sample));
            ps_vec3 at = ps_add_scaled(position, sample.distance, sample.direction);
            counts[(int)(at.x * 0.4999f * EDGE / 2)][(int)((at.z - 1.5f) * 0.9999f * EDGE / 2)]++;
        }
    for (int i = 0; i < EDGE * EDGE / 4; i++)
        assert_in_range(counts[i / (EDGE / 2)][i % (EDGE / 2)], 1, 8);
    light_release(&light);
}

/* --- many at once --- */

static void expect_same_samples(const struct light_sample *a, const struct light_sample *b)
{
    expect_close(a->distance, b->distance, 1e-6);
    expect_close(a->weight.r, b->weight.r, 1e-5);
    expect_close(a->pdf, b->pdf, 1e-5);
    assert_true(ps_length(ps_subtract(a->direction, b->direction)) < 1e-5f);
}

/* More places than are looked at in one go, in front of the lamp, behind it and in its plane. */
static void test_many_positions(void **state)
{
    (void)state;
    enum { MANY = 37 };
    struct light_mesh lamp = rectangle_mesh();
    struct light light = light_of_mesh(&lamp, false);
    ps_vec3 positions[MANY];
    float numbers[MANY][2];
    struct light_sample samples[MANY];
    struct random random = {43};
    int dark = 0;
    for (int i = 0; i < MANY; i++) {
        positions[i] = (ps_vec3){random_unit(&random), (float)(i % 5), random_unit(&random)};
        numbers[i][0] = random_unit(&random);
        numbers[i][1] = random_unit(&random);
    }
    light_sample(&light, positions, NULL, (const float(*)[2])numbers, MANY, samples);
    for (int i = 0; i < MANY; i++) {
        struct light_sample alone;
        bool lit = sample_light(&light, positions[i], numbers[i][0], numbers[i][1], &alone);
        assert_int_equal(lit, ps_rgb_maximum(samples[i].weight) > 0);
        if (lit)
            expect_same_samples(&samples[i], &alone);
        dark += !lit;
    }
    assert_in_range(dark, 5, 20);
    light_release(&light);
}

/* --- patterns --- */

/* Red follows u, green the height; blue is none. */
static ps_rgb slope(const void *user, ps_vec3 position, const struct shape_point *point)
{
    static const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    float uv[2];
    assert_ptr_equal(user, &radiance);
    shape_mesh_uv(corners, point, uv);
    return (ps_rgb){uv[0], position.x, 0};
}

static void test_pattern(void **state)
{
    (void)state;
    struct light_mesh lamp = rectangle_mesh();
    lamp.pattern = slope;
    lamp.pattern_user = &radiance;
    struct light light = light_of_mesh(&lamp, false);
    /* u = x / 2, over x from 0 to 2. */
    ps_rgb power = light_power(&light);
    expect_close(power.r, PI * 2 * 6 * 0.5, 1e-4);
    expect_close(power.g, PI * 2 * 3 * 1, 1e-4);
    assert_true(power.b == 0);
    struct random random = {41};
    double red = 0;
    for (int i = 0; i < 100000; i++) {
        struct light_sample sample;
        ps_vec3 position = {1, 1, 2}, normal;
        ps_ray ray;
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = random_unit(&random);
        ps_rgb flux = light_emit(&light, u, &ray, &normal);
        assert_true(fabs(flux.r - PI * 2 * 6 * ray.origin.x / 2) < 1e-3);
        red += flux.r / 100000;
        if (!sample_light(&light, position, u[0], u[1], &sample))
            continue;
        double x = position.x + sample.distance * sample.direction.x;
        assert_true(fabs(sample.weight.r * sample.pdf - 6 * x / 2) < 1e-3);
        assert_true(fabs(sample.weight.g * sample.pdf - 3 * x) < 1e-3);
    }
    expect_close(red, power.r, 1e-2);
    light_release(&light);
}

/* --- what has no size --- */

static void test_degenerate_meshes(void **state)
{
    (void)state;
    static const ps_vec3 vertices[] = {{0, 0, 0}, {1, 0, 0},      {2, 0, 0},
                                       {0, 1, 0}, {1e-20f, 0, 0}, {0, 1e-20f, 0}};
    static const uint32_t triangles[][3] = {{0, 1, 2}, {0, 1, 3}, {1, 1, 1}, {0, 4, 5}};
    struct light_mesh mesh = {.vertices = vertices, .triangles = triangles, .triangle_count = 4};
    const float u[4] = {0.4f, 0.6f, 0.2f, 0.9f};
    struct light light = light_of_mesh(&mesh, false);
    expect_close(light.surface.area, 0.5, 1e-6);
    expect_flux_is_power(&light, 1e-5);
    light_release(&light);
    light_release(&light);                       /* again */
    for (size_t count = 0; count < 2; count++) { /* none, or one that is a line */
        mesh.triangle_count = count;
        light = light_of_mesh(&mesh, true);
        ps_ray ray;
        ps_vec3 normal;
        struct light_sample sample;
        assert_true(light_power(&light).r == 0 && light_emit(&light, u, &ray, &normal).r == 0);
        assert_false(sample_light(&light, (ps_vec3){0, 0, 1}, 0.3f, 0.6f, &sample));
        light_release(&light);
    }
}

/* A lamp so small that the square of its area is nothing in single precision. */
static void test_tiny_lamp(void **state)
{
    (void)state;
    static const ps_vec3 vertices[] = {{0, 0, 0}, {4e-13f, 0, 0}, {0, 5e-13f, 0}};
    static const uint32_t triangles[][3] = {{0, 1, 2}};
    struct light_mesh mesh = {.vertices = vertices, .triangles = triangles, .triangle_count = 1};
    struct light light = light_of_mesh(&mesh, false);
    struct light_sample sample;
    const ps_vec3 position = {0, 0, 2};
    expect_close(light.surface.area, 1e-25, 1e-5);
    assert_true(sample_light(&light, position, 0.3f, 0.6f, &sample));
    expect_close(sample.weight.r, 6 * 1e-25 / 4, 1e-5);
    expect_flux_is_power(&light, 1e-5);
    light_release(&light);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions_have_their_density),
        cmocka_unit_test(test_other_densities_are_rejected),
        cmocka_unit_test(test_rectangle_over_a_point),
        cmocka_unit_test(test_disc_over_its_axis),
        cmocka_unit_test(test_power),
        cmocka_unit_test(test_radiance_from_power),
        cmocka_unit_test(test_emission_is_lambertian),
        cmocka_unit_test(test_photons_agree_with_samples),
        cmocka_unit_test(test_a_rectangle_stays_stratified),
        cmocka_unit_test(test_many_positions),
        cmocka_unit_test(test_pattern),
        cmocka_unit_test(test_degenerate_meshes),
        cmocka_unit_test(test_tiny_lamp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
