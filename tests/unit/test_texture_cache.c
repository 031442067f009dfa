/* test_texture_cache.c: pictures that lie in a folder are those that were decoded, texel by
 * texel. */
#include "scene/texture_cache.h"

#include "image/image.h"
#include "scene/mip_map.h"
#include "texture_fixture.h"
#include <signal.h>
#include <sys/resource.h>

#define WIDTH 131 /* of three tiles, the last ones mostly beyond the picture */
#define HEIGHT 70

/* Of any numbers; those of floats are finite. */
static struct texture create(enum raster_sample sample, uint32_t channels)
{
    struct texture texture = texture_create(sample, false, WIDTH, HEIGHT, channels);
    unsigned char *bytes = texture.raster.samples;
    for (size_t i = 0; i < raster_bytes(&texture.raster); i++)
        bytes[i] = (unsigned char)((i * 2654435761u >> 9) & (sample >= RASTER_HALF ? 0x3b : 0xff));
    texture.raster.mended = 3;
    texture.raster.file_size = 1234;
    return texture;
}

static void store(const char *path, const struct texture *texture)
{
    struct error error;
    size_t bytes = (size_t)texture->raster.width * texture->texel_bytes;
    struct texture_entry *entry = texture_entry_begin(path, texture, &error);
    assert_non_null(entry);
    for (size_t line = 0; line < texture->raster.height; line++) {
        const char *samples = texture->raster.samples;
        assert_int_equal(texture_entry_add(entry, samples + line * bytes, &error), PS_OK);
    }
    assert_int_equal(texture_entry_end(entry, texture->raster.mended, &error), PS_OK);
}

/* On all levels, without decoding. */
static void expect_same_texels(const struct texture *a, const struct texture *b)
{
    static float codes[UINT16_MAX + 1];
    for (size_t i = 0; i <= UINT16_MAX; i++)
        codes[i] = (float)i;
    assert_int_equal(a->level_count, b->level_count);
    for (uint32_t level = 0; level < a->level_count; level++) {
        struct texture pair[2] = {*a, *b};
        assert_int_equal(a->levels[level].width, b->levels[level].width);
        assert_int_equal(a->levels[level].height, b->levels[level].height);
        for (int i = 0; i < 2; i++) {
            pair[i].levels[0] = pair[i].levels[level];
            pair[i].color_of = pair[i].alpha_of = codes;
        }
        for (uint32_t row = 0; row < a->levels[level].height; row++)
            for (uint32_t column = 0; column < a->levels[level].width; column++) {
                float of_a[4], of_b[4];
                texture_texel(&pair[0], column, row, of_a);
                texture_texel(&pair[1], column, row, of_b);
                for (int i = 0; i < 4; i++)
                    if (of_a[i] != of_b[i])
                        fail_msg("texel (%u, %u) of level %u is another", column, row, level);
            }
    }
}

static void expect_stored(void **state, enum raster_sample sample, uint32_t channels)
{
    struct texture texture = create(sample, channels), kept = {0};
    struct mapped_budget *budget = mapped_budget_create(2.0 * (double)MAPPED_BLOCK);
    struct error error;
    const char *path = scratch_path(state, "entry");
    assert_int_equal(mip_map_add(&texture, &error), PS_OK);
    store(path, &texture);
    assert_int_equal(texture_cache_load(path, budget, &kept, &error), PS_OK);
    assert_int_equal(kept.level_count, 8);
    expect_same_texels(&texture, &kept);
    assert_int_equal(kept.raster.mended, 3);
    assert_int_equal(kept.raster.file_size, 1234);
    assert_true(texture_digest(&kept) == texture_digest(&texture));
    assert_true(texture_leaves_range(&kept, 0.9f) == texture_leaves_range(&texture, 0.9f));
    texture_release(&kept);
    mapped_budget_destroy(budget);
    texture_release(&texture);
}

static void test_all_kinds_of_samples(void **state)
{
    for (int sample = RASTER_BYTE; sample <= RASTER_FLOAT; sample++)
        for (uint32_t channels = 1; channels <= 4; channels++)
            expect_stored(state, (enum raster_sample)sample, channels);
}

static void expect_other_name(const char *name, const struct texture_description *description,
                              size_t size)
{
    static const unsigned char bytes[] = "bytes";
    char *other = texture_cache_path("folder", description, bytes, size);
    assert_string_not_equal(name, other);
    free(other);
}

static void test_names(void **state)
{
    static const unsigned char bytes[] = "bytes";
    static char layer[] = "layer";
    const struct texture_description plain = {.path = "a"}, same = {.path = "b", .nearest = true},
                                     of_layer = {.layer = layer},
                                     linear = {.encoding = ENCODING_LINEAR};
    char *name = texture_cache_path("folder", &plain, bytes, 5);
    char *again = texture_cache_path("folder", &same, bytes, 5);
    (void)state;
    assert_string_equal(name, again);
    assert_true(strncmp(name, "folder/", 7) == 0);
    expect_other_name(name, &of_layer, 5);
    expect_other_name(name, &linear, 5);
    expect_other_name(name, &plain, 4);
    free(name);
    free(again);
}

static void expect_no_entry(const char *path, const unsigned char *bytes, size_t size)
{
    struct mapped_budget *budget = mapped_budget_create(1e6);
    struct texture none = {0};
    struct error error;
    scratch_store(path, bytes, size);
    assert_int_equal(texture_cache_load(path, budget, &none, &error), PS_ERROR_IO);
    assert_null(none.file);
    mapped_budget_destroy(budget);
}

static void test_damaged_entries(void **state)
{
    struct texture texture = create(RASTER_BYTE, 3);
    size_t size;
    const char *path = scratch_path(state, "entry");
    store(path, &texture);
    unsigned char *bytes = scratch_load(path, &size);
    expect_no_entry(path, bytes, size - 1);
    expect_no_entry(path, bytes, 4096);
    expect_no_entry(path, bytes, 100);
    expect_no_entry(path, bytes, 0);
    bytes[0] ^= 1;
    expect_no_entry(path, bytes, size);
    memset(bytes, 0xff, 100);
    memcpy(bytes, "psplatT", 8);
    expect_no_entry(path, bytes, size);
    free(bytes);
    texture_release(&texture);
}

/* --- from a picture's file ------------------------------------------------------------------- */

#define SIDE 640 /* above a MiB of samples */

static const char *write_picture(void **state)
{
    const char *path = scratch_path(state, "picture.png");
    uint8_t *rgb = malloc((size_t)SIDE * SIDE * 3);
    struct error error;
    assert_non_null(rgb);
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 3; i++)
        rgb[i] = (uint8_t)(i * 2654435761u >> 11);
    assert_int_equal(image_write_png(path, SIDE, SIDE, rgb, NULL, 0, &error), PS_OK);
    free(rgb);
    return path;
}

static struct texture load(const char *path, const struct texture_storage *storage)
{
    struct texture_description description = {.path = (char *)path};
    struct texture texture;
    struct error error;
    if (texture_load(&description, storage, &texture, &error) != PS_OK)
        fail_msg("%s", error.text);
    return texture;
}

static void expect_same_colors(const struct texture *a, const struct texture *b)
{
    for (int i = 0; i < 200; i++) {
        float u = -1.0f + 0.0371f * (float)i, of_a[4], of_b[4];
        texture_filter(a, u, 0.3f * u, -14.0f + 0.1f * (float)i, of_a);
        texture_filter(b, u, 0.3f * u, -14.0f + 0.1f * (float)i, of_b);
        assert_memory_equal(of_a, of_b, sizeof of_a);
    }
}

static void test_picture(void **state)
{
    struct scratch *scratch = *state;
    const char *path = write_picture(state);
    const struct texture_storage in_memory = {.mip_maps = true};
    struct texture_storage storage = {
        .mip_maps = true, .cache = scratch->directory, .budget = mapped_budget_create(1e5)};
    struct texture plain = load(path, &in_memory);
    for (int i = 0; i < 2; i++) { /* made, then there */
        struct texture kept = load(path, &storage);
        assert_non_null(kept.file);
        assert_null(kept.note);
        assert_null(kept.raster.samples);
        assert_null(kept.halves);
        assert_int_equal(scratch_file_count(state), 2);
        assert_true(kept.srgb);
        expect_same_texels(&plain, &kept);
        expect_same_colors(&plain, &kept);
        texture_release(&kept);
    }
    texture_release(&plain);
    mapped_budget_destroy(storage.budget);
}

/* A file that ends among its lines leaves no entry, and what it lacks is said. */
static void test_truncated_picture(void **state)
{
    struct scratch *scratch = *state;
    const char *path = write_picture(state);
    struct texture_storage storage = {.cache = scratch->directory,
                                      .budget = mapped_budget_create(1e5)};
    struct texture_description description = {.path = (char *)path};
    struct texture texture = {0};
    struct error error;
    size_t size;
    unsigned char *bytes = scratch_load(path, &size);
    scratch_store(path, bytes, size / 2);
    assert_int_equal(texture_load(&description, &storage, &texture, &error), PS_ERROR_IO);
    assert_non_null(strstr(error.text, "too early"));
    assert_int_equal(scratch_file_count(state), 1);
    free(bytes);
    mapped_budget_destroy(storage.budget);
}

/* An entry that can't be written to its end: the picture lies in memory, as if there were no
 * cache. */
static void test_full_disk(void **state)
{
    struct scratch *scratch = *state;
    const char *path = write_picture(state);
    struct texture_storage storage = {.cache = scratch->directory,
                                      .budget = mapped_budget_create(1e5)};
    const struct texture_storage in_memory = {.folder = NULL};
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 300000;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    struct texture texture = load(path, &storage), plain = load(path, &in_memory);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_null(texture.file);
    assert_non_null(strstr(texture.note, "large"));
    assert_int_equal(scratch_file_count(state), 1);
    expect_same_texels(&plain, &texture);
    texture_release(&plain);
    texture_release(&texture);
    mapped_budget_destroy(storage.budget);
}

static void test_folder_that_is_none(void **state)
{
    const char *path = write_picture(state);
    struct texture_storage storage = {.cache = "/nowhere", .budget = mapped_budget_create(1e5)};
    struct texture texture = load(path, &storage);
    assert_null(texture.file);
    assert_non_null(texture.raster.samples);
    assert_non_null(strstr(texture.note, "/nowhere/"));
    texture_release(&texture);
    mapped_budget_destroy(storage.budget);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_all_kinds_of_samples), cmocka_unit_test(test_names),
        SCRATCH_TEST(test_damaged_entries),      SCRATCH_TEST(test_picture),
        SCRATCH_TEST(test_truncated_picture),    SCRATCH_TEST(test_full_disk),
        SCRATCH_TEST(test_folder_that_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
