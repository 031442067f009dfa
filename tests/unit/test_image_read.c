/* test_image_read.c: OpenEXR files of other programs, damaged ones, and ones that are refused. */
#include "exr_bytes.h"
#include "image/image.h"
#include "scratch.h"

static ps_result read_bytes(void **state, const struct bytes *bytes, struct image *image,
                            struct error *error)
{
    const char *path = scratch_path(state, "built.exr");
    *error = (struct error){{0}};
    *image = (struct image){0};
    scratch_store(path, bytes->data, bytes->size);
    ps_result result = image_read_exr(path, image, error);
    if (result != PS_OK) {
        assert_int_equal(image->channel_count + image->attribute_count + image->width, 0);
        assert_non_null(strstr(error->text, path));
    }
    return result;
}

static void assert_reads(void **state, const struct form *form)
{
    static const char *const names[] = {"A", "B", "C"};
    struct bytes bytes = build(form);
    struct image image;
    struct error error;
    if (read_bytes(state, &bytes, &image, &error) != PS_OK) {
        fail_msg("%s", error.text);
    }
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_int_equal(image.channel_count, 3);
    assert_int_equal(image.attribute_count, 1);
    assert_string_equal(image_attribute(&image, "comments"), "hello");
    for (int channel = 0; channel < 3; channel++) {
        const float *samples = image_channel(&image, names[channel]);
        assert_non_null(samples);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            float expected = (float)value_at(channel, i % WIDTH, i / WIDTH);
            assert_float_equal(samples[i], expected, 0.0f);
        }
    }
    image_release(&image);
}

static void assert_refused(void **state, const struct form *form, const char *reason)
{
    struct bytes bytes = build(form);
    struct image image;
    struct error error;
    assert_int_not_equal(read_bytes(state, &bytes, &image, &error), PS_OK);
    if (!strstr(error.text, reason)) {
        fail_msg("'%s' does not say '%s'", error.text, reason);
    }
}

static void test_sample_types(void **state)
{
    static const int types[][3] = {
        {FLOAT, FLOAT, FLOAT}, {HALF, HALF, HALF}, {UINT, UINT, UINT}, {UINT, HALF, FLOAT}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        struct form form = {.types = {types[i][0], types[i][1], types[i][2]}};
        assert_reads(state, &form);
        form.left = -3;
        form.top = 5;
        assert_reads(state, &form);
        form.tiled = 1;
        assert_reads(state, &form);
    }
}

static void test_refused_forms(void **state)
{
    const struct form plain = {.types = {FLOAT, FLOAT, FLOAT}};
    struct form form = plain;
    form.sampling = 2;
    form.width_claimed = 8; /* the library itself refuses odd ones */
    assert_refused(state, &form, "subsampled");
    form = plain;
    form.compression = 6;
    assert_refused(state, &form, "B44");
    form = plain;
    form.type = "deepscanline";
    form.version_flags = 0x800;
    assert_refused(state, &form, "deep");
    form = plain;
    form.type = "scanlineimage";
    form.version_flags = 0x1000;
    assert_refused(state, &form, "parts");
}

static void test_impossible_sizes(void **state)
{
    static const int widths[] = {-1, -WIDTH, 1 << 29, 1 << 30, INT32_MAX};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        const struct form form = {.types = {FLOAT, FLOAT, FLOAT}, .width_claimed = widths[i]};
        assert_refused(state, &form, "cannot read");
    }
}

/* Before any memory is asked for. */
static void test_more_than_file_holds(void **state)
{
    const struct form form = {.types = {FLOAT, FLOAT, FLOAT}, .width_claimed = 1 << 24};
    assert_refused(state, &form, "ends too early");
}

static void test_every_truncation(void **state)
{
    for (int tiled = 0; tiled < 2; tiled++) {
        const struct form form = {.types = {UINT, HALF, FLOAT}, .tiled = tiled};
        struct bytes bytes = build(&form);
        struct image image;
        struct error error;
        for (size_t whole = bytes.size; bytes.size-- > 0;) {
            if (read_bytes(state, &bytes, &image, &error) == PS_OK) {
                fail_msg("read %zu bytes of %zu", bytes.size, whole);
            }
        }
    }
}

/* What a renderer that was killed leaves: a table of zeros. */
static void test_unfinished(void **state)
{
    const struct form form = {.types = {FLOAT, FLOAT, FLOAT}};
    struct bytes bytes = build(&form);
    struct image image;
    struct error error;
    size_t lines = HEIGHT * (8 + WIDTH * 3 * sizeof(float));
    memset(bytes.data + bytes.size - lines - 8 * HEIGHT, 0, 8 * HEIGHT);
    assert_int_not_equal(read_bytes(state, &bytes, &image, &error), PS_OK);
}

/* Any byte of the pixels or of the chunks' table changed: an error, or the same picture. */
static void test_every_changed_byte(void **state)
{
    struct image image = {.width = 20, .height = 20}, back;
    struct bytes bytes = {.size = 0};
    struct error error;
    float *samples = image_add_channel(&image, "R");
    assert_non_null(samples);
    for (int i = 0; i < 400; i++) {
        samples[i] = (float)(i % 20);
    }
    const char *path = scratch_path(state, "written.exr");
    assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_OK);
    size_t size, refused = 0, header = 0;
    unsigned char *written = scratch_load(path, &size);
    put(&bytes, written, size);
    free(written);
    while (memcmp(bytes.data + header, "scanlineimage", 13) != 0) {
        header++;
    }
    for (size_t i = header + 14; i < size; i++) {
        bytes.data[i] ^= 0x55;
        if (read_bytes(state, &bytes, &back, &error) == PS_OK) {
            assert_memory_equal(back.channels[0].samples, samples, 400 * sizeof(float));
            image_release(&back);
        } else {
            refused++;
        }
        bytes.data[i] ^= 0x55;
    }
    assert_true(refused > (size - header - 14) / 2);
    image_release(&image);
}

static void test_no_exr(void **state)
{
    struct image image = {0};
    struct error error = {{0}};
    const char *path = scratch_path(state, "none.exr");
    assert_int_equal(image_read_exr(path, &image, &error), PS_ERROR_IO);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "No such file"));
    scratch_store(path, "This is a text, not a picture.\n", 31);
    assert_int_equal(image_read_exr(path, &image, &error), PS_ERROR_IO);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "not an OpenEXR file"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_sample_types),       SCRATCH_TEST(test_refused_forms),
        SCRATCH_TEST(test_impossible_sizes),   SCRATCH_TEST(test_more_than_file_holds),
        SCRATCH_TEST(test_every_truncation),   SCRATCH_TEST(test_unfinished),
        SCRATCH_TEST(test_every_changed_byte), SCRATCH_TEST(test_no_exr),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
