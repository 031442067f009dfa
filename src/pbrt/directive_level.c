/* directive_level.c: directives that open and close levels of the scene, and files. */
#include "pbrt/directive.h"

#include "pbrt/state.h"
#include <stdlib.h>
#include <string.h>

static void attribute_begin(const struct call *call)
{
    state_push(call->importer, MARK_ATTRIBUTES, call->origin, call->width);
}

static void attribute_end(const struct call *call)
{
    state_pop(call->importer, MARK_ATTRIBUTES, call->origin, call->width);
}

/* In pbrt-v4 an old name of AttributeBegin. */
static enum state_mark transform_mark(const struct call *call)
{
    return call->importer->version == 4 ? MARK_ATTRIBUTES : MARK_TRANSFORM;
}

static void transform_begin(const struct call *call)
{
    state_push(call->importer, transform_mark(call), call->origin, call->width);
}

static void transform_end(const struct call *call)
{
    state_pop(call->importer, transform_mark(call), call->origin, call->width);
}

static void world_begin(const struct call *call)
{
    state_begin_world(call->importer);
}

static void world_end(const struct call *call)
{
    (void)call; /* what follows is read as if it stood before */
}

static void object_begin(const struct call *call)
{
    char *name = call_text(call);
    if (name)
        state_begin_object(call->importer, name, call->origin, call->width);
    free(name);
}

static void object_end(const struct call *call)
{
    state_end_object(call->importer, call->origin, call->width);
}

static void object_instance(const struct call *call)
{
    char *name = call_text(call);
    if (name)
        state_add_instance(call->importer, name, call->origin, call->width);
    free(name);
}

static void include(const struct call *call)
{
    struct token *token = &call->parser->token;
    if (token->kind != TOKEN_STRING) {
        call_stop(call, "expected the name of a file in quotes");
        return;
    }
    char *name = strdup(token->text);
    struct origin origin = token->origin;
    int width = token->width;
    if (!name) {
        importer_no_memory(call->importer);
        return;
    }
    parser_include(call->parser, name, strcmp(call->word, "Import") == 0, &origin, width);
    free(name);
    if (!call->importer->stopped)
        parser_advance(call->parser);
}

static const struct directive directives[] = {
    {"AttributeBegin", IN_WORLD, attribute_begin},
    {"AttributeEnd", IN_WORLD, attribute_end},
    {"TransformBegin", ANYWHERE, transform_begin},
    {"TransformEnd", ANYWHERE, transform_end},
    {"Include", ANYWHERE, include},
    {"Import", ANYWHERE, include},
    {"WorldBegin", BEFORE_WORLD, world_begin},
    {"WorldEnd", IN_WORLD, world_end},
    {"ObjectBegin", IN_WORLD, object_begin},
    {"ObjectEnd", IN_WORLD, object_end},
    {"ObjectInstance", IN_WORLD, object_instance},
};

const struct directive_table directives_of_levels = {directives,
                                                     sizeof directives / sizeof directives[0]};
