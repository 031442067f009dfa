/* own_folder.h: where psplat's own plugins lie. */
#ifndef PLUGIN_OWN_FOLDER_H
#define PLUGIN_OWN_FOLDER_H

#include <stdbool.h>

#define LONGEST_PATH 4096

/* The folder of psplat's own plugins: found from the file that this code was loaded from, the
 * program or the library, so that an installed tree runs from any place; where the system does not
 * tell what that is, the place that the build was made for. False: its name is too long. */
bool own_folder_find(char path[LONGEST_PATH]);

#endif
