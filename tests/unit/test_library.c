/* test_library.c: psplat.h, by the shared library: pictures are the command's, errors come as
 * values, nothing is printed, and renders don't know of each other. */
#include "image/image.h"
#include "library_fixture.h"
#include "scratch.h"
#include "support/memory_limit.h"

#include <fcntl.h>
#include <fenv.h>
#include <math.h>
#include <psplat/psplat.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static psplat_picture *render(const psplat_scene *scene, const psplat_callbacks *callbacks)
{
    psplat_error error;
    psplat_picture *picture = NULL;
    if (psplat_render(scene, callbacks, &picture, &error) != PS_OK)
        fail_msg("%s", error.message);
    assert_non_null(picture);
    return picture;
}

static void expect_same_picture(const psplat_picture *a, const psplat_picture *b)
{
    size_t pixels = psplat_picture_width(a) * psplat_picture_height(a);
    assert_int_equal(psplat_picture_width(b) * psplat_picture_height(b), pixels);
    assert_int_equal(psplat_picture_channel_count(a), psplat_picture_channel_count(b));
    for (size_t i = 0; i < psplat_picture_channel_count(a); i++) {
        const char *name = psplat_picture_channel_name(a, i);
        const float *samples = psplat_picture_channel(b, name);
        assert_non_null(samples);
        assert_memory_equal(psplat_picture_channel(a, name), samples, pixels * sizeof *samples);
    }
}

/* --- pictures
 * ---------------------------------------------------------------------------------------- */

static void expect_same_files(const char *a, const char *b)
{
    FILE *files[2] = {fopen(a, "rb"), fopen(b, "rb")};
    assert_non_null(files[0]);
    assert_non_null(files[1]);
    int byte, other;
    size_t count = 0;
    do {
        byte = getc(files[0]);
        other = getc(files[1]);
        assert_int_equal(byte, other);
    } while (++count && byte != EOF);
    assert_true(count > 1000);
    fclose(files[0]);
    fclose(files[1]);
}

/* Files are the command's, byte by byte: so are samples, and what they say of themselves. */
static void test_the_command_s_picture(void **state)
{
    char command[4096];
    const char *program = getenv("PSPLAT");
    char path[512], scene_path[512];
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    assert_non_null(program);
    assert_non_null(scene);
    snprintf(scene_path, sizeof scene_path, "%s", scratch_path(state, "scene.psd"));
    write_text(scene_path, SCENE);
    snprintf(command, sizeof command,
             "'%s' -q '%s' --size 40x20 --passes 1:3 --seed 7 --plugin denoiser=none --set "
             "render.light_samples=3 --layers all,display -o '%s' -o '%s'",
             program, scene_path, scratch_path(state, "command.exr"),
             scratch_path(state, "command.png"));
    assert_int_equal(system(command), 0);
    set(scene, "size", "40x20");
    set(scene, "passes", "1:3");
    set(scene, "seed", "7");
    set(scene, "plugin", "denoiser=none");
    set(scene, "set", "render.light_samples=3");
    set(scene, "layers", "all,display");
    set(scene, "threads", "3");
    assert_int_equal(psplat_scene_load(scene, scene_path, &error), PS_OK);
    psplat_picture *picture = render(scene, NULL);
    assert_string_equal(psplat_picture_attribute(picture, "psplat.seed"), "7");
    snprintf(path, sizeof path, "%s", scratch_path(state, "library.exr"));
    assert_int_equal(psplat_picture_write(picture, path, &error), PS_OK);
    expect_same_files(path, scratch_path(state, "command.exr"));
    snprintf(path, sizeof path, "%s", scratch_path(state, "library.png"));
    assert_int_equal(psplat_picture_write(picture, path, NULL), PS_OK);
    expect_same_files(path, scratch_path(state, "command.png"));
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

static void test_channels(void **state)
{
    (void)state;
    psplat_scene *scene = psplat_scene_create();
    load(scene, SCENE);
    psplat_picture *picture = render(scene, NULL);
    assert_int_equal(psplat_picture_width(picture), 32);
    assert_int_equal(psplat_picture_height(picture), 18);
    size_t count = psplat_picture_channel_count(picture);
    assert_null(psplat_picture_channel_name(picture, count));
    assert_null(psplat_picture_channel(picture, "W"));
    assert_null(psplat_picture_attribute(picture, "psplat.weather"));
    assert_null(psplat_picture_attribute(picture, "psplat.command")); /* of a text */
    const float *red = psplat_picture_channel(picture, "R");
    const float *direct = psplat_picture_channel(picture, "direct.R");
    const float *indirect = psplat_picture_channel(picture, "indirect.R");
    assert_true(red && direct && indirect && psplat_picture_channel(picture, "display.B"));
    double sum = 0, difference = 0;
    for (size_t i = 0; i < (size_t)32 * 18; i++) {
        sum += red[i];
        difference += red[i] - direct[i] - indirect[i];
    }
    assert_true(sum > 1.0);
    assert_true(difference * difference < 1e-6 * sum * sum);
    psplat_picture_destroy(picture);
    set(scene, "layers", "none");
    load(scene, SCENE);
    picture = render(scene, NULL);
    assert_non_null(psplat_picture_channel(picture, "R"));
    assert_null(psplat_picture_channel(picture, "N.X"));
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

static void test_a_preview_yields_to_what_is_said(void **state)
{
    (void)state;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "passes", "2");
    set(scene, "plugin", "injection=photon:count=70");
    set(scene, "preview", NULL);
    load(scene, SCENE);
    psplat_picture *picture = render(scene, NULL);
    assert_string_equal(psplat_picture_attribute(picture, "psplat.passes"), "2");
    assert_string_equal(psplat_picture_attribute(picture, "psplat.denoiser"), "none");
    assert_non_null(strstr(psplat_picture_attribute(picture, "psplat.injection"), "count=70"));
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

/* A part of the picture alone. */
static void test_a_crop(void **state)
{
    (void)state;
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "plugin", "denoiser=none");
    load(scene, SCENE);
    psplat_picture *whole = render(scene, NULL);
    set(scene, "crop", "5,3,20,9");
    load(scene, SCENE);
    psplat_picture *part = render(scene, NULL);
    assert_int_equal(psplat_picture_width(part), 20);
    assert_int_equal(psplat_picture_height(part), 9);
    assert_string_equal(psplat_picture_attribute(part, "psplat.crop"), "5,3,20,9");
    for (size_t y = 0; y < 9; y++)
        assert_memory_equal(psplat_picture_channel(part, "R") + 20 * y,
                            psplat_picture_channel(whole, "R") + 32 * (y + 3) + 5,
                            20 * sizeof(float));
    set(scene, "crop", "20,0,20,9");
    assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error),
                     PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "--crop: "));
    psplat_picture_destroy(part);
    psplat_picture_destroy(whole);
    psplat_scene_destroy(scene);
}

/* A mesh file, which is a scene by itself. */
static void test_a_model(void **state)
{
    psplat_error error;
    const char *path = scratch_path(state, "wedge.obj");
    write_text(path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    psplat_scene *scene = psplat_scene_create();
    set(scene, "size", "32x18");
    set(scene, "plugin", "injection=photon:count=500");
    if (psplat_scene_load(scene, path, &error) != PS_OK)
        fail_msg("%s", error.message);
    psplat_picture *picture = render(scene, NULL);
    const float *red = psplat_picture_channel(picture, "R");
    assert_true(red[9 * 32 + 16] > 0.0f);
    assert_string_equal(psplat_picture_attribute(picture, "psplat.scene"), path);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

/* --- callbacks
 * --------------------------------------------------------------------------------------- */

struct watch {
    uint32_t passes, stop_after;
    double fraction;
    psplat_rendering *rendering;
    psplat_picture *so_far;
    ps_result out_of_place;
    _Atomic(int) stop;
};

static void note_progress(void *user, const psplat_progress *progress)
{
    struct watch *watch = user;
    psplat_picture *picture;
    assert_true(progress->stage[0] != '\0');
    assert_true(progress->fraction >= watch->fraction && progress->fraction <= 1.0);
    assert_true(progress->passes >= watch->passes && progress->passes <= 3);
    assert_true(progress->error < 0.0);
    watch->fraction = progress->fraction;
    if (watch->rendering)
        watch->out_of_place = psplat_rendering_picture(watch->rendering, &picture, NULL);
}

static int asks_to_stop(void *user)
{
    struct watch *watch = user;
    return watch->stop;
}

static void note_pass(void *user, psplat_rendering *rendering, uint32_t passes)
{
    struct watch *watch = user;
    psplat_error error;
    assert_int_equal(passes, ++watch->passes);
    watch->rendering = rendering;
    if (passes != watch->stop_after)
        return;
    assert_int_equal(psplat_rendering_picture(rendering, &watch->so_far, &error), PS_OK);
    watch->stop = 1;
}

static psplat_callbacks watching(struct watch *watch)
{
    return (psplat_callbacks){
        .size = sizeof(psplat_callbacks),
        .user = watch,
        .progress = note_progress,
        .cancelled = asks_to_stop,
        .pass = note_pass,
    };
}

static void test_passes_as_they_come(void **state)
{
    (void)state;
    struct watch watch = {.stop_after = 0};
    psplat_callbacks callbacks = watching(&watch);
    psplat_scene *scene = psplat_scene_create();
    set(scene, "passes", "3");
    load(scene, SCENE);
    psplat_picture *watched = render(scene, &callbacks), *alone = render(scene, NULL);
    assert_int_equal(watch.passes, 2);
    assert_true(watch.fraction > 0.9);
    assert_int_equal(watch.out_of_place, PS_ERROR_INVALID);
    expect_same_picture(watched, alone);
    psplat_picture_destroy(watched);
    psplat_picture_destroy(alone);
    psplat_scene_destroy(scene);
}

static int stops_at_once(void *user)
{
    (void)user;
    return 1;
}

static void test_light_of_a_pixel(void **state)
{
    (void)state;
    psplat_scene *scene = psplat_scene_create();
    psplat_pixel_light *light;
    psplat_error error;
    const psplat_callbacks stopping = {.size = sizeof stopping, .cancelled = stops_at_once};
    assert_int_equal(psplat_pixel_light_find(scene, 0, 0, NULL, &light, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "no scene is loaded"));
    set(scene, "plugin", "injection=photon:count=2000");
    load(scene, SCENE);
    const unsigned x = 16, y = 15; /* on the floor, before the box */
    assert_int_equal(psplat_pixel_light_find(scene, x, y, NULL, &light, &error), PS_OK);
    assert_true(light->source_count > 0 && light->source_count < light->photon_count);
    float sum = 0;
    for (size_t i = 0; i < light->source_count; i++) {
        const psplat_pixel_source *source = &light->sources[i];
        sum += source->irradiance[1];
        assert_true(source->bounce >= 1);
        assert_true(source->flags == 0 || source->flags & PSPLAT_SOURCE_PROJECTED);
    }
    assert_true(fabsf(sum / light->irradiance[1] - 1) < 1e-3f);
    psplat_pixel_light_destroy(light);
    psplat_pixel_light_destroy(NULL);
    assert_int_equal(psplat_pixel_light_find(scene, 99999, 0, NULL, &light, &error),
                     PS_ERROR_INVALID);
    assert_null(light);
    assert_non_null(strstr(error.message, "outside of the picture"));
    assert_int_equal(psplat_pixel_light_find(scene, x, y, &stopping, &light, &error), PS_CANCELLED);
    assert_null(light);
    psplat_scene_destroy(scene);
}

/* About so many pixels, of the same view and light; all, where there are fewer. */
static void test_previews(void **state)
{
    (void)state;
    psplat_error error;
    psplat_picture *few, *all;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "size", "320x160");
    set(scene, "quality", "draft");
    load(scene, SCENE);
    assert_int_equal(psplat_preview(scene, 800, NULL, &few, &error), PS_OK);
    assert_int_equal(psplat_picture_width(few), 40);
    assert_int_equal(psplat_picture_height(few), 20);
    assert_int_equal(psplat_preview(scene, 1000000, NULL, &all, &error), PS_OK);
    psplat_picture *rendered = render(scene, NULL);
    expect_same_picture(all, rendered);
    double light[2] = {0, 0};
    const psplat_picture *pictures[2] = {few, all};
    for (size_t i = 0; i < 2; i++) {
        const float *samples = psplat_picture_channel(pictures[i], "G");
        size_t count = psplat_picture_width(pictures[i]) * psplat_picture_height(pictures[i]);
        for (size_t j = 0; j < count; j++)
            light[i] += (double)samples[j] / (double)count;
    }
    assert_true(light[1] > 0.0 && fabs(light[0] / light[1] - 1.0) < 0.05);
    psplat_picture_destroy(rendered);
    psplat_picture_destroy(all);
    psplat_picture_destroy(few);
    psplat_scene_destroy(scene);
}

static void test_cancelled_preview(void **state)
{
    (void)state;
    const psplat_callbacks callbacks = {.size = sizeof callbacks, .cancelled = stops_at_once};
    psplat_error error;
    psplat_picture *picture;
    psplat_scene *scene = psplat_scene_create();
    load(scene, SCENE);
    assert_int_equal(psplat_preview(scene, 100, &callbacks, &picture, &error), PS_CANCELLED);
    assert_null(picture);
    psplat_scene_destroy(scene);
}

static void test_cancelled_between_passes(void **state)
{
    (void)state;
    struct watch watch = {.stop_after = 2};
    psplat_callbacks callbacks = watching(&watch);
    psplat_error error;
    psplat_picture *picture;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "passes", "5");
    load(scene, SCENE);
    assert_int_equal(psplat_render(scene, &callbacks, &picture, &error), PS_CANCELLED);
    assert_int_equal(error.result, PS_CANCELLED);
    assert_non_null(picture);
    assert_string_equal(psplat_picture_attribute(picture, "psplat.passes"), "2");
    set(scene, "passes", "2");
    load(scene, SCENE);
    psplat_picture *two = render(scene, NULL);
    expect_same_picture(watch.so_far, two);
    psplat_picture_destroy(two);
    psplat_picture_destroy(watch.so_far);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

static void test_cancelled_from_the_start(void **state)
{
    (void)state;
    struct watch watch = {.stop = 1};
    psplat_callbacks callbacks = watching(&watch);
    psplat_picture *picture;
    psplat_scene *scene = psplat_scene_create();
    load(scene, SCENE);
    assert_int_equal(psplat_render(scene, &callbacks, &picture, NULL), PS_CANCELLED);
    if (picture)
        assert_string_equal(psplat_picture_attribute(picture, "psplat.passes"), "0");
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int stops_after_a_while(void *user)
{
    const double *start = user;
    return seconds_now() > *start + 0.2;
}

/* A pass that would take hours is left where it is. */
static void test_cancelled_within_a_pass(void **state)
{
    (void)state;
    static const char *const estimators[] = {
        "estimator=pathtrace:samples=1048576",
        "estimator=gather:samples=65536",
        "estimator=bdpt:samples=1048576",
        "estimator=final_gather:samples=65536",
        "estimator=splat",
        "estimator=photonmap",
        "estimator=sppm",
        "estimator=irradiance_cache:samples=65536,spacing=0.01",
        "estimator=radiosity:epsilon=1e-6,samples=65536",
        "estimator=vpl:lights=1000000",
        "estimator=lightcuts:lights=1000000,error=0.0001",
        "estimator=voxel_cone:resolution=512,cones=1024",
        "estimator=lpv:cells=64,cascades=4",
        "estimator=hbao:slices=64,steps=64",
        "estimator=ssao:samples=4096",
    };
    for (size_t i = 0; i < sizeof estimators / sizeof estimators[0]; i++) {
        double start = seconds_now();
        const psplat_callbacks callbacks = {
            .size = sizeof callbacks, .user = &start, .cancelled = stops_after_a_while};
        psplat_picture *picture;
        psplat_scene *scene = psplat_scene_create();
        set(scene, "plugin", "injection=photon:count=100000000");
        set(scene, "plugin", estimators[i]);
        set(scene, "size", "800x450");
        load(scene, SCENE);
        if (psplat_render(scene, &callbacks, &picture, NULL) != PS_CANCELLED)
            fail_msg("%s: not cancelled", estimators[i]);
        psplat_picture_destroy(picture);
        psplat_scene_destroy(scene);
    }
}

static void test_callbacks_of_other_versions(void **state)
{
    (void)state;
    psplat_callbacks callbacks = {.size = sizeof callbacks + 8};
    psplat_error error;
    psplat_picture *picture;
    psplat_scene *scene = psplat_scene_create();
    load(scene, SCENE);
    assert_int_equal(psplat_render(scene, &callbacks, &picture, &error), PS_ERROR_INVALID);
    assert_null(picture);
    callbacks.size = 0;
    assert_int_equal(psplat_render(scene, &callbacks, &picture, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.message, "psplat_callbacks.size is 0"));
    callbacks.size = offsetof(psplat_callbacks, progress) + 1;
    assert_int_equal(psplat_render(scene, &callbacks, &picture, &error), PS_ERROR_INVALID);
    callbacks.size = offsetof(psplat_callbacks, progress);
    psplat_picture_destroy(render(scene, &callbacks));
    psplat_scene_destroy(scene);
}

/* --- errors
 * ------------------------------------------------------------------------------------------ */

static void expect_error(const psplat_error *error, const char *file, int line, int column,
                         const char *message)
{
    assert_string_equal(error->file, file);
    assert_int_equal(error->line, line);
    assert_int_equal(error->column, column);
    if (!strstr(error->message, message))
        fail_msg("no '%s' in '%s'", message, error->message);
}

static void test_wrong_options(void **state)
{
    (void)state;
    static const struct {
        const char *option, *value, *message;
    } wrong[] = {
        {"sise", "1x1", "unknown option 'sise'; did you mean 'size'?"},
        {"output", "a.jpg", "--output: 'a.jpg' ends neither in .exr nor in .png"},
        {"checkpoint", "film.png", "--checkpoint: a film needs a name that ends in .exr"},
        {"error", "0", "--error: expected percent such as 2%, got '0'"},
        {"size", "10", "--size: expected WxH, each 1..65536, got '10'"},
        {"size", NULL, "--size: a value is missing"},
        {"preview", "yes", "--preview: it takes no value"},
        {"threads", "0", "--threads: expected a whole number 1..1024, got '0'"},
        {"passes", "3:2", "--passes: expected a whole number 4..1000000, got '2'"},
        {"quality", "best", "--quality: expected"},
        {"bounces", "-1", "--bounces: expected"},
        {"direct", "maps", "--direct: expected rays or shadowmap, got 'maps'"},
        {"exposure", "99", "--exposure: expected a number -20..20, got '99'"},
        {"memory-limit", "much", "--memory-limit: expected a size such as 500M or 8G, got 'much'"},
        {"layers", "depth", "--layers: expected none, or all and names among"},
        {"compression", "jpeg", "--compression: expected one of"},
        {"restrict", "/no/such/folder", "--restrict: "},
        {"isa", "bogus", "--isa: this processor has no instruction set 'bogus'"},
        {"camera", "", "--camera: a name is missing"},
        {"param", "legs", "--param: expected NAME=VALUE, got 'legs'"},
        {"param", "=3", "--param: expected NAME=VALUE, got '=3'"},
        {"set", "image", "--set: expected NAME=VALUE, got 'image'"},
        {"plugin", "filter", "--plugin: expected KIND=NAME[:KEY=VALUE,...], got 'filter'"},
        {"plugin", "filtre=box", "--plugin: expected KIND=NAME[:KEY=VALUE,...], got 'filtre=box'"},
        {"plugin", "filter=", "--plugin filter: expected NAME"},
        {"plugin", "injection=photon:count", "--plugin injection: expected KEY=VALUE, got 'count'"},
    };
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_not_equal(psplat_scene_set(scene, wrong[i].option, wrong[i].value, &error),
                             PS_OK);
        expect_error(&error, "", 0, 0, wrong[i].message);
    }
    set(scene, "allow-scene-plugins", NULL);
    assert_int_equal(psplat_scene_set(scene, "restrict", "/", &error), PS_ERROR_INVALID);
    expect_error(&error, "", 0, 0, "--restrict and --allow-scene-plugins exclude each other");
    set(scene, "size", "8x8");
    load(scene, SCENE);
    psplat_picture_destroy(render(scene, NULL));
    psplat_scene_destroy(scene);
}

/* Options that assign have lines in the message, but no file. */
static void test_wrong_assignments(void **state)
{
    (void)state;
    static const struct {
        const char *option, *value, *message;
    } wrong[] = {
        {"param", "legs=3", "--param:1:1: error: unknown parameter 'legs'"},
        {"set", "image.width=wide", "--set:1:13: error: width in image: expected"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        psplat_error error;
        psplat_scene *scene = psplat_scene_create();
        set(scene, wrong[i].option, wrong[i].value);
        assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), "a.psd", &error),
                         PS_ERROR_INVALID);
        expect_error(&error, "", 0, 0, wrong[i].message);
        psplat_scene_destroy(scene);
    }
}

/* No more threads than the system gives: it is memory that they lack. */
static void test_no_threads(void **state)
{
    (void)state;
    psplat_error error;
    if (ADDRESS_SPACE_IS_SHADOWED)
        skip();
    psplat_scene *scene = psplat_scene_create();
    set(scene, "threads", "1024");
    struct rlimit before = limit_memory(1e8);
    ps_result result = psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error);
    setrlimit(RLIMIT_AS, &before);
    assert_int_equal(result, PS_ERROR_MEMORY);
    expect_error(&error, "", 0, 0, "cannot start 1024 threads");
    psplat_scene_destroy(scene);
}

static void test_many_problems(void **state)
{
    (void)state;
    char text[2048] = "psd: 1\n";
    psplat_error error;
    for (int i = 0; i < 40; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "k%d: 0\n", i);
    psplat_scene *scene = psplat_scene_create();
    assert_int_equal(psplat_scene_load_text(scene, text, strlen(text), "a.psd", &error),
                     PS_ERROR_INVALID);
    const char *last = strrchr(error.message, '\n');
    assert_non_null(last);
    assert_non_null(strstr(last, " errors (20 shown)"));
    psplat_scene_destroy(scene);
}

static void test_wrong_scenes(void **state)
{
    static const char text[] = "psd: 1\ncamera: {locaton: [0, 0, -1]}\n";
    psplat_error error;
    psplat_picture *picture;
    psplat_scene *scene = psplat_scene_create();
    assert_int_equal(psplat_render(scene, NULL, &picture, &error), PS_ERROR_INVALID);
    expect_error(&error, "", 0, 0, "no scene is loaded");
    const char *path = scratch_path(state, "none.psd");
    assert_int_equal(psplat_scene_load(scene, path, &error), PS_ERROR_IO);
    expect_error(&error, "", 0, 0, "none.psd: error: cannot open: No such file or directory");
    assert_int_equal(psplat_scene_load_text(scene, text, strlen(text), "/here/a.psd", &error),
                     PS_ERROR_INVALID);
    expect_error(&error, "/here/a.psd", 2, 1,
                 "/here/a.psd:2:10: error: unknown key 'locaton' in camera; did you mean "
                 "'location'?\n    2 | camera: {locaton: [0, 0, -1]}\n");
    assert_int_equal(psplat_scene_load_text(scene, "", 0, NULL, NULL), PS_ERROR_INVALID);
    write_text(path, SCENE);
    assert_int_equal(psplat_scene_load_text(scene, NULL, 0, path, NULL), PS_ERROR_INVALID);
    assert_int_equal(psplat_render(scene, NULL, &picture, &error), PS_ERROR_INVALID);
    assert_null(picture);
    psplat_scene_destroy(scene);
}

static void test_wrong_strategies(void **state)
{
    (void)state;
    static const struct {
        const char *plugin, *message;
    } wrong[] = {
        {"estimator=sun", "no estimator 'sun' (there are: "},
        {"estimator=splat:sun=1", "unknown parameter 'sun' of estimator splat"},
        {"injection=photon:count=-5", "injection photon: count: expected"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        psplat_error error;
        psplat_scene *scene = psplat_scene_create();
        set(scene, "plugin", wrong[i].plugin);
        assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error),
                         PS_ERROR_INVALID);
        expect_error(&error, "", 0, 0, wrong[i].message);
        psplat_scene_destroy(scene);
    }
}

static void test_wrong_in_the_end(void **state)
{
    psplat_error error;
    psplat_scene *scene = psplat_scene_create();
    set(scene, "memory-limit", "1K");
    assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error),
                     PS_ERROR_MEMORY);
    expect_error(&error, "", 0, 0, "a picture of 32x18 pixels takes");
    set(scene, "memory-limit", "8G");
    set(scene, "plugin", "denoiser=none");
    set(scene, "layers", "error");
    assert_int_equal(psplat_scene_load_text(scene, SCENE, strlen(SCENE), NULL, &error),
                     PS_ERROR_INVALID);
    expect_error(&error, "", 0, 0, "--layers: denoiser 'none' does not estimate its error");
    set(scene, "layers", "all");
    load(scene, SCENE);
    psplat_picture *picture = render(scene, NULL);
    assert_int_equal(psplat_picture_write(picture, "a.jpg", &error), PS_ERROR_INVALID);
    expect_error(&error, "", 0, 0, "'a.jpg' ends neither in .exr nor in .png");
    assert_int_equal(psplat_picture_write(picture, "/no/such/folder/a.exr", &error), PS_ERROR_IO);
    assert_int_equal(scratch_file_count(state), 0);
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
    psplat_scene_destroy(NULL);
    psplat_picture_destroy(NULL);
}

static void keep_warning(void *user, int is_warning, const char *message)
{
    if (is_warning)
        snprintf(user, 512, "%s", message);
}

/* Nothing goes to standard output or error, whatever happens; warnings go to who listens. */
static void test_nothing_is_printed(void **state)
{
    static const char text[] =
        OBJECTS "  - triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], "
                "triangles: [[0, 1, 2], [0, 1, 3]], material: white}\n" RENDER;
    char warning[512] = "";
    const char *path = scratch_path(state, "printed");
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600), kept[2] = {dup(1), dup(2)};
    fflush(stdout);
    dup2(file, 1);
    dup2(file, 2);
    psplat_picture *picture = NULL;
    psplat_scene *scene = psplat_scene_create();
    psplat_scene_listen(scene, keep_warning, warning);
    ps_result missing = psplat_scene_load(scene, "none.psd", NULL);
    ps_result empty = psplat_scene_load_text(scene, "psd", 3, NULL, NULL);
    ps_result good = psplat_scene_load_text(scene, text, strlen(text), "flat.psd", NULL);
    ps_result rendered = good == PS_OK ? psplat_render(scene, NULL, &picture, NULL) : good;
    psplat_picture_destroy(picture);
    psplat_scene_destroy(scene);
    fflush(NULL);
    off_t printed = lseek(file, 0, SEEK_END);
    for (int i = 0; i < 2; i++) {
        dup2(kept[i], i + 1);
        close(kept[i]);
    }
    close(file);
    assert_int_equal(missing, PS_ERROR_IO);
    assert_int_equal(empty, PS_ERROR_INVALID);
    assert_int_equal(rendered, PS_OK);
    assert_int_equal(printed, 0);
    if (strncmp(warning, "flat.psd:", 9) != 0 ||
        !strstr(warning, ": warning: a triangle without area is left out\n"))
        fail_msg("%s", warning);
}

/* --- several renders
 * --------------------------------------------------------------------------------- */

#define THREADS 4

struct task {
    psplat_scene *scene;
    psplat_picture *picture;
    ps_result result;
};

static void *work(void *user)
{
    struct task *task = user;
    task->result = psplat_render(task->scene, NULL, &task->picture, NULL);
    return NULL;
}

/* Two scenes, each in two threads, all at once, give the pictures that they give one after
 * another. */
static void test_at_once(void **state)
{
    (void)state;
    psplat_scene *scenes[2] = {psplat_scene_create(), psplat_scene_create()};
    psplat_picture *alone[2];
    struct task tasks[THREADS];
    pthread_t threads[THREADS];
    set(scenes[0], "threads", "2");
    set(scenes[1], "threads", "3");
    set(scenes[1], "passes", "2");
    set(scenes[1], "plugin", "estimator=splat");
    set(scenes[1], "direct", "shadowmap");
    for (int i = 0; i < 2; i++) {
        load(scenes[i], SCENE);
        alone[i] = render(scenes[i], NULL);
    }
    for (int i = 0; i < THREADS; i++) {
        tasks[i] = (struct task){.scene = scenes[i % 2]};
        assert_int_equal(pthread_create(&threads[i], NULL, work, &tasks[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(tasks[i].result, PS_OK);
        expect_same_picture(tasks[i].picture, alone[i % 2]);
        psplat_picture_destroy(tasks[i].picture);
    }
    for (int i = 0; i < 2; i++) {
        psplat_picture_destroy(alone[i]);
        psplat_scene_destroy(scenes[i]);
    }
}

struct loading {
    char path[512];
    psplat_picture *picture;
    psplat_error error;
    bool good;
};

static void *load_and_render(void *user)
{
    struct loading *loading = user;
    psplat_scene *scene = psplat_scene_create();
    loading->good = scene && !psplat_scene_set(scene, "threads", "2", &loading->error) &&
                    !psplat_scene_load(scene, loading->path, &loading->error) &&
                    !psplat_render(scene, NULL, &loading->picture, &loading->error);
    psplat_scene_destroy(scene);
    return NULL;
}

/* Plugins and meshes are loaded while others load and render. */
static void test_loading_at_once(void **state)
{
    struct loading loadings[THREADS] = {{.good = false}};
    pthread_t threads[THREADS];
    write_text(scratch_path(state, "mesh.obj"),
               "v 0 1 0\nv 1 1 0\nv 0 2 0\nv 1 2 0\nf 1 2 3\nf 2 4 3\n");
    write_text(scratch_path(state, "mesh.psd"),
               OBJECTS "  - mesh: {file: mesh.obj, material: white}\n" RENDER);
    for (int i = 0; i < THREADS; i++) {
        snprintf(loadings[i].path, sizeof loadings[i].path, "%s", scratch_path(state, "mesh.psd"));
        assert_int_equal(pthread_create(&threads[i], NULL, load_and_render, &loadings[i]), 0);
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        if (!loadings[i].good)
            fail_msg("%s", loadings[i].error.message);
        expect_same_picture(loadings[i].picture, loadings[0].picture);
    }
    for (int i = 0; i < THREADS; i++)
        psplat_picture_destroy(loadings[i].picture);
}

/* Nor does a picture depend on how the program rounds, or on whether it flushes denormal numbers;
 * which stays so. */
static void test_rounding(void **state)
{
    fenv_t usual;
    const char *path = scratch_path(state, "scene.psd");
    psplat_scene *scene = psplat_scene_create();
    write_text(path, SCENE);
    set(scene, "exposure", "0.3");
    assert_int_equal(psplat_scene_load(scene, path, NULL), PS_OK);
    psplat_picture *expected = render(scene, NULL);
    fegetenv(&usual);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
    fesetround(FE_UPWARD);
    set(scene, "exposure", "0.3");
    ps_result loaded = psplat_scene_load(scene, path, NULL);
    psplat_picture *picture = loaded == PS_OK ? render(scene, NULL) : NULL;
    int rounding = fegetround();
    fesetenv(&usual);
    assert_int_equal(loaded, PS_OK);
    assert_int_equal(rounding, FE_UPWARD);
    expect_same_picture(picture, expected);
    const char *command = psplat_picture_attribute(expected, "psplat.command");
    assert_non_null(strstr(command, "--exposure 0.3 "));
    assert_string_equal(psplat_picture_attribute(picture, "psplat.command"), command);
    psplat_picture_destroy(picture);
    psplat_picture_destroy(expected);
    psplat_scene_destroy(scene);
}

/* The header can't take them from where they are. */
static void test_compressions_are_the_image_s(void **state)
{
    (void)state;
    assert_string_equal(PSPLAT_COMPRESSIONS, IMAGE_COMPRESSIONS);
}

static void test_version(void **state)
{
    (void)state;
    int numbers[3];
    assert_int_equal(sscanf(psplat_version(), "%d.%d.%d", &numbers[0], &numbers[1], &numbers[2]),
                     3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_the_command_s_picture),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_a_preview_yields_to_what_is_said),
        cmocka_unit_test(test_a_crop),
        SCRATCH_TEST(test_a_model),
        cmocka_unit_test(test_passes_as_they_come),
        cmocka_unit_test(test_previews),
        cmocka_unit_test(test_cancelled_preview),
        cmocka_unit_test(test_cancelled_between_passes),
        cmocka_unit_test(test_cancelled_from_the_start),
        cmocka_unit_test(test_cancelled_within_a_pass),
        cmocka_unit_test(test_callbacks_of_other_versions),
        cmocka_unit_test(test_wrong_options),
        cmocka_unit_test(test_wrong_assignments),
        cmocka_unit_test(test_no_threads),
        cmocka_unit_test(test_light_of_a_pixel),
        cmocka_unit_test(test_many_problems),
        SCRATCH_TEST(test_wrong_scenes),
        cmocka_unit_test(test_wrong_strategies),
        SCRATCH_TEST(test_wrong_in_the_end),
        SCRATCH_TEST(test_nothing_is_printed),
        cmocka_unit_test(test_at_once),
        SCRATCH_TEST(test_loading_at_once),
        SCRATCH_TEST(test_rounding),
        cmocka_unit_test(test_compressions_are_the_image_s),
        cmocka_unit_test(test_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
