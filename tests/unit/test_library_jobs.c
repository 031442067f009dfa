/* test_library_jobs.c: psplat_render as a long job: files, films, budgets, and pictures on the way,
 * as the command has them. tests/cli/ tries the same by the command, which is a client of the
 * library. */
#include "library_fixture.h"

#include <stdbool.h>

/* What a render told. */
struct told {
    char remarks[8][600];
    unsigned remark_count, shown_count, pass_count;
    psplat_progress last;
    size_t shown_width;
    bool writes_now, was_there;
    unsigned stop_after; /* passes; 0: none */
    const char *path;    /* of the picture that `pass` looks for */
};

static void note_remark(void *user, int kind, const char *message)
{
    struct told *told = user;
    assert_int_equal(kind, PSPLAT_REMARK);
    assert_true(told->remark_count < 8);
    snprintf(told->remarks[told->remark_count++], sizeof told->remarks[0], "%s", message);
}

static void note_progress(void *user, const psplat_progress *progress)
{
    struct told *told = user;
    told->last = *progress;
}

static void note_pass(void *user, psplat_rendering *rendering, uint32_t passes)
{
    struct told *told = user;
    (void)rendering;
    told->pass_count = passes;
    told->was_there |= told->path && access(told->path, F_OK) == 0;
}

static void note_picture(void *user, psplat_picture *picture)
{
    struct told *told = user;
    told->shown_count++;
    told->shown_width = psplat_picture_width(picture);
    assert_non_null(psplat_picture_channel(picture, "indirect.R"));
    psplat_picture_destroy(picture);
}

static int asks_to_write(void *user)
{
    const struct told *told = user;
    return told->writes_now;
}

static int asks_to_stop(void *user)
{
    const struct told *told = user;
    return told->stop_after > 0 && told->pass_count >= told->stop_after;
}

static ps_result render(psplat_scene *scene, struct told *told, psplat_picture **picture,
                        psplat_error *error)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks,
        .user = told,
        .progress = note_progress,
        .cancelled = asks_to_stop,
        .pass = note_pass,
        .write_now = asks_to_write,
    };
    return psplat_render(scene, &callbacks, picture, error);
}

/* The same files as the picture that is returned would give, and a remark for each. */
static void test_files(void **state)
{
    psplat_scene *scene = psplat_scene_create();
    struct told told = {.writes_now = false};
    psplat_picture *picture;
    psplat_error error;
    char exr[512], png[512], stats[512], own[512];
    snprintf(exr, sizeof exr, "%s", scratch_path(state, "a.exr"));
    snprintf(png, sizeof png, "%s", scratch_path(state, "a.png"));
    snprintf(stats, sizeof stats, "%s", scratch_path(state, "a.json"));
    snprintf(own, sizeof own, "%s", scratch_path(state, "own.exr"));
    set(scene, "output", exr);
    set(scene, "output", png);
    set(scene, "stats", stats);
    psplat_scene_listen(scene, note_remark, &told);
    load(scene, SCENE);
    assert_int_equal(render(scene, &told, &picture, &error), PS_OK);
    assert_int_equal(told.remark_count, 2);
    assert_non_null(strstr(told.remarks[0], "wrote "));
    assert_non_null(strstr(told.remarks[0], exr));
    assert_non_null(strstr(told.remarks[1], png));
    assert_int_equal(psplat_picture_write(picture, own, &error), PS_OK);
    scratch_expect_same_bytes(exr, own);
    assert_int_equal(psplat_picture_write(picture, own, &error), PS_OK);
    assert_int_equal(access(stats, F_OK), 0);
    psplat_picture_destroy(picture);
    /* Nobody waits for the picture. */
    assert_int_equal(unlink(exr), 0);
    assert_int_equal(psplat_render(scene, NULL, NULL, &error), PS_OK);
    scratch_expect_same_bytes(exr, own);
    psplat_scene_destroy(scene);
}

static void expect_wrong(psplat_scene *scene, const char *message)
{
    psplat_error error;
    assert_int_not_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error), PS_OK);
    assert_int_equal(error.has_place, 0);
    if (!strstr(error.message, message))
        fail_msg("no '%s' in '%s'", message, error.message);
}

static void test_wrong(void **state)
{
    (void)state;
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "resume", NULL);
    expect_wrong(scene, "--resume needs --checkpoint FILE.exr, which names the film");
    set(scene, "checkpoint", "/no/such/folder/a.exr");
    expect_wrong(scene, "can't write '/no/such/folder/a.exr'");
    set(scene, "tile", "64");
    expect_wrong(scene, "--tile does not go with --checkpoint");
    assert_int_equal(psplat_scene_set(scene, "output", "a.jpg", &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "--output: 'a.jpg' ends neither in .exr nor in .png"));
    assert_int_equal(psplat_scene_set(scene, "time", "soon", &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "--time: expected a time such as 90s, 10m or 2h, got"));
    psplat_scene_destroy(scene);
}

/* Cancelled after two passes, and gone on with: the film and the picture of five at once. */
static void test_films(void **state)
{
    psplat_scene *scene = psplat_scene_create();
    struct told told = {.stop_after = 2};
    psplat_picture *parts, *whole;
    psplat_error error;
    char film[512];
    snprintf(film, sizeof film, "%s", scratch_path(state, "film.exr"));
    set(scene, "passes", "5");
    load(scene, SCENE);
    assert_int_equal(render(scene, &(struct told){.stop_after = 0}, &whole, &error), PS_OK);
    set(scene, "checkpoint", film);
    psplat_scene_listen(scene, note_remark, &told);
    load(scene, SCENE);
    assert_int_equal(render(scene, &told, &parts, &error), PS_CANCELLED);
    assert_string_equal(psplat_picture_attribute(parts, "psplat.passes"), "2");
    psplat_picture_destroy(parts);
    assert_int_equal(render(scene, &told, &parts, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "is there already; --resume goes on with it"));
    set(scene, "resume", NULL);
    load(scene, SCENE);
    told = (struct told){.stop_after = 0};
    assert_int_equal(render(scene, &told, &parts, &error), PS_OK);
    assert_non_null(strstr(told.remarks[0], "goes on with "));
    assert_non_null(strstr(told.remarks[0], ": 2 passes"));
    assert_int_equal(told.last.passes, 5);
    for (size_t i = 0; i < psplat_picture_channel_count(whole); i++) {
        const char *name = psplat_picture_channel_name(whole, i);
        assert_memory_equal(psplat_picture_channel(parts, name),
                            psplat_picture_channel(whole, name), 32 * 18 * sizeof(float));
    }
    psplat_picture_destroy(parts);
    psplat_picture_destroy(whole);
    psplat_scene_destroy(scene);
}

/* Passes until the error is small enough, which progress tells; and until the time is up. */
static void test_budgets(void **state)
{
    (void)state;
    psplat_scene *scene = psplat_scene_create();
    struct told told = {.writes_now = false};
    psplat_picture *picture;
    psplat_error error;
    set(scene, "error", "4%");
    set(scene, "plugin", "estimator=pathtrace:samples=1");
    load(scene, SCENE);
    assert_int_equal(render(scene, &told, &picture, &error), PS_OK);
    assert_true(told.last.error > 0 && told.last.error <= 0.04);
    assert_true(told.last.passes > 1);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
    scene = psplat_scene_create();
    set(scene, "time", "0.2s");
    load(scene, SCENE);
    assert_int_equal(render(scene, &told, &picture, &error), PS_OK);
    assert_true(told.last.passes >= 1 && told.last.passes < 1000000);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

/* Pictures for a viewer are as large as the last one, and come before the first pass where the
 * picture is large. */
static void test_shown(void **state)
{
    (void)state;
    psplat_scene *scene = psplat_scene_create();
    struct told told = {.writes_now = false};
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks, .user = &told, .show = note_picture};
    psplat_error error;
    set(scene, "size", "320x180");
    set(scene, "quality", "draft");
    load(scene, SCENE);
    assert_int_equal(psplat_render(scene, &callbacks, NULL, &error), PS_OK);
    assert_true(told.shown_count >= 1);
    assert_int_equal(told.shown_width, 320);
    psplat_scene_destroy(scene);
}

/* Files appear between passes, when they are asked for. */
static void test_written_on_the_way(void **state)
{
    psplat_scene *scene = psplat_scene_create();
    psplat_error error;
    char path[512];
    snprintf(path, sizeof path, "%s", scratch_path(state, "a.exr"));
    set(scene, "output", path);
    set(scene, "passes", "3");
    load(scene, SCENE);
    struct told told = {.path = path};
    assert_int_equal(render(scene, &told, NULL, &error), PS_OK);
    assert_false(told.was_there);
    assert_int_equal(unlink(path), 0);
    told.writes_now = true;
    assert_int_equal(render(scene, &told, NULL, &error), PS_OK);
    assert_true(told.was_there);
    psplat_scene_destroy(scene);
}

/* Tiles go into files without anybody who takes them. */
static void test_tiled_files(void **state)
{
    psplat_scene *scene = psplat_scene_create();
    psplat_error error;
    struct stat status;
    char path[512];
    snprintf(path, sizeof path, "%s", scratch_path(state, "a.exr"));
    set(scene, "output", path);
    set(scene, "size", "100x70");
    set(scene, "tile", "64");
    load(scene, SCENE);
    assert_int_equal(psplat_render(scene, NULL, NULL, &error), PS_OK);
    assert_int_equal(stat(path, &status), 0);
    assert_true(status.st_size > 10000);
    psplat_scene_destroy(scene);
}

static void test_models_by_name(void **state)
{
    (void)state;
    assert_true(psplat_scene_is_model("a/lamp.glb"));
    assert_true(psplat_scene_is_model("lamp.OBJ"));
    assert_false(psplat_scene_is_model("lamp.psd"));
    assert_false(psplat_scene_is_model("glb"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_files),       cmocka_unit_test(test_wrong),
        SCRATCH_TEST(test_films),       cmocka_unit_test(test_budgets),
        cmocka_unit_test(test_shown),   SCRATCH_TEST(test_written_on_the_way),
        SCRATCH_TEST(test_tiled_files), cmocka_unit_test(test_models_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
