/* test_error_estimate.c: relative errors by a picture's layer and by the variance of passes, worked
 * out by hand. */
#include "job/error_estimate.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define WIDTH 4
#define HEIGHT 3

static void expect_near(double value, double expected)
{
    if (fabs(value - expected) > 1e-6)
        fail_msg("%.9g, expected %.9g", value, expected);
}

static void fill(struct image *image, const char *name, float value)
{
    float *samples = image_add_channel(image, name);
    assert_non_null(samples);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        samples[i] = value;
}

/* Of the mean of the channels: 2. */
static void test_picture(void **state)
{
    (void)state;
    struct image image = {.width = WIDTH, .height = HEIGHT};
    fill(&image, "indirect.R", 1);
    fill(&image, "indirect.G", 2);
    fill(&image, "indirect.B", 3);
    assert_true(error_estimate_of_picture(&image) < 0);
    fill(&image, "error", 0.5f);
    expect_near(error_estimate_of_picture(&image), 0.25);
    image_release(&image);
}

/* Passes of 1 and 3 in red, and of 2 in green: their mean, (2, 2), has a variance of 1. */
static void test_film(void **state)
{
    (void)state;
    struct film film;
    struct film_sum sum;
    struct error error;
    assert_int_equal(film_create(WIDTH, HEIGHT, false, &film, &error), PS_OK);
    for (uint32_t pass = 0; pass < 2; pass++) {
        assert_int_equal(film_begin_pass(&film, pass, &error), PS_OK);
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            film.planes[FILM_COLOR_R][i] = pass ? 3 : 1;
            film.planes[FILM_COLOR_G][i] = 2;
        }
        film_end_pass(&film);
        if (pass == 0)
            assert_int_equal(film_sum_create(&film, &sum, &error), PS_OK);
        assert_int_equal(film_sum_add(&sum, &film, NULL, &error), PS_OK);
        if (pass == 0)
            assert_true(error_estimate_of_film(&sum) < 0);
    }
    expect_near(error_estimate_of_film(&sum), sqrt(1.0 / 8.0));
    film_release(&film);
    film_sum_release(&sum);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_picture),
        cmocka_unit_test(test_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
