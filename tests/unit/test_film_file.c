/* test_film_file.c: films come back from their files as they were; what is no film, or not a whole
 * one, is refused. */
#include "job/film_file.h"

#include "unit/scratch.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 19
#define HEIGHT 7
#define PIXELS (WIDTH * HEIGHT)

/* A film of one pass with all kinds of planes, whose values are any. */
static struct film any_film(uint32_t number)
{
    struct film film;
    struct error error;
    uint32_t state = number + 1;
    assert_int_equal(film_create(WIDTH, HEIGHT, true, &film, &error), PS_OK);
    assert_int_equal(film_add_ids(&film, &error), PS_OK);
    assert_int_equal(film_add_halves(&film, &error), PS_OK);
    assert_int_equal(film_add_reflected(&film, true, &error), PS_OK);
    assert_int_equal(film_add_half_of_reflected(&film, true, &error), PS_OK);
    assert_int_equal(film_add_half_of_reflected(&film, false, &error), PS_OK);
    for (int plane = FILM_SPLATTED_R; plane <= FILM_VARIANCE; plane++)
        assert_int_equal(film_add_plane(&film, plane, &error), PS_OK);
    assert_int_equal(film_begin_pass(&film, number, &error), PS_OK);
    for (int plane = 0; plane < FILM_PLANES; plane++)
        for (size_t i = 0; i < PIXELS && film.planes[plane]; i++) {
            state = state * 1664525u + 1013904223u;
            film.planes[plane][i] = ldexpf((float)(state >> 8), (int)(state % 64) - 60);
        }
    for (size_t i = 0; i < PIXELS; i++) {
        film.object[i] = i % 5 ? (uint32_t)(i * 123457) : UINT32_MAX;
        film.material[i] = (uint32_t)(i * 65537);
    }
    film_end_pass(&film);
    return film;
}

static struct film_sum any_sum(void)
{
    struct film_sum sum;
    struct error error;
    for (uint32_t number = 0; number < 5; number += 2) {
        struct film film = any_film(number);
        if (number == 0)
            assert_int_equal(film_sum_create(&film, &sum, &error), PS_OK);
        assert_true(film_sum_fits(&sum, &film));
        assert_int_equal(film_sum_add(&sum, &film, NULL, &error), PS_OK);
        film_release(&film);
    }
    return sum;
}

static void expect_equal(const struct film_sum *a, const struct film_sum *b)
{
    assert_true(film_sum_is_alike(a, b));
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++) {
        const struct exact_plane *x = &a->planes[plane], *y = &b->planes[plane];
        for (size_t i = 0; x->high && i < PIXELS; i++) {
            assert_true(x->high[i] == y->high[i]);
            assert_true((x->low ? x->low[i] : 0) == (y->low ? y->low[i] : 0));
        }
    }
    assert_memory_equal(a->object, b->object, PIXELS * sizeof *a->object);
    assert_memory_equal(a->material, b->material, PIXELS * sizeof *a->material);
}

static void test_there_and_back(void **state)
{
    const char *path = scratch_path(state, "film.exr");
    struct film_sum sum = any_sum(), again;
    struct image facts = {0}, read;
    struct error error;
    bool has_low = false;
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        has_low |= sum.planes[plane].low != NULL;
    assert_true(has_low);
    assert_int_equal(image_set_attribute(&facts, "psplat.seed", "7", &error), PS_OK);
    assert_int_equal(film_file_write(path, &sum, &facts, IMAGE_ZIP, NULL, &error), PS_OK);
    assert_int_equal(film_file_read(path, &again, &read, &error), PS_OK);
    expect_equal(&sum, &again);
    assert_string_equal(image_attribute(&read, "psplat.seed"), "7");
    assert_string_equal(image_attribute(&read, "psplat.pass_set"), "0:1,2:3,4:5");
    assert_int_equal(pass_set_size(&again.passes), 3);
    assert_int_equal(read.channel_count, 0);
    film_sum_release(&sum);
    film_sum_release(&again);
    image_release(&facts);
    image_release(&read);
}

/* Reads a film's file as a picture, lets `spoil` change it, and expects that the message says
 * so. */
static void expect_refused(void **state, void (*spoil)(struct image *image), const char *message)
{
    const char *path = scratch_path(state, "film.exr");
    struct film_sum sum = any_sum();
    struct image facts = {0}, image;
    struct error error;
    assert_int_equal(film_file_write(path, &sum, &facts, IMAGE_RLE, NULL, &error), PS_OK);
    film_sum_release(&sum);
    assert_int_equal(image_read_exr(path, &image, &error), PS_OK);
    spoil(&image);
    assert_int_equal(image_write_exr(&image, path, IMAGE_RLE, NULL, &error), PS_OK);
    image_release(&image);
    assert_int_equal(film_file_read(path, &sum, &facts, &error), PS_ERROR_INVALID);
    if (!strstr(error.text, message))
        fail_msg("'%s' does not say '%s'", error.text, message);
    assert_int_equal(sum.width, 0);
}

static void set(struct image *image, const char *name, const char *value)
{
    struct error error;
    assert_int_equal(image_set_attribute(image, name, value, &error), PS_OK);
}

static void set_version(struct image *image)
{
    set(image, "psplat.film", "2");
}

static void set_passes(struct image *image)
{
    set(image, "psplat.pass_set", "0:2,1:3");
}

static void set_no_passes(struct image *image)
{
    set(image, "psplat.pass_set", "");
}

static bool is_no_weight(const void *user, const char *name)
{
    (void)user;
    return strcmp(name, "sum.weight") != 0;
}

static void drop_weight(struct image *image)
{
    image_keep_channels(image, is_no_weight, NULL);
}

static bool is_no_odd_weight(const void *user, const char *name)
{
    (void)user;
    return strcmp(name, "sum.odd.weight") != 0;
}

static void drop_odd_weight(struct image *image)
{
    image_keep_channels(image, is_no_odd_weight, NULL);
}

static bool is_no_half(const void *user, const char *name)
{
    (void)user;
    return !strstr(name, ".half.") && !strstr(name, ".odd.reflected.") &&
           !strstr(name, ".odd.hard.");
}

static void drop_halves(struct image *image)
{
    image_keep_channels(image, is_no_half, NULL);
}

static bool is_no_reflected_odd(const void *user, const char *name)
{
    (void)user;
    return strstr(name, ".odd.reflected.G") == NULL;
}

static void drop_reflected_odd(struct image *image)
{
    image_keep_channels(image, is_no_reflected_odd, NULL);
}

static bool is_no_hard_half(const void *user, const char *name)
{
    (void)user;
    return strstr(name, ".half.hard.G") == NULL;
}

static void drop_hard_half(struct image *image)
{
    image_keep_channels(image, is_no_hard_half, NULL);
}

static bool is_no_green_splatted(const void *user, const char *name)
{
    (void)user;
    return strcmp(name, "sum.splatted.G") != 0;
}

static void drop_green_splatted(struct image *image)
{
    image_keep_channels(image, is_no_green_splatted, NULL);
}

static bool is_no_object(const void *user, const char *name)
{
    (void)user;
    return strcmp(name, "object.high") != 0;
}

static void drop_objects(struct image *image)
{
    image_keep_channels(image, is_no_object, NULL);
}

static float *samples_of(struct image *image, const char *name)
{
    float *samples = NULL;
    for (size_t i = 0; i < image->channel_count; i++)
        if (strcmp(image->channels[i].name, name) == 0)
            samples = image->channels[i].samples;
    assert_non_null(samples);
    return samples;
}

static void spoil_object(struct image *image)
{
    samples_of(image, "object.low")[3] = 0.5f;
}

static void spoil_material(struct image *image)
{
    samples_of(image, "material.low")[PIXELS - 1] = NAN;
}

static void test_what_is_no_whole_film(void **state)
{
    expect_refused(state, set_version, "format '2'");
    expect_refused(state, set_passes, "film.exr': psplat.pass_set: expected runs of passes");
    expect_refused(state, set_no_passes, "it says of no passes");
    expect_refused(state, drop_weight, "layers are missing");
    expect_refused(state, drop_odd_weight, "layers are missing");
    expect_refused(state, drop_halves, "layers are missing");
    expect_refused(state, drop_hard_half, "layers are missing");
    expect_refused(state, drop_reflected_odd, "layers are missing");
    expect_refused(state, drop_green_splatted, "layers are missing");
    expect_refused(state, drop_objects, "numbers of objects are missing");
    expect_refused(state, spoil_object, "numbers of objects are none");
    expect_refused(state, spoil_material, "numbers of objects are none");
}

/* A film of other layers, or another size, is not gone on with. */
static void test_films_that_do_not_fit(void **state)
{
    (void)state;
    struct film film = any_film(0), other;
    struct film_sum sum;
    struct error error;
    assert_int_equal(film_sum_create(&film, &sum, &error), PS_OK);
    assert_true(film_sum_fits(&sum, &film));
    assert_int_equal(film_create(WIDTH, HEIGHT, true, &other, &error), PS_OK);
    assert_false(film_sum_fits(&sum, &other));
    film_release(&other);
    assert_int_equal(film_add_plane(&film, FILM_GLOSS, &error), PS_OK);
    assert_false(film_sum_fits(&sum, &film));
    film_release(&film);
    film_sum_release(&sum);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_there_and_back),
        SCRATCH_TEST(test_what_is_no_whole_film),
        cmocka_unit_test(test_films_that_do_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
