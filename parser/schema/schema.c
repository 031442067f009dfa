/* schema.c: finds and describes the rows of the scene language; see schema.h. */
#include "parser/schema/schema.h"

#include "parser/schema/schema_rows.h"
#include <stdio.h>
#include <string.h>

static const struct schema_part *const parts[] = {
    &schema_scene_part,    &schema_language_part, &schema_placement_part,
    &schema_material_part, &schema_light_part,    &schema_object_part,
};

size_t schema_section_count(void)
{
    size_t count = 0;
    for (size_t i = 0; i < COUNT(parts); i++)
        count += parts[i]->count;
    return count;
}

const struct schema_section *schema_section(size_t index)
{
    for (size_t i = 0; i < COUNT(parts); i++) {
        if (index < parts[i]->count)
            return &parts[i]->sections[index];
        index -= parts[i]->count;
    }
    return NULL;
}

const struct schema_section *schema_find(const char *family, const char *name)
{
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        if (strcmp(family, section->family) == 0 && strcmp(name, section->name) == 0)
            return section;
    }
    return NULL;
}

const struct schema_section *schema_only(const char *family)
{
    return schema_find(family, family);
}

void schema_heading(const struct schema_section *section, char *text, size_t size)
{
    bool twice = false;
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *other = schema_section(i);
        twice = twice || (other != section && strcmp(other->name, section->name) == 0);
    }
    if (twice && strcmp(section->name, section->family) != 0)
        snprintf(text, size, "%s in %s", section->name, section->family);
    else
        snprintf(text, size, "%s", section->name);
}

struct param_table schema_table(const struct schema_section *section)
{
    return (struct param_table){.rows = &section->rows[0].param,
                                .count = section->row_count,
                                .stride = sizeof section->rows[0]};
}

bool schema_is_required(const struct schema_row *row)
{
    return !row->param.default_value && !row->absent;
}

static void describe_list(const struct schema_row *row, const char *item, char *text, size_t size)
{
    if (row->fewest == row->most)
        snprintf(text, size, "list of %zu %s", row->fewest, item);
    else if (row->most == SIZE_MAX)
        snprintf(text, size, "list of %zu or more %s", row->fewest, item);
    else
        snprintf(text, size, "list of %zu to %zu %s", row->fewest, row->most, item);
}

static void describe_words(const struct schema_row *row, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "list of");
    for (size_t i = 0; row->param.choices[i] && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s %s", i ? "," : "",
                                 row->param.choices[i]);
}

static void describe_pigment(const struct schema_row *row, char *text, size_t size)
{
    ps_param plain = row->param;
    if (row->form == SCHEMA_SCALAR_PIGMENT)
        plain.type = PS_PARAM_NUMBER;
    param_describe_domain(&plain, text, size);
    size_t used = strlen(text);
    snprintf(text + used, size - used, ", or {PATTERN: {...}}");
}

/* Of forms that always read the same. */
static const char *fixed_text(enum schema_form form)
{
    switch (form) {
    case SCHEMA_SCALE:
        return "[x, y, z] or one number";
    case SCHEMA_POINT_OR_AUTO:
        return AUTO_WORD " | [x, y, z] of number";
    case SCHEMA_PAIR:
        return "[u, v] or one number";
    case SCHEMA_MATERIAL:
        return "name of a material";
    case SCHEMA_MATERIALS:
        return "map of names to names of materials";
    case SCHEMA_GROUP:
        return "name of a group";
    case SCHEMA_FILE:
        return "path of a file";
    case SCHEMA_LAYER:
        return "name of a layer";
    case SCHEMA_STRATEGY:
        return "NAME or {NAME: {PARAMETER: VALUE, ...}}";
    case SCHEMA_NAMED:
        return "map of maps by name";
    case SCHEMA_ITEMS:
        return "list of maps";
    case SCHEMA_STEPS:
    case SCHEMA_LIST:
        return "list of maps of one key each";
    case SCHEMA_NAMED_LISTS:
        return "map of lists by name";
    default:
        return "";
    }
}

/* One map, or the word that stands for one. */
static void describe_map(const struct schema_row *row, char *text, size_t size)
{
    const struct schema_section *section = schema_only(row->family);
    const char *word = section ? section->word : NULL;
    snprintf(text, size, "%s%smap", word ? word : "", word ? " | " : "");
}

void schema_describe(const struct schema_row *row, char *text, size_t size)
{
    switch (row->form) {
    case SCHEMA_VALUE:
        param_describe_domain(&row->param, text, size);
        break;
    case SCHEMA_WORDS:
        describe_words(row, text, size);
        break;
    case SCHEMA_POINTS:
        describe_list(row, "[x, y, z]", text, size);
        break;
    case SCHEMA_MATRIX:
        describe_list(row, "numbers", text, size);
        break;
    case SCHEMA_PAIRS:
        describe_list(row, "[u, v]", text, size);
        break;
    case SCHEMA_TRIANGLES:
        describe_list(row, "[i, j, k]", text, size);
        break;
    case SCHEMA_COLORS:
        describe_list(row, "[r, g, b] or grey", text, size);
        break;
    case SCHEMA_PIGMENT:
    case SCHEMA_SCALAR_PIGMENT:
        describe_pigment(row, text, size);
        break;
    case SCHEMA_MAP:
        describe_map(row, text, size);
        break;
    default:
        snprintf(text, size, "%s", row->domain ? row->domain : fixed_text(row->form));
        break;
    }
}
