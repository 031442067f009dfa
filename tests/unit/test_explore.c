/* test_explore.c: what `psplat explore` is made of, without its server: options, pictures, files
 * that change, and the life of views. tests/cli/test_explore.sh asks the server. */
#include "explore/explorer.h"

#include "explore/comparison.h"
#include "explore/json_text.h"
#include "explore/page.h"
#include "explore/state.h"
#include "scratch.h"

#include <fcntl.h>
#include <math.h>
#include <time.h>

#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}\n"                     \
    "image: {width: 16, height: 9}\n"                                                              \
    "materials: {white: {diffuse: [0.7, 0.6, 0.5]}}\n"                                             \
    "lights: [{point: {location: [0, 3, -1], intensity: [10, 10, 10]}}]\n"                         \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: white}\n"     \
    "  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}\n"                      \
    "render: {injection: {photon: {count: 200}}, estimator: splat, denoiser: none}\n"

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void pause_a_moment(void)
{
    const struct timespec moment = {.tv_nsec = 10000000};
    nanosleep(&moment, NULL);
}

/* --- options
 * ----------------------------------------------------------------------------------------- */

static ps_result read_options(const char *text, struct option_list *list)
{
    struct arena arena = {0};
    struct json *root;
    struct error error;
    char *copy = strdup(text);
    assert_non_null(copy);
    assert_int_equal(json_read(&arena, copy, strlen(copy), &root, &error), PS_OK);
    ps_result result = option_list_read(list, root, &error);
    arena_release(&arena);
    free(copy);
    return result;
}

static void test_options(void **state)
{
    struct option_list list = {0}, scene = {0};
    struct json_buffer buffer;
    char *text = NULL;
    size_t length;
    (void)state;
    assert_int_equal(read_options("[[\"size\", \"16x9\"], [\"param\", \"who=it's\"], [\"plugin\", "
                                  "\"estimator=splat\"], [\"plugin\", \"tonemap=clip\"]]",
                                  &list),
                     PS_OK);
    assert_string_equal(option_list_value(&list, "plugin"), "tonemap=clip");
    assert_null(option_list_value(&list, "seed"));
    FILE *stream = open_memstream(&text, &length);
    option_list_print(&list, stream);
    fclose(stream);
    assert_string_equal(text, " --size 16x9 --param 'who=it'\\''s' --plugin estimator=splat "
                              "--plugin tonemap=clip");
    free(text);
    assert_true(option_list_append_scene(&scene, &list));
    assert_true(json_buffer_begin(&buffer));
    option_list_write(&scene, &buffer.writer);
    text = json_buffer_end(&buffer);
    assert_string_equal(
        text, "[[\"size\",\"16x9\"],[\"param\",\"who=it's\"],[\"plugin\",\"tonemap=clip\"]]");
    free(text);
    option_list_release(&list);
    option_list_release(&scene);
}

static void test_wrong_options(void **state)
{
    static const char *const texts[] = {
        "{}",
        "[1]",
        "[[\"size\"]]",
        "[[\"size\", \"1x1\", \"\"]]",
        "[[\"size\", null]]",
        "[[\"threads\", \"1\"]]",
        "[[\"passes\", \"1\"]]",
        "[[\"preview\", \"\"]]",
        "[[\"restrict\", \"/\"]]",
        "[[\"plugin\", \"estimator=/tmp/x.so\"]]",
        "[[\"plugin\", \"estimator=../x.so:key=1\"]]",
        "[[\"param\", \"a=\\u0000\"]]",
        "[[\"param\", \"a=\xff\"]]",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct option_list list = {0};
        if (read_options(texts[i], &list) != PS_ERROR_INVALID)
            fail_msg("%s is taken", texts[i]);
        option_list_release(&list);
    }
}

static void test_texts(void **state)
{
    struct json_buffer buffer;
    (void)state;
    assert_true(json_buffer_begin(&buffer));
    json_writer_open(&buffer.writer, '[');
    json_text_write(&buffer.writer, "caf\xc3\xa9 \xff\xc3");
    json_text_write(&buffer.writer, NULL);
    json_number_write(&buffer.writer, NAN);
    json_number_write(&buffer.writer, 1.5);
    json_writer_close(&buffer.writer, '[');
    char *text = json_buffer_end(&buffer);
    assert_string_equal(text, "[\"caf\xc3\xa9 \xef\xbf\xbd\xef\xbf\xbd\",null,null,1.5]");
    free(text);
}

static void test_page(void **state)
{
    char path[1024], bytes[65536];
    const char *source = getenv("PSPLAT_SOURCE");
    (void)state;
    if (!source)
        skip();
    assert_true(page_file_count > 0);
    for (size_t i = 0; i < page_file_count; i++) {
        snprintf(path, sizeof path, "%s/src/explore/page/%s", source, page_files[i].name);
        int file = open(path, O_RDONLY);
        assert_true(file >= 0);
        ssize_t length = read(file, bytes, sizeof bytes);
        close(file);
        assert_true(length >= 0 && (size_t)length <= page_files[i].length);
        assert_memory_equal(bytes, page_files[i].bytes, (size_t)length);
    }
}

/* --- files
 * ------------------------------------------------------------------------------------------- */

static void age(const char *path, long seconds)
{
    struct timespec times[2];
    clock_gettime(CLOCK_REALTIME, &times[0]);
    times[0].tv_sec -= seconds;
    times[1] = times[0];
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static void test_watched_files(void **state)
{
    struct watched_files files = {0};
    struct timespec now;
    const char *path = scratch_path(state, "a"), *other = scratch_path(state, "b");
    write_text(path, "1");
    age(path, 100);
    watched_files_add(&files, path);
    watched_files_add(&files, other);
    watched_files_add(&files, path);
    assert_int_equal(files.count, 2);
    clock_gettime(CLOCK_REALTIME, &now);
    watched_files_read(&files, now);
    assert_false(watched_files_changed(&files));
    assert_false(watched_files_changed(&files));
    write_text(path, "22");
    assert_false(watched_files_changed(&files)); /* it may be written still */
    assert_true(watched_files_changed(&files));
    assert_false(watched_files_changed(&files));
    write_text(other, "");
    assert_false(watched_files_changed(&files));
    assert_true(watched_files_changed(&files));
    /* Written while they were read. */
    now.tv_sec -= 10;
    age(path, 5);
    watched_files_read(&files, now);
    assert_false(watched_files_changed(&files));
    assert_true(watched_files_changed(&files));
    /* A time to come. */
    age(path, -1000);
    watched_files_read(&files, now);
    assert_false(watched_files_changed(&files));
    assert_false(watched_files_changed(&files));
    watched_files_release(&files);
}

/* --- views
 * ------------------------------------------------------------------------------------------- */

static void start(struct explorer *explorer, const char *path, const char *size)
{
    struct option_list fixed = {0}, options = {0};
    psplat_error problem = {.message = ""};
    assert_true(option_list_add(&fixed, "threads", "2"));
    assert_true(option_list_add(&options, "size", size));
    if (explorer_create(explorer, path, &fixed, &options, 2, &problem) != PS_OK)
        fail_msg("%s", problem.message);
    assert_int_equal(explorer_start(explorer), PS_OK);
}

static void stop(struct explorer *explorer)
{
    explorer_stop(explorer);
    explorer_release(explorer);
}

/* Waits, up to ten minutes, for all passes of a view; its picture, to be released. */
static struct shown_picture *wait_for_picture(struct explorer *explorer, int index)
{
    for (int i = 0; i < 60000; i++) {
        struct view *view = &explorer->views[index];
        pthread_mutex_lock(&explorer->lock);
        bool done = !view->shows_preview && view->shown_passes == view->passes && !view->stage[0];
        struct shown_picture *shown = done ? shown_picture_keep(view->shown) : NULL;
        pthread_mutex_unlock(&explorer->lock);
        if (shown)
            return shown;
        pause_a_moment();
    }
    fail_msg("no picture");
    return NULL;
}

static void expect_state(struct explorer *explorer, const char *part)
{
    uint64_t serial;
    char *text = state_write(explorer, &serial);
    assert_non_null(text);
    assert_null(strchr(text, '\n'));
    if (!strstr(text, part))
        fail_msg("no '%s' in %s", part, text);
    free(text);
}

static void test_views(void **state)
{
    struct explorer explorer;
    struct option_list options = {0};
    psplat_error error;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    start(&explorer, path, "16x9");
    struct shown_picture *first = wait_for_picture(&explorer, VIEW_A);
    assert_int_equal(shown_picture_width(first), 16);
    expect_state(&explorer, "--threads 2 --size 16x9 --passes 2\"");
    expect_state(&explorer, "\"b\":null");
    assert_null(explorer_picture(&explorer, VIEW_B));
    assert_true(option_list_add(&options, "size", "8x4"));
    assert_int_equal(explorer_put_view(&explorer, VIEW_B, &options, 1, &error), PS_OK);
    assert_int_equal(options.count, 0);
    struct shown_picture *second = wait_for_picture(&explorer, VIEW_B);
    assert_int_equal(shown_picture_width(second), 8);
    assert_true(shown_picture_number(second) > shown_picture_number(first));
    assert_true(option_list_add(&options, "plugin", "estimator=none"));
    assert_int_equal(explorer_put_view(&explorer, VIEW_B, &options, 1, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "none"));
    expect_state(&explorer, "--size 8x4 --passes 1\"");
    explorer_delete_view(&explorer, VIEW_B);
    assert_null(explorer_picture(&explorer, VIEW_B));
    stop(&explorer);
    /* References outlive the views. */
    struct shown_layer layer;
    assert_true(shown_picture_layer(first, "picture", &layer));
    assert_int_equal(layer.channel_count, 3);
    shown_picture_release(first);
    shown_picture_release(second);
}

/* As bytes in blocks of any size they are the same. */
static void test_bytes_of_layers(void **state)
{
    struct explorer explorer;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    start(&explorer, path, "5x3");
    struct shown_picture *shown = wait_for_picture(&explorer, VIEW_A);
    stop(&explorer);
    static const struct {
        const char *name;
        size_t channels;
    } rows[] = {{"picture", 3}, {"display", 3}, {"indirect", 3}, {"N", 3}, {"Z", 1}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char all[1024], parts[1024];
        struct shown_layer layer;
        assert_true(shown_picture_layer(shown, rows[i].name, &layer));
        size_t length = shown_layer_bytes(shown, &layer);
        assert_int_equal(length, 16 + 4 * 15 * rows[i].channels);
        assert_int_equal(shown_layer_read(shown, &layer, 0, all, sizeof all), length);
        assert_memory_equal(all, "\5\0\0\0\3\0\0\0", 8);
        for (size_t at = 0; at < length;)
            at += shown_layer_read(shown, &layer, at, parts + at, 7);
        assert_memory_equal(all, parts, length);
        float sample;
        memcpy(&sample, all + 16, sizeof sample);
        if (!layer.is_display)
            assert_memory_equal(&sample, layer.planes[0], sizeof sample);
    }
    struct shown_layer layer;
    assert_false(shown_picture_layer(shown, "", &layer));
    assert_false(shown_picture_layer(shown, "indirect.R.R", &layer));
    shown_picture_release(shown);
}

static void test_comparison(void **state)
{
    struct explorer explorer;
    struct option_list options = {0};
    psplat_error told;
    struct error error;
    float *map;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    start(&explorer, path, "16x9");
    assert_true(option_list_add(&options, "seed", "5"));
    assert_int_equal(explorer_put_view(&explorer, VIEW_B, &options, 1, &told), PS_OK);
    struct shown_picture *a = wait_for_picture(&explorer, VIEW_A);
    struct shown_picture *b = wait_for_picture(&explorer, VIEW_B);
    stop(&explorer);
    assert_int_equal(comparison_map(a, b, "indirect", "difference", &map, &error), PS_OK);
    free(map);
    assert_int_equal(comparison_map(a, b, "indirect", "x", &map, &error), PS_ERROR_INVALID);
    assert_null(map);
    assert_int_equal(comparison_map(a, b, "x", "flip", &map, &error), PS_ERROR_INVALID);
    assert_null(map);
    shown_picture_release(a);
    shown_picture_release(b);
}

/* A sample of a view's picture. */
static struct picture_sample *sample_of(struct explorer *explorer, int view)
{
    struct shown_picture *shown = wait_for_picture(explorer, view);
    struct picture_sample *sample = picture_sample_create(shown);
    assert_non_null(sample);
    shown_picture_release(shown);
    return sample;
}

static void test_history(void **state)
{
    struct explorer explorer;
    struct option_list options = {0};
    struct history history = {.count = 0};
    psplat_error told;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    start(&explorer, path, "800x700"); /* rows of it are left out */
    assert_true(option_list_add(&options, "size", "800x700"));
    assert_true(option_list_add(&options, "seed", "5"));
    assert_int_equal(explorer_put_view(&explorer, VIEW_B, &options, 1, &told), PS_OK);
    struct picture_sample *a = sample_of(&explorer, VIEW_A), *b = sample_of(&explorer, VIEW_B);
    stop(&explorer);
    assert_true(picture_sample_error(a, a) == 0.0);
    assert_true(picture_sample_error(a, b) > 0.0);
    /* Of passes 1 to 11 those of powers of two stay, and the last. */
    static const uint32_t kept[] = {1, 2, 4, 8, 11};
    for (uint32_t passes = 1; passes <= 11; passes++)
        history_add(&history, passes, passes, picture_sample_keep(a));
    assert_int_equal(history.count, 5);
    for (size_t i = 0; i < history.count; i++)
        assert_int_equal(history.points[i].passes, kept[i]);
    struct history copy = history_copy(&history);
    history_measure(&copy, b, false);
    assert_true(isnan(history.points[0].error));
    history_take_errors(&history, &copy);
    history_clear(&copy);
    assert_true(history.points[4].error > 0.0);
    history_measure(&history, a, false);
    assert_true(history.points[4].error > 0.0);
    history_measure(&history, a, true);
    assert_true(history.points[4].error == 0.0);
    history_clear(&history);
    picture_sample_release(a);
    picture_sample_release(b);
}

/* Stops come whenever they like: while scenes load, previews and pictures are made. */
static void test_stopping(void **state)
{
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    for (int i = 0; i < 10; i++) {
        struct explorer explorer;
        struct option_list options = {0};
        psplat_error error;
        start(&explorer, path, "160x90");
        for (int j = 0; j < i; j++)
            pause_a_moment();
        if (i % 2 == 0)
            assert_int_equal(explorer_put_view(&explorer, VIEW_B, &options, 8, &error), PS_OK);
        stop(&explorer);
    }
}

static void wait_for_failure(struct explorer *explorer)
{
    bool failed = false;
    for (int i = 0; i < 6000 && !failed; i++) {
        pause_a_moment();
        pthread_mutex_lock(&explorer->lock);
        failed = explorer->views[VIEW_A].load.failed;
        pthread_mutex_unlock(&explorer->lock);
    }
    assert_true(failed);
}

static void test_faulty_scene(void **state)
{
    struct explorer explorer;
    struct option_list fixed = {0}, options = {0};
    psplat_error problem;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, "psd: 1\nlihgts: []\n");
    age(path, 100);
    assert_int_equal(explorer_create(&explorer, path, &fixed, &options, 1, &problem), PS_OK);
    assert_non_null(strstr(problem.message, "lihgts"));
    assert_int_equal(explorer_start(&explorer), PS_OK);
    wait_for_failure(&explorer);
    expect_state(&explorer, "\"line\":1,\"column\":1}");
    write_text(path, SCENE);
    explorer_watch(&explorer);
    explorer_watch(&explorer);
    shown_picture_release(wait_for_picture(&explorer, VIEW_A));
    expect_state(&explorer, "\"scene_error\":null");
    stop(&explorer);
}

/* Options that no scene takes are no scene's fault. */
static void test_faulty_options(void **state)
{
    struct explorer explorer;
    struct option_list fixed = {0}, options = {0};
    psplat_error problem;
    const char *path = scratch_path(state, "a.psd");
    write_text(path, SCENE);
    assert_true(option_list_add(&options, "plugin", "estimator=none"));
    assert_int_equal(explorer_create(&explorer, path, &fixed, &options, 1, &problem),
                     PS_ERROR_INVALID);
    assert_non_null(strstr(problem.message, "none"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_options),     cmocka_unit_test(test_wrong_options),
        cmocka_unit_test(test_texts),       cmocka_unit_test(test_page),
        SCRATCH_TEST(test_watched_files),   SCRATCH_TEST(test_views),
        SCRATCH_TEST(test_bytes_of_layers), SCRATCH_TEST(test_comparison),
        SCRATCH_TEST(test_history),         SCRATCH_TEST(test_stopping),
        SCRATCH_TEST(test_faulty_scene),    SCRATCH_TEST(test_faulty_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
