#include "parser/format.h"

#include "base/arena.h"
#include "parser/yaml/document.h"
#include "parser/yaml/encoding.h"
#include "parser/yaml/layout.h"

static ps_result check(const char *name, const char *text, size_t length, struct diagnostics *sink)
{
    const char *file = diagnostics_add_source(sink, name, text, length);
    const struct document document = {
        .file = file, .start = {1, 1, 1}, .text = text, .length = length};
    struct arena arena = {0};
    struct budget budget = {.most = MOST_NODES};
    const struct node *root;
    if (!file)
        return PS_ERROR_MEMORY;
    ps_result result = encoding_check(file, text, length, sink);
    if (result == PS_OK)
        result = document_read(&document, sink, &arena, &budget, &root);
    arena_release(&arena);
    return result == PS_OK && diagnostics_error_count(sink) > 0 ? PS_ERROR_INVALID : result;
}

ps_result psd_format_text(const char *name, const char *text, size_t length,
                          struct diagnostics *sink, char **formatted, size_t *formatted_length)
{
    size_t mark = byte_order_mark_length(text, length);
    ps_result result = check(name, text, length, sink);
    if (result == PS_OK)
        result = layout_text(text + mark, length - mark, formatted, formatted_length);
    return result;
}
