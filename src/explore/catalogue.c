#include "explore/catalogue.h"

#include "base/input_file.h"
#include "base/path.h"
#include "base/version.h"
#include "explore/explorer.h"
#include "explore/json_text.h"
#include "explore/scene_facts.h"
#include "model/model.h"
#include "parser/psd.h"
#include "parser/schema/schema.h"
#include "plugin/loader.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- parameters of tables
 * ---------------------------------------------------------------------------- */

/* The control that a row asks for. A number with choices may be one of these words instead. */
static const char *control_of(const ps_param *row)
{
    switch ((ps_param_type)row->type) {
    case PS_PARAM_BOOL:
        return "boolean";
    case PS_PARAM_INT:
        return "integer";
    case PS_PARAM_NUMBER:
        return row->flags & PS_PARAM_WHOLE ? "integer" : "number";
    case PS_PARAM_CHOICE:
        return "choice";
    case PS_PARAM_NUMBER_OR_CHOICE:
        return row->flags & PS_PARAM_WHOLE ? "integer" : "number";
    case PS_PARAM_VEC3:
    case PS_PARAM_COLOR:
    case PS_PARAM_STRING:
        break;
    }
    return "text";
}

static bool has_range(const ps_param *row)
{
    return row->type == PS_PARAM_INT || row->type == PS_PARAM_NUMBER ||
           row->type == PS_PARAM_NUMBER_OR_CHOICE;
}

static void write_range(const ps_param *row, struct json_writer *writer)
{
    if (!has_range(row))
        return;
    if (isfinite(row->minimum))
        json_writer_number_of(writer, "minimum", row->minimum);
    if (isfinite(row->maximum))
        json_writer_number_of(writer, "maximum", row->maximum);
    if (row->flags & PS_PARAM_OPEN_MIN)
        json_writer_raw_of(writer, "minimum_excluded", "true");
    if (row->flags & PS_PARAM_OPEN_MAX)
        json_writer_raw_of(writer, "maximum_excluded", "true");
}

static void write_choices(const ps_param *row, struct json_writer *writer)
{
    if (!row->choices)
        return;
    json_writer_open_of(writer, "choices", '[');
    for (size_t i = 0; row->choices[i]; i++)
        json_writer_text(writer, row->choices[i]);
    json_writer_close(writer, '[');
}

static const char *truth(bool value)
{
    return value ? "true" : "false";
}

static void write_row(const char *name, const ps_param *row, bool is_expert,
                      struct json_writer *writer)
{
    char domain[256];
    param_describe_domain(row, domain, sizeof domain);
    json_writer_open(writer, '{');
    json_text_write_of(writer, "name", name);
    json_writer_text_of(writer, "type", control_of(row));
    write_range(row, writer);
    json_text_write_of(writer, "default", row->default_value);
    json_text_write_of(writer, "unit", row->unit);
    write_choices(row, writer);
    json_text_write_of(writer, "domain", domain);
    json_text_write_of(writer, "help", row->help);
    json_writer_raw_of(writer, "expert", truth(is_expert));
    json_writer_raw_of(writer, "by_quality", truth((row->flags & PS_PARAM_QUALITY) != 0));
    json_writer_close(writer, '{');
}

/* --- kinds
 * ------------------------------------------------------------------------------------------- */

static void write_plugin(void *user, const struct listed_strategy *listed)
{
    struct json_writer *writer = user;
    if (!listed->type)
        return; /* it can't be used */
    struct param_table table = strategy_type_params(listed->type);
    json_writer_open(writer, '{');
    json_text_write_of(writer, "name", listed->name);
    json_text_write_of(writer, "title", listed->type->summary);
    json_text_write_of(writer, "paper", listed->type->paper);
    json_writer_open_of(writer, "parameters", '[');
    for (size_t i = 0; i < table.count; i++) {
        const ps_param *row = param_row(&table, i);
        write_row(row->name, row, (row->flags & PS_PARAM_EXPERT) != 0, writer);
    }
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

static ps_result write_kind(struct loader *loader, ps_kind kind, struct json_writer *writer,
                            struct error *error)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "kind", kinds[kind].name);
    json_writer_text_of(writer, "help", kinds[kind].summary);
    json_writer_text_of(writer, "default", kinds[kind].default_strategy);
    json_writer_raw_of(writer, "display", truth(kind == PS_BLOOM || kind == PS_TONEMAP));
    json_writer_open_of(writer, "plugins", '[');
    ps_result result = loader_list(loader, kind, write_plugin, writer, error);
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
    return result;
}

ps_result catalogue_kinds(char **text, struct error *error)
{
    struct json_buffer buffer;
    struct loader *loader;
    *text = NULL;
    ps_result result = loader_create(&loader, error);
    if (result != PS_OK)
        return result;
    if (!json_buffer_begin(&buffer)) {
        loader_destroy(loader);
        return error_memory(error, 0, "the catalogue");
    }
    json_writer_open(&buffer.writer, '[');
    for (int kind = 0; kind < PS_KINDS && result == PS_OK; kind++)
        result = write_kind(loader, (ps_kind)kind, &buffer.writer, error);
    json_writer_close(&buffer.writer, '[');
    loader_destroy(loader);
    *text = json_buffer_end(&buffer);
    if (result == PS_OK && !*text)
        return error_memory(error, 0, "the catalogue");
    return result;
}

/* --- the whole
 * --------------------------------------------------------------------------------------- */

static void write_size(struct json_writer *writer)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "name", "size");
    json_writer_text_of(writer, "type", "text");
    json_writer_text_of(writer, "unit", "pixels");
    json_writer_text_of(writer, "domain", "WIDTHxHEIGHT");
    json_writer_text_of(writer, "help", "width and height of the picture");
    json_writer_raw_of(writer, "expert", "false");
    json_writer_close(writer, '{');
}

/* Those with an option of their own, or those that --set sets. */
static void write_settings(bool sets, struct json_writer *writer)
{
    for (size_t i = 0; i < scene_setting_count(); i++) {
        const struct scene_setting *setting = scene_setting(i);
        struct param_table table = schema_table(schema_only(setting->section));
        if (setting->is_set == sets)
            write_row(setting->name, param_find(&table, setting->key), sets, writer);
    }
}

static void write_scene_parameter(void *user, const struct psd_parameter *parameter)
{
    struct json_writer *writer = user;
    json_writer_open(writer, '{');
    json_text_write_of(writer, "name", parameter->name);
    json_text_write_of(writer, "type", strcmp(parameter->type, "number") == 0 ? "number" : "text");
    json_text_write_of(writer, "value", parameter->default_value);
    json_text_write_of(writer, "domain", parameter->type);
    json_text_write_of(writer, "help", parameter->help);
    json_writer_close(writer, '{');
}

/* What is wrong with the scene is told elsewhere. */
static void write_scene_parameters(const struct explorer *explorer, struct json_writer *writer)
{
    const char *restricted = option_list_value(&explorer->fixed, "restrict");
    struct error error;
    char *folder = restricted ? input_folder_resolve(restricted, &error) : NULL;
    const struct psd_options options = {.folder = folder};
    struct diagnostics *sink = diagnostics_create();
    json_writer_open_of(writer, "parameters", '[');
    if (sink && (!restricted || folder) && !model_is_file(explorer->path))
        psd_list_parameters(explorer->path, &options, sink, write_scene_parameter, writer);
    diagnostics_destroy(sink);
    free(folder);
    json_writer_close(writer, '[');
}

static void write_cameras(struct explorer *explorer, struct json_writer *writer)
{
    pthread_mutex_lock(&explorer->lock);
    json_writer_raw_of(writer, "cameras", explorer->cameras ? explorer->cameras : "[]");
    pthread_mutex_unlock(&explorer->lock);
}

char *catalogue_write(struct explorer *explorer)
{
    struct json_buffer buffer;
    if (!json_buffer_begin(&buffer))
        return NULL;
    struct json_writer *writer = &buffer.writer;
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "version", PSPLAT_VERSION);
    json_text_write_of(writer, "scene", path_name(explorer->path));
    json_writer_raw_of(writer, "kinds", explorer->kinds);
    json_writer_open_of(writer, "options", '[');
    write_size(writer);
    write_settings(false, writer);
    json_writer_close(writer, '[');
    json_writer_open_of(writer, "sets", '[');
    write_settings(true, writer);
    json_writer_close(writer, '[');
    write_scene_parameters(explorer, writer);
    write_cameras(explorer, writer);
    json_writer_close(writer, '{');
    return json_buffer_end(&buffer);
}
