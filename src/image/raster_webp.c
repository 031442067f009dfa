/* raster_webp.c: a WebP file's samples, lossy or lossless, through libwebp. */
#include "image/raster_decode.h"

#ifdef PSPLAT_WEBP
#include <webp/decode.h>

/* Both ways of coding need next to nothing for a flat picture. Small ones are let through whatever
 * the size of their file; of larger ones no real file is this much smaller than its samples. */
#define SMALL_PICTURE (UINT64_C(4) << 20) /* bytes */
#define EXPANSION 4096

static ps_result explain(const struct raster_source *source, VP8StatusCode status,
                         struct error *error)
{
    switch (status) {
    case VP8_STATUS_OK:
        return PS_OK;
    case VP8_STATUS_OUT_OF_MEMORY:
        return error_set(error, PS_ERROR_MEMORY, "%s: out of memory for a WebP reader",
                         source->path);
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED:
        return error_set(error, PS_ERROR_IO, "%s: it ends too early (a truncated WebP)",
                         source->path);
    default:
        return error_set(error, PS_ERROR_IO, "%s: this WebP file is damaged", source->path);
    }
}

static ps_result check(const struct raster_source *source, const WebPBitstreamFeatures *features,
                       size_t pixel_bytes, struct error *error)
{
    if (features->has_animation)
        return error_set(error, PS_ERROR_INVALID, "%s: it is animated (one picture can be read)",
                         source->path);
    ps_result result =
        raster_check_size(source->path, features->width, features->height, pixel_bytes, error);
    uint64_t bytes = (uint64_t)features->width * (uint64_t)features->height * pixel_bytes;
    if (result != PS_OK || bytes <= SMALL_PICTURE)
        return result;
    return raster_check_expansion(source, bytes, EXPANSION, error);
}

static ps_result decode(const struct raster_source *source, struct raster *raster,
                        struct error *error)
{
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config))
        return error_set(error, PS_ERROR_INVALID, "%s: libwebp is of another version than psplat's",
                         source->path);
    config.output.colorspace = raster->channels == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = raster->samples;
    config.output.u.RGBA.stride = (int)(raster->width * raster->channels);
    config.output.u.RGBA.size = raster_bytes(raster);
    VP8StatusCode status = WebPDecode(source->bytes, source->size, &config);
    WebPFreeDecBuffer(&config.output);
    return explain(source, status, error);
}

ps_result raster_read_webp(const struct raster_source *source, struct raster *raster,
                           struct error *error)
{
    WebPBitstreamFeatures features;
    ps_result result =
        explain(source, WebPGetFeatures(source->bytes, source->size, &features), error);
    if (result != PS_OK)
        return result;
    raster->channels = features.has_alpha ? 4 : 3;
    result = check(source, &features, raster->channels, error);
    if (result != PS_OK)
        return result;
    raster->width = (uint32_t)features.width;
    raster->height = (uint32_t)features.height;
    raster->sample = RASTER_BYTE;
    raster->srgb = true;
    result = raster_allocate(source->path, raster, error);
    return result == PS_OK ? decode(source, raster, error) : result;
}

#endif
