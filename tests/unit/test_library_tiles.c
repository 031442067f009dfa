/* test_library_tiles.c: psplat.h's tiles as they come: together they are the picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <psplat/psplat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}\n"                     \
    "image: {width: 150, height: 100}\n"                                                           \
    "materials: {white: {diffuse: [0.7, 0.6, 0.5]}}\n"                                             \
    "lights:\n"                                                                                    \
    "  - point: {location: [0, 3, -1], intensity: [10, 10, 10]}\n"                                 \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: white}\n"     \
    "  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}\n"                      \
    "render:\n"                                                                                    \
    "  injection: {photon: {count: 1000}}\n"                                                       \
    "  denoiser: none\n"

enum { WIDTH = 150, HEIGHT = 100, MOST_TILES = 6 };

/* Tiles, in the order in which they come. */
struct tiles {
    size_t count;
    psplat_picture *pictures[MOST_TILES];
    size_t x[MOST_TILES], y[MOST_TILES];
    size_t stop_after; /* 0: never */
};

static void take(void *user, psplat_picture *tile, size_t x, size_t y)
{
    struct tiles *tiles = user;
    assert_true(tiles->count < MOST_TILES);
    tiles->pictures[tiles->count] = tile;
    tiles->x[tiles->count] = x;
    tiles->y[tiles->count++] = y;
}

static int stops(void *user)
{
    const struct tiles *tiles = user;
    return tiles->stop_after > 0 && tiles->count >= tiles->stop_after;
}

static void release(struct tiles *tiles)
{
    for (size_t i = 0; i < tiles->count; i++)
        psplat_picture_destroy(tiles->pictures[i]);
}

static ps_result render_tiles(const psplat_scene *scene, struct tiles *tiles)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks, .user = tiles, .cancelled = stops, .tile = take};
    psplat_error error;
    psplat_picture *none;
    ps_result result = psplat_render(scene, &callbacks, &none, &error);
    if (result != PS_OK && result != PS_CANCELLED)
        fail_msg("%s", error.message);
    assert_null(none);
    return result;
}

static psplat_scene *load(const char *option, const char *value)
{
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    assert_non_null(scene);
    assert_int_equal(psplat_scene_set(scene, "passes", "2", &error), PS_OK);
    if (option)
        assert_int_equal(psplat_scene_set(scene, option, value, &error), PS_OK);
    if (psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error) != PS_OK)
        fail_msg("%s", error.message);
    return scene;
}

static void expect_part(const psplat_picture *tile, size_t left, size_t top,
                        const psplat_picture *whole)
{
    size_t width = psplat_picture_width(tile), height = psplat_picture_height(tile);
    assert_int_equal(psplat_picture_channel_count(tile), psplat_picture_channel_count(whole));
    for (size_t i = 0; i < psplat_picture_channel_count(tile); i++) {
        const char *name = psplat_picture_channel_name(tile, i);
        const float *part = psplat_picture_channel(tile, name);
        const float *samples = psplat_picture_channel(whole, name);
        assert_non_null(samples);
        for (size_t y = 0; y < height; y++)
            assert_memory_equal(part + y * width, samples + (top + y) * WIDTH + left,
                                width * sizeof *part);
    }
}

/* Rows from the top, each from the left; those at the right and at the bottom are smaller. */
static void test_tiles_are_the_picture(void **state)
{
    (void)state;
    static const size_t places[MOST_TILES][4] = {{0, 0, 64, 64},   {64, 0, 64, 64},
                                                 {128, 0, 22, 64}, {0, 64, 64, 36},
                                                 {64, 64, 64, 36}, {128, 64, 22, 36}};
    struct tiles tiles = {.count = 0};
    psplat_error error;
    psplat_picture *whole;
    psplat_scene *scene = load("tile", "64"), *other = load(NULL, NULL);
    assert_int_equal(psplat_render(other, NULL, &whole, &error), PS_OK);
    assert_int_equal(render_tiles(scene, &tiles), PS_OK);
    assert_int_equal(tiles.count, MOST_TILES);
    for (size_t i = 0; i < tiles.count; i++) {
        assert_int_equal(tiles.x[i], places[i][0]);
        assert_int_equal(tiles.y[i], places[i][1]);
        assert_int_equal(psplat_picture_width(tiles.pictures[i]), places[i][2]);
        assert_int_equal(psplat_picture_height(tiles.pictures[i]), places[i][3]);
        assert_string_equal(psplat_picture_attribute(tiles.pictures[i], "psplat.passes"), "2");
        expect_part(tiles.pictures[i], tiles.x[i], tiles.y[i], whole);
    }
    release(&tiles);
    psplat_picture_destroy(whole);
    psplat_scene_destroy(other);
    psplat_scene_destroy(scene);
}

/* A denoiser looks at a margin, of which the tile has nothing. */
static void test_denoised_tiles(void **state)
{
    (void)state;
    struct tiles tiles = {.count = 0};
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    assert_int_equal(psplat_scene_set(scene, "plugin", "denoiser=regression", &error), PS_OK);
    assert_int_equal(psplat_scene_set(scene, "tile", "64", &error), PS_OK);
    assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error), PS_OK);
    assert_int_equal(render_tiles(scene, &tiles), PS_OK);
    assert_int_equal(tiles.count, MOST_TILES);
    assert_int_equal(psplat_picture_width(tiles.pictures[4]), 64);
    assert_int_equal(psplat_picture_height(tiles.pictures[4]), 36);
    release(&tiles);
    psplat_scene_destroy(scene);
}

static void test_cancelled(void **state)
{
    (void)state;
    struct tiles tiles = {.stop_after = 2};
    psplat_scene *scene = load("tile", "64");
    assert_int_equal(render_tiles(scene, &tiles), PS_CANCELLED);
    assert_true(tiles.count == 2 || tiles.count == 3);
    release(&tiles);
    psplat_scene_destroy(scene);
}

static void test_wrong(void **state)
{
    (void)state;
    psplat_error error;
    psplat_picture *none;
    psplat_scene *scene = load("tile", "64");
    assert_int_equal(psplat_render(scene, NULL, &none, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "the option 'tile' needs files, or a callback"));
    assert_int_equal(psplat_scene_set(scene, "tile", "65", &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "65 is no multiple of 64"));
    assert_int_equal(psplat_scene_set(scene, "crop", "0,0,20,20", &error), PS_OK);
    assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error),
                     PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "--tile does not go with --crop"));
    psplat_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiles_are_the_picture),
        cmocka_unit_test(test_denoised_tiles),
        cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
