/* cells.h: the service of psplat/cells.h: keys of cells, and sorting by them. */
#ifndef STRATIFY_CELLS_H
#define STRATIFY_CELLS_H

#include <psplat/cells.h>

extern const ps_cells cells_service;

/* The lattice of such cells that has a corner of cells at `corner`, and holds the sphere. */
ps_lattice cells_lattice(ps_vec3 corner, double side, ps_vec3 center, float radius);

/* See ps_cells.key. */
uint64_t cells_key(const ps_lattice *lattice, uint32_t layer, ps_vec3 position);

#endif
