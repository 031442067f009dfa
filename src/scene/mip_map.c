#include "scene/mip_map.h"

#include "scene/mip_map_stream.h"
#include <assert.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

uint32_t mip_map_half(uint32_t side)
{
    return side > 1 ? side / 2 : 1;
}

uint32_t mip_map_level_count(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    for (uint32_t side = width > height ? width : height; side > 1; side = mip_map_half(side))
        count++;
    return count;
}

size_t mip_map_level_bytes(const struct texels *level, uint32_t tile_shift, uint32_t texel_bytes)
{
    uint32_t beyond = (1u << tile_shift) - 1;
    size_t across = (level->width + beyond) >> tile_shift;
    size_t down = (level->height + beyond) >> tile_shift;
    return (across * down << 2 * tile_shift) * texel_bytes;
}

size_t mip_map_place(struct texture *texture, uint32_t first, const unsigned char *bytes)
{
    uint32_t shift = texture->tile_shift, beyond = (1u << shift) - 1;
    uint32_t width = texture->levels[0].width, height = texture->levels[0].height;
    size_t sum = 0;
    for (uint32_t i = 0; i < texture->level_count; i++) {
        struct texels *level = &texture->levels[i];
        if (i >= first) {
            *level = (struct texels){width, height, (width + beyond) >> shift,
                                     bytes ? bytes + sum : NULL};
            sum += mip_map_level_bytes(level, shift, texture->texel_bytes);
        }
        width = mip_map_half(width);
        height = mip_map_half(height);
    }
    return sum;
}

bool mip_map_has_more(const struct texture *texture)
{
    bool is_float = texture->raster.sample == RASTER_HALF || texture->raster.sample == RASTER_FLOAT;
    return !(is_float && texture->srgb);
}

/* --- in memory --- */

/* A mip_map_take. */
static ps_result keep_line(void *user, uint32_t level, uint32_t line, const void *samples,
                           struct error *error)
{
    const struct texture *texture = user;
    const struct texels *texels = &texture->levels[level];
    size_t bytes = (size_t)texels->width * texture->texel_bytes;
    (void)error;
    if (level > 0) {
        ptrdiff_t start = texels->bytes - texture->levels[1].bytes;
        memcpy((unsigned char *)texture->halves + start + line * bytes, samples, bytes);
    }
    return PS_OK;
}

static ps_result add_levels(struct texture *texture, struct error *error)
{
    const struct texels *first = &texture->levels[0];
    size_t bytes = (size_t)first->width * texture->texel_bytes;
    struct mip_map_stream *stream = mip_map_open(texture, keep_line, texture, error);
    if (!stream)
        return PS_ERROR_MEMORY;
    ps_result result = PS_OK;
    for (uint32_t line = 0; line < first->height && result == PS_OK; line++)
        result = mip_map_add_line(stream, first->bytes + line * bytes, error);
    mip_map_close(stream);
    return result;
}

ps_result mip_map_add(struct texture *texture, struct error *error)
{
    assert(texture->level_count == 1 && texture->tile_shift == 0 && !texture->halves);
    texture->level_count = mip_map_level_count(texture->width, texture->height);
    size_t bytes = mip_map_place(texture, 1, NULL);
    ps_result result = PS_ERROR_MEMORY;
    texture->halves = malloc(bytes + 1);
    if (texture->halves) {
        mip_map_place(texture, 1, texture->halves);
        result = add_levels(texture, error);
    } else {
        error_memory(error, bytes, "a texture's MIP map");
    }
    if (result != PS_OK) {
        free(texture->halves);
        texture->halves = NULL;
        texture->level_count = 1;
    }
    return result;
}
