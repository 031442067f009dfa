/* model_scene.h: the text of the scene that shows a lone model. */
#ifndef MODEL_MODEL_SCENE_H
#define MODEL_MODEL_SCENE_H

#include "model/model.h"

/* The text, to be freed, of a scene that names the model by a path from where the scene will be:
 * beside the model where `scene_path` is NULL. `content`: the model's, to be released, and empty
 * after a failure. */
ps_result model_scene_make(const struct model_file *model_file, const char *scene_path, char **text,
                           struct mesh_ahead *content, struct error *error);

#endif
