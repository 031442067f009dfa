/* model_scene.h: the text of the scene that shows a lone model. */
#ifndef MODEL_MODEL_SCENE_H
#define MODEL_MODEL_SCENE_H

#include "base/error.h"

/* The text, to be freed, of a scene that names the model by a path from where the scene will be: beside the model
 * where `scene_path` is NULL. Nothing is read from outside of `folder`, where that is not NULL; `cache` as in model.h. */
ps_result model_scene_make(const char *model_path, const char *scene_path, const char *folder,
                           const char *cache, char **text, struct error *error);

#endif
