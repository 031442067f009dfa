/* pigment.c: colours, or numbers, that may vary over a surface, and the pictures that they name. */
#include "parser/sections/sections.h"

#include "parser/sections/fill.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct pigment_description pigment_of(ps_rgb color)
{
    return (struct pigment_description){
        .kind = PIGMENT_COLOR,
        .colors = {color, color},
        .texture = NO_INDEX,
        .scale_u = 1,
        .scale_v = 1,
        .placement = AFFINE_IDENTITY,
        .axis = {0, 1, 0},
        .octaves = 1,
    };
}

static bool read_color(struct reader *reader, struct subject subject, const struct schema_row *row,
                       const struct node *node, ps_rgb *color)
{
    struct schema_row plain = {.param = row->param};
    double number = 0;
    plain.param.offset = 0;
    if (row->form == SCHEMA_PIGMENT)
        return value_set(reader, subject, &plain, node, color);
    plain.param.type = PS_PARAM_NUMBER;
    bool good = value_set(reader, subject, &plain, node, &number);
    *color = (ps_rgb){(float)number, (float)number, (float)number};
    return good;
}

static bool is_in_range(const ps_param *param, ps_rgb color)
{
    const float parts[3] = {color.r, color.g, color.b};
    for (int i = 0; i < 3; i++)
        if (!((double)parts[i] >= param->minimum && (double)parts[i] <= param->maximum))
            return false;
    return true;
}

/* A pattern's colours take the range of the key that it stands under. */
static bool check_range(const struct reader *reader, struct subject subject,
                        const struct schema_row *row, const struct item *pattern,
                        const struct pigment_keys *keys)
{
    const struct item *color = node_find(pattern->value, "color");
    const struct item *colors = node_find(pattern->value, "colors");
    const struct item *at = color ? color : colors;
    const ps_rgb *first = color ? &keys->color : keys->colors;
    if (!at || (is_in_range(&row->param, first[0]) &&
                (color || is_in_range(&row->param, keys->colors[1]))))
        return true;
    char domain[128];
    schema_describe(&(struct schema_row){.param = row->param}, domain, sizeof domain);
    reader_error(reader, at->value, "%s in %s: %s in %s takes %s", at->key->text,
                 pattern->key->text, subject.key, subject.section, domain);
    return false;
}

static bool check_axis(const struct reader *reader, const struct item *pattern, ps_vec3 axis)
{
    if (axis.x != 0 || axis.y != 0 || axis.z != 0)
        return true;
    reader_error(reader, node_find(pattern->value, "axis")->value, "axis in %s: its length is 0",
                 pattern->key->text);
    return false;
}

/* A scalar is no colour, so that its file is taken to hold plain numbers. */
static size_t add_texture(struct reader *reader, enum schema_form form, struct texture_keys keys)
{
    if (form == SCHEMA_SCALAR_PIGMENT && keys.encoding == ENCODING_AUTO)
        keys.encoding = ENCODING_LINEAR;
    return texture_add(reader, &keys);
}

static struct pigment_description pigment_from(struct reader *reader, enum schema_form form,
                                               const struct schema_section *section,
                                               const struct pigment_keys *keys)
{
    struct pigment_description pigment = pigment_of(keys->colors[0]);
    pigment.kind = (enum pigment_kind)section->kind;
    if (pigment.kind == PIGMENT_IMAGE) {
        pigment.colors[0] = pigment.colors[1] = keys->color;
        pigment.texture = add_texture(reader, form, keys->texture);
        pigment.channel = keys->channel;
        pigment.scale_u = keys->repeat[0];
        pigment.scale_v = keys->repeat[1];
        pigment.offset_u = keys->offset[0];
        pigment.offset_v = keys->offset[1];
        return pigment;
    }
    pigment.colors[1] = keys->colors[1];
    pigment.turbulence = keys->turbulence;
    if (pigment.kind == PIGMENT_GRADIENT)
        pigment.axis = keys->axis;
    if (pigment.kind == PIGMENT_NOISE)
        pigment.octaves = keys->octaves;
    return pigment;
}

static bool read_pattern(struct reader *reader, struct subject subject,
                         const struct schema_row *row, const struct node *node,
                         struct pigment_description *pigment)
{
    struct pigment_keys keys = {.repeat = {1, 1}};
    const struct schema_section *section = fill_find_kind(reader, row->family, subject.key, node);
    if (!section)
        return false;
    const struct item *item = node->first;
    if (!fill_section(reader, section, item->key, item->value, &keys) ||
        !check_range(reader, subject, row, item, &keys))
        return false;
    if (section->kind == PIGMENT_GRADIENT && !check_axis(reader, item, keys.axis))
        return false;
    *pigment = pigment_from(reader, row->form, section, &keys);
    return section->kind == PIGMENT_IMAGE ||
           placement_read(reader, item->key, item->value, &keys.placement, &pigment->placement);
}

bool pigment_read(struct reader *reader, struct subject subject, const struct schema_row *row,
                  const struct node *node, void *state)
{
    size_t offset = row->param.offset - offsetof(struct pigment_description, colors[0]);
    struct pigment_description *pigment = (void *)((char *)state + offset);
    *pigment = pigment_of((ps_rgb){0, 0, 0});
    if (node->kind == NODE_MAP)
        return read_pattern(reader, subject, row, node, pigment);
    ps_rgb color = {0, 0, 0};
    bool good = read_color(reader, subject, row, node, &color);
    *pigment = pigment_of(color);
    return good;
}

/* --- textures -------------------------------------------------------------------------------- */

/* What makes two textures the same, or NULL. */
static char *identity(struct reader *reader, const struct texture_keys *keys, const char *path)
{
    const char *layer = keys->layer ? keys->layer->text : "";
    size_t size = strlen(path) + strlen(layer) + 64;
    char *text = arena_allocate(reader->arena, size);
    if (text)
        snprintf(text, size, "%d %d %d %zu %s%s", (int)keys->wrap, (int)keys->encoding,
                 (int)keys->interpolate, strlen(layer), layer, path);
    else
        reader->out_of_memory = true;
    return text;
}

static size_t append(struct reader *reader, const struct texture_keys *keys, char *path)
{
    struct scene_description *description = reader->description;
    struct texture_description *textures =
        reader_extend(reader, description->textures, description->texture_count, 1,
                      sizeof *description->textures);
    char *layer = keys->layer ? strdup(keys->layer->text) : NULL;
    if (keys->layer && !layer)
        reader->out_of_memory = true;
    if (textures)
        description->textures = textures;
    if (!textures || reader->out_of_memory) {
        free(path);
        free(layer);
        return NO_INDEX;
    }
    textures[description->texture_count] = (struct texture_description){
        .path = path,
        .layer = layer,
        .wrap_u = keys->wrap,
        .wrap_v = keys->wrap,
        .encoding = keys->encoding,
        .nearest = keys->interpolate == 1,
        .origin = reader_origin(reader, keys->file),
    };
    return description->texture_count++;
}

size_t texture_add(struct reader *reader, const struct texture_keys *keys)
{
    size_t index = NO_INDEX;
    char *path = reader_path(reader, keys->file, keys->file->text);
    const char *same = path ? identity(reader, keys, path) : NULL;
    if (same && !reference_get(&reader->textures, same, &index)) {
        index = append(reader, keys, path);
        reference_put(reader, &reader->textures, same, index);
    } else {
        free(path);
    }
    return index;
}
