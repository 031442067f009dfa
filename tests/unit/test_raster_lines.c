/* test_raster_lines.c: pictures that are read line by line are those that are read as a whole. */
#include "image/image.h"
#include "image/raster.h"

#include "texture_fixture.h"

/* What came, as a whole picture. */
struct reader {
    bool wanted;
    uint32_t fails_at; /* line */
    uint32_t lines;
    size_t line_bytes;
    unsigned char *samples; /* owned */
};

static bool want(void *user, const struct raster *raster)
{
    struct reader *reader = user;
    assert_null(raster->samples);
    reader->line_bytes = raster->width * raster_texel_bytes(raster);
    reader->samples = malloc(raster_bytes(raster));
    assert_non_null(reader->samples);
    return reader->wanted;
}

static ps_result take(void *user, const void *samples, struct error *error)
{
    struct reader *reader = user;
    if (reader->lines == reader->fails_at)
        return error_set(error, PS_CANCELLED, "no more");
    memcpy(reader->samples + reader->lines++ * reader->line_bytes, samples, reader->line_bytes);
    return PS_OK;
}

static ps_result read_by(struct reader *reader, const unsigned char *bytes, size_t size,
                         struct raster *raster, struct error *error)
{
    const struct raster_lines lines = {want, take, reader};
    *raster = (struct raster){0};
    return raster_decode("some.picture", NULL, bytes, size, &lines, raster, error);
}

static void expect_same_bytes(const unsigned char *bytes, size_t size, bool comes_by_lines)
{
    struct raster whole = {0}, lines;
    struct reader reader = {.wanted = true, .fails_at = UINT32_MAX};
    struct error error;
    assert_int_equal(raster_decode("a", NULL, bytes, size, NULL, &whole, &error), PS_OK);
    assert_int_equal(read_by(&reader, bytes, size, &lines, &error), PS_OK);
    assert_int_equal(lines.width, whole.width);
    assert_int_equal(lines.height, whole.height);
    assert_int_equal(lines.channels, whole.channels);
    assert_int_equal(lines.sample, whole.sample);
    assert_int_equal(lines.mended, whole.mended);
    assert_int_equal(lines.file_size, size);
    assert_int_equal(reader.lines, comes_by_lines ? whole.height : 0);
    assert_int_equal(lines.samples == NULL, comes_by_lines);
    assert_memory_equal(comes_by_lines ? reader.samples : lines.samples, whole.samples,
                        raster_bytes(&whole));
    free(reader.samples);
    raster_release(&lines);
    raster_release(&whole);
}

static void expect_same(const char *path, bool comes_by_lines)
{
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    expect_same_bytes(bytes, size, comes_by_lines);
    free(bytes);
}

static void test_kinds(void **state)
{
    static const char *const by_lines[] = {
        "rgb8.png",     "palettealpha.png", "grey1.png",       "rgb16.png",
        "baseline.jpg", "grey.jpg",         "progressive.jpg", "half.exr",
        "parts.exr",    "levels.exr",       "aces.exr",
    };
    static const char *const as_a_whole[] = {"interlaced.png"};
    (void)state;
    for (size_t i = 0; i < sizeof by_lines / sizeof *by_lines; i++)
        expect_same(data_path(by_lines[i]), true);
    for (size_t i = 0; i < sizeof as_a_whole / sizeof *as_a_whole; i++)
        expect_same(data_path(as_a_whole[i]), false);
}

/* Of several groups of lines; the last sample may be none that half floats hold. */
static void expect_same_floats(void **state, struct picture_window window, float last)
{
    static const char *const names[] = {"A", "B", "G", "R", "other"};
    struct image image = {.width = 21, .height = 700, .window = window};
    struct error error;
    const char *path = scratch_path(state, "floats.exr");
    for (size_t i = 0; i < 5; i++) {
        float *plane = image_add_channel(&image, names[i]);
        assert_non_null(plane);
        for (size_t k = 0; k < 21 * 700; k++)
            plane[k] = (float)(k % 97 + 100 * i);
        plane[11] = NAN;
        plane[900] = INFINITY;
        plane[21 * 700 - 1] = last;
    }
    assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_OK);
    image_release(&image);
    expect_same(path, true);
}

static void test_floats(void **state)
{
    static const struct picture_window own = {0, 0, 21, 700}, larger = {5, 20, 40, 900};
    expect_same_floats(state, own, 3.0f);
    expect_same_floats(state, own, 0.1f);
    expect_same_floats(state, larger, 3.0f);
    expect_same_floats(state, larger, 0.1f);
}

/* The display window begins and ends in the data, or beyond them. */
static void test_display_windows(void **state)
{
    static const int32_t windows[][4] = {{1, 1, 4, 2}, {-2, -3, 1, 0}, {5, 5, 7, 7}};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        size_t size, at = 0, length = sizeof "displayWindow";
        unsigned char *bytes = scratch_load(data_path("half.exr"), &size);
        while (at + length < size && memcmp(bytes + at, "displayWindow", length) != 0)
            at++;
        memcpy(bytes + at + length + sizeof "box2i" + 4, windows[i], sizeof windows[i]);
        expect_same_bytes(bytes, size, true);
        free(bytes);
    }
}

static void test_not_wanted(void **state)
{
    struct raster raster;
    struct reader reader = {.wanted = false};
    struct error error;
    size_t size;
    unsigned char *bytes = scratch_load(data_path("rgb8.png"), &size);
    (void)state;
    assert_int_equal(read_by(&reader, bytes, size, &raster, &error), PS_OK);
    assert_int_equal(reader.lines, 0);
    assert_non_null(raster.samples);
    free(reader.samples);
    raster_release(&raster);
    free(bytes);
}

/* What takes lines may fail, and files may end or be damaged among them. */
static void test_failures(void **state)
{
    static const char *const names[] = {"rgb8.png", "baseline.jpg", "half.exr"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct raster raster;
        struct reader reader = {.wanted = true, .fails_at = 1};
        struct error error;
        size_t size;
        unsigned char *bytes = scratch_load(data_path(names[i]), &size);
        assert_int_equal(read_by(&reader, bytes, size, &raster, &error), PS_CANCELLED);
        assert_string_equal(error.text, "no more");
        assert_int_equal(reader.lines, 1);
        assert_null(raster.samples);
        free(reader.samples);
        for (size_t length = 0; length < size; length++) {
            reader = (struct reader){.wanted = true, .fails_at = UINT32_MAX};
            assert_int_not_equal(read_by(&reader, bytes, length, &raster, &error), PS_OK);
            assert_true(strncmp(error.text, "some.picture: ", 14) == 0);
            assert_null(raster.samples);
            free(reader.samples);
        }
        free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinds),           SCRATCH_TEST(test_floats),
        cmocka_unit_test(test_display_windows), cmocka_unit_test(test_not_wanted),
        cmocka_unit_test(test_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
