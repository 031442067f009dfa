/* test_regression.c: the denoiser `regression` on G-buffers made by hand. */
#include "support/denoiser_picture.h"
#include "support/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CHOICE "denoiser=regression"
#define ROUNDING 2e-4f /* of planes fitted to numbers that lie in one, relative */

/* Irradiance over pi that slopes along the floor, another way in each channel. */
static float slope(int pixel, int channel)
{
    static const float along[3] = {0.01f, -0.004f, 0}, down[3] = {0, 0.02f, -0.03f};
    return 1.5f + along[channel] * (float)(pixel % WIDTH) + down[channel] * (float)(pixel / WIDTH);
}

static double worst_difference(const struct picture *a, const struct picture *b)
{
    double worst = 0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++)
            worst = fmax(worst, fabs(a->light[c][i] - b->light[c][i]) / fmax(b->light[c][i], 1e-3));
    return worst;
}

/* --- light that fits say rightly stays --- */

static void test_slopes_stay_under_any_colour(void **state)
{
    (void)state;
    struct random random = {3};
    struct picture *before = level_floor(), *after = level_floor();
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) {
            float albedo = random_between(&random, 0.1f, 0.9f);
            before->albedo[c][i] = after->albedo[c][i] = albedo;
            before->light[c][i] = after->light[c][i] = albedo * slope(i, c);
        }
    denoise(after, CHOICE, 2);
    print_message("slopes: off by %.1e at most\n", worst_difference(after, before));
    assert_true(worst_difference(after, before) < 3e-3); /* the ridge */
    free(before);
    free(after);
}

static void test_constant_light_stays_on_wild_surfaces(void **state)
{
    (void)state;
    struct picture *before = wild_picture(3), *after = wild_picture(3);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) {
            before->albedo[c][i] = after->albedo[c][i] = fmaxf(before->albedo[c][i], 0.01f);
            before->light[c][i] = 2.5f * before->albedo[c][i];
            if (isinf(before->depth[i]))
                before->light[c][i] = 7; /* of what is no surface */
            after->light[c][i] = before->light[c][i];
        }
    denoise(after, CHOICE ":normal=80", 2);
    assert_true(worst_difference(after, before) < ROUNDING);
    free(before);
    free(after);
}

/* The right half shines a hundred times brighter. Whether any of its light is seen on the left. */
static bool crosses(struct picture *picture, const char *choice)
{
    float most = 0;
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2)
            picture->light[1][i] = 100;
    denoise(picture, choice, 1);
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH < WIDTH / 2)
            most = fmaxf(most, fabsf(picture->light[1][i] - 1));
    free(picture);
    return most > ROUNDING;
}

static void test_edges_stop_it(void **state)
{
    (void)state;
    assert_true(crosses(bent_floor(0, 0), CHOICE));
    assert_false(crosses(bent_floor(90, 0), CHOICE));
    assert_false(crosses(bent_floor(20, 0), CHOICE ":normal=19,distance=1000"));
    assert_true(crosses(bent_floor(20, 0), CHOICE ":normal=21,distance=1000"));
    assert_false(crosses(bent_floor(0, 0.3f), CHOICE ":distance=0.3"));
    assert_true(crosses(bent_floor(0, 0.3f), CHOICE ":distance=0.5"));
    /* A fifth of the bandwidth: 0.12 for 6 pixels of 0.1. Either point is as far off the other's
     * plane. */
    assert_false(crosses(bent_floor(0, 0.4f), CHOICE));
    assert_true(crosses(bent_floor(0, 0.05f), CHOICE));
}

/* A thread of one pixel's width, which the centres of fits pass by, in the air before a floor of
 * other light. */
static void test_thin_things_keep_their_light(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    for (int y = 0; y < HEIGHT; y++) {
        picture->position[2][y * WIDTH + 77] = 50;
        picture->light[0][y * WIDTH + 77] = 4;
    }
    denoise(picture, CHOICE, 1);
    for (int i = 0; i < PIXELS; i++)
        assert_true(fabsf(picture->light[0][i] - (i % WIDTH == 77 ? 4.0f : 1.0f)) < ROUNDING);
    free(picture);
}

/* --- noise --- */

struct outcome {
    double mean, deviation; /* over the truth */
};

static struct outcome outcome_of(const struct picture *picture, int channel)
{
    struct outcome outcome = {0, 0};
    for (int i = 0; i < PIXELS; i++) {
        double ratio = (double)picture->light[channel][i] / (double)slope(i, channel);
        outcome.mean += ratio / PIXELS;
        outcome.deviation += (ratio - 1) * (ratio - 1) / PIXELS;
    }
    outcome.deviation = sqrt(outcome.deviation);
    return outcome;
}

/* Noise of a deviation of 0.58, the same in all channels, as that of paths nearly is; in two
 * halves, 0.82 each. */
static void add_noise(struct picture *picture, uint64_t seed)
{
    struct random random = {seed};
    for (int i = 0; i < PIXELS; i++) {
        float noise[2] = {random_between(&random, -1.414f, 1.414f),
                          random_between(&random, -1.414f, 1.414f)};
        float factor = 1 + 0.5f * (noise[0] + noise[1]);
        for (int c = 0; c < 3; c++) {
            for (int half = 0; half < 2 && picture->halves; half++)
                picture->halves[half][c][i] = slope(i, c) * (1 + noise[half]);
            picture->light[c][i] = slope(i, c) * factor;
        }
    }
}

static void expect_noise_to_fall(bool halves)
{
    static float room[2][3][PIXELS];
    struct picture *picture = level_floor();
    picture->halves = halves ? room : NULL;
    add_noise(picture, 17);
    struct outcome before = outcome_of(picture, 1);
    denoise(picture, CHOICE, 2);
    struct outcome after = outcome_of(picture, 1);
    print_message("%s: deviation %.4f -> %.4f, mean %.4f -> %.4f\n", halves ? "halves" : "one pass",
                  before.deviation, after.deviation, before.mean, after.mean);
    assert_true(before.deviation > 0.55);
    assert_true(after.deviation <
                0.06); /* 0.58 over the root of the pixels under a narrow strip's fit */
    assert_true(fabs(after.mean - before.mean) < 0.005);
    free(picture);
}

static void test_noise_falls_and_the_mean_stays(void **state)
{
    (void)state;
    expect_noise_to_fall(false);
    expect_noise_to_fall(true);
}

/* What is finer than a few pixels: the deviation of light from the mean of its neighbours two
 * pixels off. */
static double grain_of(const struct picture *picture)
{
    double sum = 0;
    int count = 0;
    for (int y = 2; y < HEIGHT - 2; y++)
        for (int x = 2; x < WIDTH - 2; x++, count++) {
            const float *at = &picture->light[1][y * WIDTH + x];
            double off =
                (double)(at[0] - 0.25f * (at[-2] + at[2] + at[-2 * WIDTH] + at[2 * WIDTH]));
            sum += off * off;
        }
    return sqrt(sum / count);
}

/* Of even light with independent noise, a mean over seeds: what chance lets pass for a narrow band
 * of signal. */
static double mean_grain(bool halves)
{
    static float room[2][3][PIXELS];
    double sum = 0;
    for (uint64_t seed = 0; seed < 8; seed++) {
        struct picture *picture = level_floor();
        picture->halves = halves ? room : NULL;
        add_noise(picture, 100 + seed);
        denoise(picture, CHOICE, 2);
        sum += grain_of(picture) / 8;
        free(picture);
    }
    return sum;
}

static void test_chance_leaves_no_grain(void **state)
{
    (void)state;
    double one = mean_grain(false), halves = mean_grain(true);
    print_message("grain of one pass %.5f, of halves %.5f\n", one, halves);
    assert_true(one < 0.01);
    assert_true(halves < 0.01);
}

/* Noise whose pixels have the mean of what 5x5 around them found on the same surface. */
static void add_shared_noise(struct picture *picture)
{
    static float noise[PIXELS];
    struct random random = {5};
    for (int i = 0; i < PIXELS; i++)
        noise[i] = random_between(&random, -1, 1);
    for (int i = 0; i < PIXELS; i++) {
        float sum = 0, count = 0;
        for (int y = i / WIDTH - 2; y <= i / WIDTH + 2; y++)
            for (int x = i % WIDTH - 2; x <= i % WIDTH + 2; x++)
                if (x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT &&
                    picture->position[2][y * WIDTH + x] == picture->position[2][i]) {
                    sum += noise[y * WIDTH + x];
                    count++;
                }
        for (int c = 0; c < 3; c++)
            picture->light[c][i] = 1 + sum / count;
    }
}

static void expect_shared_noise_to_fall(const char *where, struct picture *picture, double left)
{
    add_shared_noise(picture);
    double before = grain_of(picture);
    denoise(picture, CHOICE, 2);
    double after = grain_of(picture);
    print_message("grain of shared noise %s %.4f -> %.4f\n", where, before, after);
    assert_true(after < left * before);
    free(picture);
}

/* Where samples of gloss take the mean light of 5x5 pixels, noise is as wide. */
static void test_shared_noise_of_gloss_is_noise(void **state)
{
    (void)state;
    static float gloss[PIXELS];
    struct picture *picture = level_floor();
    for (int i = 0; i < PIXELS; i++)
        gloss[i] = 0.5f;
    picture->gloss = gloss;
    expect_shared_noise_to_fall("in gloss", picture, 0.1);
}

/* So it is where samples are taken at edges: strips of two pixels, every other one far above the
 * floor. */
static void test_shared_noise_at_edges_is_noise(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    for (int i = 0; i < PIXELS; i++)
        picture->position[2][i] = i % WIDTH % 4 < 2 ? 0 : 50;
    picture->edge_samples = 8;
    expect_shared_noise_to_fall("at edges", picture, 0.3);
}

/* An even floor under noise, with rows of three bright samples, of which one half has two. Returns
 * how far a pixel there is too bright afterwards, in the mean over seeds. */
static double left_of_bright_samples(void)
{
    enum { SEEDS = 6, APART = 25, COUNT = WIDTH / APART };
    static float room[2][3][PIXELS];
    double sum = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        struct picture *picture = level_floor();
        struct random random = {300 + seed};
        picture->halves = room;
        for (int i = 0; i < PIXELS; i++) {
            int x = i % WIDTH % APART - APART / 2;
            bool is_bright = i / WIDTH == HEIGHT / 2 && abs(x) <= 1;
            float even = random_between(&random, 0.8f, 1.2f) + (is_bright && x != 0 ? 1.5f : 0.0f);
            float odd = random_between(&random, 0.8f, 1.2f) + (is_bright && x == 0 ? 1.5f : 0.0f);
            for (int c = 0; c < 3; c++) {
                room[0][c][i] = even;
                room[1][c][i] = odd;
                picture->light[c][i] = 0.5f * (even + odd);
            }
        }
        denoise(picture, CHOICE, 2);
        for (int k = 0; k < COUNT; k++)
            sum += (double)picture->light[1][HEIGHT / 2 * WIDTH + k * APART + APART / 2] - 1;
        free(picture);
    }
    return sum / (SEEDS * COUNT);
}

static void test_bright_samples_leave_no_bumps(void **state)
{
    (void)state;
    double left = left_of_bright_samples();
    print_message("three bright samples: too bright by %.3f\n", left);
    assert_true(left < 0.1);
}

/* Pixels that stand alone, one in eleven of every sixth row. */
static bool stands_alone(int pixel)
{
    return pixel / WIDTH % 6 == 2 && pixel % WIDTH % 11 == 5;
}

/* Even light with noise, of which pixels that stand alone have three times as much or a quarter.
 * How much of that is left: 1 is all. */
static double left_of_single_pixels(const float *variance)
{
    enum { SEEDS = 8 };
    double sum = 0, count = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        struct random random = {500 + seed};
        struct picture *picture = level_floor();
        picture->variance = variance;
        for (int i = 0; i < PIXELS; i++) {
            float noisy = random_between(&random, 0.8f, 1.2f);
            float light = !stands_alone(i) ? noisy : i % 2 ? 3.0f : 0.25f;
            set_vector(picture->light, i, (ps_vec3){light, light, light});
        }
        denoise(picture, CHOICE, 2);
        for (int i = 0; i < PIXELS; i++)
            if (stands_alone(i)) {
                sum += ((double)picture->light[1][i] - 1) / (i % 2 ? 2 : -0.75);
                count++;
            }
        free(picture);
    }
    return sum / count;
}

/* A single pass cannot know that they are no noise, unless their variance says so. */
static void test_pixels_of_known_variance_stay(void **state)
{
    (void)state;
    static float small[PIXELS], large[PIXELS], none[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        small[i] = 0.01f * PS_PI * PS_PI; /* deviations of 0.1 and 1.2 of the light */
        large[i] = 1.44f * PS_PI * PS_PI;
    }
    double kept = left_of_single_pixels(small), lost = left_of_single_pixels(large);
    double unknown = left_of_single_pixels(none);
    print_message("of single pixels %.3f is left by a small variance, %.3f by a large one, %.3f "
                  "where it is not known\n",
                  kept, lost, unknown);
    assert_true(kept > 0.95);
    assert_true(fabs(lost) < 0.05);
    assert_true(fabs(unknown) < 0.05);
}

/* A disc of light ten pixels wide, as a caustic is: halves tell that it is no noise, a single pass
 * cannot know. */
static double lost_of_disc(float (*halves)[3][PIXELS])
{
    struct picture *picture = level_floor(), *truth = level_floor();
    picture->halves = halves;
    for (int i = 0; i < PIXELS; i++) {
        float far = hypotf((float)(i % WIDTH - 70), (float)(i / WIDTH - 12));
        for (int c = 0; c < 3; c++) {
            truth->light[c][i] = picture->light[c][i] = far < 5 ? 9 : 1;
            for (int half = 0; half < 2 && halves; half++)
                halves[half][c][i] = truth->light[c][i];
        }
    }
    denoise(picture, CHOICE, 2);
    double worst = worst_difference(picture, truth);
    free(picture);
    free(truth);
    return worst;
}

static void test_what_is_no_noise_stays(void **state)
{
    (void)state;
    static float room[2][3][PIXELS];
    double known = lost_of_disc(room), unknown = lost_of_disc(NULL);
    print_message("disc: off by %.3f with halves, %.3f without\n", known, unknown);
    assert_true(known < ROUNDING);
    assert_true(unknown > 0.1);
}

/* A disc of sun, whose border is a penumbra of few shadow rays: its inside is nothing that few
 * pixels found by chance. */
static void test_sun_beside_noise_stays(void **state)
{
    (void)state;
    static float room[2][3][PIXELS];
    struct picture *picture = level_floor();
    struct random random = {5};
    double worst = 0;
    picture->halves = room;
    for (int i = 0; i < PIXELS; i++) {
        float far = hypotf((float)(i % WIDTH - 70), (float)(i / WIDTH - 12));
        float lit = ps_min(ps_max(6.0f - far, 0.0f) / 2.0f, 1.0f); /* from 4 to 6 pixels */
        for (int half = 0; half < 2; half++) {
            int met = (random_unit(&random) < lit) + (random_unit(&random) < lit);
            for (int c = 0; c < 3; c++)
                room[half][c][i] = 0.1f + 5.0f * (float)met;
        }
        for (int c = 0; c < 3; c++)
            picture->light[c][i] = 0.5f * (room[0][c][i] + room[1][c][i]);
    }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++)
        if (hypotf((float)(i % WIDTH - 70), (float)(i / WIDTH - 12)) < 3.5f)
            worst = fmax(worst, fabs((double)picture->light[0][i] - 10.1));
    print_message("inside of the disc: off by %.3f of 10\n", worst);
    assert_true(worst < 1.5);
    free(picture);
}

/* One pixel as bright as a thousand: what is left of it is no speckle, and nothing of its light is
 * lost. */
static void test_outliers_spread(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    double sum = 0;
    float most = 0;
    picture->light[0][12 * WIDTH + 75] = 1000;
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++) {
        sum += (double)picture->light[0][i];
        most = fmaxf(most, picture->light[0][i]);
    }
    print_message("outlier of 1000: %.2f at most, %.4f of the light\n", (double)most,
                  sum / (PIXELS + 999));
    assert_true(most < 3);
    assert_true(fabs(sum / (PIXELS + 999) - 1) < 0.02);
    free(picture);
}

/* Five pixels within three of each other, for which the halves of the samples found 32 and 8. */
static float most_of_five(float gloss_share)
{
    static float room[2][3][PIXELS], gloss[PIXELS];
    static const int found[5] = {0, WIDTH + 2, 2 * WIDTH - 1, 1 - 2 * WIDTH, -WIDTH - 2};
    struct picture *picture = level_floor();
    float most = 0;
    picture->halves = room;
    picture->gloss = gloss;
    for (int i = 0; i < PIXELS; i++) {
        gloss[i] = gloss_share;
        for (int c = 0; c < 3; c++)
            room[0][c][i] = room[1][c][i] = picture->light[c][i];
    }
    for (int k = 0; k < 5; k++)
        for (int c = 0; c < 3; c++) {
            int i = 12 * WIDTH + 75 + found[k];
            room[k % 2][c][i] = 32;
            room[1 - k % 2][c][i] = 8;
            picture->light[c][i] = 20;
        }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++)
        most = fmaxf(most, picture->light[0][i]);
    free(picture);
    return most;
}

/* Chance has more to say in gloss: what may be a small light elsewhere is none there. */
static void test_outliers_of_gloss_spread(void **state)
{
    (void)state;
    float in_gloss = most_of_five(0.5f), elsewhere = most_of_five(0.0f);
    print_message("five outliers of 20: %.2f at most in gloss, %.2f elsewhere\n", (double)in_gloss,
                  (double)elsewhere);
    assert_true(in_gloss < 2);
    assert_true(elsewhere > 2);
}

/* A pixel for which both halves found 4, and another six pixels away for which one half found
 * `found` and the other 1. Returns what is left of the first. */
static float left_of_pixel(float found)
{
    static float room[2][3][PIXELS];
    struct picture *picture = level_floor();
    int bright = 12 * WIDTH + 75, other = bright + 6;
    picture->halves = room;
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            room[0][c][i] = i == bright ? 4.0f : i == other ? found : 1.0f;
            room[1][c][i] = i == bright ? 4.0f : 1.0f;
            picture->light[c][i] = 0.5f * (room[0][c][i] + room[1][c][i]);
        }
    denoise(picture, CHOICE, 2);
    float left = picture->light[0][bright];
    free(picture);
    return left;
}

/* Two halves may find the same by chance, where others found as much in one alone. */
static void test_what_both_halves_find_may_be_chance(void **state)
{
    (void)state;
    float sure = left_of_pixel(1.0f), chance = left_of_pixel(7.0f);
    print_message("a pixel of 4 for both halves: %.2f, beside noise %.2f\n", (double)sure,
                  (double)chance);
    assert_true(sure > 3.9f);
    assert_true(chance < 1.8f);
}

/* --- thin things --- */

/* Gives the pixels whose place is 3 of every `period` noise of a deviation of 0.29, which the rest
 * of the floor has not, and a height or a slant that no other pixel near by has. Returns the
 * deviation that is left of it. */
static double deviation_left(int period, bool slanted)
{
    struct picture *picture = level_floor();
    struct random random = {9};
    double sum = 0;
    int count = 0;
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH % period == 3) {
            float noisy = random_between(&random, 0.5f, 1.5f);
            float angle = random_between(&random, 0, 2 * PS_PI);
            ps_vec3 slant = {0.64f * cosf(angle), 0.64f * sinf(angle), 0.77f};
            set_vector(picture->light, i, (ps_vec3){noisy, noisy, noisy});
            if (slanted)
                set_vector(picture->normal, i, slant);
            else
                picture->position[2][i] = 50;
        }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH % period == 3) {
            double off = (double)picture->light[1][i] - 1;
            sum += off * off;
            count++;
        }
    free(picture);
    return sqrt(sum / count);
}

static void test_noise_of_thin_things_falls(void **state)
{
    (void)state;
    double threads = deviation_left(1000, false), odd = deviation_left(9, true);
    print_message("of 0.29: on a thread %.4f, on pixels unlike all others %.4f\n", threads, odd);
    assert_true(threads < 0.15);
    assert_true(odd < 0.15);
}

#define BEAM 11 /* the first of its two rows */
#define PATCH 8 /* pixels of a patch of light, and of a shadow */

static float light_of_beam(int x)
{
    return x / PATCH % 2 ? 2.0f : 0.5f;
}

/* A beam before a noisy floor, half of it in the sun, half in shadow. Returns how far it is off, in
 * the mean. */
static double error_of_beam(uint64_t seed)
{
    struct picture *picture = level_floor();
    struct random random = {seed};
    double sum = 0;
    add_noise(picture, seed);
    for (int i = BEAM * WIDTH; i < (BEAM + 2) * WIDTH; i++) {
        float light = light_of_beam(i % WIDTH) * random_between(&random, 0.7f, 1.3f);
        set_vector(picture->light, i, (ps_vec3){light, light, light});
        picture->position[2][i] = 50;
    }
    denoise(picture, CHOICE, 2);
    for (int i = BEAM * WIDTH; i < (BEAM + 2) * WIDTH; i++)
        sum += fabs((double)(picture->light[1][i] - light_of_beam(i % WIDTH)));
    free(picture);
    return sum / (2 * WIDTH);
}

/* The wall behind, whose narrow bands are noise, does not rule what is kept of it. */
static void test_light_of_thin_things_stays(void **state)
{
    (void)state;
    double error = 0;
    for (uint64_t seed = 0; seed < 8; seed++)
        error += error_of_beam(200 + seed) / 8;
    print_message("a beam, half in the sun: off by %.3f\n", error);
    assert_true(error < 0.45);
}

#define CAUSTIC_X 70
#define CAUSTIC_Y 20
#define CAUSTIC_RADIUS 9.0f

/* In pixels; negative inside. */
static float distance_to_caustic(int pixel)
{
    float x = (float)(pixel % WIDTH - CAUSTIC_X), y = (float)(pixel / WIDTH - CAUSTIC_Y);
    return hypotf(x, y) - CAUSTIC_RADIUS;
}

/* Smooth, and 32 times as bright as the noisy floor around. */
static float light_of_caustic(float distance)
{
    float t = fminf(fmaxf(0.5f - distance / 6.0f, 0.0f), 1.0f);
    return 3.2f * t * t * (3 - 2 * t);
}

/* Wide fits are too low beside it, and what pixels differ from them by is not their noise. */
static void test_no_dark_rim_beside_a_caustic(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    struct random random = {31};
    float darkest = 1;
    for (int i = 0; i < PIXELS; i++) {
        float noisy = 0.1f * random_between(&random, 0.3f, 1.7f);
        float light = light_of_caustic(distance_to_caustic(i)) + noisy;
        set_vector(picture->light, i, (ps_vec3){light, light, light});
    }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++)
        if (distance_to_caustic(i) > 3.0f)
            darkest = fminf(darkest, picture->light[1][i]);
    free(picture);
    print_message("beside a caustic: %.3f at least\n", (double)darkest);
    assert_true(darkest > 0.05f);
}

/* A first fit says nothing of a caustic of six pixels, and it is no outlier all the same. */
static void test_a_small_caustic_stays(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    struct random random = {1};
    double error = 0, all = 0;
    float truth[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        float x = (float)(i % WIDTH - CAUSTIC_X), y = (float)(i / WIDTH - HEIGHT / 2);
        float caustic = 3.2f * fminf(fmaxf(2 - 0.5f * hypotf(x, y), 0), 1);
        float noise = random_between(&random, -1, 1);
        float light = 0.1f * (1 + 0.7f * noise) + caustic * (1 + 0.1f * noise);
        truth[i] = caustic + 0.1f;
        set_vector(picture->light, i, (ps_vec3){light, light, light});
    }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++)
        if (truth[i] > 1.6f) {
            error += pow((double)(picture->light[1][i] - truth[i]), 2);
            all += pow((double)truth[i], 2);
        }
    free(picture);
    print_message("a small caustic: off by %.1f %%\n", 100 * sqrt(error / all));
    assert_true(error < 0.5 * 0.5 * all);
}

#define STRIP 8 /* rows of a floor below a wall */

/* Light of a caustic over pi, in the last rows of the strip. */
static float light_at_border(int pixel)
{
    float across = 1.5f - fabsf((float)(pixel % WIDTH - CAUSTIC_X)) / 16.0f;
    float down = 0.5f * (float)(pixel / WIDTH - (HEIGHT - 3));
    return 6.4f * fminf(fmaxf(across, 0), 1) * fminf(fmaxf(down, 0), 1);
}

/* Fits to the rows above it fall below zero. That must not hide what is signal near by. */
static void test_a_caustic_at_the_border_stays(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    struct random random = {1};
    double error = 0, all = 0;
    for (int i = 0; i < PIXELS; i++) {
        float noise = random_between(&random, -1, 1), noisy = 0.1f * (1 + 0.7f * noise);
        bool wall = i / WIDTH < HEIGHT - STRIP;
        float light = wall ? noisy : noisy + (1 + 0.1f * noise) * light_at_border(i);
        set_vector(picture->light, i, (ps_vec3){light, light, light});
        if (wall)
            set_vector(picture->normal, i, (ps_vec3){0, 1, 0});
    }
    denoise(picture, CHOICE, 2);
    for (int i = 0; i < PIXELS; i++) {
        double truth = 0.1 + (double)light_at_border(i), off = (double)picture->light[1][i] - truth;
        if (truth > 3.2) {
            error += off * off;
            all += truth * truth;
        }
    }
    free(picture);
    print_message("a caustic at the border: off by %.1f %%\n", 100 * sqrt(error / all));
    assert_true(error < 0.15 * 0.15 * all);
}

/* --- pixels that say nothing --- */

static void test_what_is_no_surface_stays(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    int sky = 5 * WIDTH + 30, black = 10 * WIDTH + 70, red = 12 * WIDTH + 71;
    picture->depth[sky] = INFINITY;
    for (int c = 0; c < 3; c++) {
        picture->normal[c][sky] = 0;
        picture->light[c][sky] = 1000;
        picture->albedo[c][black] = 0;
        picture->light[c][black] = 1000;
    }
    /* A channel without albedo says nothing about the light, and gets none. */
    picture->albedo[1][red] = 0;
    picture->light[1][red] = 0;
    denoise(picture, CHOICE, 1);
    for (int i = 0; i < PIXELS; i++) {
        float expected = i == sky || i == black ? 1000 : i == red ? 0 : 1;
        assert_true(fabsf(picture->light[1][i] - expected) <= ROUNDING);
    }
    free(picture);
}

static void test_nothing_seen_at_all(void **state)
{
    (void)state;
    struct picture *before = level_floor(), *after = level_floor();
    for (int i = 0; i < PIXELS; i++)
        before->depth[i] = after->depth[i] = INFINITY;
    denoise(after, CHOICE, 2);
    assert_memory_equal(after, before, sizeof *before);
    free(before);
    free(after);
}

/* --- how it runs --- */

/* Light of its own on one wild surface; in halves where there is room for them. */
static struct picture *lit_picture(uint64_t seed, float (*halves)[3][PIXELS])
{
    struct random random = {seed};
    struct picture *picture = wild_picture(17);
    picture->halves = halves;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) {
            bool seen = !isinf(picture->depth[i]);
            float even = seen ? picture->albedo[c][i] * random_between(&random, 0.5f, 3.0f) : 0;
            float odd = seen ? picture->albedo[c][i] * random_between(&random, 0.5f, 3.0f) : 0;
            picture->light[c][i] = 0.5f * (even + odd);
            if (halves) {
                halves[0][c][i] = even;
                halves[1][c][i] = odd;
            }
        }
    return picture;
}

/* Some of three images at a time, of which the first has no halves. */
static void expect_same_together(uint32_t first, uint32_t count)
{
    static float halves[3][2][3][PIXELS];
    struct picture *together[3], *alone[3];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t number = first + i;
        together[i] = lit_picture(number, number > 0 ? halves[number] : NULL);
        alone[i] = lit_picture(number, number > 0 ? halves[number] : NULL);
        denoise(alone[i], CHOICE, 2);
    }
    denoise_together(together, count, CHOICE, 2);
    for (uint32_t i = 0; i < count; i++) {
        assert_memory_equal(together[i]->light, alone[i]->light, sizeof alone[i]->light);
        free(together[i]);
        free(alone[i]);
    }
}

static void test_images_together_are_as_alone(void **state)
{
    (void)state;
    expect_same_together(0, 3);
    expect_same_together(0, 2);
    expect_same_together(1, 2);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    struct picture *one = wild_picture(5), *three = wild_picture(5);
    denoise(one, CHOICE, 1);
    denoise(three, CHOICE, 3);
    assert_memory_equal(one, three, sizeof *one);
    free(one);
    free(three);
}

static void test_stops_when_cancelled(void **state)
{
    (void)state;
    struct picture *picture = wild_picture(5);
    denoise_cancelled(picture, CHOICE, 2);
    free(picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes_stay_under_any_colour),
        cmocka_unit_test(test_constant_light_stays_on_wild_surfaces),
        cmocka_unit_test(test_edges_stop_it),
        cmocka_unit_test(test_thin_things_keep_their_light),
        cmocka_unit_test(test_noise_falls_and_the_mean_stays),
        cmocka_unit_test(test_chance_leaves_no_grain),
        cmocka_unit_test(test_shared_noise_of_gloss_is_noise),
        cmocka_unit_test(test_shared_noise_at_edges_is_noise),
        cmocka_unit_test(test_bright_samples_leave_no_bumps),
        cmocka_unit_test(test_pixels_of_known_variance_stay),
        cmocka_unit_test(test_what_is_no_noise_stays),
        cmocka_unit_test(test_sun_beside_noise_stays),
        cmocka_unit_test(test_outliers_spread),
        cmocka_unit_test(test_outliers_of_gloss_spread),
        cmocka_unit_test(test_what_both_halves_find_may_be_chance),
        cmocka_unit_test(test_noise_of_thin_things_falls),
        cmocka_unit_test(test_light_of_thin_things_stays),
        cmocka_unit_test(test_no_dark_rim_beside_a_caustic),
        cmocka_unit_test(test_a_small_caustic_stays),
        cmocka_unit_test(test_a_caustic_at_the_border_stays),
        cmocka_unit_test(test_what_is_no_surface_stays),
        cmocka_unit_test(test_nothing_seen_at_all),
        cmocka_unit_test(test_images_together_are_as_alone),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_stops_when_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
