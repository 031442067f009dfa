/* test_guide.c: rays drawn where those before them found light
 * (plugins/estimator/shared/guide.h). */
#include "plugins/estimator/shared/guide.h"

#include "support/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define RAYS 20000

static const ps_vec3 up = {0, 0, 1};

/* From a part of the hemisphere. */
static float light_of(ps_vec3 direction)
{
    return direction.x > 0.5f && direction.z > 0.5f ? 10.0f * direction.x : 0.0f;
}

static void learn_facing(ps_vec3 normal, struct guide *guide, struct random *random, size_t rays)
{
    for (size_t i = 0; i < rays; i++) {
        ps_vec3 direction = ps_cosine_direction(normal, random_unit(random), random_unit(random));
        guide_add(guide, (int)(i % 2), guide_bin_of(guide, normal, direction), light_of(direction));
    }
    guide_update(guide);
}

static void learn(struct guide *guide, struct random *random, size_t rays)
{
    learn_facing(up, guide, random, rays);
}

static void test_knows_nothing_at_first(void **state)
{
    (void)state;
    struct guide guide;
    struct random random = {3};
    guide_begin(&guide, up);
    guide_update(&guide);
    assert_true(guide.scale == 0.0f);
    for (int i = 0; i < 1000; i++) {
        float a = random_unit(&random), b = random_unit(&random);
        struct guide_sample sample = guide_sample(&guide, up, a, b);
        ps_vec3 even = ps_cosine_direction(up, a, b);
        assert_true(ps_length(ps_subtract(sample.direction, even)) < 1e-6f);
        assert_true(sample.direction.z >= 0);
        assert_true(guide_ratio(&guide, sample.bin) == 1.0f);
        assert_true(guide_smooth_ratio(&guide, 0, sample.bin) == 1.0f);
    }
}

/* The mean of 1 / ratio over rays of the guide is the integral of the cosine's pdf, and that of
 * light / ratio the light's: from a surface that faces another way than the guide as well, as far
 * as the guide reaches. */
static void test_ratio_is_that_of_the_pdf(void **state)
{
    (void)state;
    struct guide guide;
    struct random random = {5};
    guide_begin(&guide, up);
    learn(&guide, &random, 4000);
    const ps_vec3 normals[] = {up, ps_normalize((ps_vec3){0.2f, -0.3f, 1})};
    for (size_t n = 0; n < 2; n++) {
        double whole = 0, by_cosine = 0, by_guide = 0, hits = 0;
        for (int i = 0; i < RAYS; i++) {
            float a = random_unit(&random), b = random_unit(&random);
            struct guide_sample guided = guide_sample(&guide, normals[n], a, b);
            ps_vec3 even = ps_cosine_direction(normals[n], a, b);
            by_cosine += (double)light_of(even) / RAYS;
            if (!(ps_dot(guided.direction, normals[n]) > 0))
                continue;
            float ratio = guide_ratio(&guide, guided.bin);
            whole += 1.0 / (double)ratio / RAYS;
            by_guide += (double)(light_of(guided.direction) / ratio) / RAYS;
            hits += light_of(guided.direction) > 0 ? 1.0 / RAYS : 0;
        }
        assert_true(fabs(whole - 1) < 0.02);
        assert_true(fabs(by_guide / by_cosine - 1) < 0.04);
        assert_true(hits > 0.5); /* a seventh by the cosine */
    }
}

/* Over rays by the cosine, its mean is 1, as that of the pdf is. */
static void test_smooth_ratio_is_a_pdf_s(void **state)
{
    (void)state;
    struct guide guide;
    struct random random = {7};
    double sharp = 0, smooth = 0;
    guide_begin(&guide, up);
    learn(&guide, &random, 4000);
    for (int i = 0; i < RAYS; i++) {
        ps_vec3 direction = ps_cosine_direction(up, random_unit(&random), random_unit(&random));
        sharp += (double)guide_ratio(&guide, guide_bin_of(&guide, up, direction)) / RAYS;
        smooth += (double)guide_smooth_ratio(&guide, 0, guide_bin_of(&guide, up, direction)) / RAYS;
    }
    assert_true(fabs(sharp - 1) < 0.03);
    assert_true(fabs(smooth - 1) < 0.03);
}

/* What a ray found does not weigh it, nor those of its half; without light in the other half all
 * directions are alike. */
static void test_the_other_half_weighs(void **state)
{
    (void)state;
    struct guide even, lucky;
    const ps_vec3 direction = ps_normalize((ps_vec3){0.3f, 0.1f, 1});
    const ps_vec3 elsewhere = ps_normalize((ps_vec3){-1, 0.2f, 0.3f});
    guide_begin(&even, up);
    guide_begin(&lucky, up);
    for (int half = 0; half < 2; half++) {
        guide_add(&even, half, guide_bin_of(&even, up, direction), 2.0f);
        guide_add(&even, half, guide_bin_of(&even, up, elsewhere), 1.0f);
    }
    guide_add(&lucky, 1, guide_bin_of(&lucky, up, direction), 20.0f);
    guide_add(&lucky, 1, guide_bin_of(&lucky, up, elsewhere), 1.0f);
    guide_update(&even);
    guide_update(&lucky);
    float of_even = guide_smooth_ratio(&even, 0, guide_bin_of(&even, up, direction));
    assert_true(of_even == guide_smooth_ratio(&even, 1, guide_bin_of(&even, up, direction)));
    assert_true(of_even > guide_smooth_ratio(&even, 0, guide_bin_of(&even, up, elsewhere)));
    assert_true(guide_smooth_ratio(&lucky, 0, guide_bin_of(&lucky, up, direction)) >
                1.05f * of_even);
    assert_true(guide_smooth_ratio(&lucky, 1, guide_bin_of(&lucky, up, direction)) == 1.0f);
}

static struct guide_histogram histogram_of(const struct guide *guide)
{
    struct guide_histogram histogram = {.normal = guide->normal};
    memcpy(histogram.found, guide->found, sizeof histogram.found);
    return histogram;
}

/* Both halves learn half of all that the other guide found, times the share. */
static void test_learns_from_another(void **state)
{
    (void)state;
    struct guide guide, other;
    struct random random = {11};
    double own[2] = {0, 0}, all = 0, sums[2] = {0, 0};
    guide_begin(&guide, up);
    guide_begin(&other, ps_normalize((ps_vec3){0.01f, 0.0f, 1.0f}));
    learn(&guide, &random, 100);
    learn(&other, &random, 1000);
    struct guide_histogram histogram = histogram_of(&other);
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < GUIDE_BINS; i++) {
            own[half] += (double)guide.found[half][i / GUIDE_SECTORS][i % GUIDE_SECTORS];
            all += (double)other.found[half][i / GUIDE_SECTORS][i % GUIDE_SECTORS];
        }
    guide_add_histogram(&guide, &histogram, 0.5f);
    for (int half = 0; half < 2; half++) {
        for (int i = 0; i < GUIDE_BINS; i++)
            sums[half] += (double)guide.found[half][i / GUIDE_SECTORS][i % GUIDE_SECTORS];
        assert_float_equal(sums[half], own[half] + 0.25 * all, 1e-3 * all);
    }
}

/* Of a histogram by a guide that faces another way: as much light as the guide's own normal has,
 * and from there. */
static void test_learns_from_one_that_faces_another_way(void **state)
{
    (void)state;
    struct guide guide, other, own;
    struct random random = {13};
    const ps_vec3 tilted = ps_normalize((ps_vec3){0.3f, 0.2f, 1.0f});
    double all = 0, told = 0, there = 0;
    guide_begin(&guide, up);
    guide_begin(&own, up);
    guide_begin(&other, tilted);
    learn(&own, &random, RAYS);
    learn_facing(tilted, &other, &random, RAYS);
    struct guide_histogram histogram = histogram_of(&other);
    guide_add_histogram(&guide, &histogram, 1.0f);
    for (int i = 0; i < GUIDE_BINS; i++) {
        int ring = i / GUIDE_SECTORS, sector = i % GUIDE_SECTORS;
        double told_here =
            (double)guide.found[0][ring][sector] + (double)guide.found[1][ring][sector];
        all += (double)own.found[0][ring][sector] + (double)own.found[1][ring][sector];
        told += told_here;
        there += own.known[ring][sector] > 0.0f ? told_here : 0.0;
    }
    print_message("told %.3f of the light, %.3f of it where that is\n", told / all, there / told);
    assert_float_equal(told / all, 1.0, 0.05);
    assert_true(there / told > 0.9);
}

static void test_learns_nothing_from_another_side(void **state)
{
    (void)state;
    struct guide guide, other;
    struct random random = {13};
    guide_begin(&guide, up);
    guide_begin(&other, ps_normalize((ps_vec3){1.5f, 0.0f, 1.0f}));
    learn(&other, &random, 1000);
    struct guide_histogram histogram = histogram_of(&other);
    guide_add_histogram(&guide, &histogram, 0.5f);
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < GUIDE_BINS; i++)
            assert_true(guide.found[half][i / GUIDE_SECTORS][i % GUIDE_SECTORS] == 0.0f);
}

/* What two halves say of light from a share of the hemisphere. */
static struct guide coarse_guide_of(uint32_t rings)
{
    struct guide guide;
    guide_begin(&guide, up);
    for (uint32_t ring = 0; ring < rings; ring++)
        for (uint32_t sector = 0; sector < rings * 2; sector++) {
            struct guide_bin bin = {(int32_t)(ring * GUIDE_SECTORS + sector), 1.0f};
            guide_add(&guide, 0, bin, 1.0f);
            guide_add(&guide, 1, bin, 3.0f);
        }
    guide_update_coarse(&guide);
    return guide;
}

static void test_coarse_guide_draws_by_the_cosine_unless_light_is_concentrated(void **state)
{
    (void)state;
    struct guide even = coarse_guide_of(GUIDE_RINGS), spot = coarse_guide_of(1);
    struct guide quarter = coarse_guide_of(GUIDE_RINGS / 2);
    struct random random = {11};
    double sum = 0;
    assert_true(even.scale == 0.0f);
    assert_true(quarter.scale == 0.0f);
    assert_true(spot.scale > 0.0f && spot.by_cosine <= 0.5f);
    for (int i = 0; i < RAYS; i++)
        sum += 1.0 / guide_sample(&spot, up, random_unit(&random), random_unit(&random)).ratio;
    assert_true(fabs(sum / RAYS - 1) < 0.03);
}

/* Light that one half alone has found may be chance. */
static void test_coarse_guide_trusts_what_both_halves_found(void **state)
{
    (void)state;
    struct guide guide;
    guide_begin(&guide, up);
    guide_add(&guide, 0, (struct guide_bin){5, 1.0f}, 1.0f);
    guide_add(&guide, 1, (struct guide_bin){5 * GUIDE_SECTORS, 1.0f}, 1.0f);
    guide_update_coarse(&guide);
    assert_true(guide.scale == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_knows_nothing_at_first),
        cmocka_unit_test(test_ratio_is_that_of_the_pdf),
        cmocka_unit_test(test_smooth_ratio_is_a_pdf_s),
        cmocka_unit_test(test_the_other_half_weighs),
        cmocka_unit_test(test_learns_from_another),
        cmocka_unit_test(test_learns_from_one_that_faces_another_way),
        cmocka_unit_test(test_learns_nothing_from_another_side),
        cmocka_unit_test(test_coarse_guide_draws_by_the_cosine_unless_light_is_concentrated),
        cmocka_unit_test(test_coarse_guide_trusts_what_both_halves_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
