#include "support/render_scene.h"

#include "parser/psd.h"
#include "pipeline/render.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void report(void *user, const struct origin *origin, const char *message)
{
    (void)user;
    (void)origin;
    print_error("%s\n", message);
}

static void read_text(const char *text, struct scene_description *description)
{
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    ps_result result = psd_read_text("test.psd", text, strlen(text), sink, description);
    if (result != PS_OK)
        diagnostics_print(sink, stderr);
    assert_int_equal(result, PS_OK);
    diagnostics_destroy(sink);
}

ps_number_or_choice bounces_of(const char *text)
{
    if (strcmp(text, "all") == 0)
        return (ps_number_or_choice){.choice = 0};
    return (ps_number_or_choice){.number = atoi(text), .choice = -1};
}

static void lay_over(struct render_description *render, const char *text)
{
    const char *wanted;
    if (strncmp(text, "bounces=", 8) == 0) {
        render->bounces = bounces_of(text + 8);
        return;
    }
    struct strategy_choice choice;
    struct error error;
    ps_kind kind = kind_parse(text, &wanted);
    assert_true(kind < PS_KINDS && wanted);
    assert_int_equal(settings_parse_choice(wanted, &choice, &error), PS_OK);
    assert_int_equal(settings_override(&render->strategies[kind], &choice, &error), PS_OK);
}

/* Tests that say nothing look at splats as they are. */
static void lay_under(const char *text, struct render_description *render)
{
    if (!strstr(text, "bounces:"))
        render->bounces = bounces_of("1");
    if (!strstr(text, "aa_samples:"))
        render->aa_samples = 1;
    if (!render->strategies[PS_ESTIMATOR].name)
        lay_over(render, "estimator=splat");
    if (!render->strategies[PS_DENOISER].name)
        lay_over(render, "denoiser=none");
}

struct rendering render_text(const char *text, uint32_t threads, const char *const choices[])
{
    return render_text_in_batches(text, threads, 4096, choices);
}

void prepare_text(const char *text, uint32_t threads, size_t batch, const char *const choices[],
                  struct prepared *prepared)
{
    struct error error;
    read_text(text, &prepared->description);
    lay_under(text, &prepared->description.render);
    for (size_t i = 0; choices && choices[i]; i++)
        lay_over(&prepared->description.render, choices[i]);
    assert_int_equal(loader_create(&prepared->loader, &error), PS_OK);
    assert_int_equal(settings_resolve(prepared->loader, &prepared->description.render, threads,
                                      batch, report, NULL, &prepared->settings),
                     PS_OK);
    assert_int_equal(scene_create(&prepared->description, &prepared->scene, NULL, &error), PS_OK);
}

void prepared_release(struct prepared *prepared)
{
    scene_release(&prepared->scene);
    settings_release(&prepared->settings);
    loader_destroy(prepared->loader);
    scene_description_release(&prepared->description);
}

void inspect_text(const char *text, const char *const choices[],
                  ps_result (*inspect)(void *user, struct render *render, struct error *error),
                  void *user)
{
    struct prepared prepared;
    struct statistics statistics;
    struct render_callbacks callbacks = {.user = NULL};
    struct error error;
    prepare_text(text, 2, 100, choices, &prepared);
    statistics_init(&statistics);
    ps_result result = render_inspect(&prepared.scene, &prepared.settings, &callbacks, &statistics,
                                      inspect, user, &error);
    if (result != PS_OK)
        print_error("%s\n", error.text);
    assert_int_equal(result, PS_OK);
    statistics_destroy(&statistics);
    prepared_release(&prepared);
}

struct rendering render_text_in_batches(const char *text, uint32_t threads, size_t batch,
                                        const char *const choices[])
{
    struct prepared prepared;
    struct rendering rendering = {.image = {0}};
    struct render_callbacks callbacks = {.user = NULL};
    struct error error;
    prepare_text(text, threads, batch, choices, &prepared);
    statistics_init(&rendering.statistics);
    ps_result result = render_run(&prepared.scene, &prepared.settings, &callbacks,
                                  &rendering.statistics, NULL, &rendering.image, &error);
    if (result != PS_OK)
        print_error("%s\n", error.text);
    assert_int_equal(result, PS_OK);
    prepared_release(&prepared);
    return rendering;
}

void rendering_release(struct rendering *rendering)
{
    image_release(&rendering->image);
    statistics_destroy(&rendering->statistics);
}

struct scene scene_of_text(const char *text)
{
    struct scene_description description;
    struct scene scene;
    struct error error;
    read_text(text, &description);
    assert_int_equal(scene_create(&description, &scene, NULL, &error), PS_OK);
    scene_description_release(&description);
    return scene;
}

double mean_of(const struct image *image, const char *channel, size_t x, size_t y, size_t width,
               size_t height)
{
    const float *samples = image_channel(image, channel);
    assert_non_null(samples);
    double sum = 0;
    for (size_t row = y; row < y + height; row++)
        for (size_t column = x; column < x + width; column++)
            sum += samples[row * image->width + column];
    return sum / (double)(width * height);
}

double mean_of_all(const struct image *image, const char *channel)
{
    return mean_of(image, channel, 0, 0, image->width, image->height);
}

double grain_of(const struct image *image, const char *channel, size_t x, size_t y, size_t width,
                size_t height)
{
    const float *light = image_channel(image, channel);
    double squares = 0, count = (double)(width * height);
    assert_true(x > 0 && y > 0 && x + width < image->width && y + height < image->height);
    for (size_t row = y; row < y + height; row++)
        for (size_t column = x; column < x + width; column++) {
            const float *at = &light[row * image->width + column];
            const float *above = at - image->width, *below = at + image->width;
            double off = (double)(*at - 0.25f * (at[-1] + at[1] + *above + *below));
            squares += off * off;
        }
    return sqrt(squares / count) / mean_of(image, channel, x, y, width, height);
}

void expect_same_image(const struct image *a, const struct image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channel_count, b->channel_count);
    for (size_t i = 0; i < a->channel_count; i++) {
        assert_string_equal(a->channels[i].name, b->channels[i].name);
        assert_memory_equal(a->channels[i].samples, b->channels[i].samples,
                            a->width * a->height * sizeof(float));
    }
}

char *scene_file_text(const char *name, int width, int height)
{
    const char *source = getenv("PSPLAT_SOURCE");
    char path[4096], size[64];
    assert_non_null(source);
    snprintf(path, sizeof path, "%s/scenes/%s.psd", source, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t capacity = 1 << 16;
    char *text = calloc(1, capacity);
    assert_non_null(text);
    size_t length = fread(text, 1, capacity - 256, file);
    fclose(file);
    char *found = strstr(text, "\nimage: {width: ");
    assert_non_null(found);
    const char *rest = strchr(found, '}');
    assert_non_null(rest);
    int added = snprintf(size, sizeof size, "\nimage: {width: %d, height: %d", width, height);
    memmove(found + added, rest, length - (size_t)(rest - text) + 1);
    memcpy(found, size, (size_t)added);
    return text;
}

char *cornell_text(int width, int height)
{
    char *text = scene_file_text("cornell", width, height);
    strcat(text,
           "  visibility: {shadowmap: {radius: 30, resolution: 4}}\n"); /* render comes last */
    return text;
}
