#include "cli/output.h"

#include "base/parallel.h"
#include "base/text.h"
#include "image/tonemap.h"
#include "job/facts.h"
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool has_suffix(const char *path, const char *suffix)
{
    size_t length = strlen(path), suffix_length = strlen(suffix);
    return length > suffix_length && strcmp(path + length - suffix_length, suffix) == 0;
}

bool output_is_writable_format(const char *path)
{
    return output_holds_layers(path) || has_suffix(path, ".png");
}

bool output_holds_layers(const char *path)
{
    return has_suffix(path, ".exr");
}

bool output_parse_compression(const char *name, enum image_compression *compression)
{
    if (image_compression_named(name, compression))
        return true;
    fprintf(stderr,
            "psplat: error: --compression: expected one of " IMAGE_COMPRESSIONS ", got '%s'\n",
            name);
    return false;
}

char *output_default_path(const char *scene_path, const char *suffix)
{
    const char *slash = strrchr(scene_path, '/');
    const char *name = slash ? slash + 1 : scene_path;
    if (strcmp(name, "-") == 0)
        name = "stdin";
    size_t length = has_suffix(name, ".psd") ? strlen(name) - 4 : strlen(name);
    size_t bytes = length + strlen(suffix) + 1;
    char *path = malloc(bytes);
    if (path)
        snprintf(path, bytes, "%.*s%s", (int)length, name, suffix);
    return path;
}

struct encoding {
    const float *red, *green, *blue; /* 0..1 */
    size_t width;
    uint8_t *rgb;
};

static void encode_row(void *user, uint64_t y, uint32_t worker)
{
    (void)worker;
    const struct encoding *work = user;
    size_t first = y * work->width;
    tonemap_planes(work->red + first, work->green + first, work->blue + first, work->width, 0.0,
                   TONE_CLIP, work->rgb + 3 * first);
}

/* The layer `display`. */
static ps_result write_png(const struct image *image, const char *path, struct workers *workers,
                           struct error *error)
{
    size_t bytes = image->width * image->height * 3;
    uint8_t *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "a PNG");
    struct encoding work = {
        .red = image_channel(image, "display.R"),
        .green = image_channel(image, "display.G"),
        .blue = image_channel(image, "display.B"),
        .width = image->width,
        .rgb = rgb,
    };
    parallel_for(workers, image->height, encode_row, &work);
    ps_result result = image_write_png(path, image->width, image->height, rgb, image->attributes,
                                       image->attribute_count, error);
    free(rgb);
    return result;
}

ps_result output_write(const struct image *image, const char *path,
                       enum image_compression compression, struct workers *workers,
                       struct error *error)
{
    if (output_holds_layers(path))
        return image_write_exr(image, path, compression, workers, error);
    return write_png(image, path, workers, error);
}

bool output_check(const char *path, struct error *error)
{
    struct stat status;
    bool exists = stat(path, &status) == 0;
    if (exists && S_ISCHR(status.st_mode))
        return true; /* a device needs no room beside it */
    if (exists && !S_ISREG(status.st_mode)) {
        error_set(error, PS_ERROR_IO, "can't write '%s': it is %s", path,
                  S_ISDIR(status.st_mode) ? "a directory" : "neither a file nor a device");
        return false;
    }
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    char *folder = length ? strndup(path, length) : strdup(".");
    bool good = folder && access(folder, W_OK | X_OK) == 0;
    if (!good)
        error_set(error, PS_ERROR_IO, "can't write '%s': %s", path, strerror(errno));
    free(folder);
    return good;
}

/* Quotes a word for a shell unless it needs none. */
static void print_word(FILE *stream, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=:,./@%";
    if (word[0] && word[strspn(word, plain)] == '\0') {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stream);
        else
            fputc(*word, stream);
    fputc('\'', stream);
}

static void print_next(void *stream, const char *word)
{
    fputc(' ', stream);
    print_word(stream, word);
}

static void print_command(FILE *stream, const struct image *image, const char *scene_path,
                          const struct scene_options *options,
                          const struct render_settings *settings)
{
    fprintf(stream, "psplat render");
    print_next(stream, strcmp(scene_path, "<stdin>") == 0 ? "-" : scene_path);
    scene_options_each_word(options, print_next, stream);
    fprintf(stream, " --size %zux%zu --passes ", image->width, image->height);
    if (settings->first_pass > 0)
        fprintf(stream, "%" PRIu32 ":", settings->first_pass);
    fprintf(stream, "%" PRIu32 " --seed %" PRIu64, settings->passes, settings->seed);
    fprintf(stream, " --bounces %s", image_attribute(image, "psplat.bounces"));
    if (settings->isa)
        fprintf(stream, " --isa %s", settings->isa);
    if (settings->direct == DIRECT_SHADOWMAP)
        fprintf(stream, " --direct shadowmap --direct-resolution %" PRIu32,
                settings->direct_resolution);
    else
        fprintf(stream, " --direct rays");
    char stops[32];
    text_from_number(settings->exposure, stops, sizeof stops);
    fprintf(stream, " --exposure %s", stops);
    for (int kind = 0; kind < PS_KINDS; kind++) {
        char choice[2048], word[2200];
        strategy_format(&settings->strategies[kind], choice, sizeof choice);
        snprintf(word, sizeof word, "%s=%s", kinds[kind].name, choice);
        fprintf(stream, " --plugin ");
        print_word(stream, word);
    }
}

static ps_result set_command(struct image *image, const char *scene_path,
                             const struct scene_options *options,
                             const struct render_settings *settings, struct error *error)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return error_memory(error, 4096, "the picture's description");
    print_command(stream, image, scene_path, options, settings);
    fclose(stream);
    ps_result result = image_set_attribute(image, "psplat.command", text, error);
    free(text);
    return result;
}

ps_result output_describe(struct image *image, const char *scene_path,
                          const struct scene_options *options,
                          const struct render_settings *settings, bool repeatable,
                          struct error *error)
{
    char passes[32];
    snprintf(passes, sizeof passes, "%" PRIu32, settings_pass_count(settings));
    ps_result result = facts_of_settings(image, scene_path, settings, error);
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.passes", passes, error);
    return result == PS_OK && repeatable ? set_command(image, scene_path, options, settings, error)
                                         : result;
}
