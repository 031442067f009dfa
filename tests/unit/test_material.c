/* test_material.c: how surfaces scatter: energy, directions, densities, choice among lobes. */
#include "scene/material.h"
#include "support/chi_squared.h"
#include "support/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#define SAMPLES 40000

static struct microfacet_table *table;

static int make_table(void **state)
{
    (void)state;
    table = calloc(1, sizeof *table);
    microfacet_tabulate(table, 0.0f, 1.0f);
    return 0;
}

static int free_table(void **state)
{
    (void)state;
    free(table);
    return 0;
}

static struct pigment_description grey(float value)
{
    return (struct pigment_description){
        .kind = PIGMENT_COLOR, .colors = {{value, value, value}}, .placement = AFFINE_IDENTITY};
}

static struct material_description plain(enum material_kind kind, float color)
{
    return (struct material_description){
        .kind = kind,
        .color = grey(color),
        .specular = grey(0.1f),
        .roughness = grey(0.4f),
        .ior = 1.5,
        .emission = grey(0),
        .opacity = grey(1),
        .bump = grey(0),
        .normal_map = grey(1),
    };
}

static struct material made(const struct material_description *materials, size_t count,
                            size_t index)
{
    struct scene_description description = {.materials = (struct material_description *)materials,
                                            .material_count = count};
    struct material material;
    struct error error;
    assert_int_equal(material_create(&description, index, NULL, &material, &error), PS_OK);
    return material;
}

static struct material made_one(struct material_description description)
{
    return made(&description, 1, 0);
}

/* A ray that meets a level surface at the origin, from above, by the cosine to its normal. */
struct meeting {
    ps_ray ray;
    ps_hit hit;
};

static struct meeting meet(float cosine, uint32_t flags)
{
    float sine = sqrtf(1 - cosine * cosine);
    ps_vec3 up = {0, 1, 0};
    return (struct meeting){
        .ray = {{-sine, cosine, 0}, 0, {sine, -cosine, 0}, INFINITY},
        .hit = {.distance = 1, .normal = up, .geometric_normal = up, .flags = flags},
    };
}

/* With the albedo that a ray finds. */
static ps_hit hit_on(const struct material *material, const struct meeting *meeting)
{
    ps_hit hit = meeting->hit;
    hit.albedo = material_albedo(material, table, &hit, meeting->ray.direction);
    return hit;
}

static ps_bsdf_value evaluate(const struct material *material, const struct meeting *meeting,
                              ps_direction direction, ps_vec3 away)
{
    ps_hit hit = hit_on(material, meeting);
    return material_evaluate(material, table, direction, &meeting->ray, &hit, away);
}

static ps_bsdf_sample scatter_by(const struct material *material, const struct meeting *meeting,
                                 ps_direction direction, const float numbers[4],
                                 struct stratum *stratum)
{
    ps_hit hit = hit_on(material, meeting);
    return material_scatter(material, table, direction, &meeting->ray, &hit, numbers, stratum);
}

static ps_bsdf_sample scatter(const struct material *material, const struct meeting *meeting,
                              ps_direction direction, struct random *random)
{
    float numbers[4];
    for (int k = 0; k < 4; k++)
        numbers[k] = random_unit(random);
    return scatter_by(material, meeting, direction, numbers, NULL);
}

static double mean_weight(const struct material *material, float cosine, ps_direction direction)
{
    struct meeting meeting = meet(cosine, 0);
    struct random random = {11};
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++)
        sum += (double)scatter(material, &meeting, direction, &random).weight.g;
    return sum / SAMPLES;
}

/* By sampling, and as the material states it. */
static void expect_albedo(const struct material *material, float cosine, double expected)
{
    struct meeting meeting = meet(cosine, 0);
    double albedo = mean_weight(material, cosine, PS_FROM_CAMERA);
    ps_hit hit = hit_on(material, &meeting);
    double stated = (double)material_reflectance(material, table, &hit, meeting.ray.direction).g;
    if (!(fabs(albedo - expected) < 0.01 && fabs(stated - expected) < 0.01))
        fail_msg("cosine %g: %g, stated %g, expected %g", (double)cosine, albedo, stated, expected);
}

/* --- energy ---------------------------------------------------------------------------------- */

static void test_simple_albedos(void **state)
{
    (void)state;
    struct material diffuse = made_one(plain(MATERIAL_DIFFUSE, 0.6f));
    struct material mirror = made_one(plain(MATERIAL_MIRROR, 0.8f));
    struct material_description smooth = plain(MATERIAL_METAL, 0.5f);
    smooth.roughness = grey(0);
    struct material metal = made_one(smooth);
    for (float cosine = 0.1f; cosine <= 1.0f; cosine += 0.3f) {
        expect_albedo(&diffuse, cosine, 0.6);
        expect_albedo(&mirror, cosine, 0.8);
        expect_albedo(&metal, cosine, 0.5 + 0.5 * pow(1 - (double)cosine, 5));
    }
}

static void test_white_surfaces_keep_all_light(void **state)
{
    (void)state;
    struct material metal = made_one(plain(MATERIAL_METAL, 1));
    struct material glossy = made_one(plain(MATERIAL_GLOSSY, 1));
    struct material_description smooth = plain(MATERIAL_GLOSSY, 1);
    smooth.roughness = grey(0);
    struct material varnish = made_one(smooth);
    for (float cosine = 0.05f; cosine <= 1.0f; cosine += 0.19f) {
        expect_albedo(&metal, cosine, 1);
        expect_albedo(&glossy, cosine, 1);
        expect_albedo(&varnish, cosine, 1);
    }
}

static void test_coat_takes_from_its_base(void **state)
{
    (void)state;
    struct material glossy = made_one(plain(MATERIAL_GLOSSY, 0.5f));
    for (float cosine = 0.1f; cosine <= 1.0f; cosine += 0.3f) {
        double coat = (double)microfacet_albedo(table, (ps_rgb){0.1f, 0.1f, 0.1f}, 0.4f, cosine).g;
        expect_albedo(&glossy, cosine, coat + 0.5 * (1 - coat));
        struct meeting meeting = meet(cosine, 0);
        ps_rgb albedo = material_albedo(&glossy, table, &meeting.hit, meeting.ray.direction);
        assert_true(fabs((double)albedo.g - 0.5 * (1 - coat)) < 1e-5);
    }
}

static void test_mix_is_the_sum_of_shares(void **state)
{
    (void)state;
    size_t components[2] = {0, 1};
    double weights[2] = {0.25, 0.5};
    struct material_description materials[3] = {
        plain(MATERIAL_DIFFUSE, 0.8f), plain(MATERIAL_MIRROR, 0.9f), plain(MATERIAL_MIX, 0)};
    materials[2].components = components;
    materials[2].weights = weights;
    materials[2].component_count = 2;
    struct material mix = made(materials, 3, 2);
    expect_albedo(&mix, 0.5f, 0.25 * 0.8 + 0.5 * 0.9);
    struct meeting meeting = meet(0.5f, 0);
    assert_true(fabsf(material_albedo(&mix, table, &meeting.hit, meeting.ray.direction).g - 0.2f) <
                1e-6f);
}

/* Shares that vary over the surface are at each point what constant ones are: same lobes, values
 * and densities. */
static void test_varying_mix_is_a_mix(void **state)
{
    (void)state;
    size_t components[2] = {0, 1};
    double weights[2] = {0.25, 0.75};
    struct material_description materials[4] = {plain(MATERIAL_METAL, 0.8f),
                                                plain(MATERIAL_GLOSSY, 0.6f),
                                                plain(MATERIAL_MIX, 0), plain(MATERIAL_MIX, 0)};
    for (size_t i = 2; i < 4; i++) {
        materials[i].components = components;
        materials[i].weights = weights;
        materials[i].component_count = 2;
    }
    materials[3].varying = true;
    materials[3].share = grey(1);
    materials[3].share.vertex_colors = true; /* 1/4 at the point below */
    struct material constant = made(materials, 4, 2), varying = made(materials, 4, 3);
    struct meeting meeting = meet(0.5f, 0);
    struct random random = {19};
    meeting.hit.texture_point = (ps_vec3){0.25f, 0.25f, 0.25f};
    for (int i = 0; i < 100; i++) {
        struct random same = random;
        ps_bsdf_sample a = scatter(&constant, &meeting, PS_FROM_CAMERA, &random);
        ps_bsdf_sample b = scatter(&varying, &meeting, PS_FROM_CAMERA, &same);
        assert_int_equal(a.lobe, b.lobe);
        assert_true(fabsf(a.weight.g - b.weight.g) < 1e-5f && fabsf(a.pdf - b.pdf) < 1e-4f * a.pdf);
        ps_bsdf_value c = evaluate(&constant, &meeting, PS_FROM_CAMERA, a.direction);
        ps_bsdf_value d = evaluate(&varying, &meeting, PS_FROM_CAMERA, a.direction);
        assert_true(fabsf(c.value.g - d.value.g) <= 1e-4f * c.value.g);
        assert_true(fabsf(c.pdf - d.pdf) <= 1e-4f * c.pdf);
    }
}

/* Paths of the camera end at a diffuse lobe and count all diffuse light of the surface there,
 * divided by the lobe's probability: on average once, whatever the components. */
static void test_diffuse_parts_count_once(void **state)
{
    (void)state;
    size_t components[3] = {0, 1, 2};
    double weights[3] = {0.4, 0.3, 0.3};
    struct material_description materials[4] = {
        plain(MATERIAL_DIFFUSE, 0.8f), plain(MATERIAL_GLOSSY, 0.5f), plain(MATERIAL_METAL, 0.9f),
        plain(MATERIAL_MIX, 0)};
    materials[3].components = components;
    materials[3].weights = weights;
    materials[3].component_count = 3;
    struct material mix = made(materials, 4, 3);
    struct meeting meeting = meet(0.5f, 0);
    struct random random = {3};
    double ends = 0;
    for (int i = 0; i < SAMPLES; i++) {
        ps_bsdf_sample on = scatter(&mix, &meeting, PS_FROM_CAMERA, &random);
        if (on.lobe == PS_DIFFUSE)
            ends += 1.0 / (double)on.probability;
    }
    assert_true(fabs(ends / SAMPLES - 1.0) < 0.02);
}

/* --- glass
 * -------------------------------------------------------------------------------------- */

/* Each that passes weighs the same, and each that is mirrored. Returns the share of the samples
 * that passed. */
static double share_that_passes(const struct material *glass, const struct meeting *meeting,
                                ps_direction direction, double expected_sine, double passed_weight,
                                double mirrored_weight)
{
    struct random random = {23};
    int passed = 0;
    for (int i = 0; i < SAMPLES; i++) {
        ps_bsdf_sample on = scatter(glass, meeting, direction, &random);
        assert_int_equal(on.lobe, PS_SPECULAR);
        assert_true(on.pdf == 0);
        assert_true(fabsf(ps_length(on.direction) - 1) < 1e-5f);
        if (on.direction.y > 0) {
            assert_true(fabs((double)on.weight.g - mirrored_weight) < 1e-5);
            assert_true(on.normal.y > 0);
            continue;
        }
        passed++;
        assert_true(on.normal.y < 0);
        assert_true(fabs((double)on.direction.x - expected_sine) < 1e-4);
        assert_true(fabs((double)on.weight.g - passed_weight) < 1e-4);
    }
    return (double)passed / SAMPLES;
}

/* Fresnel's equations for the cosines on both sides; `eta`: of the far side over this one. */
static double fresnel(double cosine, double far_cosine, double eta)
{
    double s = (cosine - eta * far_cosine) / (cosine + eta * far_cosine);
    double p = (eta * cosine - far_cosine) / (eta * cosine + far_cosine);
    return 0.5 * (s * s + p * p);
}

/* At 60 degrees to the normal. Camera paths mirror an eighth of the time, since that is more than
 * the share. */
static void test_glass_refracts(void **state)
{
    (void)state;
    struct material glass = made_one(plain(MATERIAL_DIELECTRIC, 1));
    struct meeting outside = meet(0.5f, 0);
    double sine = sqrt(0.75) / 1.5, reflectance = fresnel(0.5, sqrt(1 - sine * sine), 1.5);
    double camera = share_that_passes(&glass, &outside, PS_FROM_CAMERA, sine,
                                      (1 - reflectance) / 0.875 / 2.25, reflectance / 0.125);
    double light = share_that_passes(&glass, &outside, PS_FROM_LIGHT, sine, 1, 1);
    assert_true(fabs(camera - 0.875) < 0.01);
    assert_true(fabs(light - (1 - reflectance)) < 0.01);
}

static void test_glass_reflects_totally_inside(void **state)
{
    (void)state;
    struct material glass = made_one(plain(MATERIAL_DIELECTRIC, 1));
    struct meeting steep = meet(0.9f, PS_HIT_BACK), flat = meet(0.6f, PS_HIT_BACK);
    double sine = 1.5 * sqrt(1 - 0.81);
    double reflectance = fresnel(0.9, sqrt(1 - sine * sine), 1 / 1.5);
    assert_true(share_that_passes(&glass, &steep, PS_FROM_LIGHT, sine, 1, 1) > 0.9);
    assert_true(share_that_passes(&glass, &steep, PS_FROM_CAMERA, sine,
                                  2.25 * (1 - reflectance) / 0.875, reflectance / 0.125) > 0.85);
    /* sine 0.8 > 1 / 1.5 */
    assert_true(share_that_passes(&glass, &flat, PS_FROM_CAMERA, 0, 0, 1) == 0);
}

static void test_power_is_not_squeezed(void **state)
{
    (void)state;
    struct material glass = made_one(plain(MATERIAL_DIELECTRIC, 1));
    assert_true(fabs(mean_weight(&glass, 0.7f, PS_FROM_LIGHT) - 1) < 1e-5);
}

/* --- paths of a pixel
 * ---------------------------------------------------------------------------- */

enum { MOST_PATHS = 8 };

/* What `paths` paths carry on, with numbers that are evenly spaced from `offset` on. Those that go
 * the same way are as many as their strata say, with numbers that are evenly spaced in turn. */
static double carried_by_paths(const struct material *material, const struct meeting *meeting,
                               uint32_t paths, float offset)
{
    static const float numbers[4] = {0.3f, 0.6f, 0, 0.5f};
    struct stratum strata[MOST_PATHS];
    ps_vec3 directions[MOST_PATHS];
    double sum = 0;
    for (uint32_t i = 0; i < paths; i++) {
        strata[i] = (struct stratum){((float)i + offset) / (float)paths, paths};
        ps_bsdf_sample on = scatter_by(material, meeting, PS_FROM_CAMERA, numbers, &strata[i]);
        directions[i] = on.direction;
        sum += (double)on.weight.g;
    }
    for (uint32_t i = 0, first = 0; i < paths; i++) {
        first = i > 0 && ps_same(directions[i], directions[i - 1]) ? first : i;
        float place = ((float)(i - first) + offset) / (float)strata[i].paths;
        assert_true(fabsf(strata[i].number - place) < 1e-4f);
        if (i + 1 == paths || !ps_same(directions[i], directions[i + 1]))
            assert_int_equal(strata[i].paths, i + 1 - first);
    }
    return sum / paths;
}

/* However they lie, they carry what a path alone carries in the mean. */
static void expect_no_chance(struct material_description description, float cosine)
{
    static const uint32_t counts[] = {2, 3, MOST_PATHS};
    struct material material = made_one(description);
    struct meeting meeting = meet(cosine, 0);
    double mean = mean_weight(&material, cosine, PS_FROM_CAMERA);
    for (int i = 0; i < 3; i++)
        for (float offset = 0.1f; offset < 1; offset += 0.2f)
            assert_true(fabs(carried_by_paths(&material, &meeting, counts[i], offset) - mean) <
                        0.005);
}

static void test_paths_share_what_glass_does(void **state)
{
    (void)state;
    for (float cosine = 0.1f; cosine <= 1.0f; cosine += 0.3f)
        expect_no_chance(plain(MATERIAL_DIELECTRIC, 1), cosine);
}

static void test_paths_share_lobes(void **state)
{
    (void)state;
    struct material_description coated = plain(MATERIAL_GLOSSY, 0.6f);
    coated.roughness = grey(0);
    for (float cosine = 0.1f; cosine <= 1.0f; cosine += 0.3f)
        expect_no_chance(coated, cosine);
}

/* One of eight goes by the glass of this mix, and is alone with its choice: it must not be the same
 * number that chose the lobe. */
static void test_choices_of_a_mix_are_independent(void **state)
{
    (void)state;
    enum { OFFSETS = 4000 };
    size_t components[2] = {0, 1};
    double weights[2] = {0.9, 0.1};
    struct material_description materials[3] = {
        plain(MATERIAL_DIFFUSE, 0.8f), plain(MATERIAL_DIELECTRIC, 1), plain(MATERIAL_MIX, 0)};
    materials[2].components = components;
    materials[2].weights = weights;
    materials[2].component_count = 2;
    struct material mix = made(materials, 3, 2);
    struct meeting meeting = meet(0.5f, 0);
    double sum = 0, mirrored = 0;
    for (int i = 0; i < OFFSETS * MOST_PATHS; i++) {
        float number = ((float)i + 0.5f) / (OFFSETS * MOST_PATHS);
        const float numbers[4] = {0.3f, 0.6f, 0, number};
        struct stratum stratum = {number, MOST_PATHS};
        ps_bsdf_sample on = scatter_by(&mix, &meeting, PS_FROM_CAMERA, numbers, &stratum);
        sum += (double)on.weight.g;
        mirrored += on.lobe == PS_SPECULAR && on.direction.y > 0;
    }
    assert_true(mirrored > 0);
    assert_true(fabs(sum / (OFFSETS * MOST_PATHS) - mean_weight(&mix, 0.5f, PS_FROM_CAMERA)) <
                0.005);
}

static void test_a_path_alone_has_no_stratum(void **state)
{
    (void)state;
    static const float numbers[4] = {0.3f, 0.6f, 0, 0.01f};
    struct material glass = made_one(plain(MATERIAL_DIELECTRIC, 1));
    struct meeting meeting = meet(1, 0);
    struct stratum alone = {0.9f, 1};
    ps_bsdf_sample on = scatter_by(&glass, &meeting, PS_FROM_CAMERA, numbers, &alone);
    assert_true(on.direction.y > 0); /* by sample[3], it mirrors */
}

static void test_glass_absorbs_by_distance(void **state)
{
    (void)state;
    struct material_description description = plain(MATERIAL_DIELECTRIC, 1);
    description.absorption = (ps_rgb){0, 0.5f, 2};
    struct material glass = made_one(description);
    struct meeting inside = meet(0.6f, PS_HIT_BACK);
    struct random random = {1};
    inside.hit.distance = 3;
    ps_bsdf_sample on = scatter(&glass, &inside, PS_FROM_CAMERA, &random);
    assert_true(fabsf(on.weight.r - 1) < 1e-6f);
    assert_true(fabsf(on.weight.g - expf(-1.5f)) < 1e-6f);
    assert_true(fabsf(on.weight.b - expf(-6)) < 1e-6f);
}

/* --- directions
 * --------------------------------------------------------------------------------- */

static void test_mirror_direction(void **state)
{
    (void)state;
    struct material mirror = made_one(plain(MATERIAL_MIRROR, 1));
    struct meeting meeting = meet(0.6f, 0);
    struct random random = {1};
    ps_bsdf_sample on = scatter(&mirror, &meeting, PS_FROM_CAMERA, &random);
    assert_true(fabsf(on.direction.x - 0.8f) < 1e-6f && fabsf(on.direction.y - 0.6f) < 1e-6f);
}

#define RINGS 12
#define SECTORS 12

/* The lobes of a coated surface together: observed against pdf, which holds their choice. */
static void test_directions_follow_the_densities(void **state)
{
    (void)state;
    struct material glossy = made_one(plain(MATERIAL_GLOSSY, 0.3f));
    struct meeting meeting = meet(0.7f, 0);
    double observed[RINGS] = {0}, expected[RINGS] = {0};
    struct random random = {29};
    int diffuse = 0;
    double probability = 0;
    for (int i = 0; i < SAMPLES; i++) {
        ps_bsdf_sample on = scatter(&glossy, &meeting, PS_FROM_CAMERA, &random);
        if (on.lobe != PS_DIFFUSE)
            continue;
        diffuse++;
        probability = (double)on.probability;
        double cosine2 = (double)on.direction.y * (double)on.direction.y;
        observed[(int)fmin(cosine2 * RINGS, RINGS - 1)]++;
        assert_true(fabs((double)on.pdf - probability * (double)on.direction.y / (double)PS_PI) <
                    1e-5);
    }
    for (int i = 0; i < RINGS; i++)
        expected[i] = (double)diffuse / RINGS; /* cosine-distributed: even in cosine squared */
    assert_true(chi_squared_probability(observed, expected, RINGS) > 1e-4);
    assert_true(fabs((double)diffuse / SAMPLES - probability) < 0.015);
}

/* Where smoothed normals are tilted, no direction of gloss passes through the surface. */
static void test_tilted_normals(void **state)
{
    (void)state;
    struct material glossy = made_one(plain(MATERIAL_GLOSSY, 0.3f));
    struct meeting meeting = meet(0.5f, 0);
    meeting.hit.normal = (ps_vec3){0.6f, 0.8f, 0};
    struct random random = {31};
    int through = 0;
    for (int i = 0; i < SAMPLES; i++) {
        ps_bsdf_sample on = scatter(&glossy, &meeting, PS_FROM_LIGHT, &random);
        through += on.direction.y <= 0;
        assert_true(on.direction.y > 0 || on.weight.g == 0);
    }
    assert_true(through > 0);
}

/* Of what is diffuse alone light paths leave to the whole hemisphere, be it behind the shading
 * normal or not, with what Veach's factor takes where they arrive. */
static void test_tilted_diffuse_normals(void **state)
{
    (void)state;
    struct material diffuse = made_one(plain(MATERIAL_DIFFUSE, 1));
    struct meeting meeting = meet(0.5f, 0);
    struct random random = {31};
    meeting.hit.normal = (ps_vec3){0.6f, 0.8f, 0};
    ps_vec3 back = ps_scale(meeting.ray.direction, -1);
    float expected = fmaxf(ps_dot(back, meeting.hit.normal), 0) / back.y;
    int behind = 0;
    for (int i = 0; i < SAMPLES; i++) {
        ps_bsdf_sample on = scatter(&diffuse, &meeting, PS_FROM_LIGHT, &random);
        assert_true(on.direction.y >= 0);
        assert_true(fabsf(on.weight.g - expected) <= 1e-5f);
        assert_true(fabsf(on.pdf - on.direction.y / PS_PI) <= 1e-5f);
        behind += ps_dot(on.direction, meeting.hit.normal) < 0;
    }
    assert_true(behind > 0);
}

/* Light that arrives along one way and leaves along the other is the same seen from either end, but
 * for the cosines by which the paths count; and each says the density of the other. */
static void test_tilted_diffuse_normals_are_reciprocal(void **state)
{
    (void)state;
    struct material diffuse = made_one(plain(MATERIAL_DIFFUSE, 1));
    struct random random = {37};
    for (int i = 0; i < 1000; i++) {
        struct meeting lit = meet(0.1f + 0.8f * random_unit(&random), 0);
        ps_vec3 up = {0, 1, 0}, in = ps_scale(lit.ray.direction, -1);
        ps_vec3 out = ps_cosine_direction(up, random_unit(&random), random_unit(&random));
        lit.hit.normal = ps_cosine_direction(up, random_unit(&random), random_unit(&random));
        struct meeting seen = lit;
        seen.ray.direction = ps_scale(out, -1);
        ps_bsdf_value light = evaluate(&diffuse, &lit, PS_FROM_LIGHT, out);
        ps_bsdf_value camera = evaluate(&diffuse, &seen, PS_FROM_CAMERA, in);
        assert_true(fabsf(light.value.g * in.y - camera.value.g * out.y) < 1e-5f);
        assert_true(fabsf(light.pdf - camera.reverse_pdf) < 1e-5f);
        assert_true(fabsf(camera.pdf - light.reverse_pdf) < 1e-5f);
    }
}

/* --- gloss by the lights' own sampling
 * ----------------------------------------------------------- */

/* Without a competing density the sum over all directions is the coat's albedo. */
static void test_gloss_sums_to_the_coat(void **state)
{
    (void)state;
    struct material glossy = made_one(plain(MATERIAL_GLOSSY, 0.3f));
    struct meeting meeting = meet(0.7f, 0);
    struct random random = {37};
    double sum = 0;
    for (int i = 0; i < 10 * SAMPLES; i++) {
        float height = random_unit(&random), phi = 2 * PS_PI * random_unit(&random);
        float radius = sqrtf(1 - height * height);
        ps_vec3 in = {radius * cosf(phi), height, radius * sinf(phi)};
        sum += (double)material_gloss(&glossy, table, &meeting.ray, &meeting.hit, in, 0).g;
    }
    double albedo = sum / (10 * SAMPLES) * 2 * (double)PS_PI;
    double coat = (double)microfacet_albedo(table, (ps_rgb){0.1f, 0.1f, 0.1f}, 0.4f, 0.7f).g;
    assert_true(fabs(albedo - coat) < 0.02 * coat);
}

/* The two ways of finding a light together count it once. */
static void test_shares_of_the_two_samplings_sum_to_one(void **state)
{
    (void)state;
    struct material_description description = plain(MATERIAL_METAL, 0.5f);
    struct material metal = made_one(description);
    struct meeting meeting = meet(0.7f, 0);
    struct random random = {41};
    for (int i = 0; i < 100; i++) {
        ps_bsdf_sample on = scatter(&metal, &meeting, PS_FROM_CAMERA, &random);
        if (!(on.weight.g > 0))
            continue;
        float light = 0.7f;
        float whole = material_gloss(&metal, table, &meeting.ray, &meeting.hit, on.direction, 0).g;
        float part =
            material_gloss(&metal, table, &meeting.ray, &meeting.hit, on.direction, light).g;
        float ratio = on.pdf / light, scattering = ratio * ratio / (1 + ratio * ratio);
        assert_true(fabsf(part / whole + scattering - 1) < 1e-3f);
    }
}

/* --- what else a material says
 * ------------------------------------------------------------------ */

static void test_emission_has_a_front(void **state)
{
    (void)state;
    struct material_description description = plain(MATERIAL_DIFFUSE, 0);
    description.emission = grey(7);
    struct material lamp = made_one(description);
    struct meeting front = meet(0.5f, 0), back = meet(0.5f, PS_HIT_BACK);
    assert_true(material_emission(&lamp, &front.hit).g == 7);
    assert_true(material_emission(&lamp, &back.hit).g == 0);
    lamp.emission_both = true;
    assert_true(material_emission(&lamp, &back.hit).g == 7);
    assert_false(made_one(plain(MATERIAL_DIFFUSE, 1)).emissive);
}

static void test_black_absorbs(void **state)
{
    (void)state;
    struct material black = made_one(plain(MATERIAL_DIFFUSE, 0));
    struct meeting meeting = meet(0.5f, 0);
    struct random random = {1};
    assert_true(scatter(&black, &meeting, PS_FROM_LIGHT, &random).weight.g == 0);
}

static void test_too_many_components(void **state)
{
    (void)state;
    enum { COUNT = MATERIAL_MOST_COMPONENTS + 1 };
    size_t components[COUNT];
    double weights[COUNT];
    struct material_description materials[2] = {plain(MATERIAL_DIFFUSE, 1), plain(MATERIAL_MIX, 0)};
    for (size_t i = 0; i < COUNT; i++) {
        components[i] = 0;
        weights[i] = 0.05;
    }
    materials[1].components = components;
    materials[1].weights = weights;
    materials[1].component_count = COUNT;
    struct scene_description description = {.materials = materials, .material_count = 2};
    struct material material;
    struct error error;
    assert_int_equal(material_create(&description, 1, NULL, &material, &error), PS_ERROR_INVALID);
}

/* --- the table of rough reflectors
 * -------------------------------------------------------------- */

static int rows_for(struct material_description description)
{
    struct microfacet_table *own = calloc(1, sizeof *own);
    struct material material = made_one(description);
    material_tabulate(&material, own);
    int rows = 0;
    for (int i = 0; i < MICROFACET_TABLE_SIZE; i++)
        rows += own->is_known[i];
    free(own);
    return rows;
}

static void test_only_what_is_looked_up_is_tabulated(void **state)
{
    (void)state;
    struct material_description metal = plain(MATERIAL_METAL, 0.5f);
    assert_int_equal(rows_for(plain(MATERIAL_DIFFUSE, 0.5f)), 0);
    assert_int_equal(rows_for(plain(MATERIAL_MIRROR, 0.5f)), 0);
    metal.roughness = grey(0);
    assert_int_equal(rows_for(metal), 0);
    metal.roughness = grey(0.35f);
    assert_int_equal(rows_for(metal), 2);
    metal.roughness.vertex_colors = true;
    assert_int_equal(rows_for(metal), MICROFACET_TABLE_SIZE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simple_albedos),
        cmocka_unit_test(test_white_surfaces_keep_all_light),
        cmocka_unit_test(test_coat_takes_from_its_base),
        cmocka_unit_test(test_mix_is_the_sum_of_shares),
        cmocka_unit_test(test_varying_mix_is_a_mix),
        cmocka_unit_test(test_diffuse_parts_count_once),
        cmocka_unit_test(test_glass_refracts),
        cmocka_unit_test(test_glass_reflects_totally_inside),
        cmocka_unit_test(test_power_is_not_squeezed),
        cmocka_unit_test(test_glass_absorbs_by_distance),
        cmocka_unit_test(test_paths_share_what_glass_does),
        cmocka_unit_test(test_paths_share_lobes),
        cmocka_unit_test(test_choices_of_a_mix_are_independent),
        cmocka_unit_test(test_a_path_alone_has_no_stratum),
        cmocka_unit_test(test_mirror_direction),
        cmocka_unit_test(test_directions_follow_the_densities),
        cmocka_unit_test(test_tilted_normals),
        cmocka_unit_test(test_tilted_diffuse_normals),
        cmocka_unit_test(test_tilted_diffuse_normals_are_reciprocal),
        cmocka_unit_test(test_gloss_sums_to_the_coat),
        cmocka_unit_test(test_shares_of_the_two_samplings_sum_to_one),
        cmocka_unit_test(test_emission_has_a_front),
        cmocka_unit_test(test_black_absorbs),
        cmocka_unit_test(test_too_many_components),
        cmocka_unit_test(test_only_what_is_looked_up_is_tabulated),
    };
    return cmocka_run_group_tests(tests, make_table, free_table);
}
