#include "plugin/loader.h"

#include "plugin/elf_check.h"
#include "plugin/own_folder.h"
#include <dirent.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LONGEST_ATTEMPTS 3400
#define SUFFIX ".so"

/* Modules that are linked into the program; NULL-terminated. Empty in ordinary builds. */
extern const ps_module *const static_modules[];

struct loader {
    char **folders; /* searched in order */
    size_t folder_count;
    loader_warn warn; /* NULL: nobody listens */
    void *user;
};

static bool add_folder(struct loader *loader, const char *path, size_t length)
{
    char **folders = realloc(loader->folders, (loader->folder_count + 1) * sizeof *folders);
    if (!folders)
        return false;
    loader->folders = folders;
    char *copy = malloc(length + 1);
    if (!copy)
        return false;
    memcpy(copy, path, length);
    copy[length] = '\0';
    folders[loader->folder_count++] = copy;
    return true;
}

/* A relative entry would take plugins, which are programs, from wherever psplat is started; and so
 * does an empty one, by the habit of $PATH. */
static ps_result refuse_entry(const char *entry, size_t length, struct error *error)
{
    return error_set(
        error, PS_ERROR_INVALID,
        "PSPLAT_PLUGIN_PATH: expected absolute folders with ':' between them, got %s%.*s%s",
        length ? "'" : "an empty entry", (int)(length < 200 ? length : 200), entry,
        length ? "'" : "");
}

static ps_result add_environment(struct loader *loader, struct error *error)
{
    const char *path = getenv("PSPLAT_PLUGIN_PATH");
    bool more = path && *path;
    while (more) {
        size_t length = strcspn(path, ":");
        if (*path != '/')
            return refuse_entry(path, length, error);
        if (!add_folder(loader, path, length))
            return error_memory(error, length, "the plugin path");
        more = path[length] == ':';
        path += length + 1;
    }
    return PS_OK;
}

static bool add_own_folder(struct loader *loader)
{
    char path[LONGEST_PATH];
    return own_folder_find(path) && add_folder(loader, path, strlen(path));
}

ps_result loader_create(struct loader **created, struct error *error)
{
    struct loader *loader = calloc(1, sizeof *loader);
    if (!loader)
        return error_memory(error, sizeof *loader, "the plugin loader");
    ps_result result = add_environment(loader, error);
    if (result == PS_OK && !add_own_folder(loader))
        result = error_memory(error, LONGEST_PATH, "the plugin path");
    if (result == PS_OK)
        *created = loader;
    else
        loader_destroy(loader);
    return result;
}

void loader_destroy(struct loader *loader)
{
    if (!loader)
        return;
    for (size_t i = 0; i < loader->folder_count; i++)
        free(loader->folders[i]);
    free(loader->folders);
    free(loader);
}

static const ps_descriptor *pick(const ps_module *module, ps_kind kind, const char *name)
{
    for (uint32_t i = 0; i < module->descriptor_count; i++) {
        const ps_descriptor *descriptor = module->descriptors[i];
        if (descriptor->kind == (uint32_t)kind && (!name || !strcmp(descriptor->name, name)))
            return descriptor;
    }
    return NULL;
}

static const ps_descriptor *find_static(ps_kind kind, const char *name)
{
    for (size_t i = 0; static_modules[i]; i++) {
        const ps_descriptor *descriptor = pick(static_modules[i], kind, name);
        if (descriptor)
            return descriptor;
    }
    return NULL;
}

static void say_what_it_holds(const ps_module *module, ps_kind kind, const char *name,
                              struct error *error)
{
    char held[400] = "";
    for (uint32_t i = 0; i < module->descriptor_count; i++) {
        const ps_descriptor *descriptor = module->descriptors[i];
        size_t used = strlen(held);
        snprintf(held + used, sizeof held - used, "%s%s '%.80s'", i ? ", " : "",
                 kinds[descriptor->kind].name, descriptor->name);
    }
    error_set(error, PS_ERROR_INVALID, "it holds %s, no %s%s", held, kinds[kind].name,
              name ? " of that name" : "");
}

/* The module in a file; NULL, and why, where there is none that can be used. */
static const ps_module *load_module(const char *path, struct error *error)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        error_set(error, PS_ERROR_IO, "no such file");
        return NULL;
    }
    const char *problem = S_ISREG(status.st_mode) ? elf_problem(path) : "it is no ordinary file";
    if (problem) {
        error_set(error, PS_ERROR_INVALID, "%s", problem);
        return NULL;
    }
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        error_set(error, PS_ERROR_INVALID, "can't be loaded (%.600s)", dlerror());
        return NULL;
    }
    const ps_module *module = dlsym(handle, "psplat_module_v1");
    if (!module) {
        error_set(error, PS_ERROR_INVALID, "it is no psplat plugin: no symbol psplat_module_v1");
        return NULL;
    }
    return module_check(module, error) ? module : NULL;
}

/* The strategy of a kind in a file; name NULL takes any. PS_ERROR_IO: there is no such file. */
static ps_result load_file(const char *path, ps_kind kind, const char *name,
                           struct strategy_type **type, struct error *error)
{
    const ps_module *module = load_module(path, error);
    if (!module)
        return access(path, F_OK) == 0 ? PS_ERROR_INVALID : PS_ERROR_IO;
    const ps_descriptor *descriptor = pick(module, kind, name);
    if (descriptor)
        return strategy_type_create(descriptor, path, type, error);
    say_what_it_holds(module, kind, name, error);
    return PS_ERROR_INVALID;
}

ps_result loader_look(const char *path, bool held[PS_KINDS], struct error *error)
{
    const ps_module *module = load_module(path, error);
    for (int kind = 0; kind < PS_KINDS && module; kind++)
        held[kind] = pick(module, (ps_kind)kind, NULL) != NULL;
    return module ? PS_OK : PS_ERROR_INVALID;
}

/* What a search came by. */
struct trail {
    char attempts[LONGEST_ATTEMPTS]; /* "; tried PATH: REASON" for each miss */
    char notes
        [LONGEST_ATTEMPTS]; /* lines about what was passed over, "" where there is nothing to say */
};

static void append_note(struct trail *trail, const char *format, const char *one, const char *other)
{
    size_t used = strlen(trail->notes);
    if (used > 0 && used + 1 < sizeof trail->notes)
        trail->notes[used++] = '\n';
    snprintf(trail->notes + used, sizeof trail->notes - used, format, one, other);
}

/* Where a strategy of that name would lie. */
static void path_of(const struct loader *loader, size_t folder, ps_kind kind, const char *name,
                    char path[LONGEST_PATH])
{
    snprintf(path, LONGEST_PATH, "%s/%s/%s" SUFFIX, loader->folders[folder], kinds[kind].name,
             name);
}

/* Notes the files after the one that was taken which have the same name. */
static void note_hidden(const struct loader *loader, size_t first, ps_kind kind, const char *name,
                        const char *taken, struct trail *trail)
{
    char path[LONGEST_PATH];
    for (size_t i = first; i < loader->folder_count; i++) {
        path_of(loader, i, kind, name, path);
        if (access(path, F_OK) == 0)
            append_note(trail, "plugin %.1500s hides %.1500s", taken, path);
    }
}

/* Searches what is linked into the program, then the folders in order; NULL where none has it. */
static struct strategy_type *search(const struct loader *loader, ps_kind kind, const char *name,
                                    struct trail *trail)
{
    struct strategy_type *type = NULL;
    struct error reason;
    *trail = (struct trail){.attempts = ""};
    const ps_descriptor *linked = find_static(kind, name);
    if (linked && strategy_type_create(linked, NULL, &type, &reason) == PS_OK)
        return type;
    if (linked)
        snprintf(trail->attempts, sizeof trail->attempts, "; tried the program's own: %.1500s",
                 reason.text);
    for (size_t i = 0; i < loader->folder_count && !type; i++) {
        char path[LONGEST_PATH];
        path_of(loader, i, kind, name, path);
        ps_result result = load_file(path, kind, name, &type, &reason);
        size_t used = strlen(trail->attempts);
        if (result == PS_OK) {
            note_hidden(loader, i + 1, kind, name, path, trail);
            return type;
        }
        snprintf(trail->attempts + used, sizeof trail->attempts - used, "; tried %s: %s", path,
                 reason.text);
        if (result != PS_ERROR_IO)
            append_note(trail, "plugin %.1500s is passed over: %.1500s", path, reason.text);
    }
    return NULL;
}

static void append_suggestion(void *user, const struct listed_strategy *listed)
{
    char *names = user;
    size_t used = strlen(names);
    if (listed->type && used < 200)
        snprintf(names + used, 240 - used, "%s%s", used ? ", " : "", listed->name);
}

static ps_result not_found(struct loader *loader, ps_kind kind, const char *name,
                           const char *attempts, struct error *error)
{
    char names[240] = "";
    struct error ignored;
    loader_list(loader, kind, append_suggestion, names, &ignored);
    return error_set(error, PS_ERROR_INVALID, "no %s '%.100s' (there are: %s)%s", kinds[kind].name,
                     name, names[0] ? names : "none", attempts);
}

static bool is_plain_name(const char *name)
{
    return *name && strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_-") == strlen(name);
}

/* Each line of the notes is a warning. */
static void warn(const struct loader *loader, char *notes)
{
    for (char *rest = notes, *line; loader->warn && (line = strtok_r(rest, "\n", &rest));)
        loader->warn(loader->user, line);
}

ps_result loader_find(struct loader *loader, ps_kind kind, const char *name,
                      struct strategy_type **found, struct error *error)
{
    if (strchr(name, '/')) {
        struct error reason;
        ps_result result = load_file(name, kind, NULL, found, &reason);
        if (result == PS_OK)
            return PS_OK;
        return error_set(error, PS_ERROR_INVALID, "%s plugin %.300s: %.600s", kinds[kind].name,
                         name, reason.text);
    }
    if (!is_plain_name(name))
        return not_found(loader, kind, name, "", error);
    struct trail trail;
    *found = search(loader, kind, name, &trail);
    if (!*found)
        return not_found(loader, kind, name, trail.attempts, error);
    warn(loader, trail.notes);
    return PS_OK;
}

void loader_set_warnings(struct loader *loader, loader_warn listener, void *user)
{
    loader->warn = listener;
    loader->user = user;
}

/* A growing list of names, for loader_list. */
struct names {
    char **items;
    size_t count;
};

static void release_names(struct names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->items[i]);
    free(names->items);
}

static bool add_name(struct names *names, const char *name, size_t length)
{
    for (size_t i = 0; i < names->count; i++)
        if (strlen(names->items[i]) == length && !strncmp(names->items[i], name, length))
            return true;
    char **items = realloc(names->items, (names->count + 1) * sizeof *items);
    if (!items)
        return false;
    names->items = items;
    items[names->count] = strndup(name, length);
    return items[names->count] != NULL && ++names->count;
}

static bool add_names_of_folder(struct names *names, const char *folder, ps_kind kind)
{
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "%s/%s", folder, kinds[kind].name);
    DIR *directory = opendir(path);
    if (!directory)
        return true;
    bool whole = true;
    for (struct dirent *entry; whole && (entry = readdir(directory));) {
        size_t length = strlen(entry->d_name), suffix = strlen(SUFFIX);
        if (length > suffix && !strcmp(entry->d_name + length - suffix, SUFFIX))
            whole = add_name(names, entry->d_name, length - suffix);
    }
    closedir(directory);
    return whole;
}

static bool collect_names(struct loader *loader, ps_kind kind, struct names *names)
{
    for (size_t i = 0; static_modules[i]; i++) {
        const ps_descriptor *descriptor = pick(static_modules[i], kind, NULL);
        if (descriptor && !add_name(names, descriptor->name, strlen(descriptor->name)))
            return false;
    }
    for (size_t i = 0; i < loader->folder_count; i++)
        if (!add_names_of_folder(names, loader->folders[i], kind))
            return false;
    return true;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

ps_result loader_list(struct loader *loader, ps_kind kind, loader_visit visit, void *user,
                      struct error *error)
{
    struct names names = {0};
    if (!collect_names(loader, kind, &names)) {
        release_names(&names);
        return error_memory(error, sizeof(char *), "a list of plugins");
    }
    if (names.count)
        qsort(names.items, names.count, sizeof *names.items, compare_names);
    for (size_t i = 0; i < names.count; i++) {
        struct trail trail;
        struct strategy_type *type = search(loader, kind, names.items[i], &trail);
        visit(user,
              &(struct listed_strategy){names.items[i], type, type ? trail.notes : trail.attempts});
        strategy_type_destroy(type);
    }
    release_names(&names);
    return PS_OK;
}
