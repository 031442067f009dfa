/* test_regression_fit.c: fits of the denoiser `regression`, which pass over pixels by bounds of
 * what those show, in windows that light steers. */
#include "../../plugins/denoiser/regression/bounds.h"
#include "../../plugins/denoiser/regression/fit.h"
#include "../../plugins/denoiser/regression/steering.h"
#include "support/one_strategy.h"
#include "support/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 133, HEIGHT = 41, PIXELS = WIDTH * HEIGHT };

enum { PLANES = 8 + REGRESSION_VALUES, RUNS_APART = PLANES * REGRESSION_LANES };

struct fixture {
    struct bare_host bare;
    struct regression surfaces;
    float *memory, *next; /* of all planes, and the next one's */
    float *values[REGRESSION_VALUES];
};

static float *new_plane(struct fixture *fixture)
{
    float *plane = fixture->next;
    fixture->next += REGRESSION_LANES;
    return plane;
}

/* Boxes of a few pixels at random heights, slanted at random, of two kinds of gloss; some show
 * nothing. */
static void set_pixel(struct fixture *fixture, struct random *random, int x, int y)
{
    struct regression *surfaces = &fixture->surfaces;
    size_t at = regression_at(surfaces, x, y);
    struct random box = {(uint64_t)(x / 5 + 1000 * (y / 9))};
    float angle = random_between(&box, 0, 2 * PS_PI), tilt = random_between(&box, 0, 0.6f);
    if (random_between(&box, 0, 1) < 0.1f)
        return;
    for (int c = 0; c < REGRESSION_VALUES; c++)
        fixture->values[c][at] = random_between(random, 0, 1);
    surfaces->normal[0][at] = sinf(tilt) * cosf(angle);
    surfaces->normal[1][at] = sinf(tilt) * sinf(angle);
    surfaces->normal[2][at] = cosf(tilt);
    surfaces->position[0][at] = 0.1f * (float)x;
    surfaces->position[1][at] = 0.1f * (float)y;
    surfaces->position[2][at] = random_between(&box, 0, 1) < 0.5f ? 0 : random_between(&box, 0, 2);
    surfaces->gloss[at] = random_between(&box, 0, 1) < 0.5f ? 0 : 0.2f;
    surfaces->size[at] = 0.1f;
}

static void create(struct fixture *fixture, float degrees)
{
    struct regression *surfaces = &fixture->surfaces;
    struct random random = {4};
    bare_host_create(&fixture->bare, 2);
    fixture->memory = calloc(regression_runs(WIDTH, HEIGHT), RUNS_APART * sizeof(float));
    fixture->next = fixture->memory;
    assert_non_null(fixture->memory);
    *surfaces = (struct regression){
        .host = &fixture->bare.host,
        .width = WIDTH,
        .height = HEIGHT,
        .runs_of_row = regression_runs_of_row(WIDTH),
        .runs_apart = RUNS_APART,
        .gloss = new_plane(fixture),
        .size = new_plane(fixture),
        .bend_scale = 1 / (1 - cosf(degrees * PS_PI / 180)),
        .bounds = malloc(regression_bounds_bytes(WIDTH, HEIGHT)),
        .fits = malloc(regression_fits_bytes(WIDTH, HEIGHT)),
        .planes = malloc(regression_planes_bytes(WIDTH, HEIGHT, REGRESSION_MOST)),
    };
    assert_non_null(surfaces->bounds);
    assert_non_null(surfaces->fits);
    for (int i = 0; i < 3; i++) {
        surfaces->normal[i] = new_plane(fixture);
        surfaces->position[i] = new_plane(fixture);
    }
    for (int c = 0; c < REGRESSION_VALUES; c++)
        fixture->values[c] = new_plane(fixture);
    for (int i = 0; i < PIXELS; i++)
        set_pixel(fixture, &random, i % WIDTH, i / WIDTH);
}

static void destroy(struct fixture *fixture)
{
    struct regression *surfaces = &fixture->surfaces;
    free(fixture->memory);
    free(surfaces->bounds);
    free(surfaces->fits);
    free(surfaces->planes);
    bare_host_release(&fixture->bare);
}

/* Bounds that hold everything, so that no pixel is passed over. */
static void make_bounds_endless(struct regression *surfaces)
{
    size_t count = regression_bounds_bytes(WIDTH, HEIGHT) / sizeof *surfaces->bounds;
    for (size_t i = 0; i < count; i++) {
        surfaces->bounds[i] = (struct regression_bounds){.gloss_extent = 1e10f};
        for (int c = 0; c < 3; c++)
            surfaces->bounds[i].normal_extent[c] = surfaces->bounds[i].position_extent[c] = 1e10f;
    }
}

static void expect_no_difference(float degrees, int bandwidth)
{
    static float with[REGRESSION_VALUES][PIXELS], without[REGRESSION_VALUES][PIXELS];
    float *const a[] = {with[0], with[1], with[2], with[3]};
    float *const b[] = {without[0], without[1], without[2], without[3]};
    struct fixture fixture;
    create(&fixture, degrees);
    regression_bounds_find(&fixture.surfaces);
    regression_fit(&fixture.surfaces, bandwidth, REGRESSION_VALUES, fixture.values, NULL, a);
    make_bounds_endless(&fixture.surfaces);
    regression_fit(&fixture.surfaces, bandwidth, REGRESSION_VALUES, fixture.values, NULL, b);
    assert_memory_equal(with, without, sizeof with);
    destroy(&fixture);
}

static void test_bounds_change_nothing(void **state)
{
    (void)state;
    static const int bandwidths[] = {3, 12, 24, 64};
    for (size_t i = 0; i < sizeof bandwidths / sizeof bandwidths[0]; i++) {
        expect_no_difference(20, bandwidths[i]);
        expect_no_difference(90, bandwidths[i]);
    }
}

/* Each pixel lies within the bounds of its run. */
static void test_bounds_hold_their_pixels(void **state)
{
    (void)state;
    struct fixture fixture;
    create(&fixture, 30);
    const struct regression *surfaces = &fixture.surfaces;
    regression_bounds_find(surfaces);
    for (int i = 0; i < PIXELS; i++) {
        size_t at = regression_at(surfaces, i % WIDTH, i / WIDTH);
        const struct regression_bounds *of = &surfaces->bounds[at / RUNS_APART];
        if (!(surfaces->size[at] > 0))
            continue;
        for (int c = 0; c < 3; c++) {
            float off = fabsf(surfaces->position[c][at] - of->position[c]);
            float bend = fabsf(surfaces->normal[c][at] - of->normal[c]);
            assert_true(off <= of->position_extent[c]);
            assert_true(bend <= of->normal_extent[c]);
        }
        assert_true(fabsf(surfaces->gloss[at] - of->gloss) <= of->gloss_extent);
    }
    destroy(&fixture);
}

/* Every pixel of a picture and its margin has a place of its own, in each plane. */
static void test_planes_lie_apart(void **state)
{
    (void)state;
    struct fixture fixture;
    create(&fixture, 30);
    size_t floats = regression_runs(WIDTH, HEIGHT) * RUNS_APART, places = 0;
    memset(fixture.memory, 0, floats * sizeof(float));
    for (int y = -REGRESSION_MARGIN; y < HEIGHT + REGRESSION_MARGIN; y++)
        for (int x = -REGRESSION_MARGIN; x < WIDTH + REGRESSION_MARGIN; x++, places++)
            for (int c = 0; c < REGRESSION_VALUES; c++)
                fixture.values[c][regression_at(&fixture.surfaces, x, y)] += 1;
    float sum = 0, most = 0;
    for (size_t i = 0; i < floats; i++) {
        sum += fixture.memory[i];
        most = fmaxf(most, fixture.memory[i]);
    }
    assert_true(most == 1);
    assert_true(sum == (float)(places * REGRESSION_VALUES));
    destroy(&fixture);
}

/* --- steered windows --- */

/* All that is inside of a window lies in its rows. */
static void test_rows_hold_their_window(void **state)
{
    (void)state;
    struct random random = {7};
    for (int i = 0; i < 2000; i++) {
        float angle = random_between(&random, 0, PS_PI), gx = cosf(angle), gy = sinf(angle);
        float across = random_between(&random, 1, 40), along = random_between(&random, 1, 40);
        float a = 1 / (across * across), b = 1 / (along * along);
        struct regression_window window = {a * gx * gx + b * gy * gy, (a - b) * gx * gy,
                                           a * gy * gy + b * gx * gx};
        int rows = regression_window_rows(&window);
        for (int y = -41; y <= 41; y++) {
            int first = 1, last = 0;
            bool reached = regression_window_row(&window, y, &first, &last);
            for (int x = -41; x <= 41; x++) {
                float fx = (float)x, fy = (float)y;
                float q = fx * (window.xx * fx + 2 * window.xy * fy) + window.yy * fy * fy;
                if (q < 1)
                    assert_true(reached && abs(y) <= rows && first <= x && x <= last);
            }
        }
    }
}

/* An even surface, on which light ends at a slanted line, but for noise. */
static float light_of(int x, int y)
{
    return (float)x + 0.5f * (float)y > 0.6f * WIDTH ? 2.0f : 0.1f;
}

static void set_edge_of_light(struct fixture *fixture, struct random *random)
{
    struct regression *surfaces = &fixture->surfaces;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            size_t at = regression_at(surfaces, x, y);
            surfaces->normal[0][at] = surfaces->normal[1][at] = 0;
            surfaces->normal[2][at] = 1;
            surfaces->position[0][at] = 0.1f * (float)x;
            surfaces->position[1][at] = 0.1f * (float)y;
            surfaces->position[2][at] = surfaces->gloss[at] = 0;
            surfaces->size[at] = 0.1f;
            for (int c = 0; c < REGRESSION_VALUES; c++)
                fixture->values[c][at] = light_of(x, y) * random_between(random, 0.5f, 1.5f);
        }
    regression_bounds_find(surfaces);
}

static double error_of(const float fitted[PIXELS])
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        double off = (double)(fitted[i] - light_of(i % WIDTH, i / WIDTH));
        sum += off * off;
    }
    return sqrt(sum / PIXELS);
}

/* Where round fits blur light, windows that they steer blur less, and leave no more noise. */
static void test_steered_windows_follow_edges(void **state)
{
    (void)state;
    static float round[REGRESSION_VALUES][PIXELS], steered[REGRESSION_VALUES][PIXELS];
    float *const a[] = {round[0], round[1], round[2], round[3]};
    float *const b[] = {steered[0], steered[1], steered[2], steered[3]};
    struct random random = {5};
    struct fixture fixture;
    create(&fixture, 30);
    set_edge_of_light(&fixture, &random);
    regression_fit(&fixture.surfaces, 12, REGRESSION_VALUES, fixture.values, NULL, a);
    struct regression_steering by = {a, 1e-3f};
    regression_fit(&fixture.surfaces, 12, REGRESSION_VALUES, fixture.values, &by, b);
    print_message("edge of light: off by %.3f by round windows, %.3f by steered ones\n",
                  error_of(a[0]), error_of(b[0]));
    assert_true(error_of(b[0]) < 0.85 * error_of(a[0]));
    destroy(&fixture);
}

/* Without a slope, in gloss, and where no surface is seen. */
static void test_windows_are_round_without_edges(void **state)
{
    (void)state;
    static float light[PIXELS];
    struct regression_window round = regression_round_window(12), window;
    struct random random = {6};
    struct fixture fixture;
    create(&fixture, 30);
    set_edge_of_light(&fixture, &random);
    float *const lights[] = {light, light, light};
    struct regression_steering by = {lights, 1e-3f};
    window = regression_steered_window(&fixture.surfaces, &by, 12, WIDTH / 2, HEIGHT / 2);
    assert_memory_equal(&window, &round, sizeof round);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            light[y * WIDTH + x] = (float)x + 0.5f * (float)y;
    int x = 20, y = HEIGHT / 2;
    size_t at = regression_at(&fixture.surfaces, x, y);
    window = regression_steered_window(&fixture.surfaces, &by, 12, x, y);
    assert_true(window.xx > 1.3f * round.xx && window.yy < round.yy && window.xy > 0);
    fixture.surfaces.gloss[at] = 0.2f;
    window = regression_steered_window(&fixture.surfaces, &by, 12, x, y);
    assert_memory_equal(&window, &round, sizeof round);
    fixture.surfaces.gloss[at] = fixture.surfaces.size[at] = 0;
    window = regression_steered_window(&fixture.surfaces, &by, 12, x, y);
    assert_memory_equal(&window, &round, sizeof round);
    destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds_change_nothing),
        cmocka_unit_test(test_bounds_hold_their_pixels),
        cmocka_unit_test(test_planes_lie_apart),
        cmocka_unit_test(test_rows_hold_their_window),
        cmocka_unit_test(test_steered_windows_follow_edges),
        cmocka_unit_test(test_windows_are_round_without_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
