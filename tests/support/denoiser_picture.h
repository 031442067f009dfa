/* denoiser_picture.h: pictures with a G-buffer, made by hand, and a denoiser that is let loose on
 * one. */
#ifndef TESTS_SUPPORT_DENOISER_PICTURE_H
#define TESTS_SUPPORT_DENOISER_PICTURE_H

#include <psplat/math.h>
#include <stdbool.h>
#include <stdint.h>

#define WIDTH 150 /* two whole blocks of a denoiser's loop, and a part */
#define HEIGHT 24
#define PIXELS (WIDTH * HEIGHT)

struct picture {
    float light[3][PIXELS], albedo[3][PIXELS], normal[3][PIXELS], position[3][PIXELS];
    float depth[PIXELS];
    float (*halves)[3][PIXELS]; /* light of even and of odd passes, two in all; NULL: one pass */
    const float *gloss;         /* share of the albedo that is gloss; NULL: none */
    uint32_t edge_samples;      /* of a pixel at an edge */
    const float *variance;      /* of the irradiance; 0 where it is not known; NULL: nowhere */
};

void set_vector(float (*planes)[PIXELS], int pixel, ps_vec3 v);
ps_vec3 vector_at(const float (*planes)[PIXELS], int pixel);

/* A level floor of albedo 1 and radiance 1, pixels 0.1 apart. The caller frees it. */
struct picture *level_floor(void);

/* The right half of a level floor is tilted, or raised. */
struct picture *bent_floor(float degrees, float step);

/* A wavy surface of many colours under noise, with pixels that see nothing. */
struct picture *wild_picture(uint64_t seed);

/* Runs a denoiser such as "denoiser=bilateral:size=9", which must succeed, and leave no memory
 * behind. */
void denoise(struct picture *picture, const char *choice, uint32_t threads);

/* The same for several pictures of one G-buffer, by filter_all. */
void denoise_together(struct picture *const pictures[], uint32_t count, const char *choice,
                      uint32_t threads);

/* The same after the host was cancelled, which the denoiser must tell. */
void denoise_cancelled(struct picture *picture, const char *choice, uint32_t threads);

#endif
