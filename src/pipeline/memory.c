/* memory.c: whether a picture of some size can be rendered here at all.
 *
 * A system that lends more memory than it has lets a render of a mistyped size begin and kills it
 * later, with others. So what grows with the picture (G-buffer, its copy for splats, film and
 * the picture itself, which are there together at the end) is compared with the machine's physical memory beforehand. What
 * else the system runs is not known, and not asked for.
 */
#include "base/machine.h"
#include "film/film.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"

#define GIB 0x1p30

double render_bytes(size_t width, size_t height)
{
    struct gbuffer gbuffer = gbuffer_layout(width, height);
    struct interleaved interleaved = interleaved_layout(&gbuffer, 1);
    return (double)gbuffer_bytes(&gbuffer) + (double)interleaved_bytes(&interleaved) +
           (double)gathered_light_bytes(&gbuffer) + (double)film_most_bytes(width, height) +
           (double)picture_bytes(width, height);
}

ps_result render_check_memory(size_t width, size_t height, struct error *error)
{
    double wanted = render_bytes(width, height), there = machine_memory();
    if (wanted <= there)
        return PS_OK;
    return error_set(
        error, PS_ERROR_MEMORY,
        "a picture of %zux%zu pixels takes %.1f GiB of memory to render, and this machine "
        "has %.1f GiB; a smaller one is had by --size",
        width, height, wanted / GIB, there / GIB);
}
