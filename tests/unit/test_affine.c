/* test_affine.c: affine maps: composition, inverse, normals, and which are similarities. */
#include "scene/affine.h"

#include "support/mesh_facts.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const struct affine sheared = {{2, 0, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};

static void test_compose_applies_the_inner_one_first(void **state)
{
    (void)state;
    struct affine turn = affine_of((ps_vec3){1, 1, 1}, (ps_vec3){0, 0, 90}, (ps_vec3){1, 0, 0});
    struct affine both = affine_compose(&turn, &sheared);
    ps_vec3 p = affine_point(&turn, affine_point(&sheared, (ps_vec3){1, 2, 3}));
    ps_vec3 q = affine_point(&both, (ps_vec3){1, 2, 3});
    expect_vector(p, -11, 10.5, 19);
    expect_vector(q, (double)p.x, (double)p.y, (double)p.z);
}

static void test_determinant(void **state)
{
    (void)state;
    struct affine mirror =
        affine_of((ps_vec3){-2, 3, 4}, (ps_vec3){10, 20, 30}, (ps_vec3){1, 2, 3});
    struct affine flat = affine_of((ps_vec3){1, 0, 1}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 0});
    expect_near(affine_determinant(&sheared), 24, 1e-12);
    expect_near(affine_determinant(&mirror), -24, 1e-6);
    assert_true(affine_determinant(&flat) == 0);
}

static void expect_inverse(struct affine map)
{
    struct affine inverse;
    assert_true(affine_invert(&map, &inverse));
    struct affine identity = affine_compose(&inverse, &map);
    expect_vector(identity.x, 1, 0, 0);
    expect_vector(identity.y, 0, 1, 0);
    expect_vector(identity.z, 0, 0, 1);
    expect_vector(identity.translation, 0, 0, 0);
}

/* The cube of a scale of 1e-14 is less than the least float. */
static void test_invert(void **state)
{
    (void)state;
    struct affine flat = {{1, 2, 3}, {2, 4, 6}, {0, 0, 1}, {0, 0, 0}}, inverse;
    expect_inverse(sheared);
    expect_inverse(
        affine_of((ps_vec3){-1e-14f, 2e-14f, 1e-14f}, (ps_vec3){1, 2, 3}, (ps_vec3){0, 0, 0}));
    expect_inverse(
        affine_of((ps_vec3){1e15f, 1e15f, 2e15f}, (ps_vec3){1, 2, 3}, (ps_vec3){0, 0, 0}));
    assert_false(affine_invert(&flat, &inverse));
    flat.x.x = INFINITY;
    assert_false(affine_invert(&flat, &inverse));
}

/* A normal stays across its plane, and on the side that the winding of the plane's image gives. */
static void test_normals(void **state)
{
    (void)state;
    const struct affine mirror = {{-2, 0, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};
    const struct affine *const maps[] = {&sheared, &mirror};
    const ps_vec3 a = {1, 2, -1}, b = {0.5f, -1, 2};
    for (int i = 0; i < 2; i++) {
        ps_vec3 n = affine_normal(maps[i], ps_cross(a, b));
        ps_vec3 expected = ps_cross(affine_direction(maps[i], a), affine_direction(maps[i], b));
        expect_vector(n, (double)expected.x, (double)expected.y, (double)expected.z);
    }
}

static void test_similarity(void **state)
{
    (void)state;
    const ps_vec3 turn = {10, 200, -37}, place = {1e6f, -3, 0};
    struct affine map = affine_of((ps_vec3){3, 3, 3}, turn, place), again = map;
    assert_true(affine_is_similarity(&map));
    for (int i = 0; i < 5; i++)
        again = affine_compose(&again, &map);
    assert_true(affine_is_similarity(&again));
    map = affine_of((ps_vec3){-1e-12f, 1e-12f, 1e-12f}, turn, place);
    assert_true(affine_is_similarity(&map));
    map = affine_of((ps_vec3){1, 1, 1.0001f}, turn, place);
    assert_false(affine_is_similarity(&map));
    map = affine_of((ps_vec3){1, 1.0001f, 1}, turn, place);
    assert_false(affine_is_similarity(&map));
    map = (struct affine){{1, 0, 0}, {1e-4f, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    assert_false(affine_is_similarity(&map));
    map = (struct affine){{1, 0, 0}, {0, 1, 0}, {1e-4f, 0, 1}, {0, 0, 0}};
    assert_false(affine_is_similarity(&map));
    map = (struct affine){{1, 0, 0}, {0, 1, 0}, {0, 1e-4f, 1}, {0, 0, 0}};
    assert_false(affine_is_similarity(&map));
    map = (struct affine){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    assert_false(affine_is_similarity(&map));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compose_applies_the_inner_one_first),
        cmocka_unit_test(test_determinant),
        cmocka_unit_test(test_invert),
        cmocka_unit_test(test_normals),
        cmocka_unit_test(test_similarity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
