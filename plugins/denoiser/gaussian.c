/* gaussian.c: a plain Gaussian blur of the indirect light (Hoet 2014, sections 3.5 and 4.4).
 *
 * Separable: rows, then columns. Pixels without a surface neither give nor take: value and coverage
 * are blurred alike and divided, so the picture's border and silhouettes against the void keep
 * their brightness. Edges between surfaces do blur; that is the method.
 */
#include <psplat/plugin.h>

static const char *const sizes[] = {"3x3", "5x5", "7x7", "9x9", NULL};

#define MOST_TAPS 9

struct state {
    int32_t size;
};

struct kernel {
    int radius; /* taps on either side */
    float taps[MOST_TAPS];
};

/* The usual rule for the deviation that fits a size, so that the outermost taps are small but not
 * nothing. */
static struct kernel make_kernel(int32_t size)
{
    struct kernel kernel = {.radius = size + 1};
    float sigma = 0.3f * ((float)kernel.radius - 1.0f) + 0.8f;
    for (int i = -kernel.radius; i <= kernel.radius; i++)
        kernel.taps[i + kernel.radius] = expf(-0.5f * (float)(i * i) / (sigma * sigma));
    return kernel;
}

struct blur {
    const struct kernel *kernel;
    const float *in;
    float *out;
    uint32_t width, height;
    int across; /* 1: along rows, 0: along columns */
};

static void blur_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct blur *blur = user;
    int length = (int)(blur->across ? blur->width : blur->height);
    size_t stride = blur->across ? 1 : blur->width;
    for (uint32_t x = 0; x < blur->width; x++) {
        size_t pixel = row * blur->width + x;
        int at = blur->across ? (int)x : (int)row;
        float sum = 0.0f;
        for (int tap = -blur->kernel->radius; tap <= blur->kernel->radius; tap++)
            if (at + tap >= 0 && at + tap < length) {
                size_t from =
                    tap < 0 ? pixel - (size_t)-tap * stride : pixel + (size_t)tap * stride;
                sum += blur->kernel->taps[tap + blur->kernel->radius] * blur->in[from];
            }
        blur->out[pixel] = sum;
    }
}

/* Blurs `plane` in place by way of `scratch`. */
static void blur_plane(const ps_host *host, const struct kernel *kernel, const ps_image_view *image,
                       float *plane, float *scratch)
{
    struct blur rows = {kernel, plane, scratch, image->width, image->height, 1};
    struct blur columns = {kernel, scratch, plane, image->width, image->height, 0};
    host->parallel_for(host, image->height, blur_row, &rows);
    host->parallel_for(host, image->height, blur_row, &columns);
}

static void fill_coverage(const ps_image_view *image, float *coverage)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        coverage[i] = ps_image_has_surface(image, i) ? 1.0f : 0.0f;
}

static void divide(const ps_image_view *image, const float *coverage, float *plane)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        plane[i] = ps_image_has_surface(image, i) ? plane[i] / coverage[i] : 0.0f;
}

static ps_result filter(const void *opaque, const ps_host *host, const ps_image_view *image)
{
    struct kernel kernel = make_kernel(((const struct state *)opaque)->size);
    size_t bytes = (size_t)image->width * image->height * sizeof(float);
    float *coverage = host->allocate(host, bytes, "denoiser");
    float *scratch = host->allocate(host, bytes, "denoiser");
    ps_result result = coverage && scratch ? PS_OK : PS_ERROR_MEMORY;
    if (result == PS_OK) {
        float *planes[] = {image->r, image->g, image->b};
        fill_coverage(image, coverage);
        blur_plane(host, &kernel, image, coverage, scratch);
        for (int i = 0; i < 3; i++) {
            blur_plane(host, &kernel, image, planes[i], scratch);
            divide(image, coverage, planes[i]);
        }
    }
    host->release(host, scratch);
    host->release(host, coverage);
    return result;
}

static const ps_param params[] = {
    PS_CHOICE(struct state, size, "5x5", sizes, "pixels under the blur"),
};

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable, .filter = filter, .pixel_bytes = 2 * sizeof(float)};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "gaussian",
    .version = "1.0",
    .summary = "blurs the indirect light, edges and all",
    .paper = "Hoet 2014, sections 3.5 and 4.4",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(denoiser, gaussian, &descriptor)
