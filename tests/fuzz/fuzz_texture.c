/* fuzz_texture.c: feeds arbitrary bytes to the readers of pictures, and looks at what comes out
 * (libFuzzer).
 *
 *     clang -fsanitize=fuzzer,address,undefined ... && ./fuzz_texture tests/fuzz/corpus_texture
 *
 * Beyond crashes and leaks it checks the readers' promises: a failure says why, after the path; a
 * success has a size within the limits and finite colours everywhere, and line by line the same
 * samples.
 */
#include "scene/mip_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_HALVED (1 << 20) /* pixels */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

static void check_texture(const struct texture *texture)
{
    require(texture->width >= 1 && texture->width <= RASTER_SIDE_LIMIT);
    require(texture->height >= 1 && texture->height <= RASTER_SIDE_LIMIT);
    for (int i = 0; i <= 64; i++) {
        float rgba[4];
        texture_sample(texture, (float)(i % 8) / 7.0f, (float)i / 64.0f, rgba);
        for (int k = 0; k < 4; k++)
            require(isfinite(rgba[k]));
        texture_filter(texture, (float)i / 64.0f, (float)(i % 8) / 7.0f, (float)(i % 20 - 17),
                       rgba);
        for (int k = 0; k < 4; k++)
            require(isfinite(rgba[k]));
    }
}

/* What is left of a picture, of which lines come. */
struct lines {
    const struct raster *whole; /* NULL: it could not be read */
    size_t taken;
};

static bool want(void *user, const struct raster *raster)
{
    (void)user;
    return raster->width > 0;
}

static ps_result take(void *user, const void *samples, struct error *error)
{
    struct lines *lines = user;
    const struct raster *whole = lines->whole;
    (void)error;
    if (whole) {
        size_t bytes = (size_t)whole->width * raster_texel_bytes(whole);
        const unsigned char *expected = whole->samples;
        require(lines->taken < whole->height);
        require(memcmp(samples, expected + lines->taken * bytes, bytes) == 0);
    }
    lines->taken++;
    return PS_OK;
}

/* `texture`: NULL where the whole picture could not be read. */
static void check_lines(const struct texture_description *description,
                        const struct texture *texture)
{
    struct lines lines = {.whole = texture ? &texture->raster : NULL};
    const struct raster_lines by_lines = {want, take, &lines};
    struct raster raster = {0};
    struct error error = {{0}};
    ps_result result = raster_decode(description->path, description->layer, description->bytes,
                                     description->byte_count, &by_lines, &raster, &error);
    require((result == PS_OK) == (texture != NULL));
    require(result != PS_OK || lines.taken == (raster.samples ? 0 : raster.height));
    raster_release(&raster);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* A copy of the size itself, since the description's bytes are not const. */
    unsigned char *bytes = malloc(size + 1);
    if (!bytes)
        return 0;
    memcpy(bytes, data, size);
    bool is_exr = size > 4 && memcmp(data, "\x76\x2f\x31\x01", 4) == 0;
    char layer[] = "P";
    struct texture_description description = {
        .path = "fuzz",
        .layer = is_exr && size % 2 == 1 ? layer : NULL,
        .bytes = bytes,
        .byte_count = size,
        .wrap_u = (int32_t)(size % 3),
        .wrap_v = (int32_t)(size / 9 % 3),
        .encoding = (int32_t)(size / 3 % 3),
        .nearest = size % 2 == 0,
    };
    struct texture texture = {0};
    struct error error = {{0}};
    ps_result result = texture_load(&description, NULL, &texture, &error);
    check_lines(&description, result == PS_OK ? &texture : NULL);
    /* Of pictures for which that does not take seconds. */
    if (result == PS_OK && (uint64_t)texture.width * texture.height < MOST_HALVED &&
        !(texture.srgb && texture.raster.sample >= RASTER_HALF))
        require(mip_map_add(&texture, &error) == PS_OK);
    if (result == PS_OK)
        check_texture(&texture);
    else
        require(strncmp(error.text, "fuzz: ", 6) == 0);
    texture_release(&texture);
    free(bytes);
    return 0;
}
