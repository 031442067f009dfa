#include "gaussian.h"

#include <stdatomic.h>
#include <stdbool.h>

enum { LANES = 16, BOXES = 3 }; /* lines that are blurred side by side */

struct box {
    size_t radius; /* whole pixels to either side */
    float end;     /* weight of the pixels beyond, 0..1 */
    float scale;   /* 1 / sum of weights */
};

/* A box of radius r alone has variance r (r + 1) / 3; the ends make up for the rest. */
static struct box box_of(double variance)
{
    double r = floor((sqrt(1.0 + 12.0 * variance) - 1.0) / 2.0);
    double rest = variance - r * (r + 1.0) / 3.0;
    double end = (2.0 * r + 1.0) * rest / (2.0 * ((r + 1.0) * (r + 1.0) - variance));
    return (struct box){(size_t)r, (float)end, (float)(1.0 / (2.0 * r + 1.0 + 2.0 * end))};
}

struct blur {
    const ps_host *host;
    float *plane;
    size_t lines, length; /* of rows, or of columns */
    size_t line_stride, pixel_stride;
    struct box box;
    atomic_bool failed;
};

/* The pixel that mirrors show at `i` pixels from the first; the picture repeats after twice its
 * length. */
static size_t mirrored(ptrdiff_t i, size_t length)
{
    ptrdiff_t period = 2 * (ptrdiff_t)length, at = i % period;
    at = at < 0 ? at + period : at;
    return (size_t)(at < (ptrdiff_t)length ? at : period - 1 - at);
}

/* Fills the margins, each as wide as the box reaches. `line` begins with the left one. */
static void fill_margins(float (*line)[LANES], size_t length, size_t margin)
{
    for (size_t i = 0; i < margin; i++) {
        size_t left = margin + mirrored(-1 - (ptrdiff_t)i, length);
        size_t right = margin + mirrored((ptrdiff_t)(length + i), length);
        for (int lane = 0; lane < LANES; lane++) {
            line[margin - 1 - i][lane] = line[left][lane];
            line[margin + length + i][lane] = line[right][lane];
        }
    }
}

/* One box, from lines with margins to lines with margins. The sum is in double: what leaves it
 * takes with it all that it brought, but for rounding. */
static void run_box(const struct box *box, size_t length, const float (*from)[LANES],
                    float (*to)[LANES])
{
    size_t reach = box->radius + 1, inner = 2 * box->radius + 1;
    double sums[LANES] = {0};
    for (size_t i = 1; i <= inner; i++)
        for (int lane = 0; lane < LANES; lane++)
            sums[lane] += (double)from[i][lane];
    for (size_t i = 0; i < length; i++)
        for (int lane = 0; lane < LANES; lane++) {
            float left = from[i][lane], right = from[i + inner + 1][lane];
            float sum = (float)sums[lane] + box->end * (left + right);
            to[reach + i][lane] = fmaxf(sum * box->scale, 0.0f);
            sums[lane] += (double)right - (double)from[i + 1][lane];
        }
}

static void blur_lines(void *user, uint64_t index, uint32_t worker)
{
    struct blur *blur = user;
    size_t margin = blur->box.radius + 1, first = index * LANES;
    size_t lanes = blur->lines - first < LANES ? blur->lines - first : LANES;
    size_t room = blur->length + 2 * margin;
    (void)worker;
    if (blur->length == 0 || blur->host->cancelled(blur->host))
        return;
    float(*line)[LANES] = blur->host->allocate(blur->host, 2 * room * sizeof *line, "bloom");
    if (!line) {
        atomic_store(&blur->failed, true);
        return;
    }
    float *plane = blur->plane + first * blur->line_stride;
    float(*from)[LANES] = line, (*to)[LANES] = line + room;
    for (size_t i = 0; i < blur->length; i++)
        for (size_t lane = 0; lane < LANES; lane++)
            from[margin + i][lane] =
                lane < lanes ? plane[i * blur->pixel_stride + lane * blur->line_stride] : 0.0f;
    for (int box = 0; box < BOXES; box++) {
        fill_margins(from, blur->length, margin);
        run_box(&blur->box, blur->length, (const float(*)[LANES])from, to);
        float(*swap)[LANES] = from;
        from = to;
        to = swap;
    }
    for (size_t i = 0; i < blur->length; i++)
        for (size_t lane = 0; lane < lanes; lane++)
            plane[i * blur->pixel_stride + lane * blur->line_stride] = from[margin + i][lane];
    blur->host->release(blur->host, line);
}

static ps_result blur_all(struct blur *blur)
{
    blur->host->parallel_for(blur->host, (blur->lines + LANES - 1) / LANES, blur_lines, blur);
    if (atomic_load(&blur->failed))
        return PS_ERROR_MEMORY;
    return blur->host->cancelled(blur->host) ? PS_CANCELLED : PS_OK;
}

ps_result gaussian_blur(const ps_host *host, float *plane, size_t width, size_t height,
                        double variance)
{
    struct box box = box_of(variance / BOXES);
    struct blur rows = {.host = host,
                        .plane = plane,
                        .lines = height,
                        .length = width,
                        .line_stride = width,
                        .pixel_stride = 1,
                        .box = box};
    struct blur columns = {.host = host,
                           .plane = plane,
                           .lines = width,
                           .length = height,
                           .line_stride = 1,
                           .pixel_stride = width,
                           .box = box};
    ps_result result = blur_all(&rows);
    return result == PS_OK ? blur_all(&columns) : result;
}
