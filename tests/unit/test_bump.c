/* test_bump.c: bent normals against those of the surface that the relief stands for. */
#include "scene/bump.h"
#include "texture_fixture.h"
#include <psplat/math.h>

#define SIDE 256

static void assert_direction(ps_vec3 n, ps_vec3 expected, float tolerance)
{
    assert_float_equal(ps_length(n), 1, 1e-5);
    expected = ps_normalize(expected);
    if (!(ps_length(ps_subtract(n, expected)) <= tolerance)) {
        fail_msg("(%g, %g, %g) is not (%g, %g, %g)", n.x, n.y, n.z, expected.x, expected.y,
                 expected.z);
    }
}

static struct pigment height_image(const struct texture *texture, float height)
{
    struct pigment_description description = {.kind = PIGMENT_IMAGE,
                                              .colors = {{height, height, height}},
                                              .scale_u = 1,
                                              .scale_v = 1,
                                              .placement = AFFINE_IDENTITY};
    return pigment_create(&description, texture);
}

/* sin(2 pi u) + sin(4 pi v), 2 periods upwards, as a picture. */
static void fill_waves(float *samples)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        float u = ((float)(i % SIDE) + 0.5f) / SIDE, v = 1 - ((float)(i / SIDE) + 0.5f) / SIDE;
        samples[i] = sinf(2 * PS_PI * u) + sinf(4 * PS_PI * v);
    }
}

/* A plane with any edges, even mirrored ones, raised by the waves: its normal is the cross product
 * of the raised surface's derivatives. */
static void assert_waves(const struct texture *texture, ps_vec3 dpdu, ps_vec3 dpdv, float side)
{
    const float height = 0.1f;
    struct pigment pigment = height_image(texture, height);
    ps_vec3 n = ps_scale(ps_normalize(ps_cross(dpdu, dpdv)), side);
    for (float u = -0.37f; u < 1; u += 0.11f) {
        for (float v = 0.01f; v < 1; v += 0.13f) {
            const float uv[2] = {u, v};
            float slope_u = height * 2 * PS_PI * cosf(2 * PS_PI * u);
            float slope_v = height * 4 * PS_PI * cosf(4 * PS_PI * v);
            ps_vec3 raised =
                ps_cross(ps_add_scaled(dpdu, slope_u, n), ps_add_scaled(dpdv, slope_v, n));
            ps_vec3 bent = bump_bump(&pigment, (ps_vec3){1, 2, 3}, uv, -INFINITY, n, dpdu, dpdv);
            assert_direction(bent, ps_scale(raised, side), 2e-3f);
            assert_true(ps_dot(bent, n) > 0);
        }
    }
}

static void test_bump_of_waves(void **state)
{
    static float samples[SIDE * SIDE];
    struct texture texture = texture_of(samples, SIDE, SIDE, 1);
    (void)state;
    fill_waves(samples);
    for (float side = -1; side <= 1; side += 2) {
        assert_waves(&texture, (ps_vec3){1, 0, 0}, (ps_vec3){0, 1, 0}, side);
        assert_waves(&texture, (ps_vec3){0, 1, 0}, (ps_vec3){1, 0, 0}, side);
        assert_waves(&texture, (ps_vec3){2, 0.3f, 1}, (ps_vec3){-0.5f, 0.2f, 1}, side);
    }
}

static void test_bump_without_uv(void **state)
{
    static float samples[SIDE * SIDE];
    struct texture texture = texture_of(samples, SIDE, SIDE, 1);
    struct pigment pigment = height_image(&texture, 1);
    const float uv[2] = {0.1f, 0.2f};
    const ps_vec3 none = {0, 0, 0}, n = {0.6f, 0, 0.8f}, x = {1, 0, 0};
    (void)state;
    fill_waves(samples);
    assert_direction(bump_bump(&pigment, none, uv, -INFINITY, n, none, none), n, 0);
    assert_direction(bump_bump(&pigment, none, uv, -INFINITY, n, x, none), n, 0);
    assert_direction(bump_bump(&pigment, none, uv, -INFINITY, n, x, ps_scale(x, 2)), n, 0);
}

static struct pigment pattern(enum pigment_kind kind, float height)
{
    struct pigment_description description = {.kind = kind,
                                              .colors = {{0, 0, 0}, {height, height, height}},
                                              .placement = AFFINE_IDENTITY,
                                              .axis = {1, 0, 0},
                                              .octaves = 3};
    return pigment_create(&description, NULL);
}

/* A ramp of slope 1/2 along x: raising a plane through it gives a plane. */
static void test_bump_of_ramp(void **state)
{
    struct pigment ramp = pattern(PIGMENT_GRADIENT, 0.5f);
    const ps_vec3 none = {0, 0, 0}, p = {0.4f, 3, 2};
    const float uv[2] = {0, 0};
    (void)state;
    assert_direction(bump_bump(&ramp, p, uv, -INFINITY, (ps_vec3){0, 0, 1}, none, none),
                     (ps_vec3){-0.5f, 0, 1}, 1e-4f);
    assert_direction(bump_bump(&ramp, p, uv, -INFINITY, (ps_vec3){0, 0, -1}, none, none),
                     (ps_vec3){-0.5f, 0, -1}, 1e-4f);
    /* Along the normal it changes nothing. */
    assert_direction(bump_bump(&ramp, p, uv, -INFINITY, (ps_vec3){1, 0, 0}, none, none),
                     (ps_vec3){1, 0, 0}, 1e-4f);
}

/* A plane raised by noise, with its normal from the raised points themselves. */
static void test_bump_of_noise(void **state)
{
    struct pigment noise = pattern(PIGMENT_NOISE, 0.4f);
    const float uv[2] = {0, 0}, h = 2e-3f;
    const ps_vec3 none = {0, 0, 0}, n = {0, 1, 0};
    double largest = 0;
    (void)state;
    for (int i = 0; i < 200; i++) {
        ps_vec3 p = {(float)i * 0.173f, 0, (float)(i % 17) * 0.31f}, q = p, r = p;
        q.x += h;
        r.z += h;
        p.x -= h;
        float slope_x = (pigment_number(&noise, q, uv) - pigment_number(&noise, p, uv)) / (2 * h);
        p.x += h;
        p.z -= h;
        float slope_z = (pigment_number(&noise, r, uv) - pigment_number(&noise, p, uv)) / (2 * h);
        p.z += h;
        ps_vec3 expected = {-slope_x, 1, -slope_z};
        assert_direction(bump_bump(&noise, p, uv, -INFINITY, n, none, none), expected, 5e-3f);
        largest = fmax(largest, hypot(slope_x, slope_z));
    }
    assert_true(largest > 0.3);
}

static void test_constant_height(void **state)
{
    struct pigment flat = pattern(PIGMENT_COLOR, 1);
    const float uv[2] = {0.3f, 0.4f};
    const ps_vec3 n = {0.6f, 0, 0.8f}, x = {1, 0, 0}, y = {0, 1, 0};
    float samples[4] = {0.7f, 0.7f, 0.7f, 0.7f};
    struct texture texture = texture_of(samples, 2, 2, 1);
    struct pigment image = height_image(&texture, 3);
    (void)state;
    assert_direction(bump_bump(&flat, x, uv, -INFINITY, n, x, y), n, 0);
    assert_direction(bump_bump(&image, x, uv, -INFINITY, n, x, y), n, 1e-6f);
}

/* --- maps of normals ------------------------------------------------------------------------- */

static void test_map_of_constant_tilt(void **state)
{
    float samples[3] = {0.5f + 0.5f * 0.48f, 0.5f + 0.5f * 0.36f, 0.5f + 0.5f * 0.8f};
    struct texture map = texture_of(samples, 1, 1, 3);
    const float uv[2] = {0.3f, 0.4f};
    const ps_vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, minus_x = {-3, 0, 0};
    (void)state;
    assert_direction(bump_normal_map(&map, uv, -INFINITY, z, x, y), (ps_vec3){0.48f, 0.36f, 0.8f},
                     1e-6f);
    /* Stretched and slanted: u stays, v is made upright. */
    assert_direction(bump_normal_map(&map, uv, -INFINITY, z, ps_scale(x, 9), (ps_vec3){4, 2, 1}),
                     (ps_vec3){0.48f, 0.36f, 0.8f}, 1e-6f);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, z, minus_x, y),
                     (ps_vec3){-0.48f, 0.36f, 0.8f}, 1e-6f);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, z, x, ps_scale(y, -1)),
                     (ps_vec3){0.48f, -0.36f, 0.8f}, 1e-6f);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, x, y, z), (ps_vec3){0.8f, 0.48f, 0.36f},
                     1e-6f);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, ps_scale(z, -1), x, y),
                     (ps_vec3){0.48f, 0.36f, -0.8f}, 1e-6f);
}

/* The same relief as heights and as normals bends normals the same way. */
static void test_map_agrees_with_bump(void **state)
{
    float heights[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2}; /* falls upwards, along v, by 3 over 0..1 */
    struct texture height_map = texture_of(heights, 3, 3, 1);
    struct pigment pigment = height_image(&height_map, 1);
    const float uv[2] = {0.5f, 0.5f}, along = 3 / sqrtf(10), up = 1 / sqrtf(10);
    float samples[3] = {0.5f, 0.5f + 0.5f * along, 0.5f + 0.5f * up};
    struct texture map = texture_of(samples, 1, 1, 3);
    const ps_vec3 x = {0, 1, 0}, y = {0, 0, 1}, n = {1, 0, 0};
    (void)state;
    height_map.wrap_u = height_map.wrap_v = WRAP_CLAMP;
    ps_vec3 bumped = bump_bump(&pigment, n, uv, -INFINITY, n, x, y);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, x, y), bumped, 1e-5f);
}

static void test_flat_map(void **state)
{
    static uint8_t bytes[3] = {128, 128, 255};
    static float table[256];
    float half[3] = {0.5f, 0.5f, 1};
    struct texture map = texture_of(half, 1, 1, 3);
    const float uv[2] = {0.3f, 0.4f};
    const ps_vec3 n = {0.6f, 0, 0.8f}, x = {0.8f, 0, -0.6f}, y = {0, 1, 0};
    (void)state;
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, x, y), n, 1e-6f);
    for (int i = 0; i < 256; i++) {
        table[i] = (float)i / 255;
    }
    map.raster.sample = RASTER_BYTE;
    map.levels[0].bytes = bytes;
    map.texel_bytes = 3;
    map.color_of = map.alpha_of = table;
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, x, y), n, 1e-6f);
}

static void test_impossible_maps(void **state)
{
    float samples[3] = {0.5f, 0.5f, 0}; /* points into the surface */
    struct texture map = texture_of(samples, 1, 1, 3);
    const float uv[2] = {NAN, INFINITY};
    const ps_vec3 n = {0, 0, 1}, x = {1, 0, 0}, y = {0, 1, 0}, none = {0, 0, 0};
    (void)state;
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, x, y), n, 1e-6f);
    samples[0] = 1;
    assert_true(bump_normal_map(&map, uv, -INFINITY, n, x, y).z > 0);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, none, none), n, 0);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, x, x), n, 0);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, n, y), n, 0);
    assert_direction(bump_normal_map(&map, uv, -INFINITY, n, (ps_vec3){NAN, 0, 0}, y), n, 0);
    samples[1] = 3e38f;
    assert_true(bump_normal_map(&map, uv, -INFINITY, n, x, y).z > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bump_of_waves),        cmocka_unit_test(test_bump_without_uv),
        cmocka_unit_test(test_bump_of_ramp),         cmocka_unit_test(test_bump_of_noise),
        cmocka_unit_test(test_constant_height),      cmocka_unit_test(test_map_of_constant_tilt),
        cmocka_unit_test(test_map_agrees_with_bump), cmocka_unit_test(test_flat_map),
        cmocka_unit_test(test_impossible_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
