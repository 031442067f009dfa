/* viewer.h: shows the picture of a render in a viewer beside it (--display), while it becomes
 * better.
 *
 * A thread sends, so that a viewer that is slow, or gone, holds nothing up: pictures that come
 * meanwhile are left out, but for the last one. Where there is no viewer, that is said once, and
 * tried again with each picture.
 */
#ifndef CLI_VIEWER_H
#define CLI_VIEWER_H

#include "cli/tev.h"

/* Row for a command's table. */
#define VIEWER_OPTION                                                                              \
    {                                                                                              \
        0, "display", "tev[:HOST[:PORT]]",                                                         \
            "show the picture in the viewer tev as it becomes better; default: at " TEV_HOST       \
            ", port " TEV_PORT                                                                     \
    }

struct viewer;

/* Checks the option's value; false, printed, where it is another. */
bool viewer_parse(const char *value, struct tev_address *address);

/* `name` is the picture's there, of which the last 255 characters count; `has_display` as of
 * tev_send. NULL, printed, where it can't be had. */
struct viewer *viewer_create(const struct tev_address *address, const char *name, bool has_display);

/* Shows a picture, which it takes over, or leaves it out where the one before is still on its way;
 * the last one waits for that. Warnings are printed by the caller's thread. */
void viewer_show(struct viewer *viewer, psplat_picture *picture, bool is_last);

/* When the picture before it is sent, or can't be. NULL is nothing. */
void viewer_destroy(struct viewer *viewer);

#endif
