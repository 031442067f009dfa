/* scene_facts.h: what a loaded scene says of itself beside its picture: for a page, as JSON, and
 * the files to watch. */
#ifndef EXPLORE_SCENE_FACTS_H
#define EXPLORE_SCENE_FACTS_H

#include "base/json_writer.h"
#include <psplat/psplat.h>
#include <stdbool.h>

/* Writes, as members of the object that is open:
 *   strategies   each kind's strategy by its name
 *   parameters   for each kind, those that scene and options state, with their values
 *   values       options of the render with their present values ("size", "bounces", "camera",
 *                ...), and those that --set sets ("render.aa_samples") */
void scene_facts_write(const psplat_scene *scene, struct json_writer *writer);

/* Writes a list of the cameras' names, in the order of the file. */
void scene_facts_write_cameras(const psplat_scene *scene, struct json_writer *writer);

/* Calls back for each file that it was read from: scenes, meshes, pictures. One may come several
 * times. */
void scene_facts_each_file(const psplat_scene *scene, void (*each)(void *user, const char *path),
                           void *user);

/* Of the picture. */
double scene_facts_pixels(const psplat_scene *scene);

/* An option of the render that is a row of the scene language's tables; all of them, by their
 * index. */
struct scene_setting {
    const char *name;    /* the option's; of what has none, the path for --set */
    bool is_set;         /* that has none */
    const char *section; /* of the scene language */
    const char *key;     /* in it */
};
size_t scene_setting_count(void);
const struct scene_setting *scene_setting(size_t index);

#endif
