#include "job/film_message.h"

#include <stdlib.h>

struct header {
    uint64_t width, height;
    uint64_t left, top, picture_width, picture_height; /* its window */
    uint64_t runs;                                     /* of passes; 0: nothing follows */
    uint8_t has_ids;
    uint8_t doubles[FILM_SUM_PLANES]; /* of each plane: 0, 1 (high) or 2 */
};

static struct header header_of(const struct film_sum *film)
{
    struct header header = {
        .width = film->width,
        .height = film->height,
        .left = film->window.left,
        .top = film->window.top,
        .picture_width = film->window.picture_width,
        .picture_height = film->window.picture_height,
        .runs = film->passes.count,
        .has_ids = film->object != NULL,
    };
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        header.doubles[plane] =
            (uint8_t)((film->planes[plane].high != NULL) + (film->planes[plane].low != NULL));
    return header;
}

void film_message_send(const struct transport *transport, int to, int tag,
                       const struct film_sum *film)
{
    const struct header header = header_of(film);
    size_t pixels = film->width * film->height;
    transport->send(to, tag, &header, sizeof header);
    if (header.runs == 0)
        return;
    transport->send(to, tag, film->passes.runs, header.runs * sizeof *film->passes.runs);
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++) {
        const struct exact_plane *sums = &film->planes[plane];
        if (sums->high)
            transport->send(to, tag, sums->high, pixels * sizeof *sums->high);
        if (sums->low)
            transport->send(to, tag, sums->low, pixels * sizeof *sums->low);
    }
    if (header.has_ids) {
        transport->send(to, tag, film->object, pixels * sizeof *film->object);
        transport->send(to, tag, film->material, pixels * sizeof *film->material);
    }
}

/* A message under way. */
struct reception {
    const struct transport *transport;
    int from, tag;
    bool out_of_memory;
    size_t pixels;
};

/* Where there is no memory to keep it, a message is taken all the same. */
static void receive(struct reception *reception, void *bytes, size_t size)
{
    const struct transport *transport = reception->transport;
    if (bytes) {
        transport->receive(reception->from, reception->tag, bytes, size);
        return;
    }
    reception->out_of_memory = true;
    transport->skip(reception->from, reception->tag, size);
}

static double *receive_doubles(struct reception *reception)
{
    double *sums = malloc(reception->pixels * sizeof *sums);
    receive(reception, sums, reception->pixels * sizeof *sums);
    return sums;
}

/* A plane that the film lacks is taken over as it is. */
static void merge_plane(struct reception *reception, int doubles, struct exact_plane *into)
{
    struct exact_plane sums = {.size = reception->pixels};
    if (doubles > 0)
        sums.high = receive_doubles(reception);
    if (doubles > 1)
        sums.low = receive_doubles(reception);
    if (!sums.high || (doubles > 1 && !sums.low)) {
        exact_plane_release(&sums);
    } else if (!into->high) {
        *into = sums;
    } else {
        reception->out_of_memory |= !exact_plane_merge(into, &sums);
        exact_plane_release(&sums);
    }
}

static void take_ids(struct reception *reception, uint32_t **into)
{
    size_t bytes = reception->pixels * sizeof **into;
    uint32_t *ids = malloc(bytes);
    receive(reception, ids, bytes);
    if (*into)
        free(ids);
    else
        *into = ids;
}

static ps_result take_passes(struct reception *reception, uint64_t count, struct pass_set *into,
                             struct error *error)
{
    struct pass_run *runs = malloc(count * sizeof *runs);
    receive(reception, runs, count * sizeof *runs);
    struct pass_set passes = {.runs = runs, .count = runs ? count : 0};
    ps_result result = pass_set_add_all(into, &passes, error);
    free(runs);
    return result;
}

ps_result film_message_merge(const struct transport *transport, int from, int tag,
                             struct film_sum *film, struct error *error)
{
    struct header header;
    transport->receive(from, tag, &header, sizeof header);
    if (header.runs == 0)
        return PS_OK;
    struct reception reception = {
        .transport = transport,
        .from = from,
        .tag = tag,
        .pixels = (size_t)(header.width * header.height),
    };
    film->width = (size_t)header.width;
    film->height = (size_t)header.height;
    film->window =
        (struct picture_window){(size_t)header.left, (size_t)header.top,
                                (size_t)header.picture_width, (size_t)header.picture_height};
    ps_result result = take_passes(&reception, header.runs, &film->passes, error);
    for (int plane = 0; plane < FILM_SUM_PLANES; plane++)
        merge_plane(&reception, header.doubles[plane], &film->planes[plane]);
    if (header.has_ids) {
        take_ids(&reception, &film->object);
        take_ids(&reception, &film->material);
    }
    if (reception.out_of_memory)
        result = error_memory(error, reception.pixels * sizeof(double), "the films of other ranks");
    if (result != PS_OK)
        film->passes.count = 0;
    return result;
}
