/* loader.h: finds strategies by name in shared objects.
 *
 * A name is looked for as <folder>/<kind>/<name>.so in the folders of $PSPLAT_PLUGIN_PATH
 * (absolute, colon-separated), then in psplat's own folder; a name with a slash is a path. A module is judged
 * (magic, ABI, layout, descriptors) before any of its functions is called. Modules are never unloaded:
 * descriptors and their strings stay valid.
 */
#ifndef PLUGIN_LOADER_H
#define PLUGIN_LOADER_H

#include "base/error.h"
#include "plugin/kind.h"
#include <stdbool.h>

struct loader;

/* PS_ERROR_INVALID: $PSPLAT_PLUGIN_PATH is wrong; PS_ERROR_MEMORY. */
ps_result loader_create(struct loader **loader, struct error *error);
void loader_destroy(struct loader *loader);

#define LOADER_LONGEST_PATH 4096

struct found_strategy {
    const ps_descriptor *descriptor;
    char file[LOADER_LONGEST_PATH]; /* empty: linked into the program */
};

/* Finds a strategy. The message of a failure lists every path that was tried and why each failed.
 * Main thread. */
ps_result loader_find(struct loader *loader, ps_kind kind, const char *name,
                      struct found_strategy *found, struct error *error);

/* Calls visit for every strategy of a kind that can be found by name, in alphabetical order; a
 * module that can't be loaded is visited with a NULL descriptor and the reason. */
typedef void (*loader_visit)(void *user, const char *name, const ps_descriptor *descriptor,
                             const char *problem);
ps_result loader_list(struct loader *loader, ps_kind kind, loader_visit visit, void *user,
                      struct error *error);

/* Whether a module may be used; on failure the message says what is wrong with it. For the loader,
 * and for tests. */
bool module_check(const ps_module *module, struct error *error);

#endif
