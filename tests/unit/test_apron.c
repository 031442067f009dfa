/* test_apron.c: which tiles count as flat, and sums over windows. */
#include "film/apron.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A plane at a slope, seen at an angle. */
static void fill_plane(struct apron_surfaces *at)
{
    for (int row = 0; row < APRON_SIDE; row++)
        for (int i = 0; i < APRON_SIDE; i++) {
            at->position_x[row][i] = 100 + 0.5f * (float)i + 0.1f * (float)row;
            at->position_y[row][i] = 20 + 0.7f * (float)row;
            at->position_z[row][i] = at->position_x[row][i];
            at->normal_x[row][i] = -sqrtf(0.5f);
            at->normal_y[row][i] = 0;
            at->normal_z[row][i] = sqrtf(0.5f);
        }
}

static void test_planes_are_flat(void **state)
{
    (void)state;
    struct apron_surfaces at;
    fill_plane(&at);
    for (int reach = 0; reach <= APRON_MARGIN; reach++)
        assert_true(apron_is_flat(&at, reach));
}

/* What differs in the outermost pixel of the window; it does not matter to narrower ones. */
static void expect_uneven(const struct apron_surfaces *at, const char *what)
{
    print_message("%s\n", what);
    assert_false(apron_is_flat(at, APRON_MARGIN));
    assert_true(apron_is_flat(at, APRON_MARGIN - 1));
}

static void test_what_is_not_flat(void **state)
{
    (void)state;
    const int last = APRON_SIDE - 1;
    struct apron_surfaces plane, at;
    fill_plane(&plane);
    at = plane;
    at.normal_z[last][last] = 0.7f;
    expect_uneven(&at, "another normal");
    at = plane;
    at.position_x[0][last] -= 0.05f;
    expect_uneven(&at, "a tenth of a pixel before the plane");
    at = plane;
    at.normal_x[last][0] = at.normal_z[last][0] = 0;
    expect_uneven(&at, "nothing seen");
    memset(&at, 0, sizeof at);
    assert_false(apron_is_flat(&at, 0));
}

static void test_sums(void **state)
{
    (void)state;
    static float from[APRON_SIDE][APRON_SIDE];
    float to[PS_TILE_SIZE][PS_TILE_SIZE];
    for (int row = 0; row < APRON_SIDE; row++)
        for (int i = 0; i < APRON_SIDE; i++)
            from[row][i] = (float)((7 * row * row + 3 * i + row * i) % 101);
    for (int reach = 0; reach <= APRON_MARGIN; reach++) {
        apron_sum((const float(*)[APRON_SIDE])from, reach, 0.5f, to);
        for (int row = 0; row < PS_TILE_SIZE; row++)
            for (int i = 0; i < PS_TILE_SIZE; i++) {
                float sum = 0;
                for (int dy = -reach; dy <= reach; dy++)
                    for (int dx = -reach; dx <= reach; dx++)
                        sum += (abs(dx) == reach ? 0.5f : 1) * (abs(dy) == reach ? 0.5f : 1) *
                               from[APRON_MARGIN + row + dy][APRON_MARGIN + i + dx];
                assert_true(fabsf(to[row][i] - sum) < 1e-4f * sum + 1e-4f);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_planes_are_flat),
        cmocka_unit_test(test_what_is_not_flat),
        cmocka_unit_test(test_sums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
