#include "explore/scene_facts.h"

#include "api/handles.h"
#include "explore/json_text.h"
#include "parser/schema/schema.h"
#include "plugin/kind.h"
#include <stdlib.h>
#include <string.h>

static const struct scene_setting settings[] = {
    {"quality", false, "render", "quality"},
    {"bounces", false, "render", "bounces"},
    {"seed", false, "render", "seed"},
    {"exposure", false, "image", "exposure"},
    {"direct", false, "render", "direct"},
    {"direct-resolution", false, "render", "direct_resolution"},
    {"image.filter", true, "image", "filter"},
    {"render.light_samples", true, "render", "light_samples"},
    {"render.light_choices", true, "render", "light_choices"},
    {"render.discontinuity_buffer", true, "render", "discontinuity_buffer"},
    {"render.aa_samples", true, "render", "aa_samples"},
    {"render.indirect_exposure", true, "render", "indirect_exposure"},
    {"render.ambient", true, "render", "ambient"},
};

double scene_facts_pixels(const psplat_scene *scene)
{
    const struct image_description *image = &scene->input.description.image;
    return (double)image->width * (double)image->height;
}

size_t scene_setting_count(void)
{
    return sizeof settings / sizeof settings[0];
}

const struct scene_setting *scene_setting(size_t index)
{
    return &settings[index];
}

static const struct scene_description *description_of(const psplat_scene *scene)
{
    return &scene->input.description;
}

static void write_strategies(const struct render_description *render, struct json_writer *writer)
{
    json_writer_open_of(writer, "strategies", '{');
    for (int kind = 0; kind < PS_KINDS; kind++) {
        const char *name = render->strategies[kind].name;
        json_text_write_of(writer, kinds[kind].name, name ? name : kinds[kind].default_strategy);
    }
    json_writer_close(writer, '{');
}

static void write_parameters(const struct render_description *render, struct json_writer *writer)
{
    json_writer_open_of(writer, "parameters", '{');
    for (int kind = 0; kind < PS_KINDS; kind++) {
        const struct strategy_choice *choice = &render->strategies[kind];
        json_writer_open_of(writer, kinds[kind].name, '{');
        for (size_t i = 0; i < choice->parameter_count; i++)
            json_text_write_of(writer, choice->parameters[i].key, choice->parameters[i].value);
        json_writer_close(writer, '{');
    }
    json_writer_close(writer, '{');
}

static const char *camera_name(const struct camera_description *camera)
{
    return camera->name ? camera->name : "camera";
}

static void write_setting(const struct scene_description *description,
                          const struct scene_setting *setting, struct json_writer *writer)
{
    struct param_table table = schema_table(schema_only(setting->section));
    const void *state = &description->render;
    char text[256];
    if (strcmp(setting->section, "image") == 0)
        state = &description->image;
    param_format(param_find(&table, setting->key), state, text, sizeof text);
    json_writer_text_of(writer, setting->name, text);
}

void scene_facts_write(const psplat_scene *scene, struct json_writer *writer)
{
    const struct scene_description *description = description_of(scene);
    char size[64];
    write_strategies(&description->render, writer);
    write_parameters(&description->render, writer);
    json_writer_open_of(writer, "values", '{');
    snprintf(size, sizeof size, "%lldx%lld", (long long)description->image.width,
             (long long)description->image.height);
    json_writer_text_of(writer, "size", size);
    json_text_write_of(writer, "camera", camera_name(&description->cameras[0]));
    for (size_t i = 0; i < scene_setting_count(); i++)
        write_setting(description, &settings[i], writer);
    json_writer_close(writer, '{');
}

static int compare_places(const void *a, const void *b)
{
    const struct camera_description *const *x = a, *const *y = b;
    int by_line = ((*x)->origin.line > (*y)->origin.line) - ((*x)->origin.line < (*y)->origin.line);
    return by_line != 0 ? by_line : strcmp(camera_name(*x), camera_name(*y));
}

/* The one that was asked for stands first in the description. */
void scene_facts_write_cameras(const psplat_scene *scene, struct json_writer *writer)
{
    const struct scene_description *description = description_of(scene);
    const struct camera_description **cameras =
        malloc((description->camera_count + 1) * sizeof(const struct camera_description *));
    json_writer_open(writer, '[');
    for (size_t i = 0; cameras && i < description->camera_count; i++)
        cameras[i] = &description->cameras[i];
    if (cameras)
        qsort(cameras, description->camera_count, sizeof(const struct camera_description *),
              compare_places);
    for (size_t i = 0; cameras && i < description->camera_count; i++)
        json_text_write(writer, camera_name(cameras[i]));
    json_writer_close(writer, '[');
    free(cameras);
}

void scene_facts_each_file(const psplat_scene *scene, void (*each)(void *user, const char *path),
                           void *user)
{
    const struct scene_description *description = description_of(scene);
    for (size_t i = 0; i < description->file_count; i++)
        each(user, description->files[i]);
    for (size_t i = 0; i < description->texture_count; i++)
        if (!description->textures[i].bytes)
            each(user, description->textures[i].path);
}
