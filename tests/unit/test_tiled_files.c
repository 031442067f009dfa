/* test_tiled_files.c: pictures that are written part by part are those that are written whole. */
#include "image/exr_tiles.h"
#include "image/png_rows.h"
#include "scratch.h"
#include "support/workers.h"

#define WIDTH 150
#define HEIGHT 100
#define SIDE 64

static const char *const names[] = {"R", "G", "N.X"};

/* A part of a picture of which each sample tells its place and channel. */
static struct image part_at(size_t left, size_t top, size_t width, size_t height)
{
    struct image part = {.width = width, .height = height, .window = {left, top, WIDTH, HEIGHT}};
    struct error error;
    for (size_t c = 0; c < 3; c++) {
        float *samples = image_add_channel(&part, names[c]);
        assert_non_null(samples);
        for (size_t i = 0; i < width * height; i++) {
            size_t x = left + i % width, y = top + i / width;
            samples[i] = (float)(c * 1000000 + y * 1000 + x);
        }
    }
    assert_int_equal(image_set_attribute(&part, "psplat.made", "in parts", &error), PS_OK);
    return part;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Writes the tiles whose bits are set, each from a part with up to 10 pixels around it. */
static void write_tiles(const char *path, unsigned wanted, enum image_compression compression,
                        struct workers *workers)
{
    struct exr_tiles *tiles = NULL;
    struct error error = {{0}};
    for (unsigned i = 0; i < 6; i++) {
        size_t x = i % 3 * SIDE, y = i / 3 * SIDE;
        size_t left = x > 10 ? x - 10 : 0, top = y > 10 ? y - 10 : 0;
        struct image part = part_at(left, top, smaller(x + SIDE + 10, WIDTH) - left,
                                    smaller(y + SIDE + 10, HEIGHT) - top);
        const struct rectangle place = {x, y, smaller(SIDE, WIDTH - x), smaller(SIDE, HEIGHT - y)};
        if (!tiles)
            assert_int_equal(
                exr_tiles_create(path, &part, WIDTH, HEIGHT, compression, &tiles, &error), PS_OK);
        if (wanted & 1u << i)
            assert_int_equal(exr_tiles_add(tiles, &part, place, workers, &error), PS_OK);
        image_release(&part);
    }
    assert_int_equal(exr_tiles_finish(tiles, workers, &error), PS_OK);
}

static void expect_tiles(const char *path, unsigned wanted)
{
    struct image whole = part_at(0, 0, WIDTH, HEIGHT), read = {0};
    struct error error;
    assert_int_equal(image_read_exr(path, &read, &error), PS_OK);
    assert_int_equal(read.width, WIDTH);
    assert_int_equal(read.height, HEIGHT);
    assert_string_equal(image_attribute(&read, "psplat.made"), "in parts");
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            unsigned tile = (unsigned)(i / WIDTH / SIDE * 3 + i % WIDTH / SIDE);
            float sample = image_channel(&whole, names[c])[i];
            assert_true(image_channel(&read, names[c])[i] == (wanted & 1u << tile ? sample : 0.0f));
        }
    image_release(&whole);
    image_release(&read);
}

static void test_parts_make_the_picture(void **state)
{
    const char *path = scratch_path(state, "a.exr");
    for (int compression = IMAGE_ZIP; compression <= IMAGE_UNCOMPRESSED; compression++) {
        write_tiles(path, 077, (enum image_compression)compression, NULL);
        expect_tiles(path, 077);
    }
}

static void test_missing_tiles_are_black(void **state)
{
    const char *path = scratch_path(state, "a.exr");
    write_tiles(path, 023, IMAGE_ZIP, NULL);
    expect_tiles(path, 023);
    write_tiles(path, 0, IMAGE_ZIP, NULL);
    expect_tiles(path, 0);
}

static bool is_green(const void *user, const char *channel)
{
    (void)user;
    return strcmp(channel, "G") == 0;
}

/* As of a tile whose denoiser failed. */
static void test_a_part_may_lack_channels(void **state)
{
    const struct rectangle left = {0, 0, SIDE, HEIGHT}, right = {SIDE, 0, WIDTH - SIDE, HEIGHT};
    const char *path = scratch_path(state, "a.exr");
    struct image whole = part_at(0, 0, WIDTH, HEIGHT), part = part_at(0, 0, WIDTH, HEIGHT), read;
    struct exr_tiles *tiles;
    struct error error;
    assert_int_equal(exr_tiles_create(path, &whole, WIDTH, HEIGHT, IMAGE_ZIP, &tiles, &error),
                     PS_OK);
    image_keep_channels(&part, is_green, NULL);
    assert_int_equal(exr_tiles_add(tiles, &whole, left, NULL, &error), PS_OK);
    assert_int_equal(exr_tiles_add(tiles, &part, right, NULL, &error), PS_OK);
    assert_int_equal(exr_tiles_finish(tiles, NULL, &error), PS_OK);
    assert_int_equal(image_read_exr(path, &read, &error), PS_OK);
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            bool is_there = i % WIDTH < SIDE || c == 1;
            float sample = image_channel(&whole, names[c])[i];
            assert_true(image_channel(&read, names[c])[i] == (is_there ? sample : 0.0f));
        }
    image_release(&whole);
    image_release(&part);
    image_release(&read);
}

static void test_workers_do_not_matter(void **state)
{
    struct workers *workers = start_workers(3);
    write_tiles(scratch_path(state, "one.exr"), 057, IMAGE_ZIP, NULL);
    write_tiles(scratch_path(state, "three.exr"), 057, IMAGE_ZIP, workers);
    scratch_expect_same_bytes(scratch_path(state, "one.exr"), scratch_path(state, "three.exr"));
    workers_destroy(workers);
}

static void test_rows_make_the_picture(void **state)
{
    static uint8_t rgb[WIDTH * HEIGHT * 3];
    struct png_rows *rows;
    struct error error;
    char key[] = "Title", value[] = "rows";
    const struct image_attribute text = {key, value};
    for (size_t i = 0; i < sizeof rgb; i++)
        rgb[i] = (uint8_t)(i * i >> 7);
    assert_int_equal(
        image_write_png(scratch_path(state, "whole.png"), WIDTH, HEIGHT, rgb, &text, 1, &error),
        PS_OK);
    assert_int_equal(
        png_rows_create(scratch_path(state, "rows.png"), WIDTH, HEIGHT, &text, 1, &rows, &error),
        PS_OK);
    assert_int_equal(png_rows_add(rows, rgb, 37, &error), PS_OK);
    assert_int_equal(png_rows_add(rows, rgb + 37 * WIDTH * 3, HEIGHT - 37, &error), PS_OK);
    assert_int_equal(png_rows_finish(rows, &error), PS_OK);
    scratch_expect_same_bytes(scratch_path(state, "whole.png"), scratch_path(state, "rows.png"));
}

/* --- what goes wrong
 * ------------------------------------------------------------------------------- */

static void test_discarded(void **state)
{
    struct image part = part_at(0, 0, WIDTH, HEIGHT);
    struct exr_tiles *tiles;
    struct png_rows *rows;
    struct error error;
    const uint8_t rgb[WIDTH * 3] = {0};
    assert_int_equal(exr_tiles_create(scratch_path(state, "a.exr"), &part, WIDTH, HEIGHT, IMAGE_ZIP,
                                      &tiles, &error),
                     PS_OK);
    assert_int_equal(
        exr_tiles_add(tiles, &part, (struct rectangle){0, 0, WIDTH, HEIGHT}, NULL, &error), PS_OK);
    exr_tiles_discard(tiles);
    assert_int_equal(
        png_rows_create(scratch_path(state, "a.png"), WIDTH, HEIGHT, NULL, 0, &rows, &error),
        PS_OK);
    assert_int_equal(png_rows_add(rows, rgb, 1, &error), PS_OK);
    png_rows_discard(rows);
    exr_tiles_discard(NULL);
    png_rows_discard(NULL);
    assert_int_equal(scratch_file_count(state), 0);
    image_release(&part);
}

static void test_full_disk(void **state)
{
    (void)state;
    struct image part = part_at(0, 0, WIDTH, HEIGHT);
    struct exr_tiles *tiles;
    struct error error;
    ps_result result =
        exr_tiles_create("/dev/full", &part, WIDTH, HEIGHT, IMAGE_ZIP, &tiles, &error);
    assert_int_equal(result, PS_ERROR_IO);
    assert_null(tiles);
    assert_non_null(strstr(error.text, "/dev/full"));
    image_release(&part);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_parts_make_the_picture),
        SCRATCH_TEST(test_missing_tiles_are_black),
        SCRATCH_TEST(test_a_part_may_lack_channels),
        SCRATCH_TEST(test_workers_do_not_matter),
        SCRATCH_TEST(test_rows_make_the_picture),
        SCRATCH_TEST(test_discarded),
        cmocka_unit_test(test_full_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
