/* sections.h: the readers of a scene's sections, each from nodes into the description.
 *
 * Each reports what is wrong and goes on (reader.h). Objects and groups are in object.h.
 */
#ifndef PARSER_SECTIONS_SECTIONS_H
#define PARSER_SECTIONS_SECTIONS_H

#include "parser/schema/keys.h"
#include "parser/sections/reader.h"
#include "parser/sections/value.h"

/* --- the whole file
 * ---------------------------------------------------------------------------- */

/* Fills the reader's description from the root of the tree, reporting what is wrong. */
void scene_read(struct reader *reader, const struct node *root);

/* --- cameras
 * ----------------------------------------------------------------------------------- */

/* Adds `camera` and `cameras` to the description. */
void cameras_read(struct reader *reader, const struct node *root);

/* Room for one more camera, or NULL, noted. */
struct camera_description *camera_add(struct reader *reader);

/* Whether the description has a camera of that name. */
bool camera_exists(const struct reader *reader, const char *name);

/* --- lights
 * ------------------------------------------------------------------------------------ */

/* Adds the lights to the description. */
void lights_read(struct reader *reader, const struct node *root);

/* --- materials
 * --------------------------------------------------------------------------------- */

/* Adds the materials to the description, and their names to the reader. */
void materials_read(struct reader *reader, const struct node *root);

/* --- colours, or numbers, that may vary over a surface
 * ----------------------------------------- */

/* A pigment of one colour, whatever it is. */
struct pigment_description pigment_of(ps_rgb color);

/* Reads a colour, or {kind: {...}}, into the pigment whose colors[0] is at the row's offset of the
 * state. Colours must be in the row's range. False where something was reported. */
bool pigment_read(struct reader *reader, struct subject subject, const struct schema_row *row,
                  const struct node *node, void *state);

/* --- pictures
 * ---------------------------------------------------------------------------------- */

/* Adds a texture to the description, once for each way in which a file is used. Returns its index,
 * or NO_INDEX where memory ran out, which is noted. */
size_t texture_add(struct reader *reader, const struct texture_keys *keys);

/* --- transforms
 * -------------------------------------------------------------------------------- */

/* Makes of what was filled from the map, whose key is `at`, a map that has an inverse; false where
 * something was reported. */
bool placement_read(struct reader *reader, const struct node *at, const struct node *map,
                    const struct placement_keys *keys, struct affine *placement);

/* Whether the map has an inverse, of numbers that floats can hold. */
bool placement_is_regular(const struct affine *map);

/* --- the plugins that `render` names, with their parameters as text
 * ---------------------------- */

/* Reads `NAME` or `{NAME: {PARAMETER: VALUE, ...}}` into a zeroed choice; false where something was
 * reported. The plugin's own table checks the parameters later. */
bool strategy_read(struct reader *reader, struct subject subject, const struct node *node,
                   struct strategy_choice *choice);

/* --- what the file names to refer to it from elsewhere: materials and groups
 * ------------------- */

/* Makes index `index` known by the name; a name that is known gets the new index. */
void reference_put(struct reader *reader, struct names *names, const char *name, size_t index);

/* False where the name is not known. */
bool reference_get(const struct names *names, const char *name, size_t *index);

/* Finds what a scalar names; false, and an error that suggests a name, where there is no such
 * thing. */
bool reference_material(const struct reader *reader, const struct node *node, size_t *index);
bool reference_group(const struct reader *reader, const struct node *node, size_t *index);

#endif
