/* memory.c: whether a picture of some size can be rendered here at all.
 *
 * A system that lends more memory than it has lets a render of a mistyped size begin and kills it
 * later, with others. So what grows with the picture (G-buffer, its copy for splats, film, the sums of passes and
 * the picture itself, which are there together at the end) is compared with the machine's memory
 * beforehand. What else the system runs is not known, and not asked for.
 */
#include "base/machine.h"
#include "film/film_sum.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"

#define GIB 0x1p30

/* Planes of a film of several passes beyond those that each has: the reflected direct light and gloss; and in parts
 * of the passes the light, its weight, coverage, and the direct light. */
#define MORE_PLANES (FILM_PLANES - FILM_ON_REQUEST + 5 + 6)

static struct rectangle film_of(const struct render_size *size)
{
    return size->crop.width > 0 ? size->crop : (struct rectangle){0, 0, size->width, size->height};
}

static double bytes_of_passes(const struct render_size *size)
{
    struct rectangle film = film_of(size);
    double pixels = (double)film.width * (double)film.height;
    double planes = FILM_ON_REQUEST + MORE_PLANES, squares = 1.0;
    if (!size->several_passes)
        return 0.0;
    double more = pixels * MORE_PLANES * sizeof(float);
    double sums = pixels * (planes + squares) * sizeof(double);
    /* A file's channels: those planes in two floats each, three for viewers, four of ids. */
    double file =
        size->keeps_film ? pixels * (2.0 * (planes + squares) + 7.0) * sizeof(float) : 0.0;
    return more + sums + file;
}

double render_bytes(const struct render_size *size)
{
    struct rectangle film = film_of(size);
    struct gbuffer gbuffer =
        gbuffer_layout_around(film, size->smooth_edges, size->width, size->height);
    struct interleaved interleaved = interleaved_layout(&gbuffer, 1);
    return (double)gbuffer_bytes(&gbuffer) + (double)interleaved_bytes(&interleaved) +
           (double)gathered_light_bytes(&gbuffer) +
           (double)film_most_bytes(film.width, film.height) +
           (double)picture_bytes(film.width, film.height, size->display) + bytes_of_passes(size);
}

ps_result render_check_memory(const struct render_size *size, double limit, struct error *error)
{
    struct rectangle film = film_of(size);
    double wanted = render_bytes(size), there = machine_memory();
    bool is_limited = limit < there;
    if (wanted <= (is_limited ? limit : there))
        return PS_OK;
    return error_set(error, PS_ERROR_MEMORY,
                     "a picture of %zux%zu pixels takes %.1f GiB of memory to render, and %s "
                     "%.1f GiB; a smaller one is had by --size, a part of it by --crop",
                     film.width, film.height, wanted / GIB,
                     is_limited ? "--memory-limit is" : "this machine has",
                     (is_limited ? limit : there) / GIB);
}
