#include "tools/plugin_test.h"

#include "cli/command.h"
#include "parser/psd.h"
#include "pipeline/render.h"
#include "render/state.h"
#include <math.h>
#include <psplat/math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Diffuse, glossy, mirroring and clear things under a spotlight and an area light. Two passes. */
static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1.5, 6], look_at: [0, 1, 0]}\n"
    "image: {width: 48, height: 27}\n"
    "render: {passes: 2, injection: {photon: {count: 2000}}}\n"
    "materials:\n"
    "  white: {diffuse: 0.7}\n"
    "  red: {diffuse: [0.6, 0.1, 0.05]}\n"
    "  mirror: {mirror: 0.9}\n"
    "  glass: {dielectric: {ior: 1.5}}\n"
    "  gloss: {glossy: {diffuse: 0.4, specular: 0.3, roughness: 0.4}}\n"
    "lights:\n"
    "  - spotlight: {location: [0.3, 2.8, 0.9], point_at: [0, 0, 0], radius: 20, falloff: 50, "
    "intensity: [9, 8, 7]}\n"
    "  - rectangle: {corners: [[-0.5, 2.9, 0], [0.5, 2.9, 0], [0.5, 2.9, 1]], power: 20}\n"
    "objects:\n"
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: white}\n"
    "  - quad: {corners: [[-2, 0, -2], [2, 0, -2], [2, 3, -2], [-2, 3, -2]], material: red}\n"
    "  - quad: {corners: [[-2, 0, 2], [-2, 0, -2], [-2, 3, -2], [-2, 3, 2]], material: gloss}\n"
    "  - box: {corners: [[-1.2, 0, -1], [-0.4, 0.9, 0]], rotate: [0, 20, 0], material: mirror}\n"
    "  - sphere: {center: [0.9, 0.6, 0.2], radius: 0.6, material: glass}\n";

/* One strategy under trial. */
struct trial {
    struct loader *loader;
    ps_kind kind;
    const char *choice; /* "FILE[:KEY=VALUE,...]"; NULL: psplat's own */
    double stops;       /* exposure of what is shown */
    bool failed;
};

struct attempt {
    uint32_t threads;
    size_t batch;
    uint64_t calls; /* of `cancelled` before it says so; 0: it never does */
};

/* What came of an attempt. */
struct outcome {
    ps_result result;
    struct error error;
    struct image image;
    double refused, kept;
};

struct patience {
    uint64_t calls;
    _Atomic(uint64_t) asked;
};

static bool is_out_of_patience(void *user)
{
    struct patience *patience = user;
    return patience->calls > 0 && atomic_fetch_add(&patience->asked, 1) >= patience->calls;
}

static void take_report(void *user, const struct origin *origin, const char *message)
{
    (void)origin;
    error_set(user, PS_ERROR_INVALID, "%s", message);
}

static ps_result read_room(struct scene_description *description, struct error *error)
{
    struct diagnostics *sink = diagnostics_create();
    if (!sink)
        return error_memory(error, sizeof room, "diagnostics");
    ps_result result = psd_read_text("test.psd", room, strlen(room), sink, description);
    diagnostics_destroy(sink);
    return result == PS_OK ? result : error_set(error, result, "the room can't be read");
}

/* Puts the strategy under trial into the room's settings. */
static ps_result choose(const struct trial *trial, struct scene_description *description,
                        struct error *error)
{
    struct strategy_choice choice;
    ps_result result = settings_parse_choice(trial->choice, &choice, error);
    return result == PS_OK
               ? settings_override(&description->render.strategies[trial->kind], &choice, error)
               : result;
}

/* What is done with the scene and the settings. */
typedef ps_result (*settings_user)(void *user, const struct scene *scene,
                                   struct render_settings *settings, struct error *error);

static ps_result with_settings(const struct trial *trial, const struct attempt *attempt,
                               settings_user use, void *user, struct error *error)
{
    struct scene_description description;
    struct render_settings settings;
    struct scene scene;
    ps_result result = read_room(&description, error);
    if (result != PS_OK)
        return result;
    if (trial->choice)
        result = choose(trial, &description, error);
    if (result == PS_OK)
        result = settings_resolve(trial->loader, &description.render, attempt->threads,
                                  attempt->batch, take_report, error, &settings);
    if (result == PS_OK) {
        settings.display = true;
        settings.exposure = trial->stops;
        result = scene_create(&description, &scene, NULL, error);
        if (result == PS_OK) {
            result = use(user, &scene, &settings, error);
            scene_release(&scene);
        }
        settings_release(&settings);
    }
    scene_description_release(&description);
    return result;
}

struct rendering {
    struct patience patience;
    struct outcome *outcome;
};

static ps_result render(void *user, const struct scene *scene, struct render_settings *settings,
                        struct error *error)
{
    struct rendering *rendering = user;
    struct render_callbacks callbacks = {
        .user = &rendering->patience,
        .cancelled = is_out_of_patience,
    };
    struct statistics statistics;
    statistics_init(&statistics);
    ps_result result = render_run(scene, settings, &callbacks, &statistics, NULL,
                                  &rendering->outcome->image, error);
    rendering->outcome->refused = statistics_counter(&statistics, "refused");
    rendering->outcome->kept = statistics_counter(&statistics, "kept blocks");
    statistics_destroy(&statistics);
    return result;
}

static struct outcome attempt(const struct trial *trial, struct attempt attempt)
{
    struct outcome outcome = {.result = PS_OK};
    struct rendering rendering = {{attempt.calls, 0}, &outcome};
    outcome.result = with_settings(trial, &attempt, render, &rendering, &outcome.error);
    return outcome;
}

/* --- verdicts
 * ----------------------------------------------------------------------------------- */

static void verdict(struct trial *trial, bool good, const char *what, const char *why)
{
    trial->failed |= !good;
    printf("  %-7s %s%s%s\n", good ? "ok" : "FAILED", what, good ? "" : ": ", good ? "" : why);
}

static bool same_light(const struct image *a, const struct image *b)
{
    static const char *const channels[] = {"R",          "G",          "B",
                                           "indirect.R", "indirect.G", "indirect.B",
                                           "display.R",  "display.G",  "display.B"};
    for (size_t i = 0; i < sizeof channels / sizeof channels[0]; i++) {
        const float *one = image_channel(a, channels[i]), *other = image_channel(b, channels[i]);
        if (!one || !other || memcmp(one, other, a->width * a->height * sizeof *one) != 0)
            return false;
    }
    return true;
}

/* The picture is that of `first`. */
static void try_again(struct trial *trial, const struct outcome *first, struct attempt other,
                      const char *what)
{
    struct outcome outcome = attempt(trial, other);
    verdict(trial, outcome.result == PS_OK && same_light(&first->image, &outcome.image), what,
            outcome.result == PS_OK ? "the picture is another one" : outcome.error.text);
    image_release(&outcome.image);
}

/* Stopped after some questions, and at the first. */
static void try_to_stop(struct trial *trial)
{
    static const uint64_t calls[] = {1, 40};
    for (int i = 0; i < 2; i++) {
        struct outcome outcome = attempt(trial, (struct attempt){2, 4096, calls[i]});
        bool good = outcome.result == PS_CANCELLED || outcome.result == PS_OK;
        verdict(trial, good && outcome.kept == 0, i ? "stops on the way" : "stops at once",
                good ? "it keeps memory" : outcome.error.text);
        image_release(&outcome.image);
    }
}

/* --- power
 * -------------------------------------------------------------------------------------- */

struct powers {
    double all, first,
        lights; /* photons, those of the first bounce among them, and what lights send out */
};

static ps_result add_powers(void *user, struct render *render, struct error *error)
{
    struct powers *powers = user;
    const ps_photon *photons;
    size_t n;
    ps_result result;
    do {
        result = photon_stream_next(&render->photons, &photons, &n, error);
        for (size_t i = 0; i < n && result == PS_OK; i++) {
            double power = (double)ps_luminance(photons[i].power);
            powers->all += power;
            powers->first += photons[i].bounce == 1 ? power : 0.0;
        }
    } while (result == PS_OK && n > 0);
    for (size_t i = 0; i < render->scene->light_count; i++)
        powers->lights += (double)ps_luminance(light_power(&render->scene->lights[i]));
    return result;
}

static ps_result inspect(void *user, const struct scene *scene, struct render_settings *settings,
                         struct error *error)
{
    static const struct render_callbacks silent = {.user = NULL};
    struct statistics statistics;
    statistics_init(&statistics);
    ps_result result =
        render_inspect(scene, settings, &silent, &statistics, add_powers, user, error);
    statistics_destroy(&statistics);
    return result;
}

/* With the trial's choice, or with psplat's own strategies. */
static ps_result measure(const struct trial *trial, struct powers *powers, struct error *error)
{
    struct attempt attempt = {1, 4096, 0};
    *powers = (struct powers){0, 0, 0};
    return with_settings(trial, &attempt, inspect, powers, error);
}

static void try_power(struct trial *trial)
{
    struct powers powers, usual;
    struct error error;
    struct trial without = {.loader = trial->loader, .kind = trial->kind};
    if (trial->kind != PS_INJECTION && trial->kind != PS_STRATIFICATION)
        return;
    ps_result result = measure(trial, &powers, &error);
    if (result == PS_OK)
        result = measure(&without, &usual, &error);
    if (result != PS_OK)
        verdict(trial, false, "makes no light", error.text);
    else if (trial->kind == PS_INJECTION)
        verdict(trial, powers.first <= 1.01 * powers.lights, "makes no light",
                "photons carry more power than the lights have");
    else
        verdict(trial, fabs(powers.all - usual.all) <= 1e-4 * usual.all, "keeps the power",
                "the photons have another power than before");
}

/* --- light that is shown
 * --------------------------------------------------------------------------- */

static double shown_light(const struct image *image)
{
    static const char *const channels[] = {"display.R", "display.G", "display.B"};
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        const float *plane = image_channel(image, channels[c]);
        for (size_t i = 0; plane && i < image->width * image->height; i++)
            sum += (double)plane[i];
    }
    return sum;
}

/* So dark that the tone map changes nothing, and nothing is cut off. */
static void try_bloom(struct trial *trial)
{
    struct trial dark = {
        .loader = trial->loader, .kind = trial->kind, .choice = trial->choice, .stops = -10.0};
    struct trial usual = {.loader = trial->loader, .kind = trial->kind, .stops = dark.stops};
    if (trial->kind != PS_BLOOM)
        return;
    struct outcome spread = attempt(&dark, (struct attempt){1, 4096, 0});
    struct outcome sharp = attempt(&usual, (struct attempt){1, 4096, 0});
    double light = shown_light(&spread.image), there = shown_light(&sharp.image);
    bool good = spread.result == PS_OK && sharp.result == PS_OK;
    verdict(trial, good && light <= 1.001 * there, "makes no light",
            good ? "it shows more light than there was" : spread.error.text);
    image_release(&spread.image);
    image_release(&sharp.image);
}

/* --- the whole
 * ---------------------------------------------------------------------------------- */

static void try_strategy(struct trial *trial)
{
    printf("%s %s\n", kinds[trial->kind].name, trial->choice);
    struct outcome first = attempt(trial, (struct attempt){1, 4096, 0});
    verdict(trial, first.result == PS_OK, "makes a picture", first.error.text);
    if (first.result == PS_OK) {
        verdict(trial, first.refused == 0, "makes numbers",
                "some are not finite, or negative; psplat counts them in a render");
        verdict(trial, first.kept == 0, "gives back its memory", "it keeps blocks");
        try_again(trial, &first, (struct attempt){1, 4096, 0}, "makes it again");
        try_again(trial, &first, (struct attempt){3, 4096, 0}, "makes it with three threads");
        try_again(trial, &first, (struct attempt){2, 100, 0}, "makes it in small batches");
        try_to_stop(trial);
        try_power(trial);
        try_bloom(trial);
    }
    image_release(&first.image);
}

int plugin_test(struct loader *loader, const char *text)
{
    bool held[PS_KINDS] = {false}, failed = false;
    char path[4096];
    struct error error;
    size_t length = strcspn(text, ":");
    if (length >= sizeof path || !memchr(text, '/', length)) {
        print_error("--test: expected the path of a file, with a slash");
        return STATUS_USAGE;
    }
    snprintf(path, sizeof path, "%.*s", (int)length, text);
    if (loader_look(path, held, &error) != PS_OK) {
        char message[sizeof error.text];
        snprintf(message, sizeof message, "plugin %.1500s: %.2000s", path, error.text);
        print_error(message);
        return STATUS_USAGE;
    }
    for (int kind = 0; kind < PS_KINDS; kind++) {
        struct trial trial = {.loader = loader, .kind = (ps_kind)kind, .choice = text};
        if (held[kind])
            try_strategy(&trial);
        failed |= trial.failed;
    }
    return failed ? STATUS_FAILED : STATUS_OK;
}
