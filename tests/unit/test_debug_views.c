/* test_debug_views.c: the views of debug show what they say: counts of splats against a count of
 * our own and against the weights of a box filter, cells of a grid, and points that are hidden or
 * not. */
#include "debug/debug.h"
#include "debug/id_colour.h"
#include "debug/legend.h"
#include "debug/pixel_light.h"
#include "debug/project.h"
#include "host/photons.h"
#include "support/render_scene.h"

#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 48
#define HEIGHT 32
#define PIXELS (WIDTH * HEIGHT)

static ps_result view(const char *name, const char *text, const struct debug_options *options,
                      const char *const choices[], struct canvas *canvas, struct error *error)
{
    struct prepared prepared;
    struct statistics statistics;
    struct render_callbacks callbacks = {.user = NULL};
    struct debug_request request = {.options = *options};
    prepare_text(text, 2, 4096, choices, &prepared);
    statistics_init(&statistics);
    assert_int_equal(debug_find(name, &request, error), PS_OK);
    ps_result result = debug_draw(&request, &prepared.scene, &prepared.settings, &callbacks,
                                  &statistics, canvas, error);
    statistics_destroy(&statistics);
    prepared_release(&prepared);
    return result;
}

/* --- overlap --- */

static ps_result count_by_kernel(void *user, struct render *render, struct error *error)
{
    float *counts = user;
    render->counts_splats = true;
    ps_result result = render_estimate(render, error);
    for (uint32_t tile = 0; tile < render->gbuffer.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            if (gbuffer_pixel(&render->gbuffer, tile, lane, &x, &y))
                counts[y * WIDTH + x] = render->gbuffer.tiles[tile].weight[lane];
        }
    return result;
}

/* With a box filter and one size of splats, the weights of a render are counts over pi R^2. */
static void expect_weights(const char *text, const char *visibility)
{
    const char *const choices[] = {"injection=photon:count=3000", "filter=box",
                                   "normalization=density", visibility, NULL};
    float *counts = calloc(PIXELS, sizeof *counts);
    double most = 0;
    assert_non_null(counts);
    inspect_text(text, choices, count_by_kernel, counts);
    struct rendering rendering = render_text(text, 2, choices);
    const float *weights = image_channel(&rendering.image, "weight");
    for (size_t i = 0; i < PIXELS; i++) {
        double expected = (double)weights[i] * 3.14159265358979 * 50 * 50;
        assert_true(fabs((double)counts[i] - expected) < 1e-3 * fmax(1, expected));
        assert_true(counts[i] == floorf(counts[i]));
        most = fmax(most, expected);
    }
    assert_true(most > 20);
    rendering_release(&rendering);
    free(counts);
}

static void test_overlap_is_the_weight_of_a_box(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    expect_weights(
        text,
        "visibility=none:radius=50,bandwidth_scale=0,max_merge_scale=1,boundary_correction=no");
    expect_weights(text, "visibility=shadowmap:radius=50,bandwidth_scale=0,max_merge_scale=1,"
                         "boundary_correction=no");
    expect_weights(
        text,
        "visibility=raycast:radius=50,bandwidth_scale=0,max_merge_scale=1,boundary_correction=no");
    free(text);
}

struct tally {
    const struct render *render;
    int *counts;
    bool *borderline;
};

static void tally_pixel(const struct tally *tally, const struct splat *splat, size_t pixel)
{
    const struct film *film = &tally->render->film;
    ps_vec3 p = {film->planes[FILM_POSITION_X][pixel], film->planes[FILM_POSITION_Y][pixel],
                 film->planes[FILM_POSITION_Z][pixel]};
    ps_vec3 n = {film->planes[FILM_NORMAL_X][pixel], film->planes[FILM_NORMAL_Y][pixel],
                 film->planes[FILM_NORMAL_Z][pixel]};
    double x = p.x - splat->bundle.centre.x, y = p.y - splat->bundle.centre.y,
           z = p.z - splat->bundle.centre.z;
    double u = x * splat->bundle.axis_u.x + y * splat->bundle.axis_u.y + z * splat->bundle.axis_u.z;
    double v = x * splat->bundle.axis_v.x + y * splat->bundle.axis_v.y + z * splat->bundle.axis_v.z;
    double t = x * splat->bundle.axis_w.x + y * splat->bundle.axis_w.y + z * splat->bundle.axis_w.z;
    double start = splat->bundle.start_depth + splat->bundle.start_slope_u * u +
                   splat->bundle.start_slope_v * v;
    double cosine = -((double)n.x * splat->bundle.axis_w.x + (double)n.y * splat->bundle.axis_w.y +
                      n.z * splat->bundle.axis_w.z);
    const double margins[5] = {(splat->bundle.radius - hypot(u, v)) / splat->bundle.radius, cosine,
                               (t - splat->near_depth) / splat->bundle.radius,
                               (splat->bundle.far_depth - t) / splat->bundle.radius,
                               (t - start) / splat->bundle.radius};
    int inside = 1;
    for (int i = 0; i < 5; i++) {
        inside = inside && margins[i] > 0;
        tally->borderline[pixel] = tally->borderline[pixel] || fabs(margins[i]) < 1e-4;
    }
    tally->counts[pixel] += inside;
}

/* Asks for the splats as the estimator does, and tries each against each pixel. */
static ps_result count_by_hand(void *user, struct render *render, struct error *error)
{
    struct tally *tally = user;
    tally->render = render;
    const ps_photon *photons;
    size_t n;
    do {
        assert_int_equal(photon_stream_next(&render->photons, &photons, &n, error), PS_OK);
        struct splat *splats = malloc((n + 1) * sizeof *splats);
        assert_non_null(splats);
        photons_place(render, photons, n, splats);
        for (size_t i = 0; i < n; i++)
            for (size_t pixel = 0; pixel < PIXELS && splats[i].bundle.radius > 0; pixel++)
                if (render->film.planes[FILM_COVERAGE][pixel] > 0)
                    tally_pixel(tally, &splats[i], pixel);
        free(splats);
    } while (n > 0);
    return PS_OK;
}

/* Sizes differ, photons are merged, and the filter does not count. */
static void test_overlap_is_the_count_by_hand(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=2000",
                                   "bounces=2",
                                   "filter=gaussian",
                                   "visibility=none:radius=60",
                                   "stratification=grid:resolution=20",
                                   NULL};
    char *text = cornell_text(WIDTH, HEIGHT);
    float *counts = calloc(PIXELS, sizeof *counts);
    struct tally tally = {NULL, calloc(PIXELS, sizeof(int)), calloc(PIXELS, sizeof(bool))};
    size_t compared = 0;
    assert_true(counts && tally.counts && tally.borderline);
    inspect_text(text, choices, count_by_kernel, counts);
    inspect_text(text, choices, count_by_hand, &tally);
    for (size_t i = 0; i < PIXELS; i++) {
        if (tally.borderline[i])
            continue;
        assert_int_equal((int)counts[i], tally.counts[i]);
        compared += tally.counts[i] > 0;
    }
    assert_true(compared > PIXELS / 4);
    free(counts);
    free(tally.counts);
    free(tally.borderline);
    free(text);
}

static void test_overlap_needs_splats(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=200", "estimator=photonmap", NULL};
    char *text = cornell_text(WIDTH, HEIGHT);
    struct debug_options options = {.exposure = 0};
    struct canvas canvas;
    struct error error;
    assert_int_equal(view("overlap", text, &options, choices, &canvas, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "photonmap"));
    assert_null(canvas.rgb);
    const char *const open[] = {"injection=photon:count=200", "visibility=none", NULL};
    assert_int_equal(view("maps", text, &options, open, &canvas, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "none"));
    free(text);
}

/* --- the light of a pixel --- */

struct explained {
    size_t x, y;
    ps_rgb irradiance, by_estimator;
};

static ps_result explain_pixel(void *user, struct render *render, struct error *error)
{
    struct explained *explained = user;
    struct pixel_light light;
    ps_rgb sum = {0, 0, 0};
    assert_int_equal(pixel_light_find(render, explained->x, explained->y, &light, error), PS_OK);
    assert_true(light.source_count > 10 && light.source_count < light.photon_count);
    for (size_t i = 0; i < light.source_count; i++) {
        const struct pixel_source *source = &light.sources[i];
        float brightness = ps_luminance(source->irradiance);
        assert_true(i == 0 || brightness <= ps_luminance(source[-1].irradiance));
        ps_vec3 there = ps_subtract(light.position, source->position);
        assert_true(ps_dot(there, source->normal) >
                    -60); /* in front of it, but for the splat's radius */
        sum = ps_rgb_add(sum, source->irradiance);
    }
    assert_true(fabsf(sum.g - light.irradiance.g) <= 1e-4f * light.irradiance.g);
    explained->irradiance = light.irradiance;
    pixel_light_release(&light);
    return PS_OK;
}

static ps_result estimate_pixel(void *user, struct render *render, struct error *error)
{
    struct explained *explained = user;
    ps_result result = render_estimate(render, error);
    for (uint32_t tile = 0; tile < render->gbuffer.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            const ps_tile *at = &render->gbuffer.tiles[tile];
            uint32_t x, y;
            if (gbuffer_pixel(&render->gbuffer, tile, lane, &x, &y) && x == explained->x &&
                y == explained->y)
                explained->by_estimator = (ps_rgb){at->irradiance_r[lane], at->irradiance_g[lane],
                                                   at->irradiance_b[lane]};
        }
    return result;
}

/* On the floor, the back wall and a block. */
static void test_light_of_a_pixel_is_the_estimators(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=30000",
                                   "estimator=splat:interleave=1,gather_rays=0",
                                   "visibility=shadowmap:radius=60", NULL};
    static const size_t pixels[][2] = {{24, 29}, {24, 6}, {20, 20}};
    char *text = cornell_text(WIDTH, HEIGHT);
    for (size_t i = 0; i < sizeof pixels / sizeof pixels[0]; i++) {
        struct explained explained = {.x = pixels[i][0], .y = pixels[i][1]};
        inspect_text(text, choices, explain_pixel, &explained);
        inspect_text(text, choices, estimate_pixel, &explained);
        ps_rgb one = explained.irradiance, other = explained.by_estimator;
        assert_true(other.r > 0 && fabsf(one.r / other.r - 1) < 1e-4f);
        assert_true(other.b > 0 && fabsf(one.b / other.b - 1) < 1e-4f);
    }
    free(text);
}

/* --- sight --- */

static ps_result check_sight(void *user, struct render *render, struct error *error)
{
    (void)error;
    size_t *seen = user;
    const struct film *film = &render->film;
    for (size_t i = 0; i < PIXELS; i++) {
        if (!(film->planes[FILM_COVERAGE][i] > 0))
            continue;
        ps_vec3 p = {film->planes[FILM_POSITION_X][i], film->planes[FILM_POSITION_Y][i],
                     film->planes[FILM_POSITION_Z][i]};
        ps_vec3 n = {film->planes[FILM_NORMAL_X][i], film->planes[FILM_NORMAL_Y][i],
                     film->planes[FILM_NORMAL_Z][i]};
        float x, y;
        assert_true(project_visible(render, p, n, &x, &y));
        assert_true(fabsf(x - (float)(i % WIDTH) - 0.5f) < 0.02f);
        assert_true(fabsf(y - (float)(i / WIDTH) - 0.5f) < 0.02f);
        assert_false(project_visible(render, p, ps_scale(n, -1.0f), &x, &y)); /* its other side */
        ps_vec3 beyond = ps_add_scaled(p, 20.0f, ps_subtract(p, render->scene->camera.location));
        assert_false(project_visible(render, beyond, n, &x, &y));
        (*seen)++;
    }
    float x, y;
    ps_vec3 n = {0, 1, 0};
    assert_false(
        project_visible(render, (ps_vec3){278, 273, -900}, n, &x, &y)); /* behind the camera */
    assert_false(
        project_visible(render, (ps_vec3){278, 5000, 100}, n, &x, &y)); /* above the picture */
    return PS_OK;
}

static void test_what_pixels_see_is_seen(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=10", NULL};
    char *text = cornell_text(WIDTH, HEIGHT);
    size_t seen = 0;
    inspect_text(text, choices, check_sight, &seen);
    assert_true(seen > PIXELS / 3);
    free(text);
}

/* --- voxels and layers --- */

static const char wall[] = "psd: 1\n"
                           "camera: {location: [0, 0, 9], look_at: [0, 0, 0], angle: 12}\n"
                           "image: {width: 48, height: 32}\n"
                           "materials: {m: {diffuse: [0.2, 0.5, 0.8]}}\n"
                           "lights: [{point: {location: [0, 0, 5], intensity: 9}}]\n"
                           "objects:\n"
                           "  - quad: {corners: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],"
                           " material: m}\n"
                           "  - quad: {corners: [[-1, -1, -1], [1, -1, -1], [1, 1, -1],"
                           " [-1, 1, -1]], material: m}\n";

static void test_voxels_are_cells_of_the_grid(void **state)
{
    (void)state;
    struct debug_options options = {.resolution = 2};
    struct canvas canvas;
    struct error error;
    struct colour corners[4];
    assert_int_equal(view("voxels", wall, &options, NULL, &canvas, &error), PS_OK);
    assert_int_equal(canvas.width, WIDTH);
    assert_int_equal(canvas.height, HEIGHT);
    for (size_t i = 0; i < 4; i++)
        corners[i] = canvas_get(&canvas, i % 2 * (WIDTH - 1), i / 2 * (HEIGHT - 1));
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < i; j++)
            assert_memory_not_equal(&corners[i], &corners[j], sizeof corners[i]);
    for (size_t y = 0; y < HEIGHT; y++)
        for (size_t x = 0; x < WIDTH; x++) {
            struct colour colour = canvas_get(&canvas, x, y);
            size_t corner = (size_t)(y >= HEIGHT / 2) * 2 + (size_t)(x >= WIDTH / 2);
            assert_memory_equal(&colour, &corners[corner], sizeof colour);
        }
    canvas_release(&canvas);
}

static size_t count_colours(const struct canvas *canvas)
{
    size_t colours = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        bool met = false;
        for (size_t j = 0; j < i && !met; j++)
            met = memcmp(canvas->rgb + 3 * i, canvas->rgb + 3 * j, 3) == 0;
        colours += !met;
    }
    return colours;
}

/* How many cells the wall has by a stratification; as many photons as fill them all. */
static size_t cells_of_wall(const char *stratification)
{
    const char *const choices[] = {"injection=photon:count=40000", stratification, NULL};
    struct debug_options options = {.resolution = 0};
    struct canvas canvas;
    struct error error;
    assert_int_equal(view("voxels", wall, &options, choices, &canvas, &error), PS_OK);
    size_t colours = count_colours(&canvas);
    canvas_release(&canvas);
    return colours;
}

/* The wall lies in the middle of the scene's sphere, and half of its width across is to be seen. */
static void test_voxels_are_cells_of_the_stratification(void **state)
{
    (void)state;
    assert_int_equal(cells_of_wall("stratification=grid:resolution=2,threshold=1"), 4);
    assert_int_equal(cells_of_wall("stratification=grid:resolution=2,threshold=1000000"), 1);
    assert_int_equal(cells_of_wall("stratification=octree:depth=1,capacity=1"), 4);
    assert_int_equal(cells_of_wall("stratification=octree:depth=1,capacity=1000000"), 1);
    assert_true(cells_of_wall("stratification=octree:capacity=4") > 16);
    assert_int_equal(cells_of_wall("stratification=cascade:levels=1,resolution=2,cell=1000"), 4);
    /* Nothing but what lies beyond: no cells. */
    assert_int_equal(
        cells_of_wall("stratification=cascade:levels=1,resolution=2,cell=0.001,beyond=keep"), 1);
}

static struct colour middle_of(const char *layer)
{
    struct debug_options options = {.exposure = 0};
    struct canvas canvas;
    struct error error;
    assert_int_equal(view(layer, wall, &options, NULL, &canvas, &error), PS_OK);
    assert_int_equal(canvas.width, WIDTH);
    assert_int_equal(canvas.height, HEIGHT);
    struct colour colour = canvas_get(&canvas, WIDTH / 2, HEIGHT / 2);
    canvas_release(&canvas);
    return colour;
}

static void expect_colour(const char *layer, uint8_t r, uint8_t g, uint8_t b)
{
    struct colour colour = middle_of(layer);
    assert_int_equal(colour.r, r);
    assert_int_equal(colour.g, g);
    assert_int_equal(colour.b, b);
}

static void test_layers_of_the_gbuffer(void **state)
{
    (void)state;
    struct colour object = id_colour(0), material = id_colour(0);
    expect_colour("gbuffer:albedo", 124, 188, 231); /* sRGB of 0.2, 0.5, 0.8 */
    expect_colour("gbuffer:normal", 128, 128, 255);
    expect_colour("gbuffer:throughput", 255, 255, 255);
    expect_colour("gbuffer:emitted", 0, 0, 0);
    expect_colour("gbuffer:object", object.r, object.g, object.b);
    expect_colour("gbuffer:material", material.r, material.g, material.b);
    struct colour position = middle_of("gbuffer:position"), depth = middle_of("gbuffer:depth");
    assert_true(abs(position.r - 128) < 3 && abs(position.g - 128) < 3 && position.b > 140);
    assert_true(depth.r > 250); /* the nearest point */
    /* 0.2 / pi * 9 / 5^2 = 0.0229 and so on */
    struct colour direct = middle_of("gbuffer:direct");
    assert_true(abs(direct.r - 42) < 3 && abs(direct.g - 67) < 3 && abs(direct.b - 84) < 3);
}

/* --- names --- */

static void expect_unknown(const char *name, const char *message)
{
    struct debug_request request;
    struct error error;
    assert_int_equal(debug_find(name, &request, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, message));
}

static void test_names_of_views(void **state)
{
    (void)state;
    struct debug_request request;
    struct error error;
    assert_int_equal(debug_find("photons", &request, &error), PS_OK);
    assert_ptr_equal(request.view, &debug_photons);
    assert_int_equal(request.part, -1);
    assert_int_equal(debug_find("gbuffer:normal", &request, &error), PS_OK);
    assert_ptr_equal(request.view, &debug_gbuffer);
    assert_int_equal(request.part, 1);
    expect_unknown("photon", "did you mean 'photons'?");
    expect_unknown("everything", "there are: photons, voxels, gbuffer, maps, overlap, pixel");
    expect_unknown("gbuffer:", "it has: albedo, normal");
    expect_unknown("gbuffer:colour", "no part 'colour'; it has: albedo, normal");
    expect_unknown("maps:1", "the view maps has no parts");
    expect_unknown("", "there is no view ''");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_overlap_is_the_weight_of_a_box),
        cmocka_unit_test(test_overlap_is_the_count_by_hand),
        cmocka_unit_test(test_overlap_needs_splats),
        cmocka_unit_test(test_light_of_a_pixel_is_the_estimators),
        cmocka_unit_test(test_what_pixels_see_is_seen),
        cmocka_unit_test(test_voxels_are_cells_of_the_grid),
        cmocka_unit_test(test_voxels_are_cells_of_the_stratification),
        cmocka_unit_test(test_layers_of_the_gbuffer),
        cmocka_unit_test(test_names_of_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
