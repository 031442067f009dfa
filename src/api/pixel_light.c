/* pixel_light.c: psplat_pixel_light: which photons light a pixel. */
#include "debug/pixel_light.h"
#include "api/rendering.h"

#include <stdlib.h>

struct question {
    size_t x, y;
    psplat_pixel_light *answer; /* NULL: none yet */
};

static void copy_color(ps_rgb color, float copy[3])
{
    copy[0] = color.r;
    copy[1] = color.g;
    copy[2] = color.b;
}

static void copy_position(ps_vec3 position, float copy[3])
{
    copy[0] = position.x;
    copy[1] = position.y;
    copy[2] = position.z;
}

static psplat_pixel_source source_of(const struct pixel_source *from)
{
    psplat_pixel_source source = {.bounce = from->bounce};
    copy_position(from->position, source.position);
    copy_color(from->irradiance, source.irradiance);
    if (from->sight == BEHIND_CAMERA)
        return source;
    source.flags = PSPLAT_SOURCE_PROJECTED | (from->sight == SEEN ? PSPLAT_SOURCE_SEEN : 0u);
    source.x = from->x;
    source.y = from->y;
    return source;
}

static ps_result copy_light(const struct pixel_light *from, psplat_pixel_light **light,
                            struct error *error)
{
    psplat_pixel_light *made = calloc(1, sizeof *made);
    psplat_pixel_source *sources = malloc((from->source_count + 1) * sizeof *sources);
    if (!made || !sources) {
        free(made);
        free(sources);
        return error_memory(error, from->source_count * sizeof *sources, "sources of light");
    }
    for (size_t i = 0; i < from->source_count; i++)
        sources[i] = source_of(&from->sources[i]);
    made->photon_count = (size_t)from->photon_count;
    made->source_count = from->source_count;
    made->sources = sources;
    copy_position(from->position, made->position);
    copy_color(from->irradiance, made->irradiance);
    *light = made;
    return PS_OK;
}

static ps_result look(void *user, struct render *render, struct error *error)
{
    struct question *question = user;
    struct pixel_light light;
    ps_result result = pixel_light_find(render, question->x, question->y, &light, error);
    if (result == PS_OK)
        result = copy_light(&light, &question->answer, error);
    pixel_light_release(&light);
    return result;
}

static ps_result inspect(psplat_rendering *rendering, void *user, struct error *error)
{
    const struct render_callbacks callbacks = rendering_callbacks(rendering);
    return render_inspect(&rendering->scene->scene, &rendering->settings, &callbacks,
                          &rendering->statistics, look, user, error);
}

ps_result psplat_pixel_light_find(const psplat_scene *scene, unsigned x, unsigned y,
                                  const psplat_callbacks *callbacks, psplat_pixel_light **light,
                                  psplat_error *error)
{
    psplat_rendering rendering = {.scene = scene};
    struct question question = {.x = x, .y = y};
    *light = NULL;
    ps_result result = rendering_do(&rendering, callbacks, inspect, &question, error);
    if (result == PS_OK)
        *light = question.answer;
    else
        psplat_pixel_light_destroy(question.answer);
    return result;
}

void psplat_pixel_light_destroy(psplat_pixel_light *light)
{
    if (light)
        free((void *)light->sources);
    free(light);
}
