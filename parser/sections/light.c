/* light.c: the section of lights. */
#include "parser/sections/sections.h"

#include "parser/schema/keys.h"
#include "parser/sections/check.h"
#include "parser/sections/fill.h"
#include <math.h>
#include <psplat/math.h>
#include <stdlib.h>

/* How far a rectangle's corners may be off, relative to its sides. */
#define RECTANGLE_TOLERANCE 1e-4

/* The unit in which the light is given; nothing at all counts as the last. */
static void set_amount(const struct node *map, const struct light_keys *keys,
                       struct light_description *light)
{
    const struct {
        const char *key;
        enum light_unit unit;
        ps_rgb amount;
    } units[] = {
        {"intensity", UNIT_INTENSITY, keys->intensity},
        {"power", UNIT_POWER, keys->power},
        {"irradiance", UNIT_IRRADIANCE, keys->irradiance},
        {"radiance", UNIT_RADIANCE, keys->radiance},
    };
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        light->unit = units[i].unit;
        light->amount = units[i].amount;
        if (node_find(map, units[i].key))
            return;
    }
    if (light->kind == LIGHT_SKY)
        light->amount = (ps_rgb){1, 1, 1};
}

static ps_vec3 half_of(ps_vec3 from, ps_vec3 to)
{
    return ps_scale(ps_subtract(to, from), 0.5f);
}

/* Three corners, in order around, or four of which the last follows from the others. */
static bool set_rectangle(const struct reader *reader, const struct node *at,
                          const struct node *map, const struct point_list *corners,
                          struct light_description *light)
{
    const ps_vec3 *p = corners->items;
    const struct item *item = node_find(map, "corners");
    const struct node *culprit = item ? item->value : at;
    ps_vec3 first = half_of(p[0], p[1]), second = half_of(p[1], p[2]);
    float longest = fmaxf(ps_length(first), ps_length(second));
    ps_vec3 fourth = ps_add(p[0], ps_subtract(p[2], p[1]));
    light->location = ps_add(p[0], half_of(p[0], p[2]));
    light->half_edges[0] = first;
    light->half_edges[1] = second;
    const char *wrong = NULL;
    if (!(ps_length(ps_cross(first, second)) > 0.0f) || !isfinite(longest))
        wrong = "the corners are on one line";
    else if (fabs((double)ps_dot(ps_normalize(first), ps_normalize(second))) > RECTANGLE_TOLERANCE)
        wrong = "the corners have no right angle";
    else if (corners->count == 4 &&
             (double)ps_length(ps_subtract(p[3], fourth)) > RECTANGLE_TOLERANCE * (double)longest)
        wrong = "the fourth corner is not where a rectangle has it";
    if (wrong)
        reader_error(reader, culprit, "corners in rectangle: %s", wrong);
    return !wrong;
}

static void set_sky(struct reader *reader, const struct light_keys *keys,
                    struct light_description *light)
{
    struct texture_keys texture = {.file = keys->file, .layer = keys->layer, .wrap = WRAP_REPEAT};
    if (keys->file)
        light->texture = texture_add(reader, &texture);
    else if (keys->layer)
        reader_error(reader, keys->layer, "layer in sky: there is no 'file' that it could be of");
}

static bool check_spotlight(const struct reader *reader, const struct node *at,
                            const struct node *map, const struct light_description *light)
{
    bool good = check_expect(reader, !ps_same(light->location, light->point_at),
                             check_value(map, at, "point_at"),
                             "point_at is the spotlight's location; it must be another point");
    if (light->radius <= light->falloff)
        return good;
    const struct node *radius =
        node_find(map, "radius") ? check_value(map, at, "radius") : check_value(map, at, "falloff");
    reader_error(reader, radius, "radius %g%s is larger than falloff %g%s in spotlight",
                 light->radius, node_find(map, "radius") ? "" : " (the default)", light->falloff,
                 node_find(map, "falloff") ? "" : " (the default)");
    return false;
}

static bool check_light(const struct reader *reader, const struct node *at, const struct node *map,
                        const struct light_description *light)
{
    bool directed = light->kind == LIGHT_SUN || light->kind == LIGHT_DISC;
    bool good = check_expect(reader, !directed || !check_zero(light->direction),
                             check_value(map, at, "direction"), "the length of direction is 0");
    if (light->kind == LIGHT_SPOT)
        return check_spotlight(reader, at, map, light);
    if (light->kind == LIGHT_SUN)
        return check_expect(
                   reader, light->unit != UNIT_RADIANCE || light->angle > 0,
                   check_value(map, at, "radiance"),
                   "a sun of angle 0 is a point, which has no radiance; give irradiance") &&
               good;
    if (light->kind == LIGHT_SKY)
        return check_expect(reader, node_find(map, "radiance") || node_find(map, "file"), at,
                            "sky needs one of radiance, file");
    return good;
}

static void read_light(struct reader *reader, const struct schema_section *section,
                       const struct item *item, struct light_description *light)
{
    struct light_keys keys = {.file = NULL};
    bool good = fill_section(reader, section, item->key, item->value, &keys);
    *light = keys.light;
    light->kind = (enum light_kind)section->kind;
    light->origin = reader_origin(reader, item->key);
    light->texture = NO_INDEX;
    light->both_sides = keys.both_sides != 0;
    light->visible = keys.visible != 0;
    set_amount(item->value, &keys, light);
    if (good && check_light(reader, item->key, item->value, light)) {
        light->direction = check_unit(light->direction);
        if (light->kind == LIGHT_RECTANGLE)
            set_rectangle(reader, item->key, item->value, &keys.corners, light);
        set_sky(reader, &keys, light);
    }
    free(keys.corners.items);
}

void lights_read(struct reader *reader, const struct node *root)
{
    struct scene_description *description = reader->description;
    const struct item *list = node_find(root, "lights");
    if (!list || !fill_expect(reader, "lights", list->value, NODE_LIST))
        return;
    description->lights =
        reader_extend(reader, NULL, 0, list->value->count, sizeof *description->lights);
    if (!description->lights)
        return;
    for (const struct item *item = list->value->first; item; item = item->next) {
        const struct schema_section *section =
            fill_find_kind(reader, "lights", "lights", item->value);
        if (section)
            read_light(reader, section, item->value->first,
                       &description->lights[description->light_count++]);
    }
}
