#include "debug/backdrop.h"

#include "image/tonemap.h"
#include <psplat/math.h>

#define HEADLIGHT_SHARE 0.12f /* of white, where a surface faces the camera */
#define DIRECT_SHARE 0.15f

static ps_vec3 vector_at(const struct film *film, enum film_plane x, size_t pixel)
{
    return (ps_vec3){film->planes[x][pixel], film->planes[x + 1][pixel],
                     film->planes[x + 2][pixel]};
}

static float luminance_at(const struct film *film, enum film_plane red, size_t pixel)
{
    ps_vec3 colour = vector_at(film, red, pixel);
    return ps_luminance((ps_rgb){colour.x, colour.y, colour.z});
}

static float brightness(const struct render *render, size_t pixel, float factor)
{
    const struct film *film = &render->film;
    float direct = fminf(factor * luminance_at(film, FILM_DIRECT_R, pixel), 1.0f);
    if (!(film->planes[FILM_COVERAGE][pixel] > 0.0f))
        return DIRECT_SHARE * direct;
    float cosine =
        fabsf(ps_dot(vector_at(film, FILM_NORMAL_X, pixel), render->scene->camera.forward));
    float light = luminance_at(film, FILM_ALBEDO_R, pixel) * (0.3f + 0.7f * fminf(cosine, 1.0f));
    return HEADLIGHT_SHARE * light + DIRECT_SHARE * direct;
}

void backdrop_draw(const struct render *render, double exposure, struct canvas *canvas)
{
    const struct film *film = &render->film;
    float factor = exp2f((float)exposure);
    for (size_t y = 0; y < film->height; y++)
        for (size_t x = 0; x < film->width; x++) {
            float linear = brightness(render, y * film->width + x, factor);
            uint8_t grey = (uint8_t)(255.0f * tonemap_srgb(linear) + 0.5f);
            canvas_set(canvas, (long)x, (long)y, (struct colour){grey, grey, grey});
        }
}
