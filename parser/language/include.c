/* include.c: depth first, so that what a file includes comes before the file itself.
 *
 * A file that several others include, as a library of materials is by those that use it, is read
 * once; the second time would only define everything again.
 */
#include "parser/language/include.h"

#include "base/text.h"
#include "parser/language/merge.h"
#include "parser/yaml/document.h"
#include "parser/yaml/encoding.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_CHAIN 400

struct source {
    const char *name;
    const struct source *by; /* who includes it; NULL: the main file */
    int depth;
    bool open; /* what it includes is being read */
    uint64_t device, serial;
};

struct inclusion {
    struct reader *reader;
    const struct psd_files *files;
    struct budget *budget;
    struct merge merge;
    struct source sources[MOST_FILES];
    size_t source_count;
    size_t include_count;
    size_t bytes_left;  /* to be read, of files that turn out to be known too */
    bool failed;        /* reported; a file is missing, and messages about the others mislead */
    bool ended;         /* there were too many */
    bool out_of_memory; /* not reported */
};

static bool is_same(const struct source *a, const struct source *b)
{
    bool known = (a->device || a->serial) && (b->device || b->serial);
    return known ? a->device == b->device && a->serial == b->serial : strcmp(a->name, b->name) == 0;
}

static const struct source *find_same(const struct inclusion *inclusion,
                                      const struct source *source)
{
    for (size_t i = 0; i < inclusion->source_count; i++)
        if (is_same(&inclusion->sources[i], source))
            return &inclusion->sources[i];
    return NULL;
}

/* Writes "a.psd -> b.psd -> " for the files from the outermost to that one. */
static void write_chain(const struct source *from, const struct source *to, char *text, size_t size)
{
    text[0] = '\0';
    if (!from)
        return;
    if (from != to)
        write_chain(from->by, to, text, size);
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s -> ", from->name);
}

/* Another version may mean anything by its keys, so that no other message would help. */
static bool is_other_version(const struct reader *reader, const struct node *root)
{
    const struct item *item = node_find(root, "psd");
    double version = 1;
    if (!item || !node_is_number(item->value, &version) || version == 1)
        return false;
    reader_error(reader, item->value, "psd version %s is unknown; this psplat reads version 1",
                 item->value->text);
    return true;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Whether the text goes on as the key "psd" does: a quote perhaps, blanks, a colon, a blank. */
static bool ends_key(const char *text, const char *end)
{
    bool quoted = text < end && (*text == '"' || *text == '\'');
    text += quoted;
    while (text < end && is_blank(*text))
        text++;
    return text < end && *text == ':' && (quoted || text + 1 == end || is_blank(text[1]));
}

/* Whether "psd" stands before a colon somewhere, as it does in every scene. */
static bool may_be_scene(const struct file_text *text)
{
    const char *end = text->bytes + text->length, *at = text->bytes;
    while (at && end - at > 3) {
        if (memcmp(at, "psd", 3) == 0 && ends_key(at + 3, end))
            return true;
        at = memchr(at + 1, 'p', (size_t)(end - at - 1));
    }
    return false;
}

static ps_result parse(struct inclusion *inclusion, const struct source *source, const char *text,
                       size_t length, const struct node **root)
{
    struct reader *reader = inclusion->reader;
    const struct document document = {
        .file = source->name, .start = {1, 1, 1}, .text = text, .length = length};
    if (!diagnostics_add_source(reader->sink, source->name, text, length))
        return PS_ERROR_MEMORY;
    ps_result result = encoding_check(source->name, text, length, reader->sink);
    if (result == PS_OK)
        result = document_read(&document, reader->sink, reader->arena, inclusion->budget, root);
    if (result == PS_OK && is_other_version(reader, *root))
        result = PS_ERROR_INVALID;
    return result;
}

static void fail(struct inclusion *inclusion, const struct node *at, const char *format, ...)
    PRINTF_LIKE(3, 4);

/* A file, or more, is missing. */
static void fail(struct inclusion *inclusion, const struct node *at, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    reader_error_list(inclusion->reader, at, format, arguments);
    va_end(arguments);
    inclusion->failed = true;
}

/* At the place that includes it: a file that is no scene may hold secrets, and no line of it is
 * shown. */
static void fail_no_scene(struct inclusion *inclusion, const struct node *at, const char *name)
{
    fail(inclusion, at, "can't include '%s': it is no scene, since it has no key 'psd'", name);
}

static void include_all(struct inclusion *inclusion, const struct source *by,
                        const struct node *root);

/* `at` is the place that includes the file; NULL for the main file, which the table of its keys
 * checks. */
static void take_file(struct inclusion *inclusion, struct source *source, const struct node *at,
                      const char *text, size_t length)
{
    const struct node *root = NULL;
    ps_result result = parse(inclusion, source, text, length, &root);
    if (result == PS_ERROR_MEMORY)
        inclusion->out_of_memory = true;
    if (result != PS_OK) {
        inclusion->failed = true;
        return;
    }
    if (at && !node_find(root, "psd")) {
        fail_no_scene(inclusion, at, source->name);
        return;
    }
    source->open = true;
    include_all(inclusion, source, root);
    source->open = false;
    if (root->kind == NODE_MAP || !source->by)
        merge_add(inclusion->reader, &inclusion->merge, root);
}

static void report_cycle(struct inclusion *inclusion, const struct source *by,
                         const struct source *twin, const struct node *at)
{
    char chain[LONGEST_CHAIN];
    write_chain(by, twin, chain, sizeof chain);
    fail(inclusion, at, "'%s' includes itself: %s%s", twin->name, chain, twin->name);
}

/* Whether the file was read before; if it is being read, that is an error. */
static bool is_known(struct inclusion *inclusion, const struct source *source,
                     const struct node *at)
{
    const struct source *twin = find_same(inclusion, source);
    if (twin && twin->open)
        report_cycle(inclusion, source->by, twin, at);
    return twin != NULL;
}

/* Takes a file that was read, unless it was before. */
static void take_once(struct inclusion *inclusion, const struct source *source,
                      const struct file_text *text, const struct node *at)
{
    inclusion->bytes_left -= text->length;
    if (is_known(inclusion, source, at))
        return;
    if (inclusion->source_count == MOST_FILES) {
        fail(inclusion, at, "more than %d files in one scene", MOST_FILES);
        inclusion->ended = true;
        return;
    }
    struct source *kept = &inclusion->sources[inclusion->source_count++];
    *kept = *source;
    kept->name = reader_add_file(inclusion->reader, source->name);
    if (!kept->name)
        return;
    struct origin from = reader_origin(inclusion->reader, at);
    if (!diagnostics_set_includer(inclusion->reader->sink, kept->name, &from)) {
        inclusion->out_of_memory = true;
        return;
    }
    take_file(inclusion, kept, at, text->bytes, text->length);
}

static void include_path(struct inclusion *inclusion, const struct source *by,
                         const struct node *at, const char *path)
{
    struct file_text text = {0};
    struct error error;
    const struct psd_files *files = inclusion->files;
    const struct source by_name = {.name = path, .by = by};
    if (is_known(inclusion, &by_name, at))
        return;
    ps_result result = files->read(files->user, path, inclusion->bytes_left, &text, &error);
    struct source source = {path, by, by->depth + 1, false, text.device, text.serial};
    if (result == PS_ERROR_MEMORY)
        inclusion->out_of_memory = true;
    else if (result != PS_OK)
        fail(inclusion, at, "can't include '%s': %s", path, error.text);
    else if (!may_be_scene(&text))
        fail_no_scene(inclusion, at, path);
    else
        take_once(inclusion, &source, &text, at);
    file_release(&text);
}

static void include_one(struct inclusion *inclusion, const struct source *by, const struct node *at)
{
    if (at->kind != NODE_SCALAR || node_is_null(at) || at->text[0] == '\0') {
        fail(inclusion, at, "include in scene: expected the path of a file, got %s",
             node_kind_name(at));
    } else if (node_is_formula(at)) {
        fail(inclusion, at, "include in scene: the path of a file can't be a formula");
    } else if (++inclusion->include_count > MOST_INCLUDES) {
        fail(inclusion, at, "more than %d files are included", MOST_INCLUDES);
        inclusion->ended = true;
    } else if (by->depth == DEEPEST_INCLUDE) {
        fail(inclusion, at, "files are included more than %d deep", DEEPEST_INCLUDE);
    } else {
        char *path = reader_path(inclusion->reader, at, at->text);
        if (path)
            include_path(inclusion, by, at, path);
        free(path);
    }
}

static bool may_go_on(const struct inclusion *inclusion)
{
    return !inclusion->ended && !inclusion->out_of_memory && !inclusion->reader->out_of_memory &&
           !diagnostics_is_full(inclusion->reader->sink);
}

static void include_all(struct inclusion *inclusion, const struct source *by,
                        const struct node *root)
{
    const struct item *include = node_find(root, "include");
    if (!include || node_is_null(include->value))
        return;
    if (include->value->kind != NODE_LIST) {
        include_one(inclusion, by, include->value);
        return;
    }
    for (const struct item *item = include->value->first; item && may_go_on(inclusion);
         item = item->next)
        include_one(inclusion, by, item->value);
}

static ps_result read_file(void *user, const char *path, size_t most, struct file_text *text,
                           struct error *error)
{
    const char *folder = user;
    return file_read_regular(path, folder, most, text, error);
}

ps_result include_read(struct reader *reader, const struct psd_files *files, struct budget *budget,
                       const struct main_text *main, const struct node **root)
{
    const struct psd_files file_system = {reader->description->folder, read_file};
    struct inclusion *inclusion = calloc(1, sizeof *inclusion);
    if (!inclusion)
        return PS_ERROR_MEMORY;
    *inclusion = (struct inclusion){.reader = reader,
                                    .files = files ? files : &file_system,
                                    .budget = budget,
                                    .source_count = 1,
                                    .bytes_left = FILE_LARGEST};
    inclusion->sources[0] =
        (struct source){.name = reader->file, .device = main->device, .serial = main->serial};
    inclusion->bytes_left -= main->length < FILE_LARGEST ? main->length : FILE_LARGEST;
    take_file(inclusion, &inclusion->sources[0], NULL, main->text, main->length);
    bool out_of_memory = reader->out_of_memory || inclusion->out_of_memory;
    ps_result result = out_of_memory       ? PS_ERROR_MEMORY
                       : inclusion->failed ? PS_ERROR_INVALID
                                           : PS_OK;
    *root = inclusion->merge.root;
    free(inclusion);
    return result;
}
