/* material.c: the section of materials, mixes of them included.
 *
 * All names are known before the first material is read, as a mixed one may name any other.
 */
#include "parser/sections/sections.h"

#include "parser/schema/keys.h"
#include "parser/sections/fill.h"
#include <stdlib.h>
#include <string.h>

/* --- mixes ----------------------------------------------------------------------------------- */

/* Of mixes in mixes: more than a scene means by it, and who evaluates them recurses. */
#define DEEPEST_MIX 16

/* How far the sum of weights may exceed 1 by rounding. */
#define ROUNDING 1e-6

static bool read_mix(struct reader *reader, const struct item *item,
                     struct material_description *material)
{
    const struct node *list = item->value;
    if (!fill_expect(reader, "mix", list, NODE_LIST))
        return false;
    if (list->count == 0) {
        reader_error(reader, item->key, "mix needs at least one material");
        return false;
    }
    material->components = reader_allocate(reader, list->count, sizeof *material->components);
    material->weights = reader_allocate(reader, list->count, sizeof *material->weights);
    if (!material->components || !material->weights)
        return false;
    bool good = true;
    double sum = 0;
    for (const struct item *each = list->first; each; each = each->next) {
        struct component_keys keys = {0};
        good = fill_section(reader, schema_only("mix"), each->value, each->value, &keys) && good;
        material->components[material->component_count] = keys.material;
        material->weights[material->component_count++] = keys.weight;
        sum += keys.weight;
    }
    if (sum <= 1 + ROUNDING)
        return good;
    reader_error(reader, item->key, "the weights of mix sum to %g, which is more than 1", sum);
    return false;
}

enum visit { UNVISITED, OPEN, DONE };

struct search {
    struct reader *reader;
    unsigned char *visits;  /* enum visit, of each material */
    unsigned char *heights; /* levels of mixes in each */
    size_t *order;          /* materials, components first */
    size_t count;           /* in `order` */
};

static bool refuse(const struct search *search, size_t index, const char *what)
{
    const struct material_description *material = &search->reader->description->materials[index];
    diagnostics_report(search->reader->sink, SEVERITY_ERROR, &material->origin,
                       material->name ? (int)strlen(material->name) : 0, "material '%s' %s",
                       material->name ? material->name : "", what);
    return false;
}

static bool visit(struct search *search, size_t index, int level)
{
    const struct material_description *material = &search->reader->description->materials[index];
    if (search->visits[index] == DONE)
        return true;
    if (search->visits[index] == OPEN)
        return refuse(search, index, "is mixed from itself");
    if (level > DEEPEST_MIX)
        return refuse(search, index, "is nested too deeply in mixes");
    search->visits[index] = OPEN;
    bool good = true;
    for (size_t i = 0; i < material->component_count && good; i++) {
        size_t component = material->components[i];
        good = visit(search, component, level + 1);
        if (good && search->heights[index] <= search->heights[component])
            search->heights[index] = search->heights[component] + 1;
    }
    search->visits[index] = DONE;
    search->order[search->count++] = index;
    if (good && search->heights[index] > DEEPEST_MIX)
        good = refuse(search, index, "nests mixes too deeply");
    return good;
}

static bool find_order(struct search *search, size_t count)
{
    bool good = true;
    for (size_t i = 0; i < count; i++)
        good = visit(search, i, 0) && good;
    return good;
}

/* Moves each material to its place, and tells who refers to it. */
static void apply_order(struct reader *reader, const size_t *order, size_t count)
{
    struct scene_description *description = reader->description;
    struct material_description *moved =
        reader_extend(reader, NULL, 0, count, sizeof *description->materials);
    size_t *places = reader_allocate(reader, count, sizeof *places);
    if (!moved || !places) {
        free(moved);
        free(places);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        moved[i] = description->materials[order[i]];
        places[order[i]] = i;
        if (moved[i].name)
            reference_put(reader, &reader->materials, moved[i].name, i);
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < moved[i].component_count; j++)
            moved[i].components[j] = places[moved[i].components[j]];
    free(description->materials);
    description->materials = moved;
    free(places);
}

/* Orders the description's materials so that components come before what is mixed from them; others
 * keep their order. Reports mixes that contain themselves. */
static void order_mixes(struct reader *reader)
{
    size_t count = reader->description->material_count;
    struct search search = {
        .reader = reader,
        .visits = reader_allocate(reader, count, 1),
        .heights = reader_allocate(reader, count, 1),
        .order = reader_allocate(reader, count, sizeof *search.order),
    };
    if (search.visits && search.heights && search.order && find_order(&search, count))
        apply_order(reader, search.order, count);
    free(search.visits);
    free(search.heights);
    free(search.order);
}

/* --- materials ------------------------------------------------------------------------------- */

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
        return read_mix(reader, mix, material);
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
static struct pigment_description read_normal_map(struct reader *reader, const struct node *map)
{
    struct pigment_description pigment = pigment_of((ps_rgb){1, 1, 1});
    struct texture_keys keys = {.file = NULL};
    const struct item *item = node_find(map, "normal_map");
    if (!item || !fill_section(reader, schema_only("normal_map"), item->key, item->value, &keys))
        return pigment;
    if (keys.encoding == ENCODING_AUTO)
        keys.encoding = ENCODING_LINEAR;
    pigment.kind = PIGMENT_IMAGE;
    pigment.texture = texture_add(reader, &keys);
    return pigment;
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
    order_mixes(reader);
}
