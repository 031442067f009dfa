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

/* PS_KINDS where there is no such name. */
ps_kind kind_find(const char *name);

#endif
