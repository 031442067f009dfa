/* test_voxel_cones.c: the volume and the cones of `voxel_cone`, on voxels made by hand: how levels
 * put voxels together, and what cones see in a box that shines, and of a wall. */
#include "../plugins/estimator/voxel_cone/cones.h"
#include "support/one_strategy.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define ACROSS 64
#define MOST_PARTS (8 * ACROSS * ACROSS)

struct fixture {
    struct bare_host bare;
    struct volume_part *parts;
    size_t count;
    struct volume volume;
};

static void start(struct fixture *fixture)
{
    bare_host_create(&fixture->bare, 2);
    fixture->parts = malloc(MOST_PARTS * sizeof *fixture->parts);
    fixture->count = 0;
    assert_non_null(fixture->parts);
}

static void build(struct fixture *fixture, uint32_t across)
{
    const struct voxel_grid grid = {{0, 0, 0}, 1.0f, across};
    assert_int_equal(
        volume_create(&fixture->bare.host, &grid, fixture->parts, fixture->count, &fixture->volume),
        PS_OK);
    assert_int_equal(volume_build_levels(&fixture->volume), PS_OK);
}

static void finish(struct fixture *fixture)
{
    volume_release(&fixture->volume);
    assert_int_equal(fixture->bare.live_allocations, 0);
    bare_host_release(&fixture->bare);
    free(fixture->parts);
}

/* A part with radiance `low` on the side against the axis, and `high` on that along it. */
static void add_part(struct fixture *fixture, const uint32_t place[3], uint32_t axis, float opacity,
                     float low, float high)
{
    assert_true(fixture->count < MOST_PARTS);
    fixture->parts[fixture->count++] = (struct volume_part){
        .x = place[0],
        .y = place[1],
        .z = place[2],
        .axis = axis,
        .opacity = opacity,
        .light = {{high, high, high}, {low, low, low}},
    };
}

/* A wall across an axis, one voxel thick. */
static void add_wall(struct fixture *fixture, uint32_t axis, uint32_t at, uint32_t from,
                     uint32_t to, float low, float high)
{
    for (uint32_t i = from; i < to; i++) {
        for (uint32_t j = from; j < to; j++) {
            uint32_t place[3];
            place[axis] = at;
            place[(axis + 1) % 3] = i;
            place[(axis + 2) % 3] = j;
            add_part(fixture, place, axis, 1.0f, low, high);
        }
    }
}

static double radiance(const struct fixture *fixture, ps_vec3 position, ps_vec3 direction,
                       float spread)
{
    ps_rgb found = cone_trace(&fixture->volume, spread, position, direction, direction);
    return (double)found.g;
}

/* --- levels --- */

/* A wall of one voxel stays opaque, and keeps its dark side, on all levels; beside it nothing is
 * there. */
static void test_levels(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture);
    add_wall(&fixture, 1, 37, 0, ACROSS, 0.0f, 3.0f);
    build(&fixture, ACROSS);
    assert_int_equal(fixture.volume.level_count, 7);
    for (uint32_t level = 0; level < 6; level++) {
        uint32_t at = 37 >> level, middle = 32 >> level;
        const struct voxel *voxel = volume_at(&fixture.volume.levels[level], middle, at, middle);
        assert_non_null(voxel);
        assert_float_equal(voxel->opacity[1], 1, 1e-6);
        assert_float_equal(voxel->opacity[0] + voxel->opacity[2], 0, 1e-6);
        assert_float_equal(voxel->light[volume_side(1, false)].g, 3, 1e-5);
        assert_float_equal(voxel->light[volume_side(1, true)].g, 0, 1e-6);
        assert_null(volume_at(&fixture.volume.levels[level], middle, at ^ 1u, middle));
    }
    assert_null(volume_at(&fixture.volume.levels[0], 64, 37, 0));
    assert_null(volume_at(&fixture.volume.levels[0], 0, UINT32_MAX, 0));
    finish(&fixture);
}

/* Shares of one surface that lies in two voxels behind each other add up; what is more than full is
 * hidden by what is before. */
static void test_pairs(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture);
    for (uint32_t i = 0; i < 4; i++) {
        add_part(&fixture, (const uint32_t[3]){4, i & 1, i >> 1}, 0, 0.25f, 0.25f, 0.5f);
        add_part(&fixture, (const uint32_t[3]){5, i & 1, i >> 1}, 0, 0.5f, 0.5f, 1.0f);
        add_part(&fixture, (const uint32_t[3]){8, i & 1, i >> 1}, 0, 0.75f, 0.75f, 0.75f);
        add_part(&fixture, (const uint32_t[3]){9, i & 1, i >> 1}, 0, 0.5f, 5.0f, 1.0f);
    }
    build(&fixture, 16);
    const struct voxel *pair = volume_at(&fixture.volume.levels[1], 2, 0, 0);
    assert_float_equal(pair->opacity[0], 0.75, 1e-6);
    assert_float_equal(pair->light[volume_side(0, true)].r, 0.75, 1e-6);
    assert_float_equal(pair->light[volume_side(0, false)].r, 1.5, 1e-6);
    pair = volume_at(&fixture.volume.levels[1], 4, 0, 0);
    assert_float_equal(pair->opacity[0], 1, 1e-6);
    assert_float_equal(pair->light[volume_side(0, true)].r, 0.75 + 5.0 / 2, 1e-5);
    assert_float_equal(pair->light[volume_side(0, false)].r, 1.0 + 0.75 * 2 / 3, 1e-5);
    finish(&fixture);
}

/* Light that is added on a coarse level is that level's light, on it and above, and radiance as on
 * a whole wall below. */
static void test_added_light(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture);
    add_wall(&fixture, 2, 5, 0, 16, 0, 0);
    build(&fixture, 16);
    size_t count = fixture.volume.levels[2].voxel_count;
    ps_rgb(*light)[6] = calloc(count, sizeof *light);
    assert_non_null(light);
    const struct voxel *lit = volume_at(&fixture.volume.levels[2], 1, 2, 1);
    light[lit - fixture.volume.levels[2].voxels][volume_side(2, false)] = (ps_rgb){1, 2, 3};
    volume_add_light(&fixture.volume, 2, (const ps_rgb(*)[6])light);
    for (uint32_t level = 0; level < 3; level++) {
        const struct voxel *voxel =
            volume_at(&fixture.volume.levels[level], 4 >> level, 8 >> level, 5 >> level);
        assert_float_equal(voxel->light[volume_side(2, false)].b, 3, 1e-6);
        assert_float_equal(voxel->light[volume_side(2, true)].b, 0, 1e-6);
    }
    assert_float_equal(
        volume_at(&fixture.volume.levels[0], 3, 8, 5)->light[volume_side(2, false)].b, 0, 1e-6);
    assert_float_equal(
        volume_at(&fixture.volume.levels[3], 0, 1, 0)->light[volume_side(2, false)].b, 0.75, 1e-6);
    free(light);
    finish(&fixture);
}

/* --- cones --- */

/* A wall that covers a half passes a half of what is behind it, at any slope, and nothing gets
 * through whole ones. */
static void test_transmittance(void **state)
{
    (void)state;
    static const float spreads[] = {0.0f, 0.1f, 0.3f};
    struct fixture fixture;
    start(&fixture);
    for (uint32_t i = 0; i < ACROSS * ACROSS; i++) {
        add_part(&fixture, (const uint32_t[3]){20, i % ACROSS, i / ACROSS}, 0, 0.5f, 0.5f, 0.0f);
        add_part(&fixture, (const uint32_t[3]){40, i % ACROSS, i / ACROSS}, 0, 1.0f, 3.0f, 0.0f);
        add_part(&fixture, (const uint32_t[3]){42, i % ACROSS, i / ACROSS}, 0, 1.0f, 9.0f, 0.0f);
    }
    build(&fixture, ACROSS);
    for (size_t i = 0; i < sizeof spreads / sizeof spreads[0]; i++) {
        for (int step = 0; step < 6; step++) {
            float slope = 0.1f * (float)step;
            ps_vec3 direction = ps_normalize((ps_vec3){1, slope, 0.5f * slope});
            double found = radiance(&fixture, (ps_vec3){3.4f, 15, 22}, direction, spreads[i]);
            assert_float_equal(found, 0.5 + 0.5 * 3, 1e-4);
        }
    }
    /* the backs are dark */
    assert_float_equal(radiance(&fixture, (ps_vec3){60, 15, 22}, (ps_vec3){-1, 0, 0}, 0), 0, 1e-6);
    finish(&fixture);
}

/* Cones leave a wall that they stand on, and see another one at its foot. */
static void test_own_surface(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture);
    add_wall(&fixture, 2, 10, 0, ACROSS, 0, 0);
    for (uint32_t y = 0; y < ACROSS; y++)
        for (uint32_t z = 10; z < ACROSS; z++)
            add_part(&fixture, (const uint32_t[3]){50, y, z}, 0, 1.0f, 1.0f, 0.0f);
    build(&fixture, ACROSS);
    const ps_vec3 up = {0, 0, 1};
    for (int step = 0; step < 4; step++) {
        ps_vec3 floor_point = {45.2f, 30, 10.05f + 0.3f * (float)step};
        ps_vec3 low = ps_normalize((ps_vec3){1, 0.1f, 0.1f});
        ps_rgb seen = cone_trace(&fixture.volume, 0.05f, floor_point, up, low);
        assert_float_equal(seen.g, 1, 1e-4);
        seen = cone_trace(&fixture.volume, 0.05f, floor_point, up, ps_scale(low, -1.0f));
        assert_float_equal(seen.g, 0, 1e-6);
    }
    finish(&fixture);
}

/* In a closed box that shines a cone sees the same light everywhere, but for what its edges let
 * through. */
static void test_box(void **state)
{
    (void)state;
    static const struct {
        uint32_t cones;
        double least;
    } cases[] = {{5, 0.85}, {9, 0.98}, {16, 0.98}, {64, 0.98}};
    struct fixture fixture;
    struct cone cones[64];
    start(&fixture);
    for (uint32_t axis = 0; axis < 3; axis++) {
        add_wall(&fixture, axis, 9, 9, 54, 0, 1);
        add_wall(&fixture, axis, 53, 9, 54, 1, 0);
    }
    build(&fixture, ACROSS);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t n = cases[i].cones;
        cones_make(n, cones);
        for (int step = 0; step < 8; step++) {
            ps_vec3 position = {11.3f + 5.0f * (float)step, 30.7f, 9.4f};
            ps_rgb found =
                cones_irradiance(&fixture.volume, cones, n, position, (ps_vec3){0, 0, 1}, 0.3f);
            assert_in_range((int)lround(1e4 * (double)found.g / PI), (int)(1e4 * cases[i].least),
                            10001);
        }
    }
    finish(&fixture);
}

/* The cones' axes have the mean height 2/3 that the cosine asks for, and look into all directions
 * alike. */
static void test_cones(void **state)
{
    (void)state;
    static struct cone cones[CONES_MOST];
    static const uint32_t counts[] = {5, 16, 100, CONES_MOST};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        double n = counts[i], x = 0, y = 0, z = 0;
        cones_make(counts[i], cones);
        for (uint32_t k = 0; k < counts[i]; k++) {
            assert_float_equal(ps_length(cones[k].axis), 1, 1e-5);
            assert_true(cones[k].axis.z > 0.0f && cones[k].spread <= cones[k].axis.z);
            x += (double)cones[k].axis.x / n;
            y += (double)cones[k].axis.y / n;
            z += (double)cones[k].axis.z / n;
        }
        assert_float_equal(z, 2.0 / 3, 0.2 / n);
        assert_float_equal(x * x + y * y, 0, 1 / n / n);
    }
}

/* Points far away, and places that are no numbers, see nothing. */
static void test_outside(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture);
    add_wall(&fixture, 0, 5, 0, 16, 1, 1);
    build(&fixture, 16);
    const ps_vec3 ahead = {1, 0, 0}, back = {-1, 0, 0};
    assert_float_equal(radiance(&fixture, (ps_vec3){-1e9f, 8, 8}, ahead, 0), 0, 1e-6);
    assert_float_equal(radiance(&fixture, (ps_vec3){NAN, 8, 8}, ahead, 0), 0, 1e-6);
    assert_float_equal(radiance(&fixture, (ps_vec3){-30, 8, 8}, ahead, 0), 1, 1e-6);
    assert_float_equal(radiance(&fixture, (ps_vec3){-30, 8, 8}, back, 0), 0, 1e-6);
    assert_float_equal(radiance(&fixture, (ps_vec3){30, 8, 8}, back, 0.3f), 1, 1e-6);
    finish(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_levels),      cmocka_unit_test(test_pairs),
        cmocka_unit_test(test_added_light), cmocka_unit_test(test_transmittance),
        cmocka_unit_test(test_own_surface), cmocka_unit_test(test_box),
        cmocka_unit_test(test_cones),       cmocka_unit_test(test_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
