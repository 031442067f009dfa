#include "model/model.h"

#include "import/import.h"

bool model_is_file(const char *path)
{
    return mesh_file_is_known(path);
}

const char *model_extension(size_t index)
{
    return mesh_file_extension(index);
}

static struct box box_of(const struct scene_description *fragment)
{
    struct box box = BOX_EMPTY;
    for (size_t i = 0; i < fragment->object_count; i++) {
        const struct object_description *object = &fragment->objects[i];
        const struct mesh_description *mesh = &fragment->meshes[object->mesh];
        for (size_t k = 0; k < mesh->triangle_count; k++)
            for (int c = 0; c < 3; c++)
                box_add_point(
                    &box, affine_point(&object->placement, mesh->vertices[mesh->triangles[k][c]]));
    }
    return box;
}

/* Also such as the file names and lacks: that is told where the scene is read, unless the scene has
 * others for them. */
static bool has_materials(const struct scene_description *fragment)
{
    bool some = false;
    for (size_t i = 0; i < fragment->object_count; i++)
        some = some || fragment->objects[i].material != NO_INDEX;
    return some;
}

/* Whether a surface shines. It is what rooms are lit by; on other things it is a sign, or a lamp
 * that lights little. */
static bool shines(const struct scene_description *fragment)
{
    bool some = false;
    for (size_t i = 0; i < fragment->object_count; i++) {
        size_t material = fragment->objects[i].material;
        if (material == NO_INDEX)
            continue;
        const struct pigment_description *emission = &fragment->materials[material].emission;
        some = some || emission->kind != PIGMENT_COLOR || ps_rgb_maximum(emission->colors[0]) > 0;
    }
    return some;
}

ps_result model_read(const struct model_file *file, struct model *model, struct mesh_ahead *content,
                     struct error *error)
{
    const char *path = file->path;
    const struct mesh_request request = {
        .path = path,
        .folder = file->folder,
        .cache = file->cache,
        .memory_limit = file->memory_limit,
        .geometry = true,
        .materials = true,
        .camera = true,
        .lights = true,
        .unit = 1,
        .bump_scale = 1,
        .up = mesh_file_up(path),
        .placement = AFFINE_IDENTITY,
    };
    ps_result result = mesh_read_ahead(&request, content, error);
    const struct scene_description *fragment = &content->fragment;
    if (result != PS_OK)
        return result;
    *model = (struct model){
        .box = box_of(fragment),
        .up = request.up,
        .has_materials = has_materials(fragment),
        .has_camera = fragment->camera_count > 0,
        .has_lights = fragment->light_count > 0,
    };
    if (box_is_empty(&model->box)) {
        mesh_ahead_release(content);
        return error_set(error, PS_ERROR_INVALID, "%s: there is nothing to see in it", path);
    }
    model->room = room_find(fragment, &model->box);
    model->has_lights = model->has_lights || (model->room.is_room && shines(fragment));
    return PS_OK;
}
