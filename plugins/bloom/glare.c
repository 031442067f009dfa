/* glare.c: the veil that a lens or an eye lays around bright light (Spencer, Shirley, Zimmerman and
 * Greenberg 1995, Physically-based glare effects for digital images).
 *
 * A share s of the light of each pixel is spread by a point-spread function whose integral is 1,
 * and the rest stays:
 *
 *     PSF = (1 - s) delta + s / 4 (G(R) + G(R / 2) + G(R / 4) + G(R / 8))
 *
 * with Gaussians G of these standard deviations. Equal light in each octave of distance is a
 * density that falls as 1 / r^2 between R / 8 and R, as the measured glare of eyes does, without
 * the corona of lashes and lens fibres. Sums of Gaussians are usual (Jimenez 2014, Next generation
 * post processing in Call of Duty); a pyramid of half-sized pictures is faster still, but keeps
 * neither the light of a pixel nor its place at odd sizes. Each blur goes on from the one before,
 * since variances add up.
 *
 * Where there is a threshold t, only what of a pixel's luminance L is above it takes part, a share
 * 1 - t / L of its light.
 */
#include "glare/gaussian.h"

enum { OCTAVES = 4 };

struct state {
    double strength, radius, threshold;
};

/* What of each pixel's light takes part, or NULL for all of it. */
static ps_result make_shares(double threshold, const ps_host *host, const ps_display_view *picture,
                             float **shares)
{
    size_t pixels = (size_t)picture->width * picture->height;
    *shares = NULL;
    if (threshold == 0.0)
        return PS_OK;
    *shares = host->allocate(host, pixels * sizeof **shares, "bloom");
    if (!*shares)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < pixels; i++) {
        float luminance = ps_luminance((ps_rgb){picture->r[i], picture->g[i], picture->b[i]});
        (*shares)[i] = luminance > (float)threshold ? 1.0f - (float)threshold / luminance : 0.0f;
    }
    return PS_OK;
}

/* Takes from the plane the light that is spread, which `glow` becomes. */
static void take(double strength, const float *shares, size_t pixels, float *plane, float *glow)
{
    for (size_t i = 0; i < pixels; i++) {
        glow[i] = (float)strength * plane[i] * (shares ? shares[i] : 1.0f);
        plane[i] -= glow[i];
    }
}

static ps_result spread_plane(const struct state *state, const ps_host *host,
                              const ps_display_view *picture, const float *shares, float *glow,
                              float *plane)
{
    size_t pixels = (size_t)picture->width * picture->height;
    double before = 0.0; /* variance of the blurs so far */
    take(state->strength, shares, pixels, plane, glow);
    for (int octave = OCTAVES - 1; octave >= 0; octave--) {
        double sigma = ldexp(state->radius * (double)picture->height, -octave);
        ps_result result =
            gaussian_blur(host, glow, picture->width, picture->height, sigma * sigma - before);
        if (result != PS_OK)
            return result;
        before = sigma * sigma;
        for (size_t i = 0; i < pixels; i++)
            plane[i] += glow[i] / (float)OCTAVES;
    }
    return PS_OK;
}

static ps_result spread(const void *opaque, const ps_host *host, const ps_display_view *picture)
{
    const struct state *state = opaque;
    float *const planes[3] = {picture->r, picture->g, picture->b};
    size_t bytes = (size_t)picture->width * picture->height * sizeof(float);
    float *shares, *glow = host->allocate(host, bytes, "bloom");
    ps_result result = make_shares(state->threshold, host, picture, &shares);
    if (!glow)
        result = PS_ERROR_MEMORY;
    for (int c = 0; c < 3 && result == PS_OK; c++)
        result = spread_plane(state, host, picture, shares, glow, planes[c]);
    host->release(host, shares);
    host->release(host, glow);
    return result;
}

static const ps_param params[] = {
    PS_NUMBER(struct state, strength, "0.05", 0, 1, 0, "", "share of the light that is spread"),
    PS_NUMBER(struct state, radius, "0.1", 0, 1, PS_PARAM_OPEN_MIN, "",
              "standard deviation of the widest Gaussian, as a share of the picture's height"),
    PS_NUMBER(struct state, threshold, "0", 0, INFINITY, 0, "",
              "luminance of the exposed picture above which light is spread"),
};

static const ps_bloom_vtable vtable = {.size = sizeof vtable, .spread = spread};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_BLOOM,
    .name = "glare",
    .version = "1.0",
    .summary = "spreads a share of the light around it, as lenses and eyes do",
    .paper = "Spencer et al. 1995, Physically-based glare effects for digital images",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(bloom, glare, &descriptor)
