/* candidates_plugin.h: completes "KIND=NAME:KEY=VALUE,..." by the tables of the plugins that are
 * there. */
#ifndef TOOLS_CANDIDATES_PLUGIN_H
#define TOOLS_CANDIDATES_PLUGIN_H

#include <psplat/plugin.h>
#include <stdbool.h>

/* What has been typed so far, and what stands before it in the same word. */
struct prefix {
    const char *before, *typed;
};

/* Prints the line of a word that begins with what was typed; see candidates.h. */
void candidate_print(const struct prefix *prefix, const char *word, const char *help, bool goes_on);

/* Kinds from `first` on; `parameters`: also what follows the colon. */
void candidates_print_plugins(const struct prefix *prefix, ps_kind first, bool parameters);

#endif
