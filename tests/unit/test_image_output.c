/* test_image_output.c: files that cannot be written leave nothing behind, and PNG. */
#include "base/output_file.h"
#include "image/image.h"
#include "scratch.h"
#include "support/workers.h"

#include <errno.h>
#include <fcntl.h>
#include <png.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/resource.h>

#define WIDTH 23
#define HEIGHT 40

/* Writes a small picture in the form that the path's ending names. */
static ps_result write_some(const char *path, struct error *error)
{
    static const uint8_t rgb[WIDTH * HEIGHT * 3] = {1, 2, 3};
    *error = (struct error){{0}};
    if (strstr(path, "png")) {
        return image_write_png(path, WIDTH, HEIGHT, rgb, NULL, 0, error);
    }
    struct image image = {.width = WIDTH, .height = HEIGHT};
    assert_non_null(image_add_channel(&image, "R"));
    ps_result result = image_write_exr(&image, path, IMAGE_ZIP, NULL, error);
    image_release(&image);
    return result;
}

static void assert_refused(const char *path, const char *reason)
{
    struct error error;
    assert_int_equal(write_some(path, &error), PS_ERROR_IO);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, reason));
}

static void test_impossible_places(void **state)
{
    scratch_store(scratch_path(state, "file"), "x", 1);
    assert_int_equal(mkdir(scratch_path(state, "directory"), 0700), 0);
    assert_int_equal(mkfifo(scratch_path(state, "pipe"), 0600), 0);
    assert_int_equal(symlink("nowhere", scratch_path(state, "link")), 0);
    assert_refused(scratch_path(state, "missing/a.exr"), strerror(ENOENT));
    assert_refused(scratch_path(state, "missing/a.png"), strerror(ENOENT));
    assert_refused(scratch_path(state, "file/a.exr"), strerror(ENOTDIR));
    assert_refused(scratch_path(state, "directory"), "directory");
    assert_refused(scratch_path(state, "missing/"), "no file");
    assert_refused(scratch_path(state, "pipe"), "neither a file nor a device");
    assert_refused(scratch_path(state, "link"), "symbolic link");
    assert_refused("", "no file");
    assert_int_equal(scratch_file_count(state), 4);
}

static void test_without_permission(void **state)
{
    if (geteuid() == 0) {
        print_message("skipped: root may write anywhere\n");
        return;
    }
    const char *kept = scratch_path(state, "kept.exr");
    scratch_store(kept, "x", 1);
    assert_int_equal(chmod(kept, 0400), 0);
    assert_refused(kept, strerror(EACCES));
    assert_int_equal(chmod(scratch_path(state, "."), 0500), 0);
    assert_refused(scratch_path(state, "a.exr"), strerror(EACCES));
    assert_refused(scratch_path(state, "a.png"), strerror(EACCES));
    assert_int_equal(scratch_file_count(state), 1);
}

static void test_devices_are_written_directly(void **state)
{
    (void)state;
    struct stat status;
    struct error error;
    assert_int_equal(write_some("/dev/null", &error), PS_OK);
    assert_int_equal(stat("/dev/null", &status), 0);
    assert_true(S_ISCHR(status.st_mode));
    if (stat("/dev/full", &status) == 0) {
        assert_refused("/dev/full", strerror(ENOSPC));
    }
}

/* A disk that fills up half-way, played by a limit on the size of files. */
static void test_a_write_that_fails_leaves_what_was_there(void **state)
{
    static const char *const names[] = {"a.exr", "a.png"};
    struct rlimit limit, old;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    limit = old;
    limit.rlim_cur = 40;
    signal(SIGXFSZ, SIG_IGN);
    for (size_t i = 0; i < 2; i++) {
        const char *path = scratch_path(state, names[i]);
        size_t size;
        scratch_store(path, "before", 6);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        struct error error;
        ps_result result = write_some(path, &error);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(result, PS_ERROR_IO);
        assert_non_null(strstr(error.text, strerror(EFBIG)));
        unsigned char *bytes = scratch_load(path, &size);
        assert_int_equal(size, 6);
        assert_memory_equal(bytes, "before", 6);
        free(bytes);
        assert_int_equal(scratch_file_count(state), i + 1);
    }
}

/* Among many chunks on several threads: those that wait for their turn must not wait for ever. */
static void test_a_chunk_that_fails_ends_the_others(void **state)
{
    struct image image = {.width = 64, .height = 16 * 50};
    float *samples = image_add_channel(&image, "R");
    assert_non_null(samples);
    for (size_t i = 0; i < image.width * image.height; i++) {
        samples[i] = (float)(i * 2654435761u % 1000003u);
    }
    struct rlimit limit, old;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    limit = old;
    signal(SIGXFSZ, SIG_IGN);
    struct workers *workers = start_workers(4);
    for (rlim_t size = 500; size < 60000; size += 6000) {
        struct error error;
        limit.rlim_cur = size;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        ps_result result =
            image_write_exr(&image, scratch_path(state, "a.exr"), IMAGE_ZIP, workers, &error);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(result, PS_ERROR_IO);
        assert_non_null(strstr(error.text, strerror(EFBIG)));
        assert_int_equal(scratch_file_count(state), 0);
    }
    workers_destroy(workers);
    image_release(&image);
}

static void test_replacing(void **state)
{
    struct stat status;
    struct error error;
    mode_t mask = umask(027);
    scratch_store(scratch_path(state, "old.exr"), "before", 6);
    assert_int_equal(symlink("old.exr", scratch_path(state, "link.exr")), 0);
    assert_int_equal(write_some(scratch_path(state, "link.exr"), &error), PS_OK);
    umask(mask);
    assert_int_equal(lstat(scratch_path(state, "link.exr"), &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(lstat(scratch_path(state, "old.exr"), &status), 0);
    assert_true(S_ISREG(status.st_mode) && status.st_size > 100);
    assert_int_equal(status.st_mode & 0777, 0640);
    assert_int_equal(scratch_file_count(state), 2);
}

static void test_long_names(void **state)
{
    char name[252];
    struct error error;
    memset(name, 'n', sizeof name);
    memcpy(name + 247, ".exr", 5);
    assert_int_equal(write_some(scratch_path(state, name), &error), PS_OK);
    assert_int_equal(scratch_file_count(state), 1);
}

static void test_two_files_at_once(void **state)
{
    struct output_file first, second;
    struct error error;
    const char *path = scratch_path(state, "same");
    size_t size;
    assert_int_equal(output_file_open(&first, path, &error), PS_OK);
    assert_int_equal(output_file_open(&second, path, &error), PS_OK);
    assert_int_equal(output_file_write(&second, 3, "def", 3, &error), PS_OK);
    assert_int_equal(output_file_write(&second, 0, "abc", 3, &error), PS_OK);
    assert_int_equal(output_file_write(&first, 0, "no", 2, &error), PS_OK);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(output_file_commit(&second, &error), PS_OK);
    output_file_discard(&first);
    unsigned char *bytes = scratch_load(path, &size);
    assert_int_equal(size, 6);
    assert_memory_equal(bytes, "abcdef", 6);
    free(bytes);
    assert_int_equal(scratch_file_count(state), 1);
}

/* The second of two new files of a name finds it taken; and so does a third. */
static void test_a_new_file_replaces_none(void **state)
{
    struct output_file first, second;
    struct error error;
    const char *path = scratch_path(state, "new");
    size_t size;
    assert_int_equal(output_file_open_new(&first, path, &error), PS_OK);
    assert_int_equal(output_file_open_new(&second, path, &error), PS_OK);
    assert_int_equal(output_file_write(&first, 0, "abc", 3, &error), PS_OK);
    assert_int_equal(output_file_write(&second, 0, "no", 2, &error), PS_OK);
    assert_int_equal(output_file_commit(&first, &error), PS_OK);
    assert_int_equal(output_file_commit(&second, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "new is there already, and stays as it is"));
    assert_int_equal(output_file_open_new(&second, path, &error), PS_ERROR_INVALID);
    unsigned char *bytes = scratch_load(path, &size);
    assert_int_equal(size, 3);
    assert_memory_equal(bytes, "abc", 3);
    free(bytes);
    assert_int_equal(scratch_file_count(state), 1);
}

static void assert_has_text(png_const_textp texts, int count, const char *key, const char *value,
                            int compression)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(texts[i].key, key) == 0) {
            assert_string_equal(texts[i].text, value);
            assert_int_equal(texts[i].compression, compression);
            return;
        }
    }
    fail_msg("no text '%s'", key);
}

static void check_png(FILE *file, const uint8_t *rgb)
{
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_textp texts = NULL;
    int count = 0, intent = -1;
    png_init_io(png, file); /* an error here aborts the test, as libpng does by itself */
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(png_get_image_width(png, info), WIDTH);
    assert_int_equal(png_get_image_height(png, info), HEIGHT);
    assert_int_equal(png_get_bit_depth(png, info), 8);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    assert_true(png_get_sRGB(png, info, &intent) != 0);
    png_bytepp rows = png_get_rows(png, info);
    for (size_t y = 0; y < HEIGHT; y++) {
        assert_memory_equal(rows[y], rgb + y * WIDTH * 3, WIDTH * 3);
    }
    png_get_text(png, info, &texts, &count);
    assert_int_equal(count, 2);
    assert_has_text(texts, count, "Software", "psplat", PNG_TEXT_COMPRESSION_NONE);
    assert_has_text(texts, count, "Author", "Zo\xc3\xab", PNG_ITXT_COMPRESSION_NONE);
    png_destroy_read_struct(&png, &info, NULL);
}

static void test_png(void **state)
{
    static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    char software[] = "Software", name[] = "psplat", author[] = "Author", person[] = "Zo\xc3\xab";
    const struct image_attribute texts[] = {{software, name}, {author, person}};
    uint8_t rgb[WIDTH * HEIGHT * 3];
    struct error error;
    const char *path = scratch_path(state, "a.png");
    for (size_t i = 0; i < sizeof rgb; i++) {
        rgb[i] = (uint8_t)(i * 7 + i / 256);
    }
    assert_int_equal(image_write_png(path, WIDTH, HEIGHT, rgb, texts, 2, &error), PS_OK);
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    assert_memory_equal(bytes, signature, sizeof signature);
    free(bytes);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    check_png(file, rgb);
    fclose(file);
    assert_int_equal(scratch_file_count(state), 1);
}

static void test_png_refusals(void **state)
{
    char empty[] = "", bad[] = "tab\there", value[] = "x", long_key[81];
    uint8_t rgb[3] = {0};
    memset(long_key, 'k', 80);
    long_key[80] = '\0';
    char *const keys[] = {empty, long_key, bad};
    const char *path = scratch_path(state, "a.png");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const struct image_attribute text = {keys[i], value};
        struct error error = {{0}};
        assert_int_equal(image_write_png(path, 1, 1, rgb, &text, 1, &error), PS_ERROR_INVALID);
        assert_non_null(strstr(error.text, path));
    }
    static const size_t sizes[][2] = {{0, 1}, {1, 0}, {SIZE_MAX, 1}, {1, (size_t)1 << 33}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct error error = {{0}};
        assert_int_equal(image_write_png(path, sizes[i][0], sizes[i][1], rgb, NULL, 0, &error),
                         PS_ERROR_INVALID);
        assert_non_null(strstr(error.text, path));
    }
    assert_int_equal(scratch_file_count(state), 0);
}

static void test_exr_refusals(void **state)
{
    struct error error = {{0}};
    const char *path = scratch_path(state, "a.exr");
    struct image image = {.width = 2, .height = 2};
    assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, path));
    assert_non_null(image_add_channel(&image, "R"));
    assert_non_null(image_add_channel(&image, "R"));
    assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "two channels"));
    image_release(&image);
    assert_int_equal(scratch_file_count(state), 0);
}

/* The file says where in the picture an image lies, and readers hear of it. */
static void test_windows(void **state)
{
    static const struct picture_window windows[] = {
        {0}, {5, 17, 99, 123}, {76, 0, 99, 40}, {0, 0, WIDTH, HEIGHT}};
    const char *path = scratch_path(state, "window.exr");
    for (size_t i = 0; i < sizeof windows / sizeof windows[0]; i++) {
        struct image image = {.width = WIDTH, .height = HEIGHT, .window = windows[i]}, read = {0};
        struct error error;
        float *samples = image_add_channel(&image, "R");
        for (size_t k = 0; k < (size_t)WIDTH * HEIGHT; k++)
            samples[k] = (float)k;
        assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_OK);
        assert_int_equal(image_read_exr(path, &read, &error), PS_OK);
        assert_true(picture_window_same(read.window, windows[i > 0 ? i : 3]));
        assert_memory_equal(image_channel(&read, "R"), samples, sizeof(float) * WIDTH * HEIGHT);
        image_release(&image);
        image_release(&read);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_impossible_places),
        SCRATCH_TEST(test_without_permission),
        cmocka_unit_test(test_devices_are_written_directly),
        SCRATCH_TEST(test_a_write_that_fails_leaves_what_was_there),
        SCRATCH_TEST(test_a_chunk_that_fails_ends_the_others),
        SCRATCH_TEST(test_replacing),
        SCRATCH_TEST(test_long_names),
        SCRATCH_TEST(test_two_files_at_once),
        SCRATCH_TEST(test_a_new_file_replaces_none),
        SCRATCH_TEST(test_png),
        SCRATCH_TEST(test_png_refusals),
        SCRATCH_TEST(test_exr_refusals),
        SCRATCH_TEST(test_windows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
