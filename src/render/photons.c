#include "render/photons.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "placement/caustics.h"
#include "render/photon_pilot.h"
#include "render/state.h"
#include "stratify/stratify.h"
#include <math.h>
#include <psplat/math.h>
#include <stdlib.h>
#include <string.h>

static ps_result reserve(struct photon_list *list, size_t count)
{
    if (count <= list->capacity)
        return PS_OK;
    size_t capacity = count + list->capacity / 2;
    ps_photon *items = realloc(list->items, capacity * sizeof *items);
    if (!items)
        return PS_ERROR_MEMORY;
    list->items = items;
    list->capacity = capacity;
    return PS_OK;
}

static ps_result append(void *core, const ps_photon *photons, size_t n)
{
    struct photon_list *list = core;
    if (n == 0)
        return PS_OK;
    if (reserve(list, list->count + n) != PS_OK)
        return PS_ERROR_MEMORY;
    memcpy(list->items + list->count, photons, n * sizeof *photons);
    list->count += n;
    return PS_OK;
}

ps_result photon_stream_create(struct render *render, struct photon_stream *stream,
                               struct error *error)
{
    *stream = (struct photon_stream){
        .render = render,
        .chunks = calloc(PHOTON_CHUNKS, sizeof *stream->chunks),
        .caustics = malloc(CAUSTIC_LANDINGS * sizeof *stream->caustics),
    };
    if (!stream->chunks || !stream->caustics) {
        photon_stream_release(stream);
        return error_memory(error, PHOTON_CHUNKS * sizeof *stream->chunks, "photons");
    }
    photon_stream_rewind(stream);
    return PS_OK;
}

void photon_stream_release(struct photon_stream *stream)
{
    for (int i = 0; i < PHOTON_CHUNKS && stream->chunks; i++)
        free(stream->chunks[i].items);
    free(stream->chunks);
    free(stream->caustics);
    free(stream->batch.items);
    *stream = (struct photon_stream){.chunks = NULL};
}

void photon_stream_rewind(struct photon_stream *stream)
{
    stream->path_count = 0;
    stream->next_path = 0;
    stream->prepared = false;
    stream->filled = false;
}

struct injection {
    struct photon_stream *stream;
    ps_result *results; /* of each chunk */
    uint64_t *refused;
};

static bool is_finite(ps_vec3 v)
{
    return isfinite(v.x + v.y + v.z);
}

/* A photon that Embree and the sums over pixels can bear. */
static bool makes_sense(const ps_photon *photon)
{
    return is_finite(photon->position) && is_finite(photon->normal) &&
           fabsf(ps_dot(photon->direction, photon->direction) - 1.0f) < 0.01f &&
           photon->power.r >= 0.0f && photon->power.g >= 0.0f && photon->power.b >= 0.0f &&
           isfinite(photon->power.r + photon->power.g + photon->power.b) && photon->merged > 0.0f &&
           isfinite(photon->merged);
}

/* Drops the photons that do not; how many. */
static uint64_t drop_senseless(ps_photon *photons, size_t *n)
{
    size_t kept = 0, before = *n;
    for (size_t i = 0; i < before; i++)
        if (makes_sense(&photons[i])) {
            if (kept != i)
                photons[kept] = photons[i];
            kept++;
        }
    *n = kept;
    return before - kept;
}

static void inject_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct injection *injection = user;
    struct photon_stream *stream = injection->stream;
    struct photon_list *list = &stream->chunks[index];
    list->count = 0;
    injection->results[index] = PS_OK;
    uint64_t first = stream->next_path + index * PS_PATH_CHUNK;
    if (first >= stream->path_count)
        return;
    uint64_t left = stream->path_count - first;
    size_t n = left < PS_PATH_CHUNK ? (size_t)left : PS_PATH_CHUNK;
    const struct render *render = stream->render;
    const struct strategy *strategy = strategy_in(render, PS_INJECTION);
    ps_photon_sink sink = {list, append};
    injection->results[index] = strategy->type->table.injection.emit(
        strategy->state, strategy->host, &render->pass, first, n, &sink);
    injection->refused[index] = drop_senseless(list->items, &list->count);
}

/* Fills the chunks with the photons of the next paths, if they don't hold them yet. */
static ps_result fill_chunks(struct photon_stream *stream, struct error *error)
{
    ps_result results[PHOTON_CHUNKS], result = PS_OK;
    uint64_t refused[PHOTON_CHUNKS] = {0};
    struct injection injection = {stream, results, refused};
    struct render *render = stream->render;
    if (stream->filled)
        return PS_OK;
    double start = clock_seconds();
    parallel_for(render->settings->workers, PHOTON_CHUNKS, inject_chunk, &injection);
    statistics_add_seconds(render->statistics, "inject", clock_seconds() - start);
    for (int i = 0; i < PHOTON_CHUNKS; i++) {
        result = result == PS_OK ? results[i] : result;
        render->refused.photons[0] += refused[i];
    }
    result = render_judge(render, PS_INJECTION, result, error);
    stream->filled = result == PS_OK;
    return result;
}

static ps_result prepare_injection(struct photon_stream *stream, struct error *error)
{
    struct render *render = stream->render;
    struct strategy *injection = strategy_in(render, PS_INJECTION);
    const ps_injection_vtable *table = &injection->type->table.injection;
    ps_result result = PS_OK;
    double start = clock_seconds();
    if (table->prepare)
        result = table->prepare(injection->state, injection->host, &render->pass);
    statistics_add_seconds(render->statistics, "inject", clock_seconds() - start);
    result = render_judge(render, PS_INJECTION, result, error);
    if (result == PS_OK)
        stream->path_count = table->path_count(injection->state);
    return result;
}

ps_result photon_stream_prepare(struct photon_stream *stream, struct error *error)
{
    if (stream->prepared)
        return PS_OK;
    ps_result result = render_find_importance(stream->render, error);
    if (result == PS_OK)
        result = prepare_injection(stream, error);
    if (result == PS_OK)
        result = fill_chunks(stream, error);
    if (result != PS_OK)
        return result;
    photon_pilot_find(stream);
    stream->prepared = true;
    return PS_OK;
}

/* Appends the photons of the next paths to the stream's batch. */
static ps_result inject(struct photon_stream *stream, struct error *error)
{
    ps_result result = fill_chunks(stream, error);
    if (result != PS_OK)
        return result;
    stream->filled = false;
    stream->next_path += (uint64_t)PHOTON_CHUNKS * PS_PATH_CHUNK;
    for (int i = 0; i < PHOTON_CHUNKS; i++) {
        const struct photon_list *chunk = &stream->chunks[i];
        if (append(&stream->batch, chunk->items, chunk->count) != PS_OK)
            return error_memory(error, chunk->count * sizeof *chunk->items, "photons");
    }
    return PS_OK;
}

static ps_result stratify_batch(struct photon_stream *stream, struct error *error)
{
    struct render *render = stream->render;
    const struct strategy *strategy = strategy_in(render, PS_STRATIFICATION);
    double start = clock_seconds();
    statistics_count(render->statistics, "photons injected", (double)stream->batch.count);
    ps_result result = stratify(strategy, strategy->host, &render->pass, stream->batch.items,
                                &stream->batch.count);
    if (strategy->type->table.stratification.stratify)
        render->refused.photons[1] += drop_senseless(stream->batch.items, &stream->batch.count);
    statistics_add_seconds(render->statistics, "stratify", clock_seconds() - start);
    statistics_count(render->statistics, "photons", (double)stream->batch.count);
    return render_judge(render, PS_STRATIFICATION, result, error);
}

static void measure(const struct photon_stream *stream)
{
    size_t capacity = stream->batch.capacity;
    for (int i = 0; i < PHOTON_CHUNKS; i++)
        capacity += stream->chunks[i].capacity;
    statistics_set_bytes(stream->render->statistics, "photons",
                         (double)(capacity * sizeof(ps_photon)));
}

/* Adds the next paths' photons to the batch. */
static ps_result inject_more(struct photon_stream *stream, struct error *error)
{
    const struct render_callbacks *callbacks = stream->render->callbacks;
    bool cancelled = callbacks->cancelled && callbacks->cancelled(callbacks->user);
    return cancelled ? PS_CANCELLED : inject(stream, error);
}

ps_result photon_stream_injected(struct photon_stream *stream, ps_photon **photons, size_t *n,
                                 struct error *error)
{
    ps_result result = photon_stream_prepare(stream, error);
    stream->batch.count = 0;
    while (stream->next_path < stream->path_count && result == PS_OK)
        result = inject_more(stream, error);
    *photons = stream->batch.items;
    *n = stream->batch.count;
    return result;
}

ps_result photon_stream_next(struct photon_stream *stream, const ps_photon **photons, size_t *n,
                             struct error *error)
{
    bool whole_pass =
        strategy_in(stream->render, PS_STRATIFICATION)->type->table.stratification.whole_pass;
    ps_result result = photon_stream_prepare(stream, error);
    stream->batch.count = 0;
    while (stream->next_path < stream->path_count && stream->batch.count == 0 && result == PS_OK) {
        do
            result = inject_more(stream, error);
        while (whole_pass && stream->next_path < stream->path_count && result == PS_OK);
        if (result == PS_OK && stream->batch.count > 0)
            result = stratify_batch(stream, error);
    }
    measure(stream);
    *photons = stream->batch.items;
    *n = stream->batch.count;
    return result;
}

double photon_stream_progress(const struct photon_stream *stream)
{
    if (stream->path_count == 0 || stream->next_path >= stream->path_count)
        return 1.0;
    return (double)stream->next_path / (double)stream->path_count;
}
