#include "film/film_parts.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct rectangle film_parts_place(const struct film_sum *part)
{
    return (struct rectangle){part->window.left, part->window.top, part->width, part->height};
}

struct rectangle film_parts_around(const struct film_sum *const parts[], size_t count)
{
    struct rectangle around = film_parts_place(parts[0]);
    for (size_t i = 1; i < count; i++) {
        struct rectangle part = film_parts_place(parts[i]);
        size_t right = around.x + around.width, bottom = around.y + around.height;
        right = part.x + part.width > right ? part.x + part.width : right;
        bottom = part.y + part.height > bottom ? part.y + part.height : bottom;
        around.x = part.x < around.x ? part.x : around.x;
        around.y = part.y < around.y ? part.y : around.y;
        around.width = right - around.x;
        around.height = bottom - around.y;
    }
    return around;
}

bool film_parts_meet(const struct film_sum *a, const struct film_sum *b)
{
    struct rectangle x = film_parts_place(a), y = film_parts_place(b);
    return x.x < y.x + y.width && y.x < x.x + x.width && x.y < y.y + y.height &&
           y.y < x.y + x.height;
}

size_t film_parts_pixels(const struct film_sum *const parts[], size_t count)
{
    size_t pixels = 0;
    for (size_t i = 0; i < count; i++)
        pixels += parts[i]->width * parts[i]->height;
    return pixels;
}

/* --- joining
 * ---------------------------------------------------------------------------------------- */

/* Copies the rows of a part's plane of values of `size` bytes to their place in another; NULL:
 * zeros, or nowhere. */
static void copy_rows(const struct film_sum *part, const void *from, const struct film_sum *joined,
                      void *to, size_t size)
{
    size_t left = part->window.left - joined->window.left;
    size_t top = part->window.top - joined->window.top;
    for (size_t y = 0; y < part->height && from && to; y++)
        memcpy((char *)to + ((top + y) * joined->width + left) * size,
               (const char *)from + y * part->width * size, part->width * size);
}

static void copy_part(const struct film_sum *part, struct film_sum *joined)
{
    for (int i = 0; i < FILM_SUM_PLANES; i++) {
        const struct exact_plane *from = &part->planes[i];
        copy_rows(part, from->high, joined, joined->planes[i].high, sizeof *from->high);
        copy_rows(part, from->low, joined, joined->planes[i].low, sizeof *from->low);
    }
    copy_rows(part, part->object, joined, joined->object, sizeof *part->object);
    copy_rows(part, part->material, joined, joined->material, sizeof *part->material);
}

static bool create_planes(const struct film_sum *const parts[], size_t count,
                          struct film_sum *joined)
{
    size_t pixels = joined->width * joined->height;
    bool there = true;
    for (int i = 0; i < FILM_SUM_PLANES; i++) {
        bool has_low = false;
        for (size_t k = 0; k < count; k++)
            has_low |= parts[k]->planes[i].low != NULL;
        if (parts[0]->planes[i].high)
            there &= exact_plane_create(pixels, &joined->planes[i]);
        if (has_low)
            there &= (joined->planes[i].low = calloc(pixels, sizeof(double))) != NULL;
    }
    if (!parts[0]->object)
        return there;
    joined->object = malloc(pixels * sizeof *joined->object);
    joined->material = malloc(pixels * sizeof *joined->material);
    return there && joined->object && joined->material;
}

ps_result film_parts_join(const struct film_sum *const parts[], size_t count,
                          struct film_sum *joined, struct error *error)
{
    struct rectangle around = film_parts_around(parts, count);
    assert(film_parts_pixels(parts, count) == around.width * around.height);
    *joined = (struct film_sum){
        .width = around.width,
        .height = around.height,
        .window = {around.x, around.y, parts[0]->window.picture_width,
                   parts[0]->window.picture_height},
    };
    if (!create_planes(parts, count, joined))
        return error_memory(error, film_sum_bytes(parts[0]), "a film of parts");
    for (size_t i = 0; i < count; i++)
        copy_part(parts[i], joined);
    return pass_set_add_all(&joined->passes, &parts[0]->passes, error);
}
