/* test_image.c: pictures in memory, and written to OpenEXR and read back. */
#include "image/image.h"
#include "scratch.h"
#include "support/workers.h"

#include <float.h>
#include <math.h>

static struct image picture(size_t width, size_t height, size_t channels)
{
    static const char *const names[] = {
        "R",          "G",          "B",           "A",        "direct.R", "direct.G", "direct.B",
        "indirect.R", "indirect.G", "indirect.B",  "albedo.R", "albedo.G", "albedo.B", "N.X",
        "N.Y",        "N.Z",        "P.X",         "P.Y",      "P.Z",      "Z",        "weight",
        "error",      "object.id",  "material.id", "a.b.c"};
    struct image image = {.width = width, .height = height};
    uint32_t random = 1;
    assert_true(channels <= sizeof names / sizeof *names);
    for (size_t i = 0; i < channels; i++) {
        float *samples = image_add_channel(&image, names[i]);
        assert_non_null(samples);
        for (size_t j = 0; j < width * height; j++) {
            assert_true(samples[j] == 0.0f);
            random = random * 1664525u + 1013904223u;
            samples[j] = (float)(random >> 8) * 0x1p-20f - 8.0f + (float)i;
        }
    }
    return image;
}

static void assert_same(const struct image *a, const struct image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channel_count, b->channel_count);
    for (size_t i = 0; i < a->channel_count; i++) {
        const float *other = image_channel(b, a->channels[i].name);
        assert_non_null(other);
        assert_memory_equal(a->channels[i].samples, other, a->width * a->height * sizeof(float));
    }
    assert_int_equal(a->attribute_count, b->attribute_count);
    for (size_t i = 0; i < a->attribute_count; i++) {
        const char *other = image_attribute(b, a->attributes[i].name);
        assert_non_null(other);
        assert_string_equal(a->attributes[i].value, other);
    }
}

static void write_with_threads(const struct image *image, const char *path,
                               enum image_compression compression, uint32_t threads)
{
    struct error error = {{0}};
    struct workers *workers = start_workers(threads);
    if (image_write_exr(image, path, compression, workers, &error) != PS_OK) {
        fail_msg("%s", error.text);
    }
    workers_destroy(workers);
}

static void write_picture(const struct image *image, const char *path)
{
    write_with_threads(image, path, IMAGE_ZIP, 3);
}

static struct image read_picture(const char *path)
{
    struct image image = {0};
    struct error error = {{0}};
    if (image_read_exr(path, &image, &error) != PS_OK) {
        fail_msg("%s", error.text);
    }
    return image;
}

/* Writes with each compression, reads back, compares and releases. */
static void assert_round_trip(void **state, struct image *image)
{
    const char *path = scratch_path(state, "round trip.exr");
    for (int i = IMAGE_ZIP; i <= IMAGE_UNCOMPRESSED; i++) {
        write_with_threads(image, path, (enum image_compression)i, 3);
        struct image back = read_picture(path);
        assert_same(image, &back);
        image_release(&back);
    }
    image_release(image);
    assert_int_equal(scratch_file_count(state), 1);
}

static void test_names_of_compressions(void **state)
{
    (void)state;
    static const char *const names[] = {"zip", "zips", "rle", "none"};
    enum image_compression compression = IMAGE_ZIP;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_true(image_compression_named(names[i], &compression));
        assert_int_equal(compression, i);
        assert_non_null(strstr(IMAGE_COMPRESSIONS, names[i]));
    }
    assert_false(image_compression_named("piz", &compression));
    assert_false(image_compression_named("", &compression));
}

static void test_channels_in_memory(void **state)
{
    (void)state;
    struct image image = {.width = 3, .height = 2};
    float *samples = image_add_channel(&image, "direct.R");
    assert_non_null(samples);
    assert_ptr_equal(image_channel(&image, "direct.R"), samples);
    assert_null(image_channel(&image, "direct"));
    float *adopted = calloc(6, sizeof *adopted);
    struct error error;
    assert_non_null(adopted);
    assert_int_equal(image_adopt_channel(&image, "Z", adopted, &error), PS_OK);
    assert_ptr_equal(image_channel(&image, "Z"), adopted);
    assert_int_equal(image.channel_count, 2);
    image_release(&image);
    assert_int_equal(image.channel_count, 0);
    image_release(&image);
    struct image empty = {0};
    assert_null(image_add_channel(&empty, "R"));
    struct image vast = {.width = SIZE_MAX / 2, .height = 3};
    assert_null(image_add_channel(&vast, "R"));
    image_release(&vast);
}

static void test_attributes_in_memory(void **state)
{
    (void)state;
    struct image image = {0};
    struct error error = {{0}};
    assert_null(image_attribute(&image, "passes"));
    assert_int_equal(image_set_attribute(&image, "passes", "16", &error), PS_OK);
    assert_int_equal(image_set_attribute(&image, "seed", "1", &error), PS_OK);
    assert_int_equal(image_set_attribute(&image, "passes", "3200", &error), PS_OK);
    assert_int_equal(image.attribute_count, 2);
    assert_string_equal(image_attribute(&image, "passes"), "3200");
    assert_string_equal(image_attribute(&image, "seed"), "1");
    image_release(&image);
}

static void test_sizes(void **state)
{
    static const size_t sizes[][2] = {{1, 1}, {1, 33}, {33, 1}, {7, 33}, {257, 19}, {16, 16}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct image image = picture(sizes[i][0], sizes[i][1], 4);
        assert_round_trip(state, &image);
    }
}

static void test_exact_bits(void **state)
{
    static const float values[] = {0.0f,     -0.0f,    1.0f,        -1.5f,     FLT_MIN, FLT_MAX,
                                   -FLT_MAX, INFINITY, -INFINITY,   0x1p-149f, 0.1f,    1e-30f,
                                   65504.0f, 65536.0f, 16777217.0f, 3.14159f};
    struct image image = picture(sizeof values / sizeof *values, 3, 2);
    memcpy(image.channels[0].samples, values, sizeof values);
    assert_round_trip(state, &image);

    image = picture(2, 2, 1);
    image.channels[0].samples[3] = NAN;
    write_picture(&image, scratch_path(state, "nan.exr"));
    struct image back = read_picture(scratch_path(state, "nan.exr"));
    assert_true(isnan(back.channels[0].samples[3]));
    image_release(&image);
    image_release(&back);
}

static void test_many_channels(void **state)
{
    struct image image = picture(31, 40, 25);
    write_picture(&image, scratch_path(state, "layers.exr"));
    struct image back = read_picture(scratch_path(state, "layers.exr"));
    assert_same(&image, &back);
    for (size_t i = 1; i < back.channel_count; i++) {
        assert_true(strcmp(back.channels[i - 1].name, back.channels[i].name) < 0);
    }
    image_release(&image);
    image_release(&back);
}

static void test_attributes_in_files(void **state)
{
    char long_value[5000];
    struct image image = picture(2, 2, 1);
    struct error error = {{0}};
    memset(long_value, 'x', sizeof long_value - 1);
    long_value[sizeof long_value - 1] = '\0';
    assert_int_equal(image_set_attribute(&image, "comments", "two\nlines", &error), PS_OK);
    assert_int_equal(image_set_attribute(&image, "owner", "Zo\xc3\xab", &error), PS_OK);
    assert_int_equal(image_set_attribute(&image, "psplat.empty", "", &error), PS_OK);
    assert_int_equal(image_set_attribute(&image, "psplat.scene", long_value, &error), PS_OK);
    assert_int_equal(
        image_set_attribute(&image, "psplat.a name of more than 31 characters", "1", &error),
        PS_OK);
    assert_round_trip(state, &image);
}

/* A name that the format keeps for itself must not become a string. */
static void test_reserved_attributes(void **state)
{
    static const char *const names[] = {"channels", "dataWindow", "type", "chromaticities"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct image image = picture(2, 2, 1);
        struct error error = {{0}};
        assert_int_equal(image_set_attribute(&image, names[i], "x", &error), PS_OK);
        assert_int_not_equal(
            image_write_exr(&image, scratch_path(state, "a.exr"), IMAGE_ZIP, NULL, &error), PS_OK);
        assert_non_null(strstr(error.text, names[i]));
        assert_int_equal(scratch_file_count(state), 0);
        image_release(&image);
    }
}

/* Chunks that take unequally long: those that come first are noise, the last are of one colour. */
static void test_same_bytes_whatever_the_threads(void **state)
{
    static const uint32_t threads[] = {1, 2, 3, 8, 64};
    struct image image = picture(50, 16 * 40 + 5, 5);
    for (size_t i = 0; i < image.channel_count; i++) {
        for (size_t j = image.width * image.height / 2; j < image.width * image.height; j++) {
            image.channels[i].samples[j] = 0.5f;
        }
    }
    const char *one = scratch_path(state, "one.exr");
    write_with_threads(&image, one, IMAGE_ZIP, 1);
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        const char *other = scratch_path(state, "other.exr");
        write_with_threads(&image, other, IMAGE_ZIP, threads[i]);
        scratch_expect_same_bytes(one, other);
    }
    image_release(&image);
}

/* Thousands of short chunks, among them some whose ZIP stream is as long as the pixels, which the
 * library by itself stores so that no reader gets them back. */
static void test_stream_as_long_as_the_pixels(void **state)
{
    struct image image = {.width = 1, .height = 16 * 4000};
    float *samples = image_add_channel(&image, "R");
    uint32_t random = 7, steps = 1;
    assert_non_null(samples);
    for (size_t i = 0; i < image.height; i++) {
        random = random * 1664525u + 1013904223u;
        steps = i % 16 == 0 ? 1 + (random >> 8) % 24 : steps;
        samples[i] = (float)((random >> 12) % steps) * 0x1p-4f;
        if ((random >> 9) % 3 == 0) {
            samples[i] += (float)(random >> 8) * 0x1p-24f;
        }
    }
    assert_round_trip(state, &image);
}

/* What a tool of the OpenEXR package says about the file, to be freed; NULL where there is none.
 * `has_status`: exrinfo 3.1 has none, as it returns a variable that it never set. */
static char *told_by(const char *tool, bool has_status, const char *path, const char *output)
{
    char command[2048];
    size_t size;
    snprintf(command, sizeof command, "command -v %s >/dev/null", tool);
    if (system(command) != 0) {
        print_message("skipped: %s is not installed\n", tool);
        return NULL;
    }
    snprintf(command, sizeof command, "%s '%s' >'%s' 2>&1", tool, path, output);
    int status = system(command);
    assert_true(has_status ? status == 0 : status != -1);
    char *text = (char *)scratch_load(output, &size);
    text[size] = '\0';
    return text;
}

static void test_other_programs_can_read_it(void **state)
{
    static const char *const header[] = {
        "indirect.R, 32-bit floating-point, sampling 1 1",
        "red   (0.64 0.33)",
        "white (0.3127 0.329)",
        "zip, multi-scanline blocks",
        "dataWindow (type box2i): (0 0) - (256 18)",
        "displayWindow (type box2i): (0 0) - (256 18)",
        "increasing y",
        "pixelAspectRatio (type float): 1",
        "screenWindowWidth (type float): 1",
    };
    struct image image = picture(257, 19, 25);
    const char *path = scratch_path(state, "tools.exr");
    const char *output = scratch_path(state, "output.txt");
    write_picture(&image, path);
    image_release(&image);
    char *text = told_by("exrheader", true, path, output);
    for (size_t i = 0; text && i < sizeof header / sizeof *header; i++) {
        assert_non_null(strstr(text, header[i]));
    }
    assert_true(!text || !strstr(text, "capDate"));
    free(text);
    text = told_by("exrinfo", false, path, output);
    assert_true(!text || strstr(text, "257 x 19"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_of_compressions),
        cmocka_unit_test(test_channels_in_memory),
        cmocka_unit_test(test_attributes_in_memory),
        SCRATCH_TEST(test_sizes),
        SCRATCH_TEST(test_exact_bits),
        SCRATCH_TEST(test_many_channels),
        SCRATCH_TEST(test_attributes_in_files),
        SCRATCH_TEST(test_reserved_attributes),
        SCRATCH_TEST(test_same_bytes_whatever_the_threads),
        SCRATCH_TEST(test_stream_as_long_as_the_pixels),
        SCRATCH_TEST(test_other_programs_can_read_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
