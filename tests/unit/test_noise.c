/* test_noise.c: what gradient noise is by its definition, and how it is spread. */
#include "scratch.h"

#include "base/sample.h"
#include "scene/noise.h"
#include <psplat/math.h>
#include <stdbool.h>

/* A random point of a cube of side 300 around the origin. */
static ps_vec3 random_point(uint64_t index)
{
    float u[4];
    sample_point(sample_key(1, 2, 3), index, u);
    return (ps_vec3){300 * u[0] - 150, 300 * u[1] - 150, 300 * u[2] - 150};
}

static void test_zero_at_lattice(void **state)
{
    (void)state;
    for (int i = -3; i <= 3; i++) {
        for (int j = -3; j <= 3; j++) {
            assert_float_equal(noise_value((ps_vec3){(float)i, (float)j, 7.0f}, 5), 0, 0);
        }
    }
}

/* Near a lattice point the noise is the product with one of the twelve directions: of its three
 * slopes one is 0 and two are 1 or -1. All twelve must come. */
static void test_directions(void **state)
{
    int seen[27] = {0}, kinds = 0;
    const float h = 1e-3f;
    (void)state;
    for (int i = 0; i < 400; i++) {
        ps_vec3 p = {(float)(i % 20 - 10), (float)(i / 20 - 10), 0};
        float slopes[3] = {noise_value((ps_vec3){p.x + h, p.y, p.z}, 9) / h,
                           noise_value((ps_vec3){p.x, p.y + h, p.z}, 9) / h,
                           noise_value((ps_vec3){p.x, p.y, p.z + h}, 9) / h};
        int code = 0, zeros = 0;
        for (int k = 0; k < 3; k++) {
            float rounded = roundf(slopes[k]);
            assert_float_equal(slopes[k], rounded, 0.01);
            zeros += rounded == 0.0f;
            code = 3 * code + (int)rounded + 1;
        }
        assert_int_equal(zeros, 1);
        kinds += seen[code]++ == 0;
    }
    assert_int_equal(kinds, 12);
}

static void test_spread(void **state)
{
    (void)state;
    for (int32_t octaves = 0; octaves <= 8; octaves += 2) { /* 0: the plain noise */
        double sum = 0, squares = 0, limit = octaves == 0 ? NOISE_LIMIT : 2 * NOISE_LIMIT;
        int count = 100000;
        for (int i = 0; i < count; i++) {
            ps_vec3 p = random_point((uint64_t)i);
            float value = octaves == 0 ? noise_value(p, 3) : noise_fractal(p, octaves, 0, 3);
            assert_true(fabs(value) <= limit);
            sum += value;
            squares += value * value;
        }
        assert_float_equal(sum / count, 0, 0.005);
        assert_float_equal(sqrt(squares / count), 0.27, 0.005);
    }
}

/* The largest value, over points of a cell, that the best directions at its corners would give. */
static void test_limit(void **state)
{
    double largest = 0;
    (void)state;
    for (int i = 0; i < 33 * 33 * 33; i++) {
        const double t[3] = {i % 33 / 32.0, i / 33 % 33 / 32.0, i / (33 * 33) / 32.0};
        double value = 0;
        for (int corner = 0; corner < 8; corner++) {
            double weight = 1, sum = 0, smallest = 1;
            for (int axis = 0; axis < 3; axis++) {
                double x = t[axis], fade = x * x * x * (x * (6 * x - 15) + 10);
                bool upper = corner >> axis & 1;
                double distance = upper ? 1 - x : x;
                weight *= upper ? fade : 1 - fade;
                sum += distance;
                smallest = fmin(smallest, distance);
            }
            value += weight * (sum - smallest);
        }
        largest = fmax(largest, value);
    }
    assert_true(largest > 1.03 && largest <= NOISE_LIMIT);
}

/* Steps of 1/1000, across many cells: the noise changes by little, and so does its slope. */
static void test_smooth(void **state)
{
    const float h = 1.0f / 1024;
    ps_vec3 way = {0.6f * h, -0.48f * h, 0.64f * h};
    float before = 0, slope_before = 0;
    (void)state;
    for (int i = 0; i < 30000; i++) {
        float value = noise_value(ps_scale(way, (float)i), 11), slope = (value - before) / h;
        if (i > 0) {
            assert_true(fabsf(slope) < 3);
        }
        if (i > 1) {
            assert_true(fabsf(slope - slope_before) < 0.03);
        }
        before = value;
        slope_before = slope;
    }
}

/* Against differences, and the values beside them are those of the noise. */
static void test_gradients(void **state)
{
    const float h = 1.0f / 1024;
    const ps_vec3 ways[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    (void)state;
    for (int i = 0; i < 3000; i++) {
        ps_vec3 p = ps_scale(random_point((uint64_t)i), 0.05f), gradients[4];
        ps_vec3 v = noise_vector_gradients(p, 2, 8, gradients), same = noise_vector(p, 2, 0, 8);
        assert_true(v.x == same.x && v.y == same.y && v.z == same.z);
        assert_true(noise_fractal_gradient(p, 3, 5, &gradients[3]) == noise_fractal(p, 3, 0, 5));
        for (int k = 0; k < 3; k++) {
            ps_vec3 a = ps_subtract(p, ways[k]), b = ps_add(p, ways[k]);
            ps_vec3 rise = ps_subtract(noise_vector(b, 2, 0, 8), noise_vector(a, 2, 0, 8));
            float of_fractal = noise_fractal(b, 3, 0, 5) - noise_fractal(a, 3, 0, 5);
            const float rises[4] = {rise.x, rise.y, rise.z, of_fractal};
            for (int j = 0; j < 4; j++) {
                const float slopes[3] = {gradients[j].x, gradients[j].y, gradients[j].z};
                assert_float_equal(slopes[k], rises[j] / (2 * h), 1e-2);
            }
        }
    }
}

/* Of the noise over a square of that width around a point, across an axis that is none of the
 * lattice's. */
static double mean_of_square(ps_vec3 middle, float width)
{
    enum { SIDE = 12 };
    ps_vec3 u, v;
    double sum = 0;
    ps_frame(ps_normalize((ps_vec3){1, 2, 3}), &u, &v);
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = ((float)(i % SIDE) + 0.5f) / SIDE - 0.5f;
        float y = ((float)(i / SIDE) + 0.5f) / SIDE - 0.5f;
        ps_vec3 p = ps_add_scaled(ps_add_scaled(middle, width * x, u), width * y, v);
        sum += (double)noise_fractal(p, 4, 0, 3);
    }
    return sum / (SIDE * SIDE);
}

/* Octaves that are as fine as the square fade, and what is left is nearer to the mean than the
 * value in the middle is. */
static void test_octaves_fade(void **state)
{
    static const float widths[] = {0.2f, 0.5f, 1.0f};
    (void)state;
    for (int k = 0; k < 3; k++) {
        double faded = 0, unfaded = 0;
        for (int i = 0; i < 500; i++) {
            ps_vec3 p = random_point((uint64_t)i);
            double mean = mean_of_square(p, widths[k]);
            faded += pow((double)noise_fractal(p, 4, widths[k], 3) - mean, 2);
            unfaded += pow((double)noise_fractal(p, 4, 0, 3) - mean, 2);
        }
        print_message("width %g: error %.4f, %.4f in the middle\n", (double)widths[k],
                      sqrt(faded / 500), sqrt(unfaded / 500));
        assert_true(sqrt(faded) < 0.65 * sqrt(unfaded));
    }
    for (int i = 0; i < 100; i++)
        assert_true(noise_fractal(random_point((uint64_t)i), 4, 2.0f, 3) == 0.0f);
}

/* Mean square of the difference over a distance along a direction. */
static double structure(ps_vec3 direction, float distance, int32_t octaves)
{
    double sum = 0;
    int count = 60000;
    for (int i = 0; i < count; i++) {
        ps_vec3 p = random_point((uint64_t)i);
        float d = noise_fractal(ps_add_scaled(p, distance, direction), octaves, 0, 3) -
                  noise_fractal(p, octaves, 0, 3);
        sum += (double)d * d;
    }
    return sum / count;
}

static void test_isotropic(void **state)
{
    static const ps_vec3 directions[] = {{1, 0, 0},
                                         {0, 1, 0},
                                         {0, 0, 1},
                                         {0.70711f, 0.70711f, 0},
                                         {0, 0.70711f, -0.70711f},
                                         {0.57735f, 0.57735f, 0.57735f},
                                         {-0.26726f, 0.53452f, 0.80178f}};
    (void)state;
    for (float distance = 0.1f; distance < 1; distance += 0.3f) {
        double least = INFINITY, most = 0;
        for (size_t i = 0; i < sizeof directions / sizeof *directions; i++) {
            double value = structure(directions[i], distance, 3);
            least = fmin(least, value);
            most = fmax(most, value);
        }
        assert_true(most < 1.2 * least);
    }
}

/* A plane of the axes is no plane of the lattice: the values there are spread like all others. */
static void test_planes_of_axes(void **state)
{
    double squares[3] = {0};
    int count = 100000;
    (void)state;
    for (int i = 0; i < count; i++) {
        ps_vec3 p = random_point((uint64_t)i);
        float values[3] = {noise_fractal((ps_vec3){0, p.y, p.z}, 1, 0, 3),
                           noise_fractal((ps_vec3){p.x, 0, p.z}, 1, 0, 3),
                           noise_fractal((ps_vec3){p.x, p.y, 0}, 1, 0, 3)};
        for (int k = 0; k < 3; k++) {
            squares[k] += (double)values[k] * values[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        assert_float_equal(sqrt(squares[k] / count), 0.27, 0.01);
    }
}

static double correlation(double xy, double xx, double yy)
{
    return xy / sqrt(xx * yy);
}

/* Seeds, and the parts of a vector, have nothing to do with each other. */
static void test_independent(void **state)
{
    double products[4] = {0}, squares[4] = {0};
    int count = 100000;
    (void)state;
    for (int i = 0; i < count; i++) {
        ps_vec3 p = random_point((uint64_t)i), v = noise_vector(p, 2, 0, 8);
        const float values[4] = {v.x, v.y, v.z, noise_fractal(p, 2, 0, 8)};
        for (int k = 0; k < 4; k++) {
            products[k] += (double)values[k] * values[(k + 1) % 4];
            squares[k] += (double)values[k] * values[k];
        }
    }
    for (int k = 0; k < 4; k++) {
        assert_float_equal(correlation(products[k], squares[k], squares[(k + 1) % 4]), 0, 0.02);
    }
}

static void test_no_period(void **state)
{
    (void)state;
    for (int power = 4; power <= 16; power++) {
        double product = 0, squares = 0;
        for (int i = 0; i < 4000; i++) {
            ps_vec3 p = random_point((uint64_t)i);
            ps_vec3 q = {p.x + (float)(1 << power), p.y, p.z};
            float a = noise_value(p, 0), b = noise_value(q, 0);
            product += (double)a * b;
            squares += (double)a * a;
        }
        assert_true(fabs(product) < 0.1 * squares);
    }
}

static void test_any_point(void **state)
{
    static const float wild[] = {NAN, INFINITY, -INFINITY, 3e38f, -8388607.5f, 1e-40f, 2e9f, -0.0f};
    (void)state;
    for (int i = 0; i < 512; i++) {
        ps_vec3 p = {wild[i % 8], wild[i / 8 % 8], wild[i / 64]};
        ps_vec3 v = noise_vector(p, NOISE_OCTAVES_LIMIT, 0, 1);
        assert_true(fabsf(noise_value(p, 1)) <= NOISE_LIMIT);
        assert_true(fabsf(v.x) + fabsf(v.y) + fabsf(v.z) <= 6 * NOISE_LIMIT);
    }
}

/* Values of this implementation, so that pictures do not change unnoticed. */
static void test_same_everywhere(void **state)
{
    (void)state;
    assert_float_equal(noise_value((ps_vec3){0.5f, 0.25f, 0.125f}, 0), 0.53419912, 1e-6);
    assert_float_equal(noise_value((ps_vec3){-7.3f, 2.9f, 100.6f}, 42), 0.5535183, 1e-6);
    assert_float_equal(noise_fractal((ps_vec3){1.5f, -2.25f, 3.125f}, 5, 0, 7), 0.35668027, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_zero_at_lattice), cmocka_unit_test(test_directions),
        cmocka_unit_test(test_spread),          cmocka_unit_test(test_limit),
        cmocka_unit_test(test_smooth),          cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_octaves_fade),    cmocka_unit_test(test_isotropic),
        cmocka_unit_test(test_planes_of_axes),  cmocka_unit_test(test_independent),
        cmocka_unit_test(test_no_period),       cmocka_unit_test(test_any_point),
        cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
