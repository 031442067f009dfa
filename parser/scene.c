/* scene.c: finds the sections and hands each to the filler and to its check.
 *
 * Materials come before objects whatever the file's order, as objects refer to them.
 */
#include "parser/scene.h"

#include "parser/check.h"
#include "parser/fill.h"
#include "parser/suggestion.h"
#include <string.h>

/* POV-Ray's default: as wide as a picture of 4/3 at distance 1. */
#define DEFAULT_ANGLE 67.38

/* Fills a section of the top level; without its key, the state takes the defaults. */
static bool read_map(struct reader *reader, const struct node *root, const char *name, void *state,
                     struct origin *origin)
{
    static const struct node nothing = {.kind = NODE_SCALAR, .plain = true, .text = ""};
    const struct item *item = node_find(root, name);
    if (item && origin)
        *origin = reader_origin(reader, item->key);
    return fill_section(reader, schema_find(NULL, name), item ? item->key : root,
                        item ? item->value : &nothing, state);
}

static void read_camera(struct reader *reader, const struct node *root)
{
    const struct item *item = node_find(root, "camera");
    if (!item) /* which the table of the whole file reports */
        return;
    struct camera_description *camera = reader_allocate(reader, 1, sizeof *camera);
    if (!camera)
        return;
    reader->description->cameras = camera;
    reader->description->camera_count = 1;
    if (read_map(reader, root, "camera", camera, &camera->origin))
        check_camera(reader, item->key, item->value, camera);
    if (camera->angle == 0 && camera->vertical_angle == 0)
        camera->angle = DEFAULT_ANGLE;
}

static void read_materials(struct reader *reader, const struct node *root)
{
    struct scene_description *description = reader->description;
    const struct item *materials = node_find(root, "materials");
    if (!materials || !fill_expect(reader, "materials", materials->value, NODE_MAP))
        return;
    size_t count = materials->value->count;
    description->materials = reader_allocate(reader, count, sizeof *description->materials);
    if (!description->materials)
        return;
    const struct schema_section *section = schema_find("materials", "material");
    for (const struct item *item = materials->value->first; item; item = item->next) {
        struct material_description *material =
            &description->materials[description->material_count++];
        fill_section(reader, section, item->key, item->value, material);
        material->normal_map = NO_INDEX;
        material->opacity.colors[0] = (ps_rgb){1, 1, 1};
        material->name = reader_copy(reader, item->key->text);
        material->origin = reader_origin(reader, item->key);
        if (!names_put(&reader->materials, reader->arena, item->key->text, material))
            reader->out_of_memory = true;
    }
}

static void report_unknown_kind(const struct reader *reader, const char *parent,
                                const struct node *key)
{
    int singular = (int)strlen(parent) - 1; /* "lights" -> "light" */
    struct suggestion suggestion = suggestion_start(key->text);
    char known[SUGGESTION_TEXT] = "; known are", hint[SUGGESTION_TEXT];
    size_t first = strlen(known);
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        if (!section->parent || strcmp(section->parent, parent) != 0)
            continue;
        suggestion_consider(&suggestion, section->name);
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s %s", used > first ? "," : "",
                 section->name);
    }
    suggestion_text(&suggestion, hint);
    reader_error(reader, key, "unknown %.*s kind '%s'%s", singular, parent, key->text,
                 suggestion.best ? hint : known);
}

/* The kind that an item of a list names: the item is a map of one key, `{spotlight: {...}}`. */
static const struct schema_section *find_kind(const struct reader *reader, const char *parent,
                                              const struct node *node)
{
    if (node->kind != NODE_MAP || node->count == 0) {
        reader_error(reader, node, "expected a map with one key in %s, got %s", parent,
                     node->kind == NODE_MAP ? "an empty map" : node_kind_name(node));
        return NULL;
    }
    const struct item *item = node->first;
    const struct schema_section *section = schema_find(parent, item->key->text);
    if (!section)
        report_unknown_kind(reader, parent, item->key);
    if (item->next) {
        reader_error(reader, item->next->key,
                     "key '%s' stands beside '%s'; indent it to put it inside",
                     item->next->key->text, item->key->text);
        return NULL;
    }
    return section;
}

/* How a list of kinds is read, for lights and objects alike. */
struct list {
    const char *name;
    size_t element_size;
    void (*finish)(const struct reader *reader, const struct schema_section *section,
                   const struct item *item, bool good, void *element);
};

static void *read_list(struct reader *reader, const struct node *root, const struct list *list,
                       size_t *count)
{
    const struct item *found = node_find(root, list->name);
    if (!found || !fill_expect(reader, list->name, found->value, NODE_LIST))
        return NULL;
    char *elements = reader_allocate(reader, found->value->count, list->element_size);
    if (!elements)
        return NULL;
    *count = found->value->count;
    char *element = elements;
    for (const struct item *item = found->value->first; item; item = item->next) {
        const struct schema_section *section = find_kind(reader, list->name, item->value);
        if (section) {
            const struct item *kind = item->value->first;
            bool good = fill_section(reader, section, kind->key, kind->value, element);
            list->finish(reader, section, kind, good, element);
        }
        element += list->element_size;
    }
    return elements;
}

static void finish_light(const struct reader *reader, const struct schema_section *section,
                         const struct item *item, bool good, void *element)
{
    struct light_description *light = element;
    light->kind = (enum light_kind)section->kind;
    light->unit = UNIT_INTENSITY;
    light->texture = NO_INDEX;
    light->origin = reader_origin(reader, item->key);
    if (good)
        check_light(reader, item->key, item->value, light);
}

static void finish_object(const struct reader *reader, const struct schema_section *section,
                          const struct item *item, bool good, void *element)
{
    struct object_description *object = element;
    object->kind = (enum object_kind)section->kind;
    object->origin = reader_origin(reader, item->key);
    object->placement =
        affine_of(object->transform.scale, object->transform.rotate, object->transform.translate);
    object->texture = object->mesh = object->group = NO_INDEX;
    if (good)
        check_object(reader, item->key, item->value, object);
}

/* A file without lights is legal, and its picture black. */
static void warn_dark(const struct reader *reader, const struct node *root)
{
    const struct item *lights = node_find(root, "lights");
    const struct node *at = lights ? lights->key : root;
    struct origin origin = reader_origin(reader, at);
    bool empty = !lights || node_is_null(lights->value) ||
                 (lights->value->kind == NODE_LIST && lights->value->count == 0);
    if (empty)
        diagnostics_report(reader->sink, SEVERITY_WARNING, &origin, at->mark.width,
                           "the scene has no lights");
}

void scene_read(struct reader *reader, const struct node *root)
{
    static const struct list lights = {"lights", sizeof(struct light_description), finish_light};
    static const struct list objects = {"objects", sizeof(struct object_description),
                                        finish_object};
    struct scene_description *description = reader->description;
    struct schema_scene scene = {0};
    fill_section(reader, schema_find(NULL, "scene"), root, root, &scene);
    if (root->kind != NODE_MAP)
        return;
    read_camera(reader, root);
    read_map(reader, root, "image", &description->image, &description->image.origin);
    read_materials(reader, root);
    description->lights = read_list(reader, root, &lights, &description->light_count);
    description->objects = read_list(reader, root, &objects, &description->object_count);
    read_map(reader, root, "render", &description->render, NULL);
    description->render.light_samples = 4;
    warn_dark(reader, root);
}
