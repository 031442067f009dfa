/* mip_map_stream.h: the levels of a picture (mip_map.h) that comes line by line.
 *
 * A line of any level is handed on as soon as it is known, those of one level from the top, so that
 * no level has to lie in memory: what is kept are sums for two lines of each.
 */
#ifndef SCENE_MIP_MAP_STREAM_H
#define SCENE_MIP_MAP_STREAM_H

#include "scene/texture.h"

/* Takes a line of a level; anything but PS_OK ends it all. */
typedef ps_result (*mip_map_take)(void *user, uint32_t level, uint32_t line, const void *samples,
                                  struct error *error);

/* One thread. */
struct mip_map_stream;

/* Of a texture whose tables and sizes of levels are known; it is borrowed. NULL with
 * PS_ERROR_MEMORY's message. */
struct mip_map_stream *mip_map_open(const struct texture *texture, mip_map_take take, void *user,
                                    struct error *error);
ps_result mip_map_add_line(struct mip_map_stream *stream, const void *samples, struct error *error);
void mip_map_close(struct mip_map_stream *stream); /* or NULL */

#endif
