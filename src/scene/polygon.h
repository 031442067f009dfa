/* polygon.h: cuts a plane polygon into triangles. */
#ifndef SCENE_POLYGON_H
#define SCENE_POLYGON_H

#include <stddef.h>
#include <stdint.h>

/* Cuts a simple polygon, whose corners may turn either way, into triangles of indices by clipping
 * ears (G. Meisters, "Polygons have ears", 1975): count - 2 of them, fewer where it crosses itself.
 * It may touch itself, as one does that goes in to a hole and out again along the same line.
 * Returns how many. `ring` is room for `count` numbers. */
size_t polygon_triangulate(const double (*points)[2], size_t count, uint32_t *ring,
                           uint32_t (*triangles)[3]);

#endif
