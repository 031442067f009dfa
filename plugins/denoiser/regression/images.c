#include "images.h"

void regression_for_each_row(struct denoised_images *images, ps_body body)
{
    const ps_host *host = images->of[0].host;
    for (int i = 0; i < images->count; i++)
        host->parallel_for(host, images->of[i].height, body, &images->of[i]);
}

static void fit_all(struct denoised_images *images, int bandwidth, image_planes from,
                    image_planes to, const struct regression_steering *steering)
{
    float *values[REGRESSION_MOST], *fitted[REGRESSION_MOST];
    for (int i = 0; i < images->count; i++)
        for (int c = 0; c < VALUES; c++) {
            values[i * VALUES + c] = from(&images->of[i])[c];
            fitted[i * VALUES + c] = to(&images->of[i])[c];
        }
    regression_fit(&images->of[0].guides, bandwidth, images->count * VALUES, values, steering,
                   fitted);
}

void regression_fit_all(struct denoised_images *images, int bandwidth, image_planes from,
                        image_planes to)
{
    fit_all(images, bandwidth, from, to, NULL);
}

void regression_fit_steered(struct denoised_images *images, int bandwidth, image_planes from,
                            image_planes to)
{
    struct regression_steering steering[REGRESSION_IMAGES];
    for (int i = 0; i < images->count; i++)
        steering[i] = (struct regression_steering){images->of[i].sum, images->of[i].least};
    fit_all(images, bandwidth, from, to, steering);
}
