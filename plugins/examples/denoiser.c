/* denoiser.c: an example: the mean of a pixel's row neighbours on the same object. */
#include <psplat/plugin.h>
#include <string.h>

struct state {
    int64_t radius;
};

/* Of the pixels [left, right] of a row, those that show what `at` shows. */
static float mean_of(const ps_image_view *image, const float *plane, size_t left, size_t right,
                     size_t at)
{
    float sum = 0.0f, count = 0.0f;
    for (size_t i = left; i <= right; i++)
        if (image->object[i] == image->object[at]) {
            sum += plane[i];
            count += 1.0f;
        }
    return sum / count;
}

static void filter_plane(const struct state *state, const ps_image_view *image, const float *from,
                         float *to)
{
    for (size_t y = 0; y < image->height; y++)
        for (size_t x = 0; x < image->width; x++) {
            size_t row = y * image->width, reach = (size_t)state->radius;
            size_t left = x > reach ? x - reach : 0;
            size_t right = x + reach < image->width ? x + reach : image->width - 1;
            to[row + x] = mean_of(image, from, row + left, row + right, row + x);
        }
}

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    float *const planes[3] = {image->r, image->g, image->b};
    size_t bytes = (size_t)image->width * image->height * sizeof(float);
    float *copy = host->allocate(host, bytes, "denoiser");
    if (!copy)
        return PS_ERROR_MEMORY;
    for (int c = 0; c < 3 && !host->cancelled(host); c++) {
        memcpy(copy, planes[c], bytes);
        filter_plane(state, image, copy, planes[c]);
    }
    host->release(host, copy);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

static const ps_param params[] = {
    PS_INT(struct state, radius, "2", 0, 100, "pixels", "neighbours to each side"),
};

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_DENOISER_IDS,
    .filter = filter,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "rows",
    .version = "1.0",
    .summary = "mean of row neighbours on the same object",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(denoiser, rows, &descriptor)
