/* camera.c: the sections of cameras. */
#include "parser/sections/sections.h"

#include "parser/schema/keys.h"
#include "parser/sections/check.h"
#include "parser/sections/fill.h"
#include <psplat/math.h>
#include <string.h>

/* POV-Ray's default: as wide as a picture of 4/3 at distance 1. */
#define DEFAULT_ANGLE 67.38

/* The name of the camera that has none. */
#define UNNAMED "camera"

struct camera_description *camera_add(struct reader *reader)
{
    struct scene_description *description = reader->description;
    struct camera_description *cameras =
        reader_extend(reader, description->cameras, description->camera_count, 1, sizeof *cameras);
    if (!cameras)
        return NULL;
    description->cameras = cameras;
    return &cameras[description->camera_count++];
}

bool camera_exists(const struct reader *reader, const char *name)
{
    const struct scene_description *description = reader->description;
    for (size_t i = 0; i < description->camera_count; i++)
        if (description->cameras[i].name && strcmp(description->cameras[i].name, name) == 0)
            return true;
    return false;
}

static bool check_projection(const struct reader *reader, const struct node *at,
                             const struct node *map, const struct camera_description *camera)
{
    bool finds = camera->finds_location;
    if (camera->kind == CAMERA_PERSPECTIVE)
        return check_expect(reader, camera->width == 0, check_value(map, at, "width"),
                            "width is of an orthographic camera; a perspective one has an angle");
    bool good = check_expect(reader, camera->width > 0 || finds, at,
                             "missing key 'width' in camera, which an orthographic one requires");
    const char *angle = camera->angle > 0 ? "angle" : "vertical_angle";
    return check_expect(reader, camera->angle == 0 && camera->vertical_angle == 0,
                        check_value(map, at, angle),
                        "an orthographic camera has no angle; it has a width") &&
           good;
}

static bool check_camera(const struct reader *reader, const struct node *at, const struct node *map,
                         const struct camera_description *camera)
{
    bool good = check_projection(reader, at, map, camera);
    if (camera->finds_location || camera->finds_look_at)
        return check_expect(reader, !check_zero(camera->up), check_value(map, at, "up"),
                            "the length of up is 0") &&
               good;
    if (ps_same(camera->location, camera->look_at))
        return check_expect(reader, false, check_value(map, at, "look_at"),
                            "look_at is the camera's location; it must be another point");
    return check_expect(reader, !check_up_along(camera->location, camera->look_at, camera->up),
                        check_value(map, at, "up"),
                        "up is along the direction of view; the camera's roll is undefined") &&
           good;
}

/* `auto` is a camera with that location. NULL when out of memory, noted. */
static const struct node *map_of(struct reader *reader, const struct node *value)
{
    static const struct node empty = {.kind = NODE_MAP};
    if (value->kind != NODE_SCALAR || strcmp(value->text, AUTO_WORD) != 0)
        return value;
    struct node *map = node_start(reader->arena, &empty);
    const struct node *key = node_scalar(reader->arena, value, "location");
    if (map && key && node_add(map, reader->arena, key, value))
        return map;
    reader->out_of_memory = true;
    return NULL;
}

static void read_camera(struct reader *reader, const struct item *item, const char *name)
{
    struct camera_keys keys = {.projection = CAMERA_PERSPECTIVE};
    struct camera_description *camera = camera_add(reader);
    const struct node *map = map_of(reader, item->value);
    if (!camera || !map)
        return;
    bool good = fill_section(reader, schema_only("camera"), item->key, map, &keys);
    *camera = keys.camera;
    camera->location = keys.location.point;
    camera->look_at = keys.look_at.point;
    camera->finds_location = keys.location.automatic != 0;
    camera->finds_look_at = keys.look_at.automatic != 0;
    camera->kind = (enum camera_kind)keys.projection;
    camera->name = reader_copy(reader, name);
    camera->origin = reader_origin(reader, item->key);
    if (good)
        check_camera(reader, item->key, map, camera);
    if (camera->kind == CAMERA_PERSPECTIVE && !camera->finds_location && camera->angle == 0 &&
        camera->vertical_angle == 0)
        camera->angle = DEFAULT_ANGLE;
}

void cameras_read(struct reader *reader, const struct node *root)
{
    const struct item *camera = node_find(root, "camera"), *cameras = node_find(root, "cameras");
    if (camera)
        read_camera(reader, camera, UNNAMED);
    if (!cameras || !fill_expect(reader, "cameras", cameras->value, NODE_MAP))
        return;
    for (const struct item *item = cameras->value->first; item; item = item->next) {
        if (camera && strcmp(item->key->text, UNNAMED) == 0)
            reader_error(reader, item->key, "the camera without a name is called '%s' already",
                         UNNAMED);
        read_camera(reader, item, item->key->text);
    }
}
