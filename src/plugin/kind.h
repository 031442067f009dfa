/* kind.h: the kinds of strategy: names and defaults. */
#ifndef PLUGIN_KIND_H
#define PLUGIN_KIND_H

#include <psplat/plugin.h>

struct kind {
    const char *name;             /* as in scene files, --plugin and the plugin folders */
    const char *summary;          /* one line */
    const char *default_strategy; /* what is used where nothing is said */
};

/* The kinds by number (ps_kind). */
extern const struct kind kinds[PS_KINDS];

/* The kind that a text such as "filter" or "filter=tent" begins with; PS_KINDS where there is none.
 * `rest` becomes what follows the '=', or NULL where there is none. */
ps_kind kind_parse(const char *text, const char **rest);

#endif
