/* test_microfacet.c: the GGX reflector: its sampling against its density, its energy, its
 * symmetry. */
#include "scene/microfacet.h"
#include "support/chi_squared.h"
#include "support/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static const float roughnesses[] = {0.1f, 0.3f, 0.6f, 1.0f};
static const float cosines[] = {0.1f, 0.4f, 0.8f, 1.0f};

static ps_vec3 direction_of(double cosine, double phi)
{
    double sine = sqrt(fmax(0, 1 - cosine * cosine));
    return (ps_vec3){(float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine};
}

/* --- sampling ------------------------------------------------------------------------------- */

#define RINGS 20
#define SECTORS 24
#define FINE 24 /* points of the quadrature along each side of a bin */
#define SAMPLES 200000

/* Puts bins that expect too few together. */
static size_t merge_small(double *observed, double *expected, size_t n)
{
    size_t count = 0;
    double seen = 0, wanted = 0;
    for (size_t i = 0; i < n; i++) {
        seen += observed[i];
        wanted += expected[i];
        if (wanted < 20 && i + 1 < n)
            continue;
        observed[count] = seen;
        expected[count++] = wanted;
        seen = wanted = 0;
    }
    if (count > 1 && expected[count - 1] < 20) {
        expected[count - 2] += expected[count - 1];
        observed[count - 2] += observed[count - 1];
        count--;
    }
    return count;
}

/* Bins over the upper hemisphere, even in cosine and angle, and one for what goes below. */
static size_t bin_of(ps_vec3 w)
{
    if (!(w.z > 0.0f))
        return RINGS * SECTORS;
    int ring = (int)fminf(w.z * RINGS, RINGS - 1);
    double turn = atan2((double)w.y, (double)w.x) / (2 * (double)PS_PI) + 0.5;
    int sector = (int)fmin(turn * SECTORS, SECTORS - 1);
    return (size_t)(ring * SECTORS + sector);
}

static double expected_share(float roughness, ps_vec3 out, int ring, int sector)
{
    double sum = 0;
    for (int i = 0; i < FINE; i++)
        for (int k = 0; k < FINE; k++) {
            double cosine = (ring + (i + 0.5) / FINE) / RINGS;
            double turn = (sector + (k + 0.5) / FINE) / SECTORS - 0.5;
            sum += (double)microfacet_pdf(roughness, out,
                                          direction_of(cosine, turn * 2 * (double)PS_PI));
        }
    return sum / (FINE * FINE) * 2 * (double)PS_PI / (RINGS * SECTORS);
}

static void expect_sampled_as_said(float roughness, float cosine)
{
    double observed[RINGS * SECTORS + 1] = {0}, expected[RINGS * SECTORS + 1], sum = 0;
    ps_vec3 out = direction_of((double)cosine, 0.7);
    struct random random = {17};
    for (int i = 0; i < SAMPLES; i++)
        observed[bin_of(
            microfacet_sample(roughness, out, random_unit(&random), random_unit(&random)))]++;
    for (int i = 0; i < RINGS * SECTORS; i++) {
        expected[i] = SAMPLES * expected_share(roughness, out, i / SECTORS, i % SECTORS);
        sum += expected[i];
    }
    expected[RINGS * SECTORS] = fmax(0, SAMPLES - sum);
    size_t bins = merge_small(observed, expected, RINGS * SECTORS + 1);
    double probability = chi_squared_probability(observed, expected, bins);
    if (!(probability > 1e-4))
        fail_msg("roughness %g, cosine %g: probability %g", (double)roughness, (double)cosine,
                 probability);
}

static void test_sampling_follows_the_density(void **state)
{
    (void)state;
    for (size_t i = 1; i < 4; i++) /* smoother ones are narrower than the bins */
        for (size_t k = 0; k < 4; k++)
            expect_sampled_as_said(roughnesses[i], cosines[k]);
}

/* --- energy ----------------------------------------------------------------------------------- */

static double mean_weight(const struct microfacet_table *table, float roughness, float f0,
                          float cosine)
{
    ps_vec3 out = direction_of((double)cosine, 0.3);
    ps_rgb color = {f0, f0, f0};
    struct random random = {3};
    double sum = 0;
    for (int i = 0; i < SAMPLES / 4; i++) {
        ps_vec3 in = microfacet_sample(roughness, out, random_unit(&random), random_unit(&random));
        sum += (double)microfacet_weight(roughness, color, out, in).r;
    }
    return sum / (SAMPLES / 4) * (double)microfacet_compensation(table, color, roughness, cosine).r;
}

static void test_white_metal_reflects_all(void **state)
{
    (void)state;
    struct microfacet_table *table = calloc(1, sizeof *table);
    microfacet_tabulate(table, 0.0f, 1.0f);
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 4; k++) {
            double albedo = mean_weight(table, roughnesses[i], 1.0f, cosines[k]);
            if (!(fabs(albedo - 1) < 0.01))
                fail_msg("roughness %g, cosine %g: %g", (double)roughnesses[i], (double)cosines[k],
                         albedo);
        }
    free(table);
}

static void test_albedo_is_that_of_the_samples(void **state)
{
    (void)state;
    struct microfacet_table *table = calloc(1, sizeof *table);
    microfacet_tabulate(table, 0.0f, 1.0f);
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 4; k++) {
            double sampled = mean_weight(table, roughnesses[i], 0.2f, cosines[k]);
            double said = (double)microfacet_albedo(table, (ps_rgb){0.2f, 0.2f, 0.2f},
                                                    roughnesses[i], cosines[k])
                              .r;
            if (!(fabs(sampled - said) < 0.01))
                fail_msg("roughness %g, cosine %g: sampled %g, said %g", (double)roughnesses[i],
                         (double)cosines[k], sampled, said);
        }
    free(table);
}

/* f(o, i) = f(i, o), without the factor that depends on the eye. */
static void test_single_bounces_are_symmetric(void **state)
{
    (void)state;
    struct random random = {5};
    for (int i = 0; i < 1000; i++) {
        ps_vec3 a = direction_of(0.05 + 0.95 * (double)random_unit(&random),
                                 6 * (double)random_unit(&random));
        ps_vec3 b = direction_of(0.05 + 0.95 * (double)random_unit(&random),
                                 6 * (double)random_unit(&random));
        ps_rgb f0 = {0.3f, 0.3f, 0.3f};
        float there = microfacet_reflect(0.5f, f0, a, b).r / b.z;
        float back = microfacet_reflect(0.5f, f0, b, a).r / a.z;
        assert_true(fabsf(there - back) <= 1e-4f * fmaxf(there, back) + 1e-7f);
    }
}

/* Rows are filled where they are looked up, and are those of the whole table. */
static void test_rows_are_filled_where_they_are_needed(void **state)
{
    (void)state;
    struct microfacet_table *whole = calloc(1, sizeof *whole), *some = calloc(1, sizeof *some);
    microfacet_tabulate(whole, 0.0f, 1.0f);
    microfacet_tabulate(some, 0.4f, 0.4f);
    microfacet_tabulate(some, 1.0f, 1.0f);
    int known = 0;
    for (int row = 0; row < MICROFACET_TABLE_SIZE; row++) {
        assert_true(whole->is_known[row]);
        known += some->is_known[row];
        if (some->is_known[row])
            assert_memory_equal(some->scale[row], whole->scale[row], sizeof whole->scale[row]);
    }
    assert_int_equal(known, 4);
    const ps_rgb white = {1, 1, 1};
    assert_true(microfacet_albedo(some, white, 0.4f, 0.5f).g ==
                microfacet_albedo(whole, white, 0.4f, 0.5f).g);
    assert_true(microfacet_albedo(some, white, 1.0f, 0.5f).g ==
                microfacet_albedo(whole, white, 1.0f, 0.5f).g);
    free(whole);
    free(some);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sampling_follows_the_density),
        cmocka_unit_test(test_white_metal_reflects_all),
        cmocka_unit_test(test_albedo_is_that_of_the_samples),
        cmocka_unit_test(test_rows_are_filled_where_they_are_needed),
        cmocka_unit_test(test_single_bounces_are_symmetric),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
