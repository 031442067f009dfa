/* scene.c: finds the sections and hands each to its reader.
 *
 * Materials come before objects whatever the file's order, as objects refer to them.
 */
#include "parser/sections/sections.h"
#include "scene/repeated_meshes.h"

#include "parser/sections/fill.h"
#include "parser/sections/object.h"

/* Fills a section of the top level; without its key, the state takes the defaults. */
static bool read_map(struct reader *reader, const struct node *root, const char *name, void *state,
                     struct origin *origin)
{
    static const struct node nothing = {.kind = NODE_SCALAR, .plain = true, .text = ""};
    const struct item *item = node_find(root, name);
    if (item && origin)
        *origin = reader_origin(reader, item->key);
    return fill_section(reader, schema_only(name), item ? item->key : root,
                        item ? item->value : &nothing, state);
}

static void read_objects(struct reader *reader, const struct node *root)
{
    const struct item *item = node_find(root, "objects");
    struct object_list list = {NULL, 0};
    const struct object_context context = {.list = &list, .placement = AFFINE_IDENTITY};
    if (item)
        objects_read(reader, "objects", item->value, &context);
    reader->description->objects = list.items;
    reader->description->object_count = list.count;
}

/* A mesh may have brought the only one. */
static void require_camera(const struct reader *reader, const struct node *root)
{
    const struct item *cameras = node_find(root, "cameras");
    if (reader->description->camera_count > 0)
        return;
    if (cameras)
        reader_error(reader, cameras->key, "the scene has no camera");
    else if (!node_find(root, "camera"))
        reader_error(reader, root, "missing key 'camera' in scene");
}

static bool shines(const struct material_description *material)
{
    const struct pigment_description *emission = &material->emission;
    const ps_rgb color = emission->colors[0];
    return emission->kind != PIGMENT_COLOR || color.r > 0 || color.g > 0 || color.b > 0;
}

static bool has_light(const struct scene_description *description)
{
    for (size_t i = 0; i < description->material_count; i++)
        if (shines(&description->materials[i]))
            return true;
    return description->light_count > 0;
}

/* A file without lights is legal, and its picture black. Where there are errors, a light may be
 * what was wrong. */
static void warn_dark(const struct reader *reader, const struct node *root)
{
    const struct item *lights = node_find(root, "lights");
    const struct node *at = lights ? lights->key : root;
    struct origin origin = reader_origin(reader, at);
    bool empty = !lights || node_is_null(lights->value) ||
                 (lights->value->kind == NODE_LIST && lights->value->count == 0);
    if (empty && diagnostics_error_count(reader->sink) == 0 && !has_light(reader->description))
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width,
                           "the scene has no lights");
}

static void read_sections(struct reader *reader, const struct node *root)
{
    struct scene_description *description = reader->description;
    cameras_read(reader, root);
    read_map(reader, root, "image", &description->image, &description->image.origin);
    materials_read(reader, root);
    lights_read(reader, root);
    groups_read(reader, root);
    read_objects(reader, root);
    read_map(reader, root, "render", &description->render, NULL);
    if (diagnostics_error_count(reader->sink) == 0 && !scene_description_share_meshes(description))
        reader->out_of_memory = true;
    warn_dark(reader, root);
}

void scene_read(struct reader *reader, const struct node *root)
{
    struct schema_scene scene = {0};
    fill_section(reader, schema_only("scene"), root, root, &scene);
    if (root->kind == NODE_MAP)
        read_sections(reader, root);
    if (root->kind == NODE_MAP || node_is_null(root))
        require_camera(reader, root);
}
