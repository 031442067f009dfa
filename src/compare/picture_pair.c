#include "compare/picture_pair.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Crops a window of a picture to another one of it that lies in this one; `layer`'s planes
 * alone. */
static void crop_to(struct image *image, const struct layer *layer, const struct image *part)
{
    const struct picture_window *window = &image->window;
    struct rectangle crop = {part->window.left - window->left, part->window.top - window->top,
                             part->width, part->height};
    bool one_picture = part->window.picture_width > 0 &&
                       part->window.picture_width == window->picture_width &&
                       part->window.picture_height == window->picture_height;
    /* What begins before this one wraps around, and fits nowhere. */
    if (!one_picture || !rectangle_fits(crop, image->width, image->height))
        return;
    for (size_t c = 0; c < layer->channel_count; c++)
        image_crop_plane(layer->planes[c], image->width, crop);
    image->width = crop.width;
    image->height = crop.height;
    image->window = part->window;
}

static bool is_part(const struct image *image)
{
    return image->width < image->window.picture_width ||
           image->height < image->window.picture_height;
}

/* Where an image lies: as it says, or all of its picture. */
static struct picture_window place_of(const struct image *image)
{
    return image->window.picture_width > 0
               ? image->window
               : (struct picture_window){0, 0, image->width, image->height};
}

/* Two of one size. */
static ps_result check_places(const struct image images[2], const char *const paths[2],
                              struct error *error)
{
    struct picture_window a = place_of(&images[0]), b = place_of(&images[1]);
    if (picture_window_same(a, b) || (!is_part(&images[0]) && !is_part(&images[1])))
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "the parts lie at different places: '%s' is at %zu,%zu of %zux%zu, '%s' at "
                     "%zu,%zu of %zux%zu",
                     paths[0], a.left, a.top, a.picture_width, a.picture_height, paths[1], b.left,
                     b.top, b.picture_width, b.picture_height);
}

static ps_result check_alike(const struct picture_pair *pair, const char *const paths[2],
                             const struct layer layers[2], struct error *error)
{
    const struct image *a = &pair->images[0], *b = &pair->images[1];
    if (a->width != b->width || a->height != b->height)
        return error_set(error, PS_ERROR_INVALID,
                         "the pictures differ in size: '%s' is %zux%zu, '%s' is %zux%zu", paths[0],
                         a->width, a->height, paths[1], b->width, b->height);
    if (layers[0].kind != layers[1].kind)
        return error_set(error, PS_ERROR_INVALID,
                         "the layer's channels differ: it begins with '%s' in '%s', '%s' in '%s'",
                         layers[0].names[0], paths[0], layers[1].names[0], paths[1]);
    return check_places(pair->images, paths, error);
}

ps_result picture_pair_read(struct picture_pair *pair, const char *reference_path,
                            const char *test_path, const char *layer, struct error *error)
{
    const char *const paths[2] = {reference_path, test_path};
    struct layer layers[2];
    for (int i = 0; i < 2; i++) {
        ps_result result = image_read_exr(paths[i], &pair->images[i], error);
        if (result == PS_OK)
            result = layer_find(&pair->images[i], paths[i], layer, &layers[i], error);
        if (result != PS_OK)
            return result;
    }
    crop_to(&pair->images[0], &layers[0], &pair->images[1]);
    crop_to(&pair->images[1], &layers[1], &pair->images[0]);
    pair->width = pair->images[0].width;
    pair->height = pair->images[0].height;
    pair->left = pair->images[0].window.left;
    pair->top = pair->images[0].window.top;
    pair->channel_count = layers[0].channel_count;
    for (size_t c = 0; c < pair->channel_count; c++) {
        pair->names[c] = layers[0].names[c];
        pair->reference[c] = layers[0].planes[c];
        pair->test[c] = layers[1].planes[c];
    }
    ps_result result = check_alike(pair, paths, layers, error);
    return result == PS_OK ? workers_create(parallel_processor_count(), &pair->workers, error)
                           : result;
}

void picture_pair_release(struct picture_pair *pair)
{
    workers_destroy(pair->workers);
    image_release(&pair->images[0]);
    image_release(&pair->images[1]);
    *pair = (struct picture_pair){0};
}

ps_result picture_pair_crop(struct picture_pair *pair, struct rectangle crop, struct error *error)
{
    if (!rectangle_fits(crop, pair->width, pair->height))
        return error_set(
            error, PS_ERROR_INVALID,
            "the crop %zu,%zu,%zu,%zu is empty or reaches beyond the pictures' %zux%zu", crop.x,
            crop.y, crop.width, crop.height, pair->width, pair->height);
    for (size_t c = 0; c < pair->channel_count; c++) {
        image_crop_plane(pair->reference[c], pair->width, crop);
        image_crop_plane(pair->test[c], pair->width, crop);
    }
    pair->width = crop.width;
    pair->height = crop.height;
    pair->left += crop.x;
    pair->top += crop.y;
    return PS_OK;
}

static bool reaches(const struct picture_pair *pair, size_t pixel, double bound)
{
    for (size_t c = 0; c < pair->channel_count; c++)
        if ((double)pair->reference[c][pixel] >= bound)
            return true;
    return false;
}

static void mark_with_neighbours(const struct picture_pair *pair, size_t pixel, bool *marks)
{
    size_t x = pixel % pair->width, y = pixel / pair->width;
    for (size_t row = y > 0 ? y - 1 : 0; row <= y + 1 && row < pair->height; row++)
        for (size_t column = x > 0 ? x - 1 : 0; column <= x + 1 && column < pair->width; column++)
            marks[row * pair->width + column] = true;
}

static void clear_pixel(struct picture_pair *pair, size_t pixel)
{
    for (size_t c = 0; c < pair->channel_count; c++)
        pair->reference[c][pixel] = pair->test[c][pixel] = 0.0f;
}

ps_result picture_pair_leave_out(struct picture_pair *pair, double bound, struct error *error)
{
    size_t pixels = pair->width * pair->height;
    bool *marks = calloc(pixels, sizeof *marks);
    if (!marks)
        return error_memory(error, pixels * sizeof *marks, "the pixels that are left out");
    for (size_t i = 0; i < pixels; i++)
        if (reaches(pair, i, bound))
            mark_with_neighbours(pair, i, marks);
    pair->left_out = 0;
    for (size_t i = 0; i < pixels; i++)
        if (marks[i]) {
            clear_pixel(pair, i);
            pair->left_out++;
        }
    free(marks);
    if (pair->left_out < pixels)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "no pixel is left: all reach %g in the reference, or lie beside one that does",
                     bound);
}

static ps_result check_planes(const struct picture_pair *pair, float *const planes[3],
                              const char *which, struct error *error)
{
    size_t pixels = pair->width * pair->height, count = 0, first = 0, channel = 0;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < pair->channel_count; c++)
            if (!isfinite(planes[c][i]) && count++ == 0) {
                first = i;
                channel = c;
            }
    if (count == 0)
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "%s holds %zu sample%s that %s NaN or infinite, the first (%g) in channel "
                     "'%s' at x=%zu, y=%zu",
                     which, count, count == 1 ? "" : "s", count == 1 ? "is" : "are",
                     (double)planes[channel][first], pair->names[channel],
                     pair->left + first % pair->width, pair->top + first / pair->width);
}

ps_result picture_pair_check_finite(const struct picture_pair *pair, struct error *error)
{
    ps_result result = check_planes(pair, pair->reference, "the reference", error);
    return result == PS_OK ? check_planes(pair, pair->test, "the test picture", error) : result;
}

ps_result picture_pair_check_reference(const struct picture_pair *pair, const char *what,
                                       struct error *error)
{
    for (size_t c = 0; c < pair->channel_count; c++)
        for (size_t i = 0; i < pair->width * pair->height; i++)
            if (pair->reference[c][i] != 0.0f)
                return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "the reference is zero everywhere: %s, a ratio to it, is undefined", what);
}
