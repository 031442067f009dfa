/* test_portals.c: rays of the sky that go through windows (direct/portals.h), and windows that rays
 * tell of (importance/lit_rectangles.h).
 */
#include "direct/portals.h"

#include "importance/lit_rectangles.h"
#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define SAMPLES 400000

static const ps_vec3 low = {0, 0, 0}, high = {4, 3, 5};
static const ps_vec3 inside = {1.2f, 0.1f, 2}, outside = {1.2f, 3.5f, 2};
static const ps_vec3 no_normal = {0, 0, 0}, up = {0, 1, 0}, tilted = {-0.6f, 0, 0.8f};

/* A window at z = 5, of a quarter of that wall, and a small one at x = 0. */
static const struct portal_bins large = {{2, true}, {16, 16}, {48, 48}};
static const struct portal_bins small = {{0, false}, {8, 40}, {12, 48}};

static struct portals portals;

static int make_portals(void **state)
{
    (void)state;
    portals_begin(&portals, low, high);
    portals_add(&portals, &large);
    portals_add(&portals, &small);
    portals.visibility[portals_cell(&portals, inside)][1] = 0.3f;
    return 0;
}

static struct light sky_of(const struct sky_picture *picture)
{
    const struct light_description description = {
        .kind = LIGHT_SKY, .amount = {2, 1, 0.5f}, .unit = UNIT_RADIANCE};
    return light_of(&description, picture);
}

/* A dim sky with a bright patch. */
static struct sky_picture spotted(void)
{
    enum { WIDTH = 24, HEIGHT = 12 };
    static float rgb[WIDTH * HEIGHT][3];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        bool is_patch = i % WIDTH >= 5 && i % WIDTH < 9 && i / WIDTH >= 3 && i / WIDTH < 6;
        for (int k = 0; k < 3; k++)
            rgb[i][k] = is_patch ? 12.0f : 0.5f;
    }
    return (struct sky_picture){WIDTH, HEIGHT, (const float(*)[3])rgb};
}

static struct light_sample sample_at(const struct light *sky, ps_vec3 position, ps_vec3 normal,
                                     struct random *random)
{
    struct light_sample sample = {.pdf = 0.0f};
    const float numbers[1][2] = {{random_unit(random), random_unit(random)}};
    portals_sample(&portals, sky, &position, &normal, numbers, 1, &sample);
    return sample;
}

/* --- densities --- */

/* Directions come as often as their pdf says if its inverse has the whole sphere as its mean. */
static void expect_density(const struct light *sky)
{
    struct random random = {1};
    double sphere = 0.0, through = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        struct light_sample sample = sample_at(sky, inside, no_normal, &random);
        float pdf = portals_pdf(&portals, sky, inside, sample.direction);
        struct portal_exit exit = portals_exit(&portals, inside, sample.direction);
        assert_true(sample.pdf > 0.0f);
        expect_close((double)sample.pdf, (double)pdf, 1e-3);
        sphere += 1.0 / (double)pdf;
        through += exit.face.axis == 2 && exit.face.high && exit.bin[0] >= large.first[0] &&
                   exit.bin[0] < large.end[0] && exit.bin[1] >= large.first[1] &&
                   exit.bin[1] < large.end[1];
    }
    expect_close(sphere / SAMPLES, 4.0 * PI, 0.02);
    assert_true(through > 0.3 * SAMPLES);
}

static void test_directions_have_their_density(void **state)
{
    (void)state;
    struct sky_picture picture = spotted();
    struct light even = sky_of(NULL), uneven = sky_of(&picture);
    expect_density(&even);
    expect_density(&uneven);
    light_release(&even);
    light_release(&uneven);
}

static double irradiance_at(const struct light *sky, ps_vec3 position, ps_vec3 normal)
{
    struct random random = {2};
    double sum = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        struct light_sample sample = sample_at(sky, position, normal, &random);
        float cosine = ps_dot(sample.direction, normal);
        if (sample.pdf > 0.0f && cosine > 0.0f)
            sum += (double)(sample.weight.r * cosine);
    }
    return sum / SAMPLES;
}

static void test_irradiance_is_that_of_the_sky(void **state)
{
    (void)state;
    struct sky_picture picture = spotted();
    struct light even = sky_of(NULL), uneven = sky_of(&picture);
    expect_close(irradiance_at(&even, inside, up), 2.0 * PI, 0.01);
    expect_close(irradiance_at(&even, inside, tilted), 2.0 * PI, 0.01);
    expect_close(irradiance_at(&even, outside, up), 2.0 * PI, 0.01);
    expect_close(irradiance_at(&uneven, inside, tilted),
                 irradiance_by_samples(&uneven, inside, tilted), 0.02);
    light_release(&even);
    light_release(&uneven);
}

/* Behind a surface there is no portal, so all rays go by the sky. */
static void test_no_portal_behind_a_surface(void **state)
{
    (void)state;
    const ps_vec3 corner = {0.01f, 1.5f, 4.99f};
    const float numbers[2] = {0.5f, 0.5f};
    ps_vec3 direction;
    portals_begin(&portals, low, high);
    portals_add(&portals, &(struct portal_bins){{2, true}, {56, 16}, {60, 48}});
    assert_false(portals_choose(&portals, corner, (ps_vec3){-1, 0, 0}, numbers, &direction));
    assert_true(portals_choose(&portals, corner, (ps_vec3){1, 0, 0}, numbers, &direction));
    assert_false(portals_know(&portals, outside));
}

/* --- windows --- */

/* `times` rays through each bin of a rectangle. */
static size_t count_rays(struct exit_counts *counts, const struct portal_bins *bins, uint32_t times)
{
    size_t rays = 0;
    for (uint32_t y = bins->first[1]; y < bins->end[1]; y++)
        for (uint32_t x = bins->first[0]; x < bins->end[0]; x++)
            for (uint32_t i = 0; i < times; i++, rays++)
                exit_counts_add(counts, &(struct portal_exit){.face = bins->face, .bin = {x, y}});
    return rays;
}

/* A rectangle and one bin around it. */
static struct portal_bins widened(struct portal_bins bins)
{
    for (int k = 0; k < 2; k++) {
        bins.first[k]--;
        bins.end[k]++;
    }
    return bins;
}

static float area_of(const struct portals *found, const struct portal_bins *bins)
{
    float size[3] = {found->high.x - found->low.x, found->high.y - found->low.y,
                     found->high.z - found->low.z};
    float area = 1.0f;
    for (uint32_t k = 0; k < 2; k++)
        area *= size[(bins->face.axis + 1 + k) % 3] * (float)(bins->end[k] - bins->first[k]) /
                PORTAL_BINS;
    return area;
}

/* The bins of `windows`, each once, and no others. */
static void expect_windows(const struct portals *found, const struct portal_bins *windows,
                           size_t count)
{
    float all = 0.0f, wanted = 0.0f;
    for (size_t i = 0; i < found->count; i++)
        all += found->area[i];
    for (size_t i = 0; i < count; i++) {
        const struct portal_bins *bins = &windows[i];
        wanted += area_of(found, bins);
        for (uint32_t y = bins->first[1]; y < bins->end[1]; y++)
            for (uint32_t x = bins->first[0]; x < bins->end[0]; x++)
                assert_true(found->portal_of[bins->face.axis][bins->face.high][y][x] > 0);
    }
    assert_float_equal(all, wanted, 1e-4f * wanted);
}

/* Each with the bins around it, in parts. */
static void test_windows_are_found(void **state)
{
    (void)state;
    struct exit_counts counts = {{{{{0}}}}};
    const struct portal_bins windows[2] = {widened(large), widened(small)};
    size_t rays = count_rays(&counts, &large, 4) + count_rays(&counts, &small, 4);
    struct portals found;
    portals_begin(&found, low, high);
    assert_true(lit_rectangles(&counts, rays, &found));
    assert_true(found.count > 2 && found.count <= PORTALS_MOST);
    expect_windows(&found, windows, 2);
}

/* Of few rays, bins are taken together: the window has no holes. */
static void test_few_rays_make_no_holes(void **state)
{
    (void)state;
    enum { RAYS = 64, STEP = PORTAL_BINS / 8 };
    struct exit_counts counts = {{{{{0}}}}};
    struct random random = {3};
    struct portals found;
    for (int i = 0; i < RAYS; i++)
        exit_counts_add(&counts, &(struct portal_exit){
                                     .face = large.face,
                                     .bin = {16 + (uint32_t)(32 * random_unit(&random)),
                                             16 + (uint32_t)(32 * random_unit(&random))},
                                 });
    const struct portal_bins window = {large.face, {16 - STEP, 16 - STEP}, {48 + STEP, 48 + STEP}};
    portals_begin(&found, low, high);
    assert_true(lit_rectangles(&counts, RAYS, &found));
    expect_windows(&found, &window, 1);
}

/* Here and there a ray, and windows nowhere. */
static void test_stray_rays(void **state)
{
    (void)state;
    enum { BLOCK = PORTAL_BINS / 4 };
    struct exit_counts counts = {{{{{0}}}}};
    struct portals found;
    size_t rays = 0;
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t block = 0; block < 16; block++) {
            uint32_t x = block % 4 * BLOCK, y = block / 4 * BLOCK;
            const struct portal_bins bin = {{face / 2, face % 2 != 0}, {x, y}, {x + 1, y + 1}};
            rays += count_rays(&counts, &bin, 3);
        }
    portals_begin(&found, low, high);
    assert_false(lit_rectangles(&counts, rays, &found));
    assert_int_equal(found.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_directions_have_their_density, make_portals),
        cmocka_unit_test_setup(test_irradiance_is_that_of_the_sky, make_portals),
        cmocka_unit_test(test_no_portal_behind_a_surface),
        cmocka_unit_test(test_windows_are_found),
        cmocka_unit_test(test_few_rays_make_no_holes),
        cmocka_unit_test(test_stray_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
