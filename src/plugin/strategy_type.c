#include "plugin/strategy_type.h"

#include "plugin/shared_params.h"
#include <stdlib.h>
#include <string.h>

#define STATE_ALIGNMENT 16

/* Copies what a module's struct has of ours, the rest 0. */
static void adopt(void *ours, size_t size, const void *theirs, size_t their_size)
{
    memset(ours, 0, size);
    memcpy(ours, theirs, their_size < size ? their_size : size);
}

static void copy_rows(const ps_descriptor *descriptor, const struct param_table *shared,
                      struct strategy_type *type)
{
    for (size_t i = 0; i < shared->count; i++) {
        type->rows[i] = *param_row(shared, i);
        type->rows[i].offset += type->shared_offset;
    }
    for (size_t i = 0; i < descriptor->param_count; i++)
        adopt(&type->rows[shared->count + i], sizeof *type->rows,
              (const char *)descriptor->params + i * descriptor->param_size,
              descriptor->param_size);
}

/* That no two parameters have the same name, which module_check has seen of the module's own, and
 * that defaults are values. */
static ps_result check_rows(const struct strategy_type *type, struct error *error)
{
    struct param_table table = strategy_type_params(type);
    struct error reason;
    for (size_t i = 0; i < table.count; i++)
        if (param_find(&table, type->rows[i].name) != &type->rows[i])
            return error_set(error, PS_ERROR_INVALID,
                             "its parameter '%.80s' is one that psplat gives to every %s",
                             type->rows[i].name, kinds[type->kind].name);
    void *state = calloc(1, type->state_size);
    if (!state)
        return error_memory(error, type->state_size, "a plugin's state");
    ps_result result = param_set_defaults(&table, state, 1.0, &reason);
    param_release(&table, state);
    free(state);
    if (result == PS_OK)
        return PS_OK;
    return error_set(error, result, "it has a bad default: %.700s", reason.text);
}

static ps_result fill(const ps_descriptor *descriptor, const char *file, struct strategy_type *type,
                      struct error *error)
{
    size_t shared_size;
    struct param_table shared = shared_params(type->kind, &type->table, &shared_size);
    size_t own_size = (size_t)descriptor->state_size;
    type->shared_offset = (own_size + STATE_ALIGNMENT - 1) / STATE_ALIGNMENT * STATE_ALIGNMENT;
    type->state_size = type->shared_offset + shared_size + 1; /* never 0 */
    type->row_count = shared.count + descriptor->param_count;
    type->rows = calloc(type->row_count + 1, sizeof *type->rows);
    type->file = file ? strdup(file) : NULL;
    if (!type->rows || (file && !type->file))
        return error_memory(error, type->row_count * sizeof *type->rows, "a plugin's parameters");
    copy_rows(descriptor, &shared, type);
    return check_rows(type, error);
}

ps_result strategy_type_create(const ps_descriptor *theirs, const char *file,
                               struct strategy_type **created, struct error *error)
{
    struct strategy_type *type = calloc(1, sizeof *type);
    if (!type)
        return error_memory(error, sizeof *type, "a plugin");
    ps_descriptor descriptor;
    adopt(&descriptor, sizeof descriptor, theirs, theirs->size);
    const uint32_t *table_size = descriptor.vtable;
    *type = (struct strategy_type){
        .kind = (ps_kind)descriptor.kind,
        .name = descriptor.name,
        .version = descriptor.version,
        .summary = descriptor.summary,
        .paper = descriptor.paper,
        .init = descriptor.init,
        .destroy = descriptor.destroy,
    };
    adopt(&type->table, sizeof type->table, descriptor.vtable, *table_size);
    ps_result result = fill(&descriptor, file, type, error);
    if (result == PS_OK)
        *created = type;
    else
        strategy_type_destroy(type);
    return result;
}

void strategy_type_destroy(struct strategy_type *type)
{
    if (!type)
        return;
    free(type->rows);
    free(type->file);
    free(type);
}

struct param_table strategy_type_params(const struct strategy_type *type)
{
    return (struct param_table){type->rows, type->row_count, sizeof *type->rows};
}
