/* frame.c: files, levels and names; see reader.h. */
#include "pov/reader.h"

#include "base/file.h"
#include "base/input_file.h"
#include "base/path.h"
#include <stdlib.h>
#include <string.h>

#define BYTES_OF_WORD 64 /* a new one, with its place in the index */

/* --- files
 * -------------------------------------------------------------------------------------- */

/* FOLDER/NAME, to be freed; NULL: out of memory. */
static char *join(const char *folder, const char *name)
{
    size_t length = strlen(folder), size = length + strlen(name) + 2;
    bool slash = length > 0 && folder[length - 1] != '/';
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s%s", *name == '/' ? "" : folder, slash && *name != '/' ? "/" : "",
                 name);
    return path;
}

/* The path in that folder; NULL: no file that may be read lies there. */
static char *look_in(const char *folder, const char *name, const char *allowed)
{
    char *path = join(folder, name);
    if (path && input_file_exists(path, allowed))
        return path;
    free(path);
    return NULL;
}

char *pov_find(struct pov_reader *reader, const char *name, bool *is_system)
{
    const struct pov_options *options = reader->options;
    char *path = look_in(options->scene_folder, name, options->folder);
    *is_system = false;
    if (!path && reader->frame_count > 0) {
        const char *own = reader->frames[reader->frame_count - 1].tokens->folder;
        path = look_in(own ? own : "", name, options->folder);
    }
    for (size_t i = 0; i < options->library_count && !path; i++)
        path = look_in(options->libraries[i], name, options->folder);
    if (!path && options->system && *name != '/') {
        path = look_in(options->system, name, options->system);
        *is_system = path != NULL;
    }
    return path;
}

/* A place for the file's tokens in the list. NULL: reported. */
static struct pov_tokens *add_file(struct pov_reader *reader, const char *path)
{
    struct pov_tokens *tokens = calloc(1, sizeof *tokens);
    if (tokens)
        tokens->folder = strndup(path, (size_t)(path_name(path) - path));
    if (!tokens || !tokens->folder ||
        !pov_grow(reader, (void **)&reader->files, &reader->file_capacity, reader->file_count + 1,
                  sizeof *reader->files)) {
        pov_no_memory(reader);
        if (tokens)
            pov_tokens_release(tokens);
        free(tokens);
        return NULL;
    }
    reader->files[reader->file_count++] = tokens;
    return tokens;
}

/* NULL: reported. */
static const struct pov_tokens *cut_file(struct pov_reader *reader, const char *path,
                                         const char *text, size_t length)
{
    struct pov_tokens *tokens = add_file(reader, path);
    const char *name = diagnostics_add_source(reader->sink, path, text, length);
    size_t words = reader->words.count;
    if (!tokens || !name) {
        pov_no_memory(reader);
        return NULL;
    }
    if (!pov_charge(reader, length, 1)) /* the copy for messages */
        return NULL;
    size_t most = pov_memory_left(reader) / sizeof *tokens->list;
    if (!pov_tokens_cut(tokens, name, text, length, most, &reader->words, &reader->arena)) {
        if (tokens->count < most || pov_charge(reader, most + 1, sizeof *tokens->list))
            pov_no_memory(reader);
        return NULL;
    }
    bool fits = pov_charge(reader, tokens->count, sizeof *tokens->list) &&
                pov_charge(reader, reader->words.count - words, BYTES_OF_WORD);
    return fits ? tokens : NULL;
}

bool pov_start(struct pov_reader *reader, const char *name, const char *text, size_t length)
{
    if (!pov_words_start(&reader->words)) {
        pov_no_memory(reader);
        return false;
    }
    const struct pov_tokens *tokens = cut_file(reader, name, text, length);
    if (!tokens)
        return false;
    reader->files[0]->device = reader->options->device;
    reader->files[0]->serial = reader->options->serial;
    reader->frames[reader->frame_count++] = (struct pov_frame){.tokens = tokens, .is_file = true};
    return true;
}

/* A file is cut once, by whatever path it is included. */
static const struct pov_tokens *read_file(struct pov_reader *reader, const struct pov_token *token,
                                          const char *path, const char *allowed)
{
    struct file_text text = {0};
    struct error error;
    const struct pov_tokens *tokens = NULL;
    if (file_read_regular(path, allowed, POV_LARGEST_FILE, &text, &error) != PS_OK)
        pov_error(reader, token, "%.300s: %.300s", path, error.text);
    for (size_t i = 0; i < reader->file_count && !tokens && !reader->stopped; i++) {
        const struct pov_tokens *file = reader->files[i];
        bool known = file->device || file->serial;
        if (known && file->device == text.device && file->serial == text.serial)
            tokens = file;
    }
    if (!tokens && !reader->stopped && reader->file_count == POV_MOST_FILES)
        pov_error(reader, token, "the scene includes more than %d files", POV_MOST_FILES);
    if (!tokens && !reader->stopped) {
        tokens = cut_file(reader, path, text.bytes, text.length);
        if (tokens) {
            reader->files[reader->file_count - 1]->device = text.device;
            reader->files[reader->file_count - 1]->serial = text.serial;
        }
    }
    file_release(&text);
    return tokens;
}

void pov_include(struct pov_reader *reader, const struct pov_token *token, const char *name)
{
    bool is_system = false;
    char *path = pov_find(reader, name, &is_system);
    if (!path)
        pov_error(reader, token,
                  "#include: no readable file '%.300s' lies beside the scene or in a library",
                  name);
    const struct pov_tokens *tokens =
        path ? read_file(reader, token, path,
                         is_system ? reader->options->system : reader->options->folder)
             : NULL;
    if (path && !is_system && !scene_text_note(&reader->scene, path))
        pov_no_memory(reader);
    free(path);
    if (tokens)
        pov_push_frame(reader, token, tokens, 0, true);
}

void pov_release(struct pov_reader *reader)
{
    for (size_t i = 0; i < reader->file_count; i++) {
        pov_tokens_release(reader->files[i]);
        free(reader->files[i]);
    }
    free(reader->files);
    free(reader->bindings);
    free(reader->streams);
    free(reader->objects);
    warnings_release(&reader->warnings);
    pov_words_release(&reader->words);
    arena_release(&reader->arena);
    scene_text_release(&reader->scene);
}

/* --- levels and names
 * ----------------------------------------------------------------------------- */

bool pov_push_frame(struct pov_reader *reader, const struct pov_token *token,
                    const struct pov_tokens *tokens, size_t at, bool is_file)
{
    if (reader->frame_count == POV_MOST_FRAMES) {
        pov_error(reader, token, "files and macros are in each other more than %d deep",
                  POV_MOST_FRAMES);
        return false;
    }
    reader->frames[reader->frame_count++] = (struct pov_frame){
        .tokens = tokens, .at = at, .blocks = reader->block_count, .is_file = is_file};
    return true;
}

void pov_pop_frame(struct pov_reader *reader)
{
    struct pov_frame *frame = &reader->frames[--reader->frame_count];
    reader->block_count = frame->blocks;
    struct pov_binding *next;
    for (struct pov_binding *local = frame->locals; local; local = next) {
        struct pov_binding **at = &reader->bindings[local->word];
        while (*at && *at != local) /* a global one may have come on top */
            at = &(*at)->below;
        if (*at)
            *at = local->below;
        next = local->same_frame;
        local->below = reader->spare;
        reader->spare = local;
    }
}

struct pov_value *pov_lookup(const struct pov_reader *reader, uint32_t word)
{
    const struct pov_binding *binding =
        word < reader->binding_capacity ? reader->bindings[word] : NULL;
    return binding ? binding->value : NULL;
}

/* The word's list of meanings; NULL: reported. */
static struct pov_binding **bindings_of(struct pov_reader *reader, uint32_t word)
{
    size_t before = reader->binding_capacity;
    if (word >= before) {
        if (!pov_grow(reader, (void **)&reader->bindings, &reader->binding_capacity,
                      reader->words.count, sizeof *reader->bindings))
            return NULL;
        memset(reader->bindings + before, 0,
               (reader->binding_capacity - before) * sizeof *reader->bindings);
    }
    return &reader->bindings[word];
}

/* A binding of an earlier frame is used again, since macros are called often. NULL: reported. */
static struct pov_binding *new_binding(struct pov_reader *reader)
{
    struct pov_binding *binding = reader->spare;
    if (binding)
        reader->spare = binding->below;
    return binding ? binding : pov_allocate(reader, 1, sizeof *binding);
}

struct pov_value *pov_bind(struct pov_reader *reader, uint32_t word, bool local,
                           struct pov_value *shared)
{
    struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    struct pov_binding **list = bindings_of(reader, word);
    struct pov_binding *binding = list ? new_binding(reader) : NULL;
    if (!binding)
        return NULL;
    *binding = (struct pov_binding){.word = word, .below = *list};
    binding->value = shared ? shared : &binding->own;
    if (local && reader->frame_count > 1) {
        binding->level = reader->frame_count;
        binding->same_frame = frame->locals;
        frame->locals = binding;
    }
    *list = binding;
    return binding->value;
}

bool pov_is_own(const struct pov_reader *reader, uint32_t word)
{
    size_t level = reader->frame_count > 1 ? reader->frame_count : 0;
    return word < reader->binding_capacity && reader->bindings[word] &&
           reader->bindings[word]->level == level;
}

void pov_unbind(struct pov_reader *reader, uint32_t word)
{
    if (word >= reader->binding_capacity || !reader->bindings[word])
        return;
    /* It stays in its frame's list; taking it out there finds nothing. */
    reader->bindings[word] = reader->bindings[word]->below;
}
