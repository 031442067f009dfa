/* denoise.h: the denoiser's part of making a picture of a film, and planes of light. */
#ifndef PIPELINE_DENOISE_H
#define PIPELINE_DENOISE_H

#include "pipeline/stages.h"

struct rgb_planes {
    float *r, *g, *b;
};

static inline size_t pixels_of(const struct render *render)
{
    return render->film.width * render->film.height;
}

static inline struct rgb_planes planes_at(float *first, size_t pixels)
{
    return (struct rgb_planes){first, first + pixels, first + 2 * pixels};
}

/* Makes what is no number, or negative, 0, and counts how many values there were. */
void mend_rgb(struct render *render, struct rgb_planes planes, uint64_t *refused);

/* The indirect light of even and of odd passes, for a denoiser that asks: six planes in one piece
 * of memory, of which the caller frees `light`. */
struct halves {
    float *light;
    struct rgb_planes even, odd;
    float odd_share; /* of the passes, or of the samples */
};

/* Denoises, in place, the indirect light, and in the film, whose planes are means, the direct
 * light, where the denoiser takes that. `estimate`: see ps_image_view.error; NULL where nobody
 * asks. Where it fails, all that is not done stays as it is, with a warning. */
ps_result denoise_film(struct render *render, struct rgb_planes indirect,
                       const struct halves *halves, float *estimate, struct error *error);

#endif
