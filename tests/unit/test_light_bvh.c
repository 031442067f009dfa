/* test_light_bvh.c: lights that points draw, against asking all of them. */
#include "scene/light_bvh.h"

#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#define LIGHTS 600
#define TURNS 20000
#define TRIANGLES 500

/* --- lights --- */

static const ps_vec3 no_normal = {0, 0, 0};

static struct light_description random_description(struct random *random, bool spot, float size)
{
    ps_vec3 location = ps_scale(random_direction(random), size * random_unit(random));
    float strength = powf(10.0f, random_between(random, -1.0f, 2.0f));
    return (struct light_description){
        .kind = spot ? LIGHT_SPOT : LIGHT_POINT,
        .location = location,
        .point_at = ps_add_scaled(location, fmaxf(size, 1.0f), random_direction(random)),
        .radius = 5 + 30 * (double)random_unit(random),
        .falloff = 40 + 100 * (double)random_unit(random),
        .amount = {strength, 0.5f * strength, 0.1f * strength},
        .unit = UNIT_INTENSITY,
    };
}

/* Points, spots and spheres that shine. */
static struct light *random_lights(uint64_t seed, size_t count, float size)
{
    struct random random = {seed};
    struct light *lights = calloc(count, sizeof *lights);
    assert_non_null(lights);
    for (size_t i = 0; i < count; i++) {
        struct light_description description = random_description(&random, i % 3 == 1, size);
        lights[i] = i % 3 == 2 ? light_create_sphere(description.location,
                                                     size * random_between(&random, 0.001f, 0.05f),
                                                     description.amount, i % 2 == 0)
                               : light_of(&description, NULL);
    }
    return lights;
}

static struct light_bvh *bvh_of(const struct light *lights, size_t count)
{
    struct light_bvh *bvh;
    struct error error;
    assert_int_equal(light_bvh_create(lights, count, &bvh, &error), PS_OK);
    return bvh;
}

static void release_lights(struct light *lights, size_t count)
{
    for (size_t i = 0; i < count; i++)
        light_release(&lights[i]);
    free(lights);
}

/* What the light gives to the point, by its middle or by the mean of a grid of its points. */
static double contribution(const struct light *light, ps_vec3 position, ps_vec3 normal)
{
    double sum = 0.0;
    int side = light_is_delta(light) ? 1 : 8;
    for (int i = 0; i < side * side; i++) {
        int column = i % side, row = i / side;
        float numbers[1][2] = {
            {((float)column + 0.5f) / (float)side, ((float)row + 0.5f) / (float)side}};
        struct light_sample sample;
        light_sample(light, &position, NULL, (const float(*)[2])numbers, 1, &sample);
        float cosine = ps_dot(normal, normal) > 0.0f ? ps_dot(sample.direction, normal) : 1.0f;
        sum += (double)(sample.weight.r * ps_max(cosine, 0.0f)) / (side * side);
    }
    return sum;
}

/* --- the mean --- */

struct drawn {
    double mean, standard_error;
    double draws; /* of lights, in the mean */
};

static const struct light_draws one = {.most = 1};

static struct light_draws exactly(uint32_t number)
{
    return (struct light_draws){.most = number};
}

/* The estimate of the sum of all contributions by drawing lights. */
static struct drawn draw_often(const struct light_bvh *bvh, const double *contributions,
                               ps_vec3 position, ps_vec3 normal, const struct light_draws *draws)
{
    struct random random = {99};
    double sum = 0.0, squares = 0.0, all = 0.0;
    for (int turn = 0; turn < TURNS; turn++) {
        struct light_choice choices[MOST_LIGHT_CHOICES];
        double estimate = 0.0;
        size_t count =
            light_bvh_choose(bvh, position, normal, draws, (double)random_unit(&random), choices);
        assert_true(count <= draws->most);
        for (size_t i = 0; i < count; i++)
            estimate += (double)choices[i].weight * contributions[choices[i].light];
        sum += estimate;
        all += (double)count;
        squares += estimate * estimate;
    }
    double mean = sum / TURNS;
    return (struct drawn){mean, sqrt(fmax(squares / TURNS - mean * mean, 0.0) / TURNS),
                          all / TURNS};
}

static void expect_mean_at(const struct light *lights, const struct light_bvh *bvh,
                           ps_vec3 position, ps_vec3 normal, uint32_t number, double most_noise)
{
    double contributions[LIGHTS], all = 0.0;
    for (size_t i = 0; i < LIGHTS; i++)
        all += contributions[i] = contribution(&lights[i], position, normal);
    struct light_draws draws = exactly(number);
    struct drawn drawn = draw_often(bvh, contributions, position, normal, &draws);
    assert_true(fabs(drawn.mean - all) <= 4.0 * drawn.standard_error + 1e-4 * all);
    assert_true(drawn.standard_error * sqrt(TURNS) <= most_noise * all);
}

/* One draw has noise of 50 to 90 % here. 16 independent ones would have a quarter of it; a
 * systematic sample has less. */
static void test_draws_have_the_mean_of_all_lights(void **state)
{
    (void)state;
    struct light *lights = random_lights(1, LIGHTS, 5.0f);
    struct light_bvh *bvh = bvh_of(lights, LIGHTS);
    struct random random = {3};
    for (int i = 0; i < 8; i++) {
        ps_vec3 position = ps_scale(random_direction(&random), 6.0f);
        ps_vec3 normal = i % 2 ? ps_normalize(ps_scale(position, -1.0f)) : no_normal;
        expect_mean_at(lights, bvh, position, normal, 1, 1.2);
        expect_mean_at(lights, bvh, position, normal, 16, 0.2);
    }
    light_bvh_destroy(bvh);
    release_lights(lights, LIGHTS);
}

/* What draws of the lights beside the first give, which shines with `strength`. */
static struct drawn draw_beside(float strength, uint32_t number)
{
    struct light *lights = random_lights(1, LIGHTS, 5.0f);
    struct light_description lamp = {.kind = LIGHT_POINT,
                                     .location = {1, 1, 1},
                                     .amount = {strength, strength, strength},
                                     .unit = UNIT_INTENSITY};
    ps_vec3 position = {2, 6, -1};
    double contributions[LIGHTS] = {0.0};
    light_release(&lights[0]);
    lights[0] = light_of(&lamp, NULL);
    for (size_t i = 1; i < LIGHTS; i++)
        contributions[i] = contribution(&lights[i], position, no_normal);
    struct light_bvh *bvh = bvh_of(lights, LIGHTS);
    struct light_draws draws = exactly(number);
    struct drawn drawn = draw_often(bvh, contributions, position, no_normal, &draws);
    light_bvh_destroy(bvh);
    release_lights(lights, LIGHTS);
    return drawn;
}

/* A lamp that outshines all others takes one draw, even where something is in its way. */
static void test_strong_light_takes_one_draw(void **state)
{
    (void)state;
    struct drawn strong = draw_beside(1e6f, 8), dark = draw_beside(0.0f, 7);
    expect_close(strong.mean, dark.mean, 0.02);
    assert_true(strong.standard_error < 1.3 * dark.standard_error);
}

/* Lights below the threshold are drawn seldom, and in proportion; the mean stays. */
static void test_faint_lights_are_drawn_seldom(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    struct light *lights = random_lights(23, COUNT, 5.0f);
    ps_vec3 position = {30, 8, -3};
    double contributions[COUNT], all = 0.0;
    for (size_t i = 0; i < COUNT; i++)
        all += contributions[i] = contribution(&lights[i], position, no_normal);
    struct light_bvh *bvh = bvh_of(lights, COUNT);
    const double thresholds[] = {2.0 * all, 0.02 * all}, most_draws[] = {4.0, 0.9 * COUNT};
    for (int i = 0; i < 2; i++) {
        struct light_draws draws = {COUNT, true, (float)thresholds[i]};
        struct drawn drawn = draw_often(bvh, contributions, position, no_normal, &draws);
        assert_true(fabs(drawn.mean - all) <= 4.0 * drawn.standard_error);
        assert_true(drawn.standard_error < 0.03 * all);
        assert_true(drawn.draws > 0.2 && drawn.draws < most_draws[i]);
    }
    light_bvh_destroy(bvh);
    release_lights(lights, COUNT);
}

/* No light is below a threshold that is low enough. */
static void test_all_lights_are_asked(void **state)
{
    (void)state;
    enum { COUNT = 6 };
    struct light lights[COUNT];
    for (int i = 0; i < COUNT; i++)
        lights[i] = light_create_sphere((ps_vec3){(float)i, 0, 0}, 0.1f, (ps_rgb){1, 1, 1}, false);
    struct light_bvh *bvh = bvh_of(lights, COUNT);
    struct light_choice choices[COUNT];
    struct light_draws draws = {COUNT, true, 1e-12f};
    ps_vec3 position = {0.1f, 2.0f, 0.2f};
    assert_true(light_bvh_choose(bvh, position, no_normal, &draws, 0.5, choices) == LIGHT_BVH_ALL);
    assert_true(light_bvh_expected(bvh, 3, position, &draws) == 1.0f);
    draws.all = false;
    draws.most = 2;
    assert_int_equal(light_bvh_choose(bvh, position, no_normal, &draws, 0.5, choices), 2);
    light_bvh_destroy(bvh);
}

/* What gives light to a point can be drawn there. */
static void test_no_light_is_left_out(void **state)
{
    (void)state;
    struct light *lights = random_lights(5, LIGHTS, 5.0f);
    struct light_bvh *bvh = bvh_of(lights, LIGHTS);
    struct random random = {7};
    struct light_draws draws = exactly(4);
    for (int i = 0; i < 200; i++) {
        ps_vec3 position = ps_scale(random_direction(&random), 8.0f * random_unit(&random));
        for (size_t light = 0; light < LIGHTS; light++)
            if (contribution(&lights[light], position, no_normal) > 0.0)
                assert_true(light_bvh_expected(bvh, light, position, &draws) > 0.0f);
    }
    light_bvh_destroy(bvh);
    release_lights(lights, LIGHTS);
}

static void test_draws_come_as_often_as_expected(void **state)
{
    (void)state;
    enum { number = 5 };
    struct light_draws draws = exactly(number);
    struct light *lights = random_lights(11, LIGHTS, 5.0f);
    struct light_bvh *bvh = bvh_of(lights, LIGHTS);
    ps_vec3 position = {1, 2, -1};
    double counts[LIGHTS] = {0.0}, expected = 0.0;
    for (int turn = 0; turn < TURNS; turn++) {
        struct light_choice choices[number];
        double u = (turn + 0.5) / TURNS;
        size_t count = light_bvh_choose(bvh, position, no_normal, &draws, u, choices);
        for (size_t i = 0; i < count; i++) {
            float chance = light_bvh_expected(bvh, choices[i].light, position, &draws);
            counts[choices[i].light] += (double)(choices[i].weight * chance) / TURNS;
        }
    }
    for (size_t i = 0; i < LIGHTS; i++) {
        float chance = light_bvh_expected(bvh, i, position, &draws);
        expected += (double)chance;
        assert_true(fabs(counts[i] - (double)chance) <= 1e-3 + 1e-3 * (double)chance);
    }
    /* Some nodes may give light that none of their children gives. */
    assert_true(expected <= number + 1e-3 && expected > 0.9 * number);
    light_bvh_destroy(bvh);
    release_lights(lights, LIGHTS);
}

/* --- meshes --- */

/* A band of triangles around the y axis that face away from it, radius 1. */
struct band {
    ps_vec3 vertices[2 * TRIANGLES];
    uint32_t triangles[TRIANGLES][3];
};

static struct light_mesh band_mesh(struct band *band)
{
    uint32_t half = TRIANGLES / 2;
    for (uint32_t i = 0; i < half; i++) {
        float angle = 2.0f * PS_PI * (float)i / (float)half;
        uint32_t next = (i + 1) % half;
        for (uint32_t k = 0; k < 2; k++)
            band->vertices[2 * i + k] = (ps_vec3){cosf(angle), (float)k, sinf(angle)};
        uint32_t corners[2][3] = {{2 * i, 2 * i + 1, 2 * next},
                                  {2 * next, 2 * i + 1, 2 * next + 1}};
        for (int k = 0; k < 6; k++)
            band->triangles[2 * i + (uint32_t)k / 3][k % 3] = corners[k / 3][k % 3];
    }
    return (struct light_mesh){
        .vertices = band->vertices,
        .triangles = (const uint32_t(*)[3])band->triangles,
        .triangle_count = TRIANGLES,
    };
}

/* Estimates by triangles of the tree and by points of the whole area agree; those have less
 * noise. */
static void test_triangles_of_a_mesh_are_drawn(void **state)
{
    (void)state;
    static struct band band;
    struct light_mesh mesh = band_mesh(&band);
    struct light light;
    struct error error;
    assert_int_equal(light_create_mesh(&mesh, (ps_rgb){1, 1, 1}, false, &light, &error), PS_OK);
    struct light_bvh *bvh = bvh_of(&light, 1);
    assert_true(light_bvh_is_split(bvh, 0));
    struct random random = {13};
    ps_vec3 position = {1.5f, 0.5f, 0}, normal = {-1, 0, 0};
    double sums[2] = {0, 0}, squares[2] = {0, 0};
    for (int turn = 0; turn < TURNS; turn++) {
        float numbers[1][2] = {{random_unit(&random), random_unit(&random)}};
        struct light_choice choice;
        struct light_sample samples[2];
        double u = (double)random_unit(&random);
        assert_true(light_bvh_choose_triangle(bvh, 0, position, normal, u, &choice));
        light_sample_triangle(&light, choice.triangle, position, numbers[0], &samples[0]);
        light_sample(&light, &position, NULL, (const float(*)[2])numbers, 1, &samples[1]);
        samples[0].weight.r *= choice.weight;
        for (int i = 0; i < 2; i++) {
            float cosine = ps_max(ps_dot(samples[i].direction, normal), 0.0f);
            double irradiance = (double)(samples[i].weight.r * cosine);
            sums[i] += irradiance / TURNS;
            squares[i] += irradiance * irradiance / TURNS;
        }
    }
    double variance[2] = {squares[0] - sums[0] * sums[0], squares[1] - sums[1] * sums[1]};
    double noise = sqrt((variance[0] + variance[1]) / TURNS);
    assert_true(sums[0] > 0.1 && fabs(sums[0] - sums[1]) < 4.0 * noise);
    assert_true(variance[0] < 0.2 * variance[1]);
    light_bvh_destroy(bvh);
    light_release(&light);
}

/* Shines where no grid of points looks. */
static ps_rgb speck(const void *user, ps_vec3 position, const struct shape_point *point)
{
    (void)user;
    (void)point;
    float lit = fabsf(position.y - 0.41234f) < 1e-4f ? 1.0f : 0.0f;
    return (ps_rgb){lit, lit, lit};
}

/* What is known of a pattern by points may be all dark; the light is in the tree, by its parts or
 * whole. */
static void test_light_whose_pattern_is_missed(void **state)
{
    (void)state;
    static struct band band;
    for (int i = 0; i < 2; i++) {
        struct light_mesh mesh = band_mesh(&band);
        struct light light;
        struct error error;
        mesh.pattern = speck;
        mesh.triangle_count = i == 0 ? TRIANGLES : LIGHT_BVH_TRIANGLES;
        assert_int_equal(light_create_mesh(&mesh, (ps_rgb){1, 1, 1}, false, &light, &error), PS_OK);
        assert_true(light.surface.mean.r == 0.0f);
        struct light_bvh *bvh = bvh_of(&light, 1);
        assert_true(light_bvh_expected(bvh, 0, (ps_vec3){1.5f, 0.5f, 0}, &one) > 0.0f);
        light_bvh_destroy(bvh);
        light_release(&light);
    }
}

/* A triangle that is a millionth of a billionth of its mesh has its own area. */
static void test_small_triangles_have_their_area(void **state)
{
    (void)state;
    static const ps_vec3 vertices[] = {{0, 0, 0}, {1e5f, 0, 0},  {0, 0, 1e5f},
                                       {0, 1, 0}, {1e-3f, 1, 0}, {0, 1, 1e-3f}};
    static const uint32_t triangles[][3] = {{0, 1, 2}, {3, 4, 5}};
    struct light_mesh mesh = {.vertices = vertices, .triangles = triangles, .triangle_count = 2};
    struct light light;
    struct error error;
    assert_int_equal(light_create_mesh(&mesh, (ps_rgb){1, 1, 1}, false, &light, &error), PS_OK);
    expect_close((double)light_bounds_of(&light, 1).intensity, 3 * 0.5e-6, 1e-4);
    light_release(&light);
}

/* --- limits --- */

static void expect_finite(const struct light_bvh *bvh, ps_vec3 position)
{
    struct light_choice choices[MOST_LIGHT_CHOICES];
    struct light_draws draws = exactly(MOST_LIGHT_CHOICES);
    size_t count = light_bvh_choose(bvh, position, no_normal, &draws, 0.25, choices);
    assert_true(count > 0);
    for (size_t i = 0; i < count; i++)
        assert_true(choices[i].weight > 0.0f && choices[i].weight < INFINITY);
}

/* Lights in one place, a point on top of them, and scenes of any size. */
static void test_hostile_places(void **state)
{
    (void)state;
    static const float sizes[] = {0.0f, 1e-6f, 1e9f};
    for (int i = 0; i < 3; i++) {
        struct light *lights = random_lights(17, LIGHTS, sizes[i]);
        struct light_bvh *bvh = bvh_of(lights, LIGHTS);
        expect_finite(bvh, (ps_vec3){0, 0, 0});
        expect_finite(bvh, (ps_vec3){1e-7f, 0, 0});
        expect_finite(bvh, (ps_vec3){3, -2, 1});
        expect_finite(bvh, (ps_vec3){1e9f, 1e9f, 0});
        light_bvh_destroy(bvh);
        release_lights(lights, LIGHTS);
    }
}

/* The light that shines from afar, and the dark one, are not in the tree. */
static void test_lights_that_are_left_out(void **state)
{
    (void)state;
    struct light_description descriptions[] = {
        {.kind = LIGHT_SKY, .amount = {1, 1, 1}, .unit = UNIT_RADIANCE},
        {.kind = LIGHT_POINT, .amount = {0, 0, 0}, .unit = UNIT_INTENSITY},
        {.kind = LIGHT_POINT, .amount = {1, 1, 1}, .unit = UNIT_INTENSITY},
    };
    struct light lights[3];
    for (int i = 0; i < 3; i++)
        lights[i] = light_of(&descriptions[i], NULL);
    struct light_bvh *bvh = bvh_of(lights, 3);
    struct light_choice choice;
    assert_int_equal(light_bvh_count(bvh), 1);
    assert_int_equal(light_bvh_choose(bvh, (ps_vec3){1, 0, 0}, no_normal, &one, 0.5, &choice), 1);
    assert_int_equal(choice.light, 2);
    assert_true(light_bvh_expected(bvh, 1, (ps_vec3){1, 0, 0}, &one) == 0.0f);
    light_bvh_destroy(bvh);
    bvh = bvh_of(lights, 2);
    assert_int_equal(light_bvh_choose(bvh, (ps_vec3){1, 0, 0}, no_normal, &one, 0.5, &choice), 0);
    light_bvh_destroy(bvh);
    for (int i = 0; i < 3; i++)
        light_release(&lights[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_draws_have_the_mean_of_all_lights),
        cmocka_unit_test(test_strong_light_takes_one_draw),
        cmocka_unit_test(test_faint_lights_are_drawn_seldom),
        cmocka_unit_test(test_all_lights_are_asked),
        cmocka_unit_test(test_no_light_is_left_out),
        cmocka_unit_test(test_draws_come_as_often_as_expected),
        cmocka_unit_test(test_triangles_of_a_mesh_are_drawn),
        cmocka_unit_test(test_light_whose_pattern_is_missed),
        cmocka_unit_test(test_small_triangles_have_their_area),
        cmocka_unit_test(test_hostile_places),
        cmocka_unit_test(test_lights_that_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
