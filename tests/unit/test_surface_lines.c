/* test_surface_lines.c: lines through a grid find both sides of a sphere, with its area, whatever
 * the grid's shift; and places and cells of grids. */
#include "../plugins/estimator/shared/surface_lines.h"
#include "support/one_strategy.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define RADIUS 40.0

/* A ps_host.intersect: the sphere of RADIUS around (10, 20, 30). */
static void intersect_sphere(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits)
{
    (void)host;
    for (size_t i = 0; i < n; i++) {
        ps_vec3 from = ps_subtract(rays[i].origin, (ps_vec3){10, 20, 30});
        double half = -(double)ps_dot(from, rays[i].direction);
        double inside = half * half - (double)ps_dot(from, from) + RADIUS * RADIUS;
        hits[i] = (ps_hit){.distance = INFINITY, .object = PS_NO_OBJECT};
        for (int end = 0; inside >= 0 && end < 2; end++) {
            double distance = half + (end ? 1 : -1) * sqrt(inside);
            if (distance <= (double)rays[i].tnear || distance >= (double)rays[i].tfar ||
                hits[i].distance < INFINITY)
                continue;
            ps_vec3 at = ps_add_scaled(rays[i].origin, (float)distance, rays[i].direction);
            ps_vec3 normal = ps_normalize(ps_subtract(at, (ps_vec3){10, 20, 30}));
            hits[i].distance = (float)distance;
            hits[i].position = at;
            hits[i].geometric_normal = end ? ps_scale(normal, -1.0f) : normal;
        }
    }
}

struct found {
    const struct surface_lines *lines;
    double area[2];             /* outside, inside */
    double moments[3];          /* of the normals outside: mean squares, over the area */
    uint32_t met[SURFACE_WAYS]; /* lines that met something */
    uint32_t crossings, wrong_rounds;
};

static void take(void *user, struct surface_crossings *crossings)
{
    struct found *found = user;
    for (size_t i = 0; i < crossings->n; i++) {
        ps_vec3 n = crossings->hits[i].geometric_normal;
        ps_vec3 out = ps_subtract(crossings->hits[i].position, (ps_vec3){10, 20, 30});
        int inside = ps_dot(n, out) < 0.0f;
        double step = (double)found->lines->grid.side / found->lines->per_cell;
        double area = step * step * (double)surface_lines_area(n);
        found->area[inside] += area;
        found->moments[0] += inside ? 0 : area * (double)(n.x * n.x);
        found->moments[1] += inside ? 0 : area * (double)(n.y * n.y);
        found->moments[2] += inside ? 0 : area * (double)(n.z * n.z);
        found->met[crossings->way] += crossings->round == 0;
        found->wrong_rounds += crossings->round != (uint32_t)inside;
        found->crossings++;
    }
}

static struct found follow_all(const float shift[3], uint32_t across, uint32_t per_cell)
{
    struct bare_host bare;
    bare_host_create(&bare, 1);
    bare.host.intersect = intersect_sphere;
    const struct surface_lines lines = {
        .host = &bare.host,
        .grid = voxel_grid_around((ps_vec3){10, 20, 30}, (float)RADIUS, across, shift),
        .per_cell = per_cell,
        .offset = 1e-3f,
    };
    struct found found = {.lines = &lines};
    for (uint32_t way = 0; way < SURFACE_WAYS; way++)
        for (uint32_t row = 0; row < surface_lines_across(&lines); row++)
            surface_lines_follow(&lines, way, row, take, &found);
    bare_host_release(&bare);
    found.lines = NULL;
    return found;
}

static void expect_near(double value, double expected, double tolerance)
{
    if (!(fabs(value / expected - 1) < tolerance))
        fail_msg("%g, expected %g", value, expected);
}

static void test_sphere(void **state)
{
    (void)state;
    static const float shifts[][3] = {{0, 0, 0}, {0.3f, 0.9f, 0.5f}};
    const double area = 4 * PI * RADIUS * RADIUS;
    for (size_t i = 0; i < sizeof shifts / sizeof shifts[0]; i++) {
        struct found found = follow_all(shifts[i], 40, 3);
        expect_near(found.area[0], area, 0.002);
        expect_near(found.area[1], area, 0.002);
        for (int k = 0; k < 3; k++)
            expect_near(found.moments[k], area / 3, 0.005);
        assert_int_equal(found.wrong_rounds, 0);
        for (uint32_t way = 0; way < 3; way++)
            assert_int_equal(found.met[way], found.met[way + 3]);
    }
}

/* More lines than fit into a batch. */
static void test_long_rows(void **state)
{
    (void)state;
    const float shift[3] = {0, 0, 0};
    struct found found = follow_all(shift, 100, 4);
    expect_near(found.area[0], 4 * PI * RADIUS * RADIUS, 0.0005);
    assert_int_equal(found.wrong_rounds, 0);
}

static void test_grid(void **state)
{
    (void)state;
    const float shift[3] = {0.25f, 0.0f, 1.0f};
    const struct voxel_grid grid = voxel_grid_around((ps_vec3){5, 5, 5}, 10, 21, shift);
    uint32_t cell[3];
    float place[3], share;
    assert_float_equal(grid.side, 2 * 10.01 / 20, 1e-5);
    for (int end = -1; end <= 1; end += 2) { /* both ends of the sphere are inside */
        float at = 5.0f + 10.0f * (float)end;
        assert_true(voxel_grid_cell(&grid, (ps_vec3){at, 5, 5}, cell));
        assert_true(voxel_grid_cell(&grid, (ps_vec3){5, at, 5}, cell));
        assert_true(voxel_grid_cell(&grid, (ps_vec3){5, 5, at}, cell));
    }
    assert_false(voxel_grid_cell(&grid, (ps_vec3){5, 5, 5 - 12}, cell));
    assert_false(voxel_grid_cell(&grid, (ps_vec3){5 + 12, 5, 5}, cell));
    assert_false(voxel_grid_cell(&grid, (ps_vec3){NAN, 5, 5}, cell));
    voxel_grid_place(&grid, ps_add_scaled(grid.corner, grid.side, (ps_vec3){1, 2.5f, 3}), place);
    assert_float_equal(place[0], 1, 1e-4);
    assert_float_equal(place[1], 2.5, 1e-4);
    assert_float_equal(place[2], 3, 1e-4);
    assert_int_equal(voxel_between(2.75f, &share), 2);
    assert_float_equal(share, 0.25, 1e-6);
    assert_int_equal(voxel_between(0.25f, &share), -1);
    assert_float_equal(share, 0.75, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_long_rows),
        cmocka_unit_test(test_grid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
