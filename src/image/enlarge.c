#include "image/enlarge.h"

#include <assert.h>

struct work {
    const struct image *from;
    float step;
    size_t width;
    const float *small; /* the channel under way */
    float *large;
};

/* Where a sample lies between two of the small picture. */
struct between {
    size_t first, second;
    float share; /* of the second, 0..1 */
};

static struct between find(size_t index, float step, size_t count)
{
    float place = ((float)index + 0.5f) / step - 0.5f;
    if (place <= 0.0f)
        return (struct between){0, 0, 0.0f};
    size_t first = (size_t)place;
    if (first + 1 >= count)
        return (struct between){count - 1, count - 1, 0.0f};
    return (struct between){first, first + 1, place - (float)first};
}

/* Where one counts for nothing, it may be infinite. */
static float mix(float a, float b, float share)
{
    return share > 0.0f ? (1.0f - share) * a + share * b : a;
}

static void enlarge_row(void *user, uint64_t y, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    size_t width = work->from->width;
    struct between row = find(y, work->step, work->from->height);
    const float *upper = work->small + row.first * width, *lower = work->small + row.second * width;
    for (size_t x = 0; x < work->width; x++) {
        struct between column = find(x, work->step, width);
        work->large[y * work->width + x] =
            mix(mix(upper[column.first], upper[column.second], column.share),
                mix(lower[column.first], lower[column.second], column.share), row.share);
    }
}

static ps_result enlarge_channel(const struct image *image, const struct image_channel *channel,
                                 double step, struct workers *workers, struct image *large,
                                 struct error *error)
{
    float *samples = image_add_channel(large, channel->name);
    struct work work = {image, (float)step, large->width, channel->samples, samples};
    if (!samples)
        return error_memory(error, large->width * large->height * sizeof *samples,
                            "a picture scaled up");
    parallel_for(workers, large->height, enlarge_row, &work);
    return PS_OK;
}

ps_result image_enlarge(const struct image *image, struct enlargement to,
                        bool (*keeps)(const char *channel), struct workers *workers,
                        struct image *large, struct error *error)
{
    ps_result result = PS_OK;
    assert((double)to.width <= (double)image->width * to.step + 1e-6);
    assert((double)to.height <= (double)image->height * to.step + 1e-6);
    *large = (struct image){.width = to.width, .height = to.height};
    for (size_t i = 0; i < image->channel_count && result == PS_OK; i++)
        if (keeps(image->channels[i].name))
            result = enlarge_channel(image, &image->channels[i], to.step, workers, large, error);
    if (result != PS_OK)
        image_release(large);
    return result;
}
