/* facts.h: what a picture or a film was made with, as attributes of its file.
 *
 * Attributes are named "psplat.KEY". Those of a film say all that its passes depend on, so that
 * films are added up, or gone on with, only where every pass would be the same.
 */
#ifndef JOB_FACTS_H
#define JOB_FACTS_H

#include "image/image.h"
#include "render/settings.h"
#include "scene/scene.h"

/* Version, scene and every setting. */
ps_result facts_of_settings(struct image *image, const char *scene_path,
                            const struct render_settings *settings, struct error *error);

/* The part of the picture, in place of the one that was said; no width: all of it. */
ps_result facts_set_crop(struct image *image, struct rectangle part, struct error *error);

/* A strategy with its parameters. */
ps_result facts_set_strategy(struct image *image, const struct strategy *strategy,
                             struct error *error);

/* Those of the settings, and what else passes depend on: size, instruction set, what is in the
 * scene. And the camera, the bounds and the exposure that the scene asks for. PS_ERROR_INVALID
 * where this processor lacks the instruction set. */
ps_result facts_of_job(struct image *image, const struct scene_description *description,
                       const struct scene *scene, const struct render_settings *settings,
                       struct error *error);

/* Puts what denoisers ask of a film's scene into one that has nothing else: its camera, and its
 * bounding sphere; and samples of a pixel at an edge. PS_ERROR_INVALID where the facts do not tell
 * it. */
ps_result facts_view(const struct image *facts, struct scene *scene, uint32_t *aa_samples,
                     struct error *error);

/* A number that two films of one job have in common. */
uint64_t facts_digest(const struct image *facts);

/* Whether the passes of two films are those of one job. If not, `difference` says what differs
 * first: "the seed, 1 and 2". */
bool facts_agree(const struct image *a, const struct image *b, char *difference, size_t size);

#endif
