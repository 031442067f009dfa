#include "steering.h"

#include <math.h>

#define STRENGTH 3.0f
#define LONGEST 3.0f
#define SPAN 4          /* the gradient is told by pixels R / SPAN away */
#define OUTSIDE 1.0001f /* where all is outside, whatever rounding does */

struct regression_window regression_round_window(int bandwidth)
{
    float reach = (float)bandwidth + 0.5f, scale = 1.0f / (reach * reach);
    return (struct regression_window){scale, 0.0f, scale};
}

static float light_at(const struct regression *regression, const struct regression_steering *by,
                      int x, int y)
{
    return brightness_at(by->light, (size_t)y * regression->width + (size_t)x);
}

/* Change of the light a pixel along (dx, dy), by the pixels that far to either side that show the
 * same surface. */
static float slope(const struct regression *regression, const struct regression_steering *by, int x,
                   int y, int dx, int dy)
{
    size_t at = regression_at(regression, x, y);
    float change = 0.0f, pixels = 0.0f;
    for (int side = -1; side <= 1; side += 2) {
        int i = x + side * dx, j = y + side * dy;
        /* In the margin nothing is seen. */
        if (!regression_is_like(regression, at, regression_at(regression, i, j)))
            continue;
        change += (float)side * (light_at(regression, by, i, j) - light_at(regression, by, x, y));
        pixels += (float)(dx + dy);
    }
    return pixels > 0.0f ? change / pixels : 0.0f;
}

struct regression_window regression_steered_window(const struct regression *regression,
                                                   const struct regression_steering *by,
                                                   int bandwidth, int x, int y)
{
    struct regression_window round = regression_round_window(bandwidth);
    size_t at = regression_at(regression, x, y);
    int span = bandwidth > SPAN ? bandwidth / SPAN : 1;
    if (!(regression->size[at] > 0.0f) || regression->gloss[at] > 0.0f)
        return round;
    float gx = slope(regression, by, x, y, span, 0), gy = slope(regression, by, x, y, 0, span);
    float length = sqrtf(gx * gx + gy * gy);
    float light = ps_max(light_at(regression, by, x, y), 0.0f) + by->least;
    if (!(length > 1e-6f * light))
        return round;
    float s = ps_min(1.0f + STRENGTH * (float)bandwidth * length / light, LONGEST);
    float across = s * round.xx, along = round.xx / s;
    gx /= length;
    gy /= length;
    return (struct regression_window){
        .xx = across * gx * gx + along * gy * gy,
        .xy = (across - along) * gx * gy,
        .yy = across * gy * gy + along * gx * gx,
    };
}

static int at_most_margin(float pixels)
{
    return (int)ps_min(pixels, (float)REGRESSION_MARGIN);
}

int regression_window_rows(const struct regression_window *window)
{
    float determinant = window->xx * window->yy - window->xy * window->xy;
    return at_most_margin(sqrtf(OUTSIDE * window->xx / determinant));
}

bool regression_window_row(const struct regression_window *window, int y, int *first, int *last)
{
    float row = (float)y, middle = -window->xy * row / window->xx;
    float square = middle * middle - (window->yy * row * row - OUTSIDE) / window->xx;
    if (!(square >= 0.0f))
        return false;
    float half = sqrtf(square);
    *first = -at_most_margin(half - middle);
    *last = at_most_margin(middle + half);
    return *first <= *last;
}
