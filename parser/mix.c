/* mix.c: see mix.h. Depth-first search, not deeper than mixes may nest. */
#include "parser/mix.h"

#include "parser/fill.h"
#include "parser/keys.h"
#include "parser/reference.h"
#include <stdlib.h>
#include <string.h>

/* Of mixes in mixes: more than a scene means by it, and who evaluates them recurses. */
#define DEEPEST_MIX 16

/* How far the sum of weights may exceed 1 by rounding. */
#define ROUNDING 1e-6

bool mix_read(struct reader *reader, const struct item *item, struct material_description *material)
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

void mix_order(struct reader *reader)
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
