/* test_light_grid.c: spherical harmonics of order 1, and the grids of `lpv`: flux stays, walls stop
 * it, cascades keep light apart by where it comes from. */
#include "../plugins/estimator/lpv/cascades.h"
#include "support/one_strategy.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define ACROSS 12

static const ps_rgb white = {1, 1, 1};

/* --- spherical harmonics --- */

/* Directions that cover the sphere evenly. */
static ps_vec3 direction_of(int i, int n)
{
    double z = 1 - (2 * i + 1.0) / n, radius = sqrt(1 - z * z), angle = 2.39996322973 * i;
    return (ps_vec3){(float)(radius * cos(angle)), (float)(radius * sin(angle)), (float)z};
}

static float sh_evaluate(const struct sh *f, ps_vec3 w)
{
    return f->c[0] * SH_Y0 + (f->c[1] * w.x + f->c[2] * w.y + f->c[3] * w.z) * SH_Y1;
}

/* Coefficients are the integrals of the function times each basis function, and reproduce order
 * 1. */
static void test_clamped_cosine(void **state)
{
    (void)state;
    enum { DIRECTIONS = 20000 };
    const ps_vec3 axis = ps_normalize((ps_vec3){1, -2, 0.5f});
    const ps_vec3 other = ps_normalize((ps_vec3){-1, 1, 3});
    struct sh f = sh_clamped_cosine(axis), g = sh_clamped_cosine(other), sums = {{0}};
    double integral = 0, product = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        ps_vec3 w = direction_of(i, DIRECTIONS);
        float value = ps_max(ps_dot(w, axis), 0.0f) * (float)(4 * PI / DIRECTIONS);
        const struct sh basis = {{SH_Y0, SH_Y1 * w.x, SH_Y1 * w.y, SH_Y1 * w.z}};
        sh_add_scaled(&sums, value, &basis);
        integral += 4 * PI / DIRECTIONS * (double)sh_evaluate(&f, w);
        product += 4 * PI / DIRECTIONS * (double)(sh_evaluate(&f, w) * sh_evaluate(&g, w));
    }
    for (int i = 0; i < 4; i++)
        assert_float_equal(f.c[i], sums.c[i], 1e-3);
    assert_float_equal(integral, PI, 1e-3);
    assert_float_equal(sh_integral(&f), PI, 1e-5);
    assert_float_equal(sh_dot(&f, &g), product, 1e-3);
    assert_float_equal(sh_evaluate(&f, axis), 0.75, 1e-5);
    assert_float_equal(sh_evaluate(&f, ps_scale(axis, -1.0f)), -0.25, 1e-5);
}

/* --- one grid --- */

struct fixture {
    struct bare_host bare;
    struct blockers blockers;
    struct light_grid light;
};

/* A ps_host.intersect: a wall across x at 6.3, below y = 5.2. */
static void intersect_wall(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    (void)host;
    for (size_t i = 0; i < n; i++) {
        float distance = (6.3f - rays[i].origin.x) / rays[i].direction.x;
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
        ps_vec3 at = ps_add_scaled(rays[i].origin, distance, rays[i].direction);
        if (rays[i].direction.x == 0.0f || distance <= rays[i].tnear || distance >= rays[i].tfar ||
            at.y > 5.2f)
            continue;
        hits[i].distance = distance;
        hits[i].position = at;
        hits[i].geometric_normal = (ps_vec3){rays[i].direction.x > 0 ? -1.0f : 1.0f, 0, 0};
    }
}

static void intersect_nothing(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    (void)host, (void)rays;
    for (size_t i = 0; i < n; i++)
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
}

static void start(struct fixture *fixture, uint32_t threads,
                  void (*intersect)(const ps_host *, const ps_ray *, size_t, ps_hit *))
{
    const struct voxel_grid grid = {{0, 0, 0}, 1.0f, ACROSS};
    bare_host_create(&fixture->bare, threads);
    fixture->bare.host.intersect = intersect;
    const struct surface_lines lines = {&fixture->bare.host, grid, 4, 1e-4f};
    assert_int_equal(blockers_create(&lines, &fixture->blockers), PS_OK);
    assert_int_equal(light_grid_create(&fixture->bare.host, &grid, &fixture->light), PS_OK);
}

static void finish(struct fixture *fixture)
{
    light_grid_release(&fixture->light);
    blockers_release(&fixture->blockers);
    assert_int_equal(fixture->bare.live_allocations, 0);
    bare_host_release(&fixture->bare);
}

static const struct sh_rgb *cell_of(const struct sh_rgb *cells, int x, int y, int z)
{
    return &cells[(z * ACROSS + y) * ACROSS + x];
}

static double power_under_way(const struct light_grid *light)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)ACROSS * ACROSS * ACROSS; i++)
        sum += (double)sh_integral(&light->now[i].g);
    return sum;
}

/* As long as no light reaches the border, all of it is there after each step, and more of it where
 * it shines to. */
static void test_flux_stays(void **state)
{
    (void)state;
    struct fixture fixture;
    const ps_vec3 axis = ps_normalize((ps_vec3){1, 2, 3});
    start(&fixture, 2, intersect_nothing);
    light_grid_inject(&fixture.light, (ps_vec3){5.2f, 6.7f, 5.5f}, axis, white);
    assert_float_equal(power_under_way(&fixture.light), 1, 1e-5);
    for (int step = 1; step <= 4; step++) {
        assert_int_equal(light_grid_propagate(&fixture.light, &fixture.blockers, 1, 0), PS_OK);
        assert_float_equal(power_under_way(&fixture.light), 1, 1e-4);
    }
    ps_vec3 middle = {0, 0, 0};
    for (int i = 0; i < ACROSS * ACROSS * ACROSS; i++) {
        int x = i % ACROSS - 5, y = i / ACROSS % ACROSS - 6, z = i / (ACROSS * ACROSS) - 5;
        middle = ps_add_scaled(middle, sh_integral(&fixture.light.now[i].g),
                               (ps_vec3){(float)x, (float)y, (float)z});
    }
    assert_true(ps_dot(ps_normalize(middle), axis) > 0.98f);
    finish(&fixture);
}

/* A wall stops what crosses it, and a part of it that part; it stands at the nearest face. */
static void test_wall(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture, 1, intersect_wall);
    const uint32_t low[3] = {6, 2, 3}, edge[3] = {6, 5, 3}, high[3] = {6, 8, 3},
                   next[3] = {7, 2, 3};
    const float *faces = fixture.blockers.faces[0];
    const struct voxel_grid *grid = &fixture.light.grid;
    assert_float_equal(faces[blockers_face(grid, 0, low)], 1, 1e-6);
    assert_float_equal(faces[blockers_face(grid, 0, edge)], 0.25, 1e-6); /* of four lines, one */
    assert_float_equal(faces[blockers_face(grid, 0, high)], 0, 1e-6);
    assert_float_equal(faces[blockers_face(grid, 0, next)], 0, 1e-6);
    light_grid_inject(&fixture.light, (ps_vec3){5.5f, 2.5f, 3.5f}, (ps_vec3){1, 0, 0}, white);
    light_grid_inject(&fixture.light, (ps_vec3){5.5f, 5.5f, 8.5f}, (ps_vec3){1, 0, 0}, white);
    light_grid_inject(&fixture.light, (ps_vec3){5.5f, 8.5f, 3.5f}, (ps_vec3){1, 0, 0}, white);
    assert_int_equal(light_grid_propagate(&fixture.light, &fixture.blockers, 1, 0), PS_OK);
    const struct sh_rgb *now = fixture.light.now;
    float open = cell_of(now, 6, 8, 3)->g.c[0];
    assert_true(open > 0.1f);
    assert_float_equal(cell_of(now, 6, 2, 3)->g.c[0], 0, 1e-9);
    assert_float_equal(cell_of(now, 6, 5, 8)->g.c[0], 0.75f * open, 1e-5);
    finish(&fixture);
}

/* Light from all sides alike gives pi times its radiance; cells below the surface do not count. */
static void test_irradiance(void **state)
{
    (void)state;
    struct fixture fixture;
    start(&fixture, 1, intersect_nothing);
    for (int i = 0; i < ACROSS * ACROSS * ACROSS; i++) {
        int below = i % ACROSS < 5;
        fixture.light.field[i] = (struct sh_rgb){{{0}}, {{below ? 100.0f : 1.0f / SH_Y0}}, {{0}}};
    }
    for (int step = 0; step < 5; step++) { /* the surface is in one of the cells 4 and 5 */
        ps_vec3 position = {4.55f + 0.2f * (float)step, 6.2f, 7.3f};
        ps_rgb found = light_grid_irradiance(&fixture.light, position, (ps_vec3){1, 0, 0});
        assert_float_equal(found.g, PI * 2 / 3, 1e-4);
        assert_float_equal(found.r, 0, 1e-6);
    }
    ps_rgb outside = light_grid_irradiance(&fixture.light, (ps_vec3){40, 1, 1}, (ps_vec3){1, 0, 0});
    assert_float_equal(outside.g, 0, 1e-9);
    finish(&fixture);
}

static void test_threads(void **state)
{
    (void)state;
    struct fixture one, many;
    start(&one, 1, intersect_wall);
    start(&many, 4, intersect_wall);
    for (int i = 0; i < 2; i++) {
        struct fixture *fixture = i ? &many : &one;
        light_grid_inject(&fixture->light, (ps_vec3){3, 2, 3}, (ps_vec3){1, 0, 0}, white);
        assert_int_equal(light_grid_propagate(&fixture->light, &fixture->blockers, 20, 0.01),
                         PS_OK);
    }
    assert_memory_equal(one.light.field, many.light.field,
                        sizeof *one.light.field * ACROSS * ACROSS * ACROSS);
    many.bare.cancelled = true;
    assert_int_equal(light_grid_propagate(&many.light, &many.blockers, 20, 0), PS_CANCELLED);
    finish(&one);
    finish(&many);
}

/* --- cascades --- */

static void ignore_progress(const ps_host *host, double fraction)
{
    (void)host, (void)fraction;
}

static ps_rgb lit_by(struct bare_host *bare, uint32_t count, ps_vec3 source, ps_vec3 position)
{
    struct cascades cascades;
    const ps_pass pass = {.surface_offset = 1e-3f};
    const struct cascades_setting setting = {.host = &bare->host,
                                             .pass = &pass,
                                             .focus = {-20, 10, 0},
                                             .count = count,
                                             .across = 16,
                                             .lines_per_cell = 1};
    const ps_photon photon = {
        .position = source, .normal = {1, 0, 0}, .power = {1, 1, 1}, .lobe = PS_DIFFUSE};
    assert_int_equal(cascades_create(&setting, &cascades), PS_OK);
    assert_int_equal(cascades.count, count);
    assert_true(cascades_inject(&cascades, &photon));
    assert_int_equal(cascades_propagate(&cascades, 100, 0), PS_OK);
    ps_rgb found = cascades_irradiance(&cascades, position, (ps_vec3){-1, 0, 0});
    cascades_release(&cascades);
    return found;
}

/* Far from the finer grid, or by light from out of it, all is as without it; inside it is not. */
static void test_cascades(void **state)
{
    (void)state;
    struct bare_host bare;
    const ps_vec3 inside = {-30, 5, 0}, other_inside = {5, 15, 2}, outside = {85, 5, 3},
                  far_side = {-90, 0, 5};
    bare_host_create(&bare, 2);
    bare.host.intersect = intersect_nothing;
    bare.host.progress = ignore_progress;
    assert_float_equal(lit_by(&bare, 2, inside, outside).g, lit_by(&bare, 1, inside, outside).g,
                       1e-9);
    assert_float_equal(lit_by(&bare, 2, far_side, inside).g, lit_by(&bare, 1, far_side, inside).g,
                       1e-9);
    double fine = (double)lit_by(&bare, 2, inside, other_inside).g;
    double coarse = (double)lit_by(&bare, 1, inside, other_inside).g;
    assert_true(fine > 0 && fabs(fine / coarse - 1) > 0.01);
    assert_int_equal(bare.live_allocations, 0);
    bare_host_release(&bare);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clamped_cosine), cmocka_unit_test(test_flux_stays),
        cmocka_unit_test(test_wall),           cmocka_unit_test(test_irradiance),
        cmocka_unit_test(test_threads),        cmocka_unit_test(test_cascades),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
