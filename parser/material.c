/* material.c: see material.h.
 *
 * All names are known before the first material is read, as a mixed one may name any other.
 */
#include "parser/material.h"

#include "parser/fill.h"
#include "parser/keys.h"
#include "parser/mix.h"
#include "parser/pigment.h"
#include "parser/reference.h"
#include "parser/texture.h"
#include <string.h>

static void add_names(struct reader *reader, const struct node *map)
{
    struct scene_description *description = reader->description;
    description->materials =
        reader_extend(reader, NULL, 0, map->count, sizeof *description->materials);
    if (!description->materials)
        return;
    for (const struct item *item = map->first; item; item = item->next) {
        size_t index = description->material_count++;
        description->materials[index].name = reader_copy(reader, item->key->text);
        description->materials[index].origin = reader_origin(reader, item->key);
        reference_put(reader, &reader->materials, item->key->text, index);
    }
}

/* Of the key that says of which kind the material is; what is under it goes into the keys. */
static bool read_kind(struct reader *reader, const struct node *map, struct material_keys *keys)
{
    static const char *const maps[] = {"metal", "glossy", "dielectric"};
    struct material_description *material = &keys->material;
    const struct item *mix = node_find(map, "mix");
    material->kind = node_find(map, "mirror") ? MATERIAL_MIRROR : MATERIAL_DIFFUSE;
    if (mix) {
        material->kind = MATERIAL_MIX;
        return mix_read(reader, mix, material);
    }
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        const struct item *item = node_find(map, maps[i]);
        const struct schema_section *section = schema_only(maps[i]);
        if (!item)
            continue;
        material->kind = (enum material_kind)section->kind;
        return fill_section(reader, section, item->key, item->value, keys);
    }
    return true;
}

/* Normals are numbers, whatever the type of their file. */
static size_t read_normal_map(struct reader *reader, const struct node *map)
{
    struct texture_keys keys = {.file = NULL};
    const struct item *item = node_find(map, "normal_map");
    if (!item || !fill_section(reader, schema_only("normal_map"), item->key, item->value, &keys))
        return NO_INDEX;
    if (keys.encoding == ENCODING_AUTO)
        keys.encoding = ENCODING_LINEAR;
    return texture_add(reader, &keys);
}

static void read_material(struct reader *reader, const struct item *item,
                          struct material_description *material)
{
    const struct pigment_description black = pigment_of((ps_rgb){0, 0, 0});
    struct material_keys keys = {.material = *material};
    keys.material.color = keys.material.specular = keys.material.roughness = black;
    keys.material.emission = keys.material.opacity = keys.material.bump = black;
    keys.material.ior = 1;
    if (fill_section(reader, schema_only("material"), item->key, item->value, &keys))
        read_kind(reader, item->value, &keys);
    keys.material.emission_both = keys.emission_both != 0;
    keys.material.normal_map = read_normal_map(reader, item->value);
    *material = keys.material;
}

void materials_read(struct reader *reader, const struct node *root)
{
    struct scene_description *description = reader->description;
    const struct item *materials = node_find(root, "materials");
    if (!materials || !fill_expect(reader, "materials", materials->value, NODE_MAP) ||
        materials->value->count == 0)
        return;
    add_names(reader, materials->value);
    struct material_description *material = description->materials;
    for (const struct item *item = materials->value->first; item && material; item = item->next)
        read_material(reader, item, material++);
    mix_order(reader);
}
