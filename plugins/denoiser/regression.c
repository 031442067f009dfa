/* regression.c: planes fitted to the irradiance, as wide as its noise asks for.
 *
 * regression/fit.h fits planes to the irradiance E of the pixels around, along the surfaces that
 * they show. One bandwidth cannot do: a wide one blurs, a narrow one leaves noise. So fits F_R of
 * five bandwidths R make bands, and each band is added as far as it is signal, neighbourhood by
 * neighbourhood (shrinkage: James and Stein 1961; Donoho and Johnstone 1994):
 *
 *     E' = F_48 + sum over R = 24, 12, 6, 3 of k_R B
 *     B = F_R - F_2R,   k_R = max(0, 1 - (c <N^2> / <B^2>)^2)
 *
 * The windows of the latter fits follow the edges of light (regression/steering.h). N is the band
 * of a picture of the noise alone, and <> a mean over a square around, of pixels of one kind
 * (regression/kinds.h). Such a square holds only a few blobs of noise, so noise sometimes passes
 * for signal. Edges of light show in all bands, noise seldom in two: so the factor c is 2 where the
 * wider band was kept, 4 where it was not, and in between in proportion (bivariate shrinkage,
 * Sendur and Selesnick 2002). In a single pass, whose noise is estimated from the light itself, 1.2
 * takes the place of 2 past the first band, and 1.4 in narrow ones, R = 6 and 3. <N^2> is a mean
 * over a wider square than <B^2>, since one picture of the noise is a poor estimate. Where a few
 * bright samples meet, it tells too little, and they would stay as bumps of even walls: so where
 * halves tell the noise (below), narrow bands take the larger of that mean and 1.25 times that over
 * the square of <B^2>; less where <B^2> is large, as at edges of shadows and caustics, which have
 * their noise in one place with their light.
 *
 * Where two halves of the light are known, of passes or of shadow rays, their difference is the
 * noise, and the pixels themselves are a last band: light without noise stays as it is, with its
 * hard shadows. Of a single pass of indirect light the noise is what pixels differ from a first
 * fit, with random signs (the wild bootstrap, Wu 1986). Where light changes fast, that has light in
 * it: so in narrow bands <N^2> is multiplied by the mean square of what the bands so far leave of
 * the pixels, over that of what the first fit left, if that is less than 1. All that needs noise
 * that is independent from pixel to pixel, as that of paths is and that of splats is not. At edges,
 * in gloss and behind a lens, where samples of a pixel share the light of those around it
 * (src/view/edges.h), blocks of pixels take one sign (the dependent wild bootstrap, Shao 2010).
 * Where the estimator tells the variance of a pixel, that pixel is a last band, judged by itself:
 * contact shadows are often narrower than any fit.
 *
 * Bright samples of few pixels would leave speckles in narrow bands. So each pixel is limited to
 * twice the first fit, if the excess may be noise and few pixels near it are as bright: three,
 * where halves are known, or half of them and two thirds of those next to it. At the end the
 * residual E - E' is fitted with the widest bandwidth and added. It contains what was cut off, so
 * no light is lost, and the bias of the fits (twicing, Tukey 1977).
 *
 * E is radiance over albedo, so that colours of surfaces stay sharp. A channel that a surface
 * hardly reflects says nothing about the light, and is taken for the mean of its other channels.
 * What gloss mirrors is fitted along the glossy surface, as if it were irradiance, and is blurred
 * as far as noise asks.
 */
#include "regression/bands.h"
#include "regression/bounds.h"
#include "regression/clamp.h"
#include "regression/kinds.h"

#include <psplat/plugin.h>
#include <stdbool.h>
#include <string.h>

#define FIRST 24                  /* bandwidth of the first fit */
#define WIDEST REGRESSION_LARGEST /* of the rest */

/* From the sum over bands to the error: errors of the bands are correlated, and detail finer than
 * the narrowest fit is in no band. Calibrated with path-traced references of seven scenes. */
#define UNSEEN 1.4f

static const char *const automatic[] = {"auto", NULL};

struct state {
    double normal;
    ps_number_or_choice distance;
};

/* --- the rest --- */

static void take_rest_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++) {
        size_t at = regression_at(&image->guides, (int)x, (int)row);
        for (int c = 0; c < REGRESSION_COLOURS && image->guides.size[at] > 0.0f; c++)
            image->clamped[c][at] = image->light[c][at] - image->sum[c][row * image->width + x];
    }
}

static void store_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    const ps_image_view *view = image->view;
    float *const out[3] = {view->r, view->g, view->b};
    const float *const albedo[3] = {view->albedo_r, view->albedo_g, view->albedo_b};
    for (size_t x = 0; x < image->width; x++) {
        size_t i = row * image->width + x;
        if (!regression_shows_surface(&image->guides, (int)x, (int)row))
            continue;
        for (int c = 0; c < 3; c++)
            out[c][i] = albedo[c][i] * ps_max(image->sum[c][i] + image->fine[c][i], 0.0f);
    }
}

/* That of the sum of the irradiance's channels becomes that of the mean of the radiance's. */
static void store_error_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    const ps_image_view *view = image->view;
    for (size_t x = 0; x < image->width; x++) {
        size_t i = row * image->width + x;
        if (!regression_shows_surface(&image->guides, (int)x, (int)row))
            continue;
        float off = UNSEEN * sqrtf(image->error[i] / image->inverse_square[i]);
        float irradiance = brightness_at(image->sum, i) + brightness_at(image->fine, i);
        float radiance = (view->r[i] + view->g[i] + view->b[i]) * (1.0f / 3.0f);
        float albedo = (view->albedo_r[i] + view->albedo_g[i] + view->albedo_b[i]) * (1.0f / 9.0f);
        view->error[i] = off * (irradiance > 0.0f ? radiance / irradiance : albedo);
    }
}

static void denoise(struct denoised_images *images)
{
    regression_for_each_row(images, regression_take_row);
    regression_bounds_find(&images->of[0].guides);
    regression_kinds_find(images);
    regression_fit_all(images, FIRST, light_of, fine_of);
    for (int i = 0; i < images->count; i++)
        regression_clamp_outliers(&images->of[i]);
    regression_add_bands(images);
    regression_for_each_row(images, take_rest_of_row);
    regression_fit_all(images, WIDEST, clamped_of, fine_of);
    regression_for_each_row(images, store_row);
    for (int i = 0; i < images->count; i++)
        if (images->of[i].error)
            images->of[i].host->parallel_for(images->of[i].host, images->of[i].height,
                                             store_error_of_row, &images->of[i]);
}

/* --- the strategy --- */

/* Where the next planes go: those with a margin, whose runs lie together, and the others. */
struct room {
    float *with_margin, *without;
    size_t pixels;
};

static void lay_out(float **next, size_t apart, int count, float *planes[])
{
    for (int i = 0; i < count; i++, *next += apart)
        planes[i] = *next;
}

static void lay_out_with_margin(struct room *room, int count, float *planes[])
{
    lay_out(&room->with_margin, REGRESSION_LANES, count, planes);
}

static void lay_out_without(struct room *room, int count, float *planes[])
{
    lay_out(&room->without, room->pixels, count, planes);
}

/* Planes that all images share, with a margin and without, and those of each. */
enum { GUIDES = 8, SCRATCH = 7 };
enum { IMAGE_WITH_MARGIN = 2 * VALUES, IMAGE = 2 * VALUES + REGRESSION_COLOURS + 4 };

#define IMAGE_BYTES ((IMAGE_WITH_MARGIN + IMAGE) * sizeof(float) + REGRESSION_PLANES_PIXEL)

static void lay_out_shared(struct denoised_image *image, struct room *room)
{
    lay_out_with_margin(room, 3, image->guides.normal);
    lay_out_with_margin(room, 3, image->guides.position);
    lay_out_with_margin(room, 1, &image->guides.gloss);
    lay_out_with_margin(room, 1, &image->guides.size);
    lay_out_without(room, 1, &image->signal);
    lay_out_without(room, 1, &image->scratch);
    lay_out_without(room, 1, &image->noise_near);
    lay_out_without(room, 1, &image->newer_near);
    lay_out_without(room, 1, &image->signal_weight);
    lay_out_without(room, 1, &image->noise_weight);
    lay_out_without(room, 1, &image->kind);
}

static void lay_out_image(struct denoised_image *image, struct room *room)
{
    float *error;
    lay_out_with_margin(room, VALUES, image->light);
    lay_out_with_margin(room, VALUES, image->clamped);
    lay_out_without(room, VALUES, image->fine);
    lay_out_without(room, VALUES, image->coarse);
    lay_out_without(room, REGRESSION_COLOURS, image->sum);
    lay_out_without(room, 1, &image->inverse_square);
    lay_out_without(room, 1, &image->noise);
    lay_out_without(room, 1, &image->shrinkage);
    lay_out_without(room, 1, &error);
    image->error = image->view->error ? error : NULL;
}

static size_t planes_with_margin(int images)
{
    return GUIDES + (size_t)images * IMAGE_WITH_MARGIN;
}

static size_t floats_with_margin(size_t width, size_t height, int images)
{
    return planes_with_margin(images) * REGRESSION_LANES * regression_runs(width, height);
}

static size_t floats_of(size_t width, size_t height, int images)
{
    return floats_with_margin(width, height, images) +
           (SCRATCH + (size_t)images * IMAGE) * width * height;
}

/* Images with halves may show means over several passes, and come first. The first one's guides are
 * all of them's. */
static void lay_out_all(struct denoised_images *images, const struct denoised_image *shared,
                        float *memory, const ps_image_view *views)
{
    int count = images->count;
    size_t width = shared->width, height = shared->height;
    struct room room = {memory, memory + floats_with_margin(width, height, count), width * height};
    struct denoised_image each = *shared;
    lay_out_shared(&each, &room);
    for (int i = 0; i < count; i++)
        images->halved += views[i].even_r != NULL;
    each.guides.runs_apart = planes_with_margin(count) * REGRESSION_LANES;
    each.guides.narrow = images->halved * VALUES;
    for (int i = 0, with = 0, without = images->halved; i < count; i++) {
        struct denoised_image *image = &images->of[views[i].even_r ? with++ : without++];
        *image = each;
        image->view = &views[i];
        lay_out_image(image, &room);
    }
}

static ps_result filter_all(const void *opaque, const ps_host *host, const ps_image_view *views,
                            uint32_t count)
{
    const struct state *state = opaque;
    struct denoised_images images = {.count = (int)count};
    struct denoised_image shared = {.host = host, .width = views->width, .height = views->height};
    size_t width = shared.width, height = shared.height;
    size_t floats = floats_of(width, height, images.count);
    float *memory = host->allocate(host, floats * sizeof *memory, "denoiser");
    shared.guides = (struct regression){
        .host = host,
        .width = width,
        .height = height,
        .runs_of_row = regression_runs_of_row(width),
        .bend_scale = (float)(1 / (1 - cos(state->normal * (double)PS_PI / 180))),
        .distance = state->distance.choice >= 0 ? 0.0f : (float)state->distance.number,
        .bounds = host->allocate(host, regression_bounds_bytes(width, height), "denoiser"),
        .fits = host->allocate(host, regression_fits_bytes(width, height), "denoiser"),
        .planes = host->allocate(
            host, regression_planes_bytes(width, height, images.count * VALUES), "denoiser"),
    };
    const struct regression *guides = &shared.guides;
    bool good = memory && guides->bounds && guides->fits && guides->planes;
    ps_result result = good ? PS_OK : PS_ERROR_MEMORY;
    if (result == PS_OK) {
        memset(memory, 0, floats * sizeof *memory);
        shared.camera = (ps_camera){.size = sizeof shared.camera};
        host->camera(host, &shared.camera);
        lay_out_all(&images, &shared, memory, views);
        denoise(&images);
        result = host->cancelled(host) ? PS_CANCELLED : PS_OK;
    }
    host->release(host, shared.guides.planes);
    host->release(host, shared.guides.fits);
    host->release(host, shared.guides.bounds);
    host->release(host, memory);
    return result;
}

static ps_result filter(const void *opaque, const ps_host *host, const ps_image_view *view)
{
    return filter_all(opaque, host, view, 1);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, normal, "30", 1, 90, PS_PARAM_EXPERT, "degrees",
              "angle between normals from which on nothing crosses"),
    PS_NUMBER_OR(struct state, distance, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT,
                 automatic, "scene units",
                 "distance from the tangent plane from which on nothing crosses; auto: a fifth of "
                 "the bandwidth"),
};

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_DENOISER_HALVES | PS_DENOISER_DIRECT | PS_DENOISER_ERROR | PS_DENOISER_VARIANCE,
    .filter = filter,
    .pixel_bytes = (GUIDES + SCRATCH) * sizeof(float) + REGRESSION_BOUNDS_PIXEL +
                   REGRESSION_FITS_PIXEL + IMAGE_BYTES,
    .filter_all = filter_all,
    .image_bytes = IMAGE_BYTES,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "regression",
    .version = "1.0",
    .summary = "fits planes to the irradiance of surfaces, as wide as its noise asks for",
    .paper = "Moon et al. 2014, Adaptive rendering based on weighted local regression; Bitterli et "
             "al. 2016, Nonlinearly weighted first-order regression for denoising Monte Carlo "
             "renderings",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(denoiser, regression, &descriptor)
