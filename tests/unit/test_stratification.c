/* test_stratification.c: what every stratification keeps: power, order, the photons themselves; and
 * memory. For which photons merge see test_strata.c, for which stay test_representative.c. */
#include "support/random.h"
#include "support/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define RADIUS 10.0f

/* Coarse and fine, all of the parameters that decide what merges. */
static const char *const choices[] = {
    "none",
    "grid",
    "grid:resolution=1",
    "grid:cell=0.7,centre=camera",
    "grid:resolution=3,bucket=7",
    "grid:resolution=4,per_cell=3,representative=dominant",
    "grid:resolution=32,threshold=40,levels=4,representative=nearest_mean",
    "grid:resolution=32,threshold=40,levels=20,normal_angle=180",
    "cascade",
    "cascade:cell=0.1,resolution=8,beyond=keep",
    "cascade:cell=0.1,resolution=8,beyond=merge,representative=dominant",
    "cascade:levels=15,growth=1.1,resolution=16,normal_angle=20",
    "octree",
    "octree:capacity=1,depth=20",
    "octree:capacity=100,depth=3,representative=nearest_mean",
    "octree:depth=0,representative=dominant,normal_angle=180",
};
#define CHOICES (sizeof choices / sizeof choices[0])

/* Photons anywhere in the ball, in any colour; path i has power of its own. */
static ps_photon *random_photons(size_t n)
{
    struct random random = {42};
    ps_photon *photons = calloc(n + 1, sizeof *photons);
    assert_non_null(photons);
    for (size_t i = 0; i < n; i++)
        photons[i] = (ps_photon){
            .position = ps_scale(random_direction(&random), RADIUS * random_unit(&random)),
            .normal = random_direction(&random),
            .direction = random_direction(&random),
            .power = {random_unit(&random), random_unit(&random), 10 * random_unit(&random)},
            .bounce = 1 + (uint32_t)(i % 3),
            .merged = 1,
            .path = i,
        };
    return photons;
}

struct total {
    double r, g, b, merged;
};

static struct total total_of(const ps_photon *photons, size_t n)
{
    struct total total = {0};
    for (size_t i = 0; i < n; i++) {
        total.r += photons[i].power.r;
        total.g += photons[i].power.g;
        total.b += photons[i].power.b;
        total.merged += photons[i].merged;
    }
    return total;
}

/* The sums agree, as far as floats add up (NaN does not). */
static void expect_same_total(const char *choice, struct total a, struct total b)
{
    bool same = fabs(a.r - b.r) <= 1e-6 * a.r && fabs(a.g - b.g) <= 1e-6 * a.g &&
                fabs(a.b - b.b) <= 1e-6 * a.b && a.merged == b.merged;
    if (!same)
        fail_msg("%s: %.9g %.9g %.9g of %g became %.9g %.9g %.9g of %g", choice, a.r, a.g, a.b,
                 a.merged, b.r, b.g, b.b, b.merged);
}

/* Every photon left is one of those given but for power and merged, and they are in path order. */
static void expect_members(const ps_photon *given, const ps_photon *left, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        ps_photon expected = given[left[i].path];
        expected.power = left[i].power;
        expected.merged = left[i].merged;
        assert_memory_equal(&expected, &left[i], sizeof expected);
        assert_true(i == 0 || left[i - 1].path < left[i].path);
    }
}

static void test_power_and_order_stay(void **state)
{
    (void)state;
    enum { N = 3000 };
    struct stage stage = stage_of(RADIUS);
    stage.camera = (ps_vec3){3, 1, -8};
    ps_photon *given = random_photons(N), *photons = random_photons(N);
    for (size_t c = 0; c < CHOICES; c++) {
        memcpy(photons, given, N * sizeof *given);
        size_t left = stratify_photons(&stage, choices[c], photons, N);
        assert_int_equal(stage.result, PS_OK);
        assert_true(left > 0 && left <= N && (left < N || c == 0 || strstr(choices[c], "=1,")));
        expect_same_total(choices[c], total_of(given, N), total_of(photons, left));
        expect_members(given, photons, left);
        if (c > 0)
            assert_true(statistics_counter(&stage.statistics, "photons merged") ==
                        (double)(N - left));
    }
    free(given);
    free(photons);
    stage_release(&stage);
}

static void test_none_and_one(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    ps_photon *given = random_photons(1);
    for (size_t c = 0; c < CHOICES; c++) {
        ps_photon photon = given[0];
        assert_int_equal(stratify_photons(&stage, choices[c], &photon, 0), 0);
        assert_int_equal(stage.result, PS_OK);
        assert_int_equal(stratify_photons(&stage, choices[c], &photon, 1), 1);
        assert_int_equal(stage.result, PS_OK);
        assert_memory_equal(&photon, given, sizeof photon);
    }
    free(given);
    stage_release(&stage);
}

/* Cells smaller than the distance between photons change nothing, to the last bit. */
static void test_converges_to_none(void **state)
{
    (void)state;
    enum { N = 1000 };
    static const char *const fine[] = {"grid:resolution=1000000", "grid:cell=1e-4,centre=camera",
                                       "cascade:cell=1e-4,resolution=1000000,levels=2",
                                       "octree:capacity=1,depth=20"};
    struct stage stage = stage_of(RADIUS);
    ps_photon *given = random_photons(N), *photons = random_photons(N);
    for (size_t c = 0; c < sizeof fine / sizeof fine[0]; c++) {
        assert_int_equal(stratify_photons(&stage, fine[c], photons, N), N);
        assert_memory_equal(photons, given, N * sizeof *given);
    }
    free(given);
    free(photons);
    stage_release(&stage);
}

/* Positions that are no numbers, and a scene without extent, do no harm. */
static void test_hostile_input(void **state)
{
    (void)state;
    enum { N = 200 };
    for (int flat = 0; flat < 2; flat++) {
        struct stage stage = stage_of(flat ? 0 : RADIUS);
        for (size_t c = 0; c < CHOICES; c++) {
            ps_photon *photons = random_photons(N);
            photons[1].position.x = NAN;
            photons[2].position.y = INFINITY;
            photons[3].position = (ps_vec3){-INFINITY, 1e38f, -1e38f};
            photons[4].power = (ps_rgb){0, 0, 0};
            struct total before = total_of(photons, N);
            size_t left = stratify_photons(&stage, choices[c], photons, N);
            expect_same_total(choices[c], before, total_of(photons, left));
            free(photons);
        }
        stage_release(&stage);
    }
}

static void test_out_of_memory(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    stage.out_of_memory = true;
    ps_photon *given = random_photons(10), *photons = random_photons(10);
    static const char *const names[] = {"grid", "cascade", "octree"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(stratify_photons(&stage, names[i], photons, 10), 10);
        assert_int_equal(stage.result, PS_ERROR_MEMORY);
        assert_memory_equal(photons, given, 10 * sizeof *given);
    }
    free(given);
    free(photons);
    stage_release(&stage);
}

/* A hundredth of the 576 MB of an array of 256^3 cells is for 25,000 photons and their strata. */
static void test_memory_goes_by_photons(void **state)
{
    (void)state;
    enum { N = 25000 };
    static const char *const many[] = {"grid:resolution=1", "grid:resolution=256",
                                       "grid:resolution=1000000", "cascade", "octree:depth=20"};
    struct stage stage = stage_of(RADIUS);
    for (int i = 0; i < 5; i++) {
        ps_photon *photons = random_photons(N);
        stratify_photons(&stage, many[i], photons, N);
        double bytes = statistics_bytes(&stage.statistics, "strata");
        print_message("%s: %.0f bytes\n", many[i], bytes);
        assert_true(bytes > 0 && bytes <= 40.0 * N + 64);
        assert_true(bytes + (double)(N * sizeof *photons) < 5.76e6);
        free(photons);
    }
    stage_release(&stage);
}

/* The choice follows from seed and pass: repeated with them, another with others. */
static void test_choices_repeat(void **state)
{
    (void)state;
    enum { N = 2000 };
    struct stage stage = stage_of(RADIUS);
    ps_photon *first = random_photons(N);
    size_t left = stratify_photons(&stage, "grid:resolution=8", first, N);
    for (int i = 0; i < 3; i++) {
        ps_photon *again = random_photons(N);
        stage.pass = i == 1;
        stage.seed = i == 2 ? 2 : 1;
        assert_int_equal(stratify_photons(&stage, "grid:resolution=8", again, N), left);
        assert_int_equal(memcmp(first, again, left * sizeof *first) == 0, i == 0);
        free(again);
    }
    free(first);
    stage_release(&stage);
}

/* Photons of one number became one, and those of none stayed. */
static void expect_cells(struct stage *stage, const char *choice, size_t n)
{
    ps_photon *given = random_photons(n), *left = random_photons(n);
    uint64_t *numbers = calloc(n, sizeof *numbers);
    assert_non_null(numbers);
    assert_true(stratify_cells(stage, choice, given, n, numbers));
    assert_int_equal(stage->result, PS_OK);
    size_t count = stratify_photons(stage, choice, left, n);
    print_message("%s: %zu of %zu\n", choice, count, n);
    for (size_t i = 0; i < count; i++) {
        uint64_t number = numbers[left[i].path];
        size_t alike = 0;
        for (size_t j = 0; j < n; j++)
            alike += numbers[j] == number;
        assert_true(left[i].merged == (number == PS_NO_STRATUM ? 1.0f : (float)alike));
    }
    free(numbers);
    free(left);
    free(given);
}

static void test_cells_hold_what_merges(void **state)
{
    (void)state;
    static const char *const cells[] = {
        "grid:resolution=8,normal_angle=180,threshold=1",
        "grid:resolution=8,normal_angle=180",
        "grid:resolution=16,normal_angle=180,threshold=3,levels=2",
        "grid:cell=0.7,centre=camera,normal_angle=180,threshold=40,levels=4",
        "grid:resolution=32,normal_angle=180,threshold=9,levels=20",
        "cascade:resolution=8,normal_angle=180",
        "cascade:cell=0.1,resolution=8,beyond=keep,normal_angle=180",
        "cascade:cell=0.1,resolution=8,beyond=merge,normal_angle=180",
        "cascade:levels=15,growth=1.1,resolution=16,normal_angle=180",
        "octree:normal_angle=180",
        "octree:capacity=1,depth=20,normal_angle=180",
        "octree:capacity=30,depth=3,normal_angle=180",
        "octree:depth=0,normal_angle=180",
    };
    struct stage stage = stage_of(RADIUS);
    uint64_t number;
    ps_photon *one = random_photons(1);
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++)
        expect_cells(&stage, cells[i], 2000);
    assert_false(stratify_cells(&stage, "none", one, 1, &number));
    stage.out_of_memory = true;
    assert_true(stratify_cells(&stage, "octree", one, 1, &number));
    assert_int_equal(stage.result, PS_ERROR_MEMORY);
    free(one);
    stage_release(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_power_and_order_stay), cmocka_unit_test(test_none_and_one),
        cmocka_unit_test(test_converges_to_none),    cmocka_unit_test(test_hostile_input),
        cmocka_unit_test(test_out_of_memory),        cmocka_unit_test(test_memory_goes_by_photons),
        cmocka_unit_test(test_choices_repeat),       cmocka_unit_test(test_cells_hold_what_merges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
