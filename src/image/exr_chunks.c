/* exr_chunks.c: compression takes nearly all of the time of writing a picture, so chunks are shared
 * out among threads, each with an encoder of its own on the one context, as the library has it. A
 * thread that is done with a chunk waits for its turn before writing it: the file has its chunks in
 * order, is the same for any number of threads, and no more than one chunk a thread is in memory.
 * Chunks are handed out in order, so whoever holds the first that is missing never waits.
 */
#include "image/exr_output.h"

#include <pthread.h>

#define SAMPLE_SIZE ((int32_t)sizeof(float))

struct queue {
    const struct exr_chunks *chunks;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t moved; /* `written` or `code` has changed */
    size_t handed_out;    /* chunks that were given to threads */
    size_t written;       /* chunks that are in the file */
    exr_result_t code;    /* of the first failure; ends the work */
};

/* A thread's. */
struct encoding {
    struct queue *queue;
    size_t index; /* of the chunk in hand */
    exr_encode_pipeline_t encoder;
};

/* The library holds the channels sorted, so each is looked up by its name. */
static void point_at(exr_encode_pipeline_t *encoder, const struct image *image, size_t pixel)
{
    for (int i = 0; i < encoder->channel_count; i++) {
        exr_coding_channel_info_t *channel = &encoder->channels[i];
        const float *samples = image_channel(image, channel->channel_name);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = (int16_t)SAMPLE_SIZE;
        channel->user_pixel_stride = SAMPLE_SIZE;
        channel->user_line_stride = (int32_t)image->width * SAMPLE_SIZE;
        channel->encode_from_ptr = (const uint8_t *)(samples + pixel);
    }
}

static bool take_chunk(struct queue *queue, size_t *index)
{
    pthread_mutex_lock(&queue->lock);
    bool left = queue->code == EXR_ERR_SUCCESS && queue->handed_out < queue->chunks->count;
    *index = queue->handed_out;
    queue->handed_out += left;
    pthread_mutex_unlock(&queue->lock);
    return left;
}

static void give_up(struct queue *queue, exr_result_t code)
{
    pthread_mutex_lock(&queue->lock);
    if (queue->code == EXR_ERR_SUCCESS)
        queue->code = code;
    pthread_cond_broadcast(&queue->moved);
    pthread_mutex_unlock(&queue->lock);
}

/* The encoder calls it between compressing and writing. */
static exr_result_t await_turn(exr_encode_pipeline_t *encoder)
{
    const struct encoding *encoding = encoder->encoding_user_data;
    struct queue *queue = encoding->queue;
    pthread_mutex_lock(&queue->lock);
    while (queue->code == EXR_ERR_SUCCESS && queue->written != encoding->index)
        pthread_cond_wait(&queue->moved, &queue->lock);
    exr_result_t code = queue->code;
    pthread_mutex_unlock(&queue->lock);
    return code;
}

static void end_turn(struct queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->written++;
    pthread_cond_broadcast(&queue->moved);
    pthread_mutex_unlock(&queue->lock);
}

/* Stands in for the library's own writing of a chunk. Readers take a chunk as long as its pixels
 * for uncompressed, but the library (openexr issue 2306) stores the ZIP stream
 * also where it happens to have just that length: two in a hundred tiny pictures came back as
 * noise. */
static exr_result_t write_shorter(exr_encode_pipeline_t *encoder)
{
    const struct encoding *encoding = encoder->encoding_user_data;
    const struct exr_chunks *chunks = encoding->queue->chunks;
    const void *bytes = encoder->compressed_bytes < encoder->packed_bytes
                            ? encoder->compressed_buffer
                            : encoder->packed_buffer;
    exr_result_t code = chunks->store(chunks, encoding->index, bytes, encoder->compressed_bytes);
    if (code == EXR_ERR_SUCCESS)
        end_turn(encoding->queue);
    return code;
}

static exr_result_t write_chunk(struct encoding *encoding)
{
    const struct exr_chunks *chunks = encoding->queue->chunks;
    exr_encode_pipeline_t *encoder = &encoding->encoder;
    exr_context_t context = chunks->output->context;
    exr_chunk_info_t chunk;
    bool first = !encoder->context;
    exr_result_t code = chunks->describe(chunks, encoding->index, &chunk);
    if (code == EXR_ERR_SUCCESS)
        code = first ? exr_encoding_initialize(context, EXR_OUTPUT_PART, &chunk, encoder)
                     : exr_encoding_update(context, EXR_OUTPUT_PART, &chunk, encoder);
    if (code != EXR_ERR_SUCCESS)
        return code;
    point_at(encoder, chunks->image, chunks->begins(chunks, encoding->index));
    if (first) {
        code = exr_encoding_choose_default_routines(context, EXR_OUTPUT_PART, encoder);
        encoder->encoding_user_data = encoding;
        encoder->yield_until_ready_fn = await_turn;
        encoder->write_fn = write_shorter;
    }
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, EXR_OUTPUT_PART, encoder) : code;
}

static void work_off(void *user, uint64_t index, uint32_t worker)
{
    (void)index;
    (void)worker;
    struct encoding encoding = {.queue = user, .encoder = EXR_ENCODE_PIPELINE_INITIALIZER};
    exr_result_t code = EXR_ERR_SUCCESS;
    while (code == EXR_ERR_SUCCESS && take_chunk(encoding.queue, &encoding.index))
        code = write_chunk(&encoding);
    if (code != EXR_ERR_SUCCESS)
        give_up(encoding.queue, code);
    exr_encoding_destroy(encoding.queue->chunks->output->context, &encoding.encoder);
}

ps_result exr_chunks_write(const struct exr_chunks *chunks, struct workers *workers,
                           struct error *error)
{
    struct queue queue = {.chunks = chunks, .code = EXR_ERR_SUCCESS};
    chunks->output->error = error;
    pthread_mutex_init(&queue.lock, NULL);
    pthread_cond_init(&queue.moved, NULL);
    parallel_for(workers, workers_count(workers), work_off, &queue);
    pthread_cond_destroy(&queue.moved);
    pthread_mutex_destroy(&queue.lock);
    return exr_output_explain(chunks->output, queue.code, "the", "pixels");
}
