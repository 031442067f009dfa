/* files.c: reads whole files, from the disk or from a list.
 *
 * Whole, since OBJ and glTF are read here too, and so that a pipe or a device under the name of a
 * mesh is refused before anything waits for it.
 */
#include "import/files.h"

#include "base/input_file.h"
#include "base/parallel.h"
#include <assert.h>
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const struct mesh_memory_file *find_in_memory(const struct mesh_files *files,
                                                     const char *path)
{
    for (size_t i = 0; i < files->memory_count; i++)
        if (strcmp(files->memory[i].path, path) == 0)
            return &files->memory[i];
    return NULL;
}

static void destroy_file(struct mesh_file *file)
{
    free(file->path);
    free(file->bytes);
    free(file);
}

static ps_result check_size(const char *path, uint64_t length, struct error *error)
{
    if (length > MESH_FILE_LARGEST)
        return error_set(error, PS_ERROR_INVALID, "%s is larger than 4 GiB", path);
    return PS_OK;
}

/* NULL: out of memory. */
static struct mesh_file *create_file(const char *path, size_t length)
{
    struct mesh_file *file = calloc(1, sizeof *file);
    if (!file)
        return NULL;
    file->path = strdup(path);
    file->bytes = malloc(length + 1);
    file->length = length;
    if (file->path && file->bytes)
        return file;
    destroy_file(file);
    return NULL;
}

static ps_result read_opened(const char *path, const struct input_file *input,
                             struct mesh_file **read, struct error *error)
{
    ps_result result = check_size(path, input->size, error);
    if (result != PS_OK)
        return result;
    struct mesh_file *file = create_file(path, (size_t)input->size);
    if (!file)
        return error_memory(error, (size_t)input->size, "a mesh file");
    *read = file;
    struct error reason;
    result = input_file_read(input, file->bytes, &file->length, &reason);
    return result == PS_OK ? PS_OK : error_set(error, result, "%s: %.1000s", path, reason.text);
}

static ps_result read_from_disk(const char *path, const char *folder, struct mesh_file **read,
                                struct error *error)
{
    struct input_file input;
    struct error reason;
    ps_result result = input_file_open(path, folder, &input, &reason);
    if (result != PS_OK)
        return error_set(error, result, "%s: %.1000s", path, reason.text);
    result = read_opened(path, &input, read, error);
    close(input.descriptor);
    return result;
}

static ps_result read_from_memory(const struct mesh_files *files, const char *path,
                                  struct mesh_file **read, struct error *error)
{
    const struct mesh_memory_file *source = find_in_memory(files, path);
    if (!source)
        return error_set(error, PS_ERROR_IO, "%s: cannot open: no such file", path);
    ps_result result = check_size(path, source->length, error);
    if (result != PS_OK)
        return result;
    struct mesh_file *file = create_file(path, source->length);
    if (!file)
        return error_memory(error, source->length, "a mesh file");
    if (source->length > 0)
        memcpy(file->bytes, source->bytes, source->length);
    *read = file;
    return PS_OK;
}

ps_result mesh_files_read(struct mesh_files *files, const char *path, struct mesh_file **file,
                          struct error *error)
{
    for (*file = files->read; *file; *file = (*file)->next)
        if (strcmp((*file)->path, path) == 0)
            return PS_OK;
    struct mesh_file *read = NULL;
    ps_result result = files->memory ? read_from_memory(files, path, &read, error)
                                     : read_from_disk(path, files->folder, &read, error);
    if (result != PS_OK || !read) {
        if (read)
            destroy_file(read);
        mesh_looks_add(files->looks, (struct mesh_look){.kind = LOOK_WHOLE}, path);
        return result;
    }
    if (files->looks)
        mesh_looks_add(files->looks,
                       (struct mesh_look){.kind = LOOK_WHOLE,
                                          .there = true,
                                          .digest = mesh_digest(read->bytes, read->length)},
                       path);
    read->bytes[read->length] = '\0';
    read->next = files->read;
    files->read = read;
    *file = read;
    return PS_OK;
}

ps_result mesh_file_workers(const struct mesh_file *file, struct workers **workers,
                            struct error *error)
{
    size_t pieces = (file->length >> 20) + 1, processors = parallel_processor_count();
    return workers_create((uint32_t)(pieces < processors ? pieces : processors), workers, error);
}

ps_result mesh_files_add(struct mesh_files *files, const char *path, char *bytes, size_t length,
                         struct error *error)
{
    struct mesh_file *file = calloc(1, sizeof *file);
    char *copy = strdup(path);
    if (!file || !copy) {
        free(file);
        free(copy);
        free(bytes);
        return error_memory(error, length, "a mesh file");
    }
    *file = (struct mesh_file){files->read, copy, bytes, length, true};
    files->read = file;
    return PS_OK;
}

bool mesh_files_exist(struct mesh_files *files, const char *path)
{
    if (files->memory)
        return find_in_memory(files, path) != NULL;
    bool there = input_file_exists(path, files->folder);
    mesh_looks_add(files->looks, (struct mesh_look){.kind = LOOK_EXISTS, .there = there}, path);
    return there;
}

/* --- letter case
 * ------------------------------------------------------------------------------- */

/* Makes `name`, which is in the folder, what the folder calls it. */
static bool match_entry(const char *folder, char *name)
{
    DIR *directory = opendir(folder);
    char *best = NULL;
    if (!directory)
        return false;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        if (strcasecmp(entry->d_name, name) == 0 && (!best || strcmp(entry->d_name, best) < 0)) {
            free(best);
            best = strdup(entry->d_name);
        }
    closedir(directory);
    if (best)
        memcpy(name, best, strlen(best)); /* as long: only letters differ */
    free(best);
    return best != NULL;
}

static bool match_on_disk(char *path, size_t folder, const char *restricted)
{
    char *name = path + folder;
    while (*name) {
        char *end = name + strcspn(name, "/"), after = *end;
        *end = '\0';
        bool is_there = access(path, F_OK) == 0;
        if (!is_there) {
            char before = name > path ? name[-1] : '\0';
            if (name > path)
                name[-1] = '\0';
            const char *parent = name == path ? "." : name - 1 == path ? "/" : path;
            is_there = input_folder_has(restricted, parent) && match_entry(parent, name);
            if (name > path)
                name[-1] = before;
        }
        *end = after;
        if (!is_there)
            return false;
        name = after ? end + 1 : end;
    }
    return true;
}

static bool match_in_memory(const struct mesh_files *files, char *path)
{
    const char *best = NULL;
    for (size_t i = 0; i < files->memory_count; i++) {
        const char *candidate = files->memory[i].path;
        if (strcasecmp(candidate, path) == 0 && (!best || strcmp(candidate, best) < 0))
            best = candidate;
    }
    if (best)
        memcpy(path, best, strlen(best));
    return best != NULL;
}

static bool look_for_case(struct mesh_files *files, char *path, size_t folder)
{
    char *asked = files->looks ? strdup(path) : NULL;
    bool there =
        match_on_disk(path, folder, files->folder) && input_file_exists(path, files->folder);
    if (asked)
        mesh_looks_add(files->looks,
                       (struct mesh_look){.kind = LOOK_CASE,
                                          .there = there,
                                          .size = folder,
                                          .digest = mesh_digest(path, strlen(path))},
                       asked);
    else if (files->looks)
        files->looks->incomplete = true;
    free(asked);
    return there;
}

bool mesh_files_match_case(struct mesh_files *files, char *path, size_t folder)
{
    return files->memory ? match_in_memory(files, path) : look_for_case(files, path, folder);
}

/* --- the first bytes
 * --------------------------------------------------------------------------- */

static size_t peek_on_disk(const char *path, const char *folder, unsigned char *bytes, size_t size)
{
    struct input_file input;
    struct error ignored;
    if (input_file_open(path, folder, &input, &ignored) != PS_OK)
        return 0;
    if (input_file_read(&input, bytes, &size, &ignored) != PS_OK)
        size = 0;
    close(input.descriptor);
    return size;
}

static size_t look_at_first(struct mesh_files *files, const char *path, unsigned char *bytes,
                            size_t size)
{
    size_t found = peek_on_disk(path, files->folder, bytes, size);
    const struct mesh_look look = {
        .kind = LOOK_FIRST, .there = true, .size = size, .digest = mesh_digest(bytes, found)};
    mesh_looks_add(files->looks, look, path);
    return found;
}

size_t mesh_files_peek(struct mesh_files *files, const char *path, unsigned char *bytes,
                       size_t size)
{
    assert(size <= MESH_PEEK_MOST);
    if (!files->memory)
        return look_at_first(files, path, bytes, size);
    const struct mesh_memory_file *source = find_in_memory(files, path);
    if (!source || source->length < size)
        size = source ? source->length : 0;
    if (size > 0)
        memcpy(bytes, source->bytes, size);
    return size;
}

void mesh_files_release(struct mesh_files *files)
{
    while (files->read) {
        struct mesh_file *file = files->read;
        files->read = file->next;
        destroy_file(file);
    }
}
