/* test_merged_weight.c: in the weight a merged photon counts as often as those that it stands for
 * (Hoet 2014, section 3.2.1). Two beams as thin as a ray meet a mirror and are spots on a wall that
 * overlap. The photons of a beam coincide, so merging them must change nothing, whatever the
 * normalization.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* Mirrored by the floor at 45 degrees, both go up to the wall; the red one has nine times the
 * paths. */
static const char two_beams[] =
    "psd: 1\n"
    "camera: {location: [0.1, 1.2, 2], look_at: [0.1, 1.2, -1], angle: 30}\n"
    "image: {width: 64, height: 48}\n"
    "materials: {wall: {diffuse: 0.8}, mirror: {mirror: 1}}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 1, 1.2], point_at: [0, 0, 0.2], radius: 0.03,"
    " falloff: 0.03, intensity: [9e9, 0, 1e9]}\n"
    "  - spotlight: {location: [0.2, 1, 1.2], point_at: [0.2, 0, 0.2], radius: 0.03,"
    " falloff: 0.03, intensity: [0, 3e8, 1e8]}\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, 0], [-1, 0, 0]], material: mirror}\n"
    "  - quad: {corners: [[-2, 0, -1], [2, 0, -1], [2, 3, -1], [-2, 3, -1]], material: wall}\n";

static struct rendering render(const char *stratification, const char *normalization)
{
    const char *const choices[] = {"injection=photon:count=1000",
                                   "visibility=none:radius=0.5,bandwidth_scale=0,max_merge_scale=1",
                                   stratification, normalization, NULL};
    return render_text(two_beams, 2, choices);
}

#define MERGED "stratification=grid:resolution=64,threshold=1"

/* But for pixels at the rim of a spot, since beams have some width. */
static void expect_same(const struct image *a, const struct image *b, const char *channel)
{
    const float *x = image_channel(a, channel), *y = image_channel(b, channel);
    size_t lit = 0, apart = 0, n = a->width * a->height;
    float largest = 0.0f;
    for (size_t i = 0; i < n; i++) {
        largest = fmaxf(largest, y[i]);
        lit += y[i] > 0.0f;
    }
    assert_true(lit > n / 20);
    for (size_t i = 0; i < n; i++)
        apart += fabsf(x[i] - y[i]) > 0.005f * largest;
    print_message("%s: %zu pixels differ of %zu lit\n", channel, apart, lit);
    assert_true(apart <= lit / 50);
}

static void expect_no_change(const char *normalization)
{
    static const char *const channels[] = {"indirect.R", "indirect.G", "indirect.B", "weight"};
    struct rendering plain = render("stratification=none", normalization);
    struct rendering merged = render(MERGED, normalization);
    double left = statistics_counter(&merged.statistics, "photons");
    print_message("%s: %.0f photons of %.0f\n", normalization, left,
                  statistics_counter(&plain.statistics, "photons"));
    assert_true(left < 0.5 * statistics_counter(&plain.statistics, "photons"));
    for (size_t i = 0; i < sizeof channels / sizeof channels[0]; i++)
        expect_same(&merged.image, &plain.image, channels[i]);
    rendering_release(&plain);
    rendering_release(&merged);
}

static void test_photons_that_coincide(void **state)
{
    (void)state;
    expect_no_change("normalization=weight:exposure=1");
    expect_no_change("normalization=weight");
    expect_no_change("normalization=intensity:exposure=1");
    expect_no_change("normalization=density");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_photons_that_coincide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
