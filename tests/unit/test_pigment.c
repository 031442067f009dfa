/* test_pigment.c: colours against their definitions: checker, gradient, noise, images. */
#include "scene/noise.h"
#include "scene/pigment.h"
#include "texture_fixture.h"
#include <psplat/math.h>

static const float no_uv[2] = {0, 0};

/* From black to a colour that tells the channels apart. */
static struct pigment_description describe(enum pigment_kind kind)
{
    return (struct pigment_description){.kind = kind,
                                        .colors = {{0, 0, 0}, {0.2f, 0.4f, 0.9f}},
                                        .scale_u = 1,
                                        .scale_v = 1,
                                        .placement = AFFINE_IDENTITY,
                                        .axis = {1, 0, 0},
                                        .octaves = 1};
}

/* How much of the second colour there is; all channels must agree. */
static float share_at(const struct pigment *pigment, ps_vec3 p)
{
    ps_rgb color = pigment_color(pigment, p, no_uv);
    assert_float_equal(color.r / 0.2f, color.b / 0.9f, 1e-6);
    assert_float_equal(color.g / 0.4f, color.b / 0.9f, 1e-6);
    assert_float_equal(pigment_number(pigment, p, no_uv), color.b / 0.9f * 0.5f, 1e-6);
    return color.b / 0.9f;
}

static void test_color(void **state)
{
    struct pigment_description description = describe(PIGMENT_COLOR);
    (void)state;
    description.colors[0] = (ps_rgb){0.3f, 0.6f, 0.9f};
    struct pigment pigment = pigment_create(&description, NULL);
    assert_true(pigment_is_constant(&pigment));
    assert_float_equal(pigment_color(&pigment, (ps_vec3){NAN, 0, 0}, no_uv).g, 0.6f, 0);
    assert_float_equal(pigment_number(&pigment, (ps_vec3){1, 2, 3}, no_uv), 0.6, 1e-6);
}

static void test_checker_parity(void **state)
{
    struct pigment_description description = describe(PIGMENT_CHECKER);
    struct pigment pigment = pigment_create(&description, NULL);
    (void)state;
    assert_false(pigment_is_constant(&pigment));
    for (int i = -4; i < 4; i++) {
        for (int j = -4; j < 4; j++) {
            for (int k = -4; k < 4; k++) {
                float parity = (float)(((i + j + k) % 2 + 2) % 2);
                static const float inside[] = {0.01f, 0.5f, 0.99f};
                for (int n = 0; n < 3; n++) {
                    ps_vec3 p = {(float)i + inside[n], (float)j + 0.3f, (float)k + inside[2 - n]};
                    assert_float_equal(share_at(&pigment, p), parity, 0);
                }
            }
        }
    }
}

/* A floor in a plane between cubes, with the rounding that hits have. */
static void test_checker_on_faces(void **state)
{
    struct pigment_description description = describe(PIGMENT_CHECKER);
    struct pigment pigment = pigment_create(&description, NULL);
    (void)state;
    for (int plane = -300; plane <= 300; plane += 25) {
        float y = (float)plane, above = share_at(&pigment, (ps_vec3){0.5f, y + 0.5f, 0.5f});
        for (int ulps = -8; ulps <= 8; ulps++) {
            ps_vec3 p = {0.5f, y + (float)ulps * 4e-5f, 0.5f};
            assert_float_equal(share_at(&pigment, p), above, 0);
        }
    }
}

static void test_placement(void **state)
{
    struct pigment_description description = describe(PIGMENT_CHECKER);
    (void)state;
    /* Cubes of side 5, turned by 45 degrees about y, from (100, 0, 0). */
    description.placement =
        affine_of((ps_vec3){5, 5, 5}, (ps_vec3){0, 45, 0}, (ps_vec3){100, 0, 0});
    struct pigment pigment = pigment_create(&description, NULL);
    for (int i = -3; i < 3; i++) {
        ps_vec3 center = {(float)i + 0.5f, 0.5f, 0.5f};
        ps_vec3 p = affine_point(&description.placement, center);
        assert_float_equal(share_at(&pigment, p), (float)(i & 1), 0);
    }
    ps_vec3 diagonal = {100, 2.5f, -5.0f}; /* (x, z) = (sqrt 1/2, -sqrt 1/2) in cubes: one odd */
    assert_float_equal(share_at(&pigment, diagonal), 1, 0);
}

static void test_no_inverse(void **state)
{
    struct pigment_description description = describe(PIGMENT_NOISE);
    (void)state;
    description.placement.z = (ps_vec3){0, 0, 0};
    struct pigment pigment = pigment_create(&description, NULL);
    float share = share_at(&pigment, (ps_vec3){0.2f, 0.4f, 0.6f});
    assert_float_equal(share_at(&pigment, (ps_vec3){4, 5, 6}), share, 0);
}

static void test_gradient(void **state)
{
    struct pigment_description description = describe(PIGMENT_GRADIENT);
    (void)state;
    description.axis = (ps_vec3){0, 3, 4}; /* of any length */
    struct pigment pigment = pigment_create(&description, NULL);
    for (int period = -5; period <= 5; period++) {
        for (float t = 0.01f; t < 0.995f; t += 0.07f) {
            float along = (float)period + t;
            ps_vec3 p = {17, 0.6f * along + 0.8f, 0.8f * along - 0.6f};
            assert_float_equal(share_at(&pigment, p), t, 2e-6);
        }
    }
    description.axis = (ps_vec3){0, 0, 0};
    pigment = pigment_create(&description, NULL);
    assert_float_equal(share_at(&pigment, (ps_vec3){1.3f, 2.4f, 0.7f}), 0, 0);
}

static void test_gradient_where_it_starts_over(void **state)
{
    struct pigment_description description = describe(PIGMENT_GRADIENT);
    struct pigment pigment = pigment_create(&description, NULL);
    (void)state;
    for (int plane = -3; plane <= 3; plane++) {
        for (int ulps = -8; ulps <= 8; ulps++) {
            ps_vec3 p = {(float)plane + (float)ulps * 4e-5f, 5, 6};
            assert_float_equal(share_at(&pigment, p), 0, 4e-4);
        }
    }
}

static void test_noise(void **state)
{
    struct pigment_description description = describe(PIGMENT_NOISE);
    (void)state;
    description.octaves = 4;
    struct pigment pigment = pigment_create(&description, NULL);
    double sum = 0, squares = 0;
    int count = 20000;
    for (int i = 0; i < count; i++) {
        ps_vec3 p = {(float)(i % 171) * 0.37f, (float)(i % 97) * 0.71f, (float)i * 0.013f};
        float share = share_at(&pigment, p);
        assert_true(share >= 0 && share <= 1);
        sum += share;
        squares += share * share;
    }
    assert_float_equal(sum / count, 0.5, 0.01);
    assert_float_equal(sqrt(squares / count - sum / count * sum / count), 0.135, 0.01);
}

static void test_octaves_are_kept_in_bounds(void **state)
{
    struct pigment_description description = describe(PIGMENT_NOISE);
    ps_vec3 p = {0.3f, 0.6f, 0.8f};
    float shares[4];
    static const int64_t octaves[4] = {1, INT64_MIN, NOISE_OCTAVES_LIMIT, INT64_MAX};
    (void)state;
    for (int i = 0; i < 4; i++) {
        description.octaves = octaves[i];
        struct pigment pigment = pigment_create(&description, NULL);
        shares[i] = share_at(&pigment, p);
    }
    assert_float_equal(shares[0], shares[1], 0);
    assert_float_equal(shares[2], shares[3], 0);
    assert_float_not_equal(shares[0], shares[2], 1e-4);
}

/* The gradient tells by how much a point was displaced along its axis. */
static void test_turbulence(void **state)
{
    struct pigment_description description = describe(PIGMENT_GRADIENT);
    const double turbulence = 0.05;
    double squares = 0;
    int count = 5000;
    (void)state;
    description.turbulence = turbulence;
    struct pigment pigment = pigment_create(&description, NULL);
    for (int i = 0; i < count; i++) {
        ps_vec3 p = {0.5f, (float)(i % 71) * 0.37f, (float)i * 0.0437f};
        double moved = share_at(&pigment, p) - 0.5;
        assert_true(fabs(moved) <= turbulence * 2 * NOISE_LIMIT);
        squares += moved * moved;
    }
    assert_float_equal(sqrt(squares / count), turbulence * 0.27, turbulence * 0.03);
}

/* --- images ---------------------------------------------------------------------------------- */

static void test_image(void **state)
{
    struct pigment_description description = describe(PIGMENT_IMAGE);
    struct texture textures[2] = {{0}, load_data("rgba8.png", ENCODING_LINEAR)};
    const float middle_below[2] = {0.5f, 0.25f}; /* (128, 64, 32), alpha 1 */
    ps_vec3 p = {NAN, NAN, NAN};
    (void)state;
    description.texture = 1;
    description.colors[0] = (ps_rgb){1, 0.5f, 2};
    struct pigment pigment = pigment_create(&description, textures);
    ps_rgb color = pigment_color(&pigment, p, middle_below);
    assert_float_equal(color.r, 128 / 255.0, 1e-6);
    assert_float_equal(color.g, 32 / 255.0, 1e-6);
    assert_float_equal(color.b, 64 / 255.0, 1e-6);
    assert_float_equal(pigment_number(&pigment, p, middle_below), 224 / 255.0 / 3, 1e-6);
    static const float channels[] = {0, 128, 64, 32, 1};
    description.colors[0] = (ps_rgb){0.5f, 0.5f, 0.5f};
    for (int channel = CHANNEL_R; channel <= CHANNEL_A; channel++) {
        description.channel = channel;
        pigment = pigment_create(&description, textures);
        assert_float_equal(pigment_number(&pigment, p, middle_below),
                           channels[channel] / 255.0 * 0.5, 1e-6);
    }
    texture_release(&textures[1]);
}

static void test_image_scale_and_offset(void **state)
{
    float samples[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    struct texture texture = texture_of(samples, 4, 3, 1);
    struct pigment_description description = describe(PIGMENT_IMAGE);
    (void)state;
    texture.nearest = true;
    description.colors[0] = (ps_rgb){1, 1, 1};
    description.scale_u = 2;
    description.scale_v = 0.5;
    description.offset_u = 0.25;
    description.offset_v = 0.5;
    struct pigment pigment = pigment_create(&description, &texture);
    const float uv[2] = {0.3f, 0.9f}; /* u' = 0.85, v' = 0.95: upper right texel */
    assert_float_equal(pigment_number(&pigment, (ps_vec3){0, 0, 0}, uv), 3, 0);
    const float repeated[2] = {0.4f, 0.1f}; /* u' = 1.05: the first again; v' = 0.55 */
    assert_float_equal(pigment_number(&pigment, (ps_vec3){0, 0, 0}, repeated), 4, 0);
}

/* --- slopes ---------------------------------------------------------------------------------- */

static void assert_vector(ps_vec3 v, double x, double y, double z, double tolerance)
{
    assert_float_equal(v.x, x, tolerance);
    assert_float_equal(v.y, y, tolerance);
    assert_float_equal(v.z, z, tolerance);
}

static void test_slope_of_gradient(void **state)
{
    struct pigment_description description = describe(PIGMENT_GRADIENT);
    (void)state;
    description.colors[1] = (ps_rgb){6, 6, 6};
    description.axis = (ps_vec3){0, 1, 0};
    /* Pattern y, 3 long in the scene, points along -x after the turn: 6 / 3 per unit. */
    description.placement = affine_of((ps_vec3){2, 3, 5}, (ps_vec3){0, 0, 90}, (ps_vec3){7, 8, 9});
    struct pigment pigment = pigment_create(&description, NULL);
    assert_vector(pigment_gradient(&pigment, (ps_vec3){6, 1, 2}), -2, 0, 0, 1e-3);
}

/* Against differences of the noise itself, summed along a way. */
static void expect_slopes_to_sum_up(const struct pigment *pigment)
{
    const ps_vec3 way = {0.6f, -0.48f, 0.64f};
    const float h = 1e-3f;
    double sum = 0, largest = 0;
    for (int i = 0; i < 4000; i++) {
        ps_vec3 middle = ps_scale(way, ((float)i + 0.5f) * h);
        double slope = ps_dot(pigment_gradient(pigment, middle), way);
        sum += slope * h;
        double difference = pigment_number(pigment, ps_scale(way, (float)(i + 1) * h), no_uv) -
                            pigment_number(pigment, (ps_vec3){0, 0, 0}, no_uv);
        assert_float_equal(sum, difference, 2e-4);
        largest = fmax(largest, fabs(difference));
    }
    assert_true(largest > 0.05);
}

static void test_slope_of_noise(void **state)
{
    struct pigment_description description = describe(PIGMENT_NOISE);
    (void)state;
    description.octaves = 2;
    description.placement =
        affine_of((ps_vec3){2, 3, 5}, (ps_vec3){30, 20, 70}, (ps_vec3){1, 2, 3});
    struct pigment pigment = pigment_create(&description, NULL);
    expect_slopes_to_sum_up(&pigment);
    description.turbulence = 0.4;
    pigment = pigment_create(&description, NULL);
    expect_slopes_to_sum_up(&pigment);
}

/* Where shares would be below 0 or above 1 they are flat. */
static void test_slope_of_clamped_noise(void **state)
{
    struct pigment_description description = describe(PIGMENT_NOISE);
    int clamped = 0;
    (void)state;
    description.octaves = 4;
    struct pigment pigment = pigment_create(&description, NULL);
    for (int i = 0; i < 200000; i++) {
        ps_vec3 p = {(float)i * 0.37f, (float)i * 0.11f, (float)i * -0.23f};
        float share = pigment_number(&pigment, p, no_uv);
        if (share > 0 && share < 1)
            continue;
        assert_vector(pigment_gradient(&pigment, p), 0, 0, 0, 0);
        clamped++;
    }
    assert_true(clamped > 0);
}

static void test_slope_of_image(void **state)
{
    float samples[20], gradient[2];
    struct pigment_description description = describe(PIGMENT_IMAGE);
    (void)state;
    for (int i = 0; i < 20; i++) { /* 5 x 4: 3 a column, -7 a row upwards */
        samples[i] = (float)(3 * (i % 5) + 7 * (i / 5));
    }
    struct texture texture = texture_of(samples, 5, 4, 1);
    texture.wrap_u = texture.wrap_v = WRAP_CLAMP;
    description.colors[0] = (ps_rgb){2, 2, 2};
    description.scale_u = 0.5;
    description.scale_v = -2; /* v' goes from 1 down to -1 */
    description.offset_v = 1;
    struct pigment pigment = pigment_create(&description, &texture);
    const float uv[2] = {1.1f, 0.27f};
    pigment_uv_gradient(&pigment, uv, -INFINITY, gradient);
    assert_float_equal(gradient[0], 2 * 3 * 5 * 0.5, 1e-3);
    assert_float_equal(gradient[1], 2 * -7 * 4 * -2, 1e-3);
    const float far[2] = {100.3f, -3.0f};
    pigment_uv_gradient(&pigment, far, -INFINITY, gradient);
    assert_float_equal(gradient[0], 0, 1e-6);
    assert_float_equal(gradient[1], 0, 1e-6);
    description.scale_u = 0;
    pigment = pigment_create(&description, &texture);
    pigment_uv_gradient(&pigment, uv, -INFINITY, gradient);
    assert_float_equal(gradient[0], 0, 0);
    description.scale_v = 0; /* turned: u' = v / 2, v' = 1 - 2 u */
    description.cross_u = 0.5;
    description.cross_v = -2;
    pigment = pigment_create(&description, &texture);
    const float turned[2] = {0.27f, 1.1f};
    pigment_uv_gradient(&pigment, turned, -INFINITY, gradient);
    assert_float_equal(gradient[0], 2 * -7 * 4 * -2, 1e-3);
    assert_float_equal(gradient[1], 2 * 3 * 5 * 0.5, 1e-3);
}

static void test_any_number(void **state)
{
    static const float wild[] = {NAN,         INFINITY, -INFINITY, 3e38f,
                                 -8388607.5f, 1e-40f,   2e9f,      -1e20f};
    struct texture texture = load_data("rgb8.png", ENCODING_AUTO);
    (void)state;
    for (int kind = PIGMENT_COLOR; kind <= PIGMENT_NOISE; kind++) {
        struct pigment_description description = describe(kind);
        description.turbulence = 1;
        struct pigment pigment = pigment_create(&description, &texture);
        for (int i = 0; i < 512; i++) {
            ps_vec3 p = {wild[i % 8], wild[i / 8 % 8], wild[i / 64]};
            const float uv[2] = {p.x, p.y};
            float gradient[2];
            float number = pigment_number(&pigment, p, uv);
            assert_true(number >= 0 && number <= 1);
            pigment_gradient(&pigment, p);
            pigment_uv_gradient(&pigment, uv, -INFINITY, gradient);
        }
    }
    texture_release(&texture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_color),
        cmocka_unit_test(test_checker_parity),
        cmocka_unit_test(test_checker_on_faces),
        cmocka_unit_test(test_placement),
        cmocka_unit_test(test_no_inverse),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_gradient_where_it_starts_over),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_octaves_are_kept_in_bounds),
        cmocka_unit_test(test_turbulence),
        cmocka_unit_test(test_image),
        cmocka_unit_test(test_image_scale_and_offset),
        cmocka_unit_test(test_slope_of_gradient),
        cmocka_unit_test(test_slope_of_noise),
        cmocka_unit_test(test_slope_of_clamped_noise),
        cmocka_unit_test(test_slope_of_image),
        cmocka_unit_test(test_any_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
