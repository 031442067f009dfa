/* state.h: pbrt's graphics state and the stack that it is kept on. */
#ifndef PBRT_STATE_H
#define PBRT_STATE_H

#include "pbrt/importer.h"

/* What opened a level of the stack; its end must be of the same sort. */
enum state_mark {
    MARK_ATTRIBUTES = 'a',
    MARK_TRANSFORM = 't',
    MARK_OBJECT = 'o',
    MARK_IMPORT = 'i'
};

/* False: reported. */
bool state_push(struct importer *importer, enum state_mark mark, const struct origin *origin,
                int width);
bool state_pop(struct importer *importer, enum state_mark mark, const struct origin *origin,
               int width);

/* What follows is mapped by `map` first, and then as before. */
void state_transform(struct importer *importer, const struct transform *map);

/* False: reported. Before the first statement of the world. */
bool state_begin_world(struct importer *importer);

/* Coordinate systems by name; the latest of a name counts. */
bool state_name_coordinates(struct importer *importer, const char *name,
                            const struct transform *transform);
const struct transform *state_find_coordinates(const struct importer *importer, const char *name);

/* Objects, which instances place. False: reported. */
bool state_begin_object(struct importer *importer, const char *name, const struct origin *origin,
                        int width);
bool state_end_object(struct importer *importer, const struct origin *origin, int width);
void state_add_instance(struct importer *importer, const char *name, const struct origin *origin,
                        int width);

#endif
