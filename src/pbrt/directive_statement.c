/* directive_statement.c: directives with a list of parameters: what the scene is made of. */
#include "pbrt/directive.h"

#include "pbrt/light.h"
#include "pbrt/shape.h"
#include "pbrt/state.h"
#include <stdlib.h>
#include <string.h>

/* Takes over the statement, with the attributes of its sort; NULL: reported. */
static const struct statement *keep(const struct call *call, bool has_kind, int target)
{
    struct statement statement;
    if (!call_statement(call, has_kind, &statement))
        return NULL;
    if (target < TARGETS)
        statement.attributes = call->importer->state.attributes[target];
    const struct statement *kept = importer_keep(call->importer, &statement);
    statement_release(&statement);
    return kept;
}

static void camera(const struct call *call)
{
    struct importer *importer = call->importer;
    const struct statement *kept = keep(call, true, TARGETS);
    struct transform to_world;
    if (!kept)
        return;
    importer->camera_statement = kept;
    importer->camera = importer->state.ctm;
    if (transform_invert(&importer->camera, &to_world))
        state_name_coordinates(importer, "camera", &to_world);
}

static void film(const struct call *call)
{
    const struct statement *kept = keep(call, true, TARGETS);
    call->importer->film = kept ? kept : call->importer->film;
}

static void pixel_filter(const struct call *call)
{
    const struct statement *kept = keep(call, true, TARGETS);
    call->importer->filter = kept ? kept : call->importer->filter;
}

/* Sampler, Integrator and others: psplat has its own ways. */
static void no_counterpart(const struct call *call)
{
    struct statement statement;
    if (!call_statement(call, true, &statement))
        return;
    importer_warn(call->importer, call->origin, call->width, "%s has no counterpart: left out",
                  call->word);
    statement_release(&statement);
}

static void color_space(const struct call *call)
{
    char *name = call_text(call);
    if (name && strcmp(name, "srgb") != 0)
        importer_warn(call->importer, call->origin, call->width,
                      "ColorSpace: colours of '%.40s' are taken as if they were of srgb", name);
    free(name);
}

/* Option "NAME" VALUE: of one word, text or number. */
static void option(const struct call *call)
{
    const struct token *token = &call->parser->token;
    char *name = call_text(call);
    if (!name)
        return;
    if (token->kind == TOKEN_WORD || token->kind == TOKEN_STRING || token->kind == TOKEN_NUMBER) {
        parser_advance(call->parser);
        importer_warn(call->importer, call->origin, call->width,
                      "Option '%.40s' has no counterpart: left out", name);
    } else {
        call_stop(call, "expected a name and a value");
    }
    free(name);
}

static void medium_interface(const struct call *call)
{
    char *inside = call_text(call), *outside = NULL;
    if (inside && call->parser->token.kind == TOKEN_STRING)
        outside = call_text(call);
    bool empty = inside && !*inside && (!outside || !*outside);
    if (inside && !empty)
        importer_warn(call->importer, call->origin, call->width,
                      "media have no counterpart: left out");
    free(inside);
    free(outside);
}

/* Attribute "shape" "float radius" 2: for all that follow, until the level ends. */
static void attribute(const struct call *call)
{
    static const char *const targets[TARGETS] = {"shape", "light", "material", "medium", "texture"};
    struct importer *importer = call->importer;
    const struct statement *kept = keep(call, true, TARGETS);
    struct attributes *link = kept ? arena_allocate(&importer->arena, sizeof *link) : NULL;
    if (!kept)
        return;
    if (!link) {
        importer_no_memory(importer);
        return;
    }
    for (size_t i = 0; i < TARGETS; i++)
        if (strcmp(kept->kind, targets[i]) == 0) {
            *link = (struct attributes){kept, importer->state.attributes[i]};
            importer->state.attributes[i] = link;
            return;
        }
    importer_error(importer, call->origin, call->width,
                   "Attribute: expected \"shape\", \"light\", \"material\", \"medium\" or "
                   "\"texture\", got \"%.40s\"",
                   kept->kind);
}

static void material(const struct call *call)
{
    const struct statement *kept = keep(call, true, TARGET_MATERIAL);
    call->importer->state.material = kept;
    call->importer->state.material_name = NULL;
}

/* A text in quotes that follows, which stays; NULL: reported. */
static const char *kept_text(const struct call *call)
{
    char *text = call_text(call);
    const char *kept = text ? arena_copy(&call->importer->arena, text, strlen(text)) : NULL;
    if (text && !kept)
        importer_no_memory(call->importer);
    free(text);
    return kept;
}

/* The kind is the parameter "string type". */
static void make_named_material(const struct call *call)
{
    struct importer *importer = call->importer;
    const char *name = kept_text(call);
    struct statement statement;
    if (!name || !call_statement(call, false, &statement))
        return;
    statement.attributes = importer->state.attributes[TARGET_MATERIAL];
    const char *kind = statement_string(importer, &statement, "type");
    statement.kind = strdup(kind ? kind : "diffuse");
    if (!kind)
        importer_error(importer, call->origin, call->width,
                       "MakeNamedMaterial: \"string type\" is missing");
    const struct statement *kept = statement.kind ? importer_keep(importer, &statement) : NULL;
    if (kept &&
        importer_grow(importer, (void **)&importer->materials, &importer->material_capacity,
                      importer->material_count + 1, sizeof *importer->materials) &&
        name_index_add(&importer->materials_by_name, name_index_hash(name)))
        importer->materials[importer->material_count++] =
            (struct named_statement){.name = name, .statement = kept};
    else
        importer_no_memory(importer);
    statement_release(&statement);
}

static void named_material(const struct call *call)
{
    struct importer *importer = call->importer;
    const char *name = kept_text(call);
    struct place place = {call->origin, call->width};
    if (!name)
        return;
    importer->state.material_name = name;
    importer->state.material = importer->version == 4 && !material_is_named(importer, name)
                                   ? NULL /* surface.c looks again */
                                   : material_find(importer, name, &place);
}

static void texture(const struct call *call)
{
    char *name = call_text(call), *type = name ? call_text(call) : NULL;
    struct statement statement;
    if (type && call_statement(call, true, &statement)) {
        statement.attributes = call->importer->state.attributes[TARGET_TEXTURE];
        statement.of_numbers = strcmp(type, "float") == 0;
        texture_define(call->importer, &statement, name, type);
        statement_release(&statement);
    }
    free(name);
    free(type);
}

static void light_source(const struct call *call)
{
    struct statement statement;
    if (!call_statement(call, true, &statement))
        return;
    statement.attributes = call->importer->state.attributes[TARGET_LIGHT];
    light_add(call->importer, &statement);
    statement_release(&statement);
}

/* pbrt has no lights in objects either. */
static void area_light_source(const struct call *call)
{
    struct importer *importer = call->importer;
    const struct statement *kept = keep(call, true, TARGET_LIGHT);
    importer->state.area_light = importer->current_object ? NULL : kept;
    if (kept && importer->current_object)
        importer_warn(importer, call->origin, call->width,
                      "lights in objects are left out, as pbrt does");
}

static void shape(const struct call *call)
{
    struct statement statement;
    if (!call_statement(call, true, &statement))
        return;
    statement.attributes = call->importer->state.attributes[TARGET_SHAPE];
    shape_add(call->importer, &statement);
    statement_release(&statement);
}

static const struct directive directives[] = {
    {"Attribute", ANYWHERE, attribute},
    {"Camera", BEFORE_WORLD, camera},
    {"Film", BEFORE_WORLD, film},
    {"PixelFilter", BEFORE_WORLD, pixel_filter},
    {"Sampler", BEFORE_WORLD, no_counterpart},
    {"Integrator", BEFORE_WORLD, no_counterpart},
    {"Accelerator", BEFORE_WORLD, no_counterpart},
    {"ColorSpace", ANYWHERE, color_space},
    {"Option", BEFORE_WORLD, option},
    {"MakeNamedMedium", ANYWHERE, no_counterpart},
    {"MediumInterface", ANYWHERE, medium_interface},
    {"Material", IN_WORLD, material},
    {"MakeNamedMaterial", IN_WORLD, make_named_material},
    {"NamedMaterial", IN_WORLD, named_material},
    {"Texture", IN_WORLD, texture},
    {"LightSource", IN_WORLD, light_source},
    {"AreaLightSource", IN_WORLD, area_light_source},
    {"Shape", IN_WORLD, shape},
};

const struct directive_table directives_of_statements = {directives,
                                                         sizeof directives / sizeof directives[0]};
