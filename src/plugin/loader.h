/* loader.h: finds strategies by name in shared objects.
 *
 * A name is looked for as <folder>/<kind>/<name>.so in the folders of $PSPLAT_PLUGIN_PATH
 * (absolute, colon-separated), then in psplat's own folder; a name with a slash is a path. A module
 * is judged (magic, ABI, layout, descriptors) before any of its functions is called. Modules are
 * never unloaded: descriptors and their strings stay valid.
 */
#ifndef PLUGIN_LOADER_H
#define PLUGIN_LOADER_H

#include "base/error.h"
#include "plugin/strategy_type.h"
#include <stdbool.h>

struct loader;

/* PS_ERROR_INVALID: $PSPLAT_PLUGIN_PATH is wrong; PS_ERROR_MEMORY. */
ps_result loader_create(struct loader **loader, struct error *error);
void loader_destroy(struct loader *loader);

/* Finds a strategy, which the caller destroys. The message of a failure lists every path that was
 * tried and why each failed. Main thread. */
ps_result loader_find(struct loader *loader, ps_kind kind, const char *name,
                      struct strategy_type **found, struct error *error);

/* Which kinds of strategy the module in a file holds. PS_ERROR_INVALID: it can't be used. */
ps_result loader_look(const char *path, bool held[PS_KINDS], struct error *error);

/* A strategy that loader_list found, or a name under which none could be loaded. */
struct listed_strategy {
    const char *name;
    const struct strategy_type *type; /* NULL: none can be used */
    const char *problem; /* why, and what was passed over on the way; "" where nothing is wrong */
};

/* Calls visit for every name of a kind that can be found, in alphabetical order. */
typedef void (*loader_visit)(void *user, const struct listed_strategy *listed);
ps_result loader_list(struct loader *loader, ps_kind kind, loader_visit visit, void *user,
                      struct error *error);

/* Called with a line for what loader_find passes over: a broken module in front of the one that it
 * takes, or another that this one hides. */
typedef void (*loader_warn)(void *user, const char *message);
void loader_set_warnings(struct loader *loader, loader_warn warn, void *user);

#endif
