/* handle_light.c: which photons light a pixel, in a scene that is loaded anew: the view's own
 * belongs to its thread. */
#include "explore/explorer.h"
#include "explore/handlers.h"

#define MOST_COORDINATE 1000000 /* of a pixel; the scene knows how many there are */
#define MOST_SOURCES 500        /* that a page draws; the brightest */

static void write_numbers(struct json_writer *writer, const char *key, const float *numbers, int n)
{
    json_writer_open_of(writer, key, '[');
    for (int i = 0; i < n; i++)
        json_number_write(writer, (double)numbers[i]);
    json_writer_close(writer, '[');
}

static void write_source(struct json_writer *writer, const psplat_pixel_source *source)
{
    const float place[2] = {source->x, source->y};
    json_writer_open(writer, '{');
    if (source->flags & PSPLAT_SOURCE_PROJECTED)
        write_numbers(writer, "place", place, 2);
    json_writer_number_of(writer, "seen", source->flags & PSPLAT_SOURCE_SEEN ? 1 : 0);
    json_writer_number_of(writer, "bounce", source->bounce);
    write_numbers(writer, "irradiance", source->irradiance, 3);
    json_writer_close(writer, '{');
}

static char *light_text(const psplat_pixel_light *light)
{
    struct json_buffer buffer;
    struct json_writer *writer = &buffer.writer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    json_writer_open(writer, '{');
    write_numbers(writer, "irradiance", light->irradiance, 3);
    json_writer_number_of(writer, "photons", (double)light->photon_count);
    json_writer_number_of(writer, "count", (double)light->source_count);
    json_writer_open_of(writer, "sources", '[');
    for (size_t i = 0; i < light->source_count && i < MOST_SOURCES; i++)
        write_source(writer, &light->sources[i]);
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
    return json_buffer_end(&buffer);
}

static int was_stopped(void *explorer)
{
    return atomic_load(&((struct explorer *)explorer)->stopping);
}

static ps_result load(struct explorer *explorer, int view, psplat_scene **scene,
                      psplat_error *error)
{
    struct option_list options = {0};
    pthread_mutex_lock(&explorer->lock);
    bool present = explorer->views[view].is_present;
    bool copied = option_list_append(&options, &explorer->views[view].options);
    pthread_mutex_unlock(&explorer->lock);
    ps_result result = copied ? PS_OK : PS_ERROR_MEMORY;
    *error = (psplat_error){.result = result, .message = "out of memory"};
    if (!present) {
        result = PS_ERROR_INVALID;
        *error = (psplat_error){.result = result, .message = "there is no such view"};
    }
    if (result == PS_OK)
        result = explorer_load(explorer, view, &options, 1, scene, error);
    option_list_release(&options);
    return result;
}

static ps_result find_light(struct explorer *explorer, int view, const size_t pixel[2],
                            psplat_pixel_light **light, psplat_error *error)
{
    const psplat_callbacks callbacks = {
        .size = sizeof callbacks, .user = explorer, .cancelled = was_stopped};
    psplat_scene *scene;
    ps_result result = load(explorer, view, &scene, error);
    if (result != PS_OK)
        return result;
    result = psplat_pixel_light_find(scene, (unsigned)pixel[0], (unsigned)pixel[1], &callbacks,
                                     light, error);
    psplat_scene_destroy(scene);
    return result;
}

bool handle_get_light(const struct route_request *request, const char *rest)
{
    int view = handle_view_named(rest);
    size_t pixel[2];
    psplat_pixel_light *light;
    psplat_error told;
    if (view < 0 || !handle_coordinate(request, "x", MOST_COORDINATE, &pixel[0]) ||
        !handle_coordinate(request, "y", MOST_COORDINATE, &pixel[1]))
        return handle_unknown(request);
    ps_result result = find_light(request->explorer, view, pixel, &light, &told);
    if (result != PS_OK)
        return handle_change(request, result, told.message);
    bool good = answer_json(request->connection, MHD_HTTP_OK, light_text(light));
    psplat_pixel_light_destroy(light);
    return good;
}
