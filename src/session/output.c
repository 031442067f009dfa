#include "session/output.h"

#include "base/parallel.h"
#include "base/path.h"
#include "base/shell_word.h"
#include "base/text.h"
#include "image/tonemap.h"
#include "job/facts.h"
#include "session/layers.h"
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_is_writable_format(const char *path)
{
    return output_holds_layers(path) || text_has_suffix(path, ".png");
}

bool output_holds_layers(const char *path)
{
    return text_has_suffix(path, ".exr");
}

struct encoding {
    const float *red, *green, *blue; /* 0..1, from the part's first pixel on */
    size_t width;                    /* of the planes */
    uint32_t x, y;                   /* of that pixel in the picture */
    size_t count;                    /* pixels of a row */
    uint8_t *rgb;
    size_t stride;
};

static void encode_row(void *user, uint64_t y, uint32_t worker)
{
    (void)worker;
    const struct encoding *work = user;
    size_t first = y * work->width;
    tonemap_row(work->red + first, work->green + first, work->blue + first, work->count, work->x,
                work->y + (uint32_t)y, work->rgb + y * work->stride);
}

void output_encode(const struct image *image, struct rectangle part, uint8_t *rgb, size_t stride,
                   struct workers *workers)
{
    size_t first = (part.y - image->window.top) * image->width + part.x - image->window.left;
    struct encoding work = {
        .red = image_channel(image, "display.R") + first,
        .green = image_channel(image, "display.G") + first,
        .blue = image_channel(image, "display.B") + first,
        .width = image->width,
        .x = (uint32_t)part.x,
        .y = (uint32_t)part.y,
        .count = part.width,
        .rgb = rgb,
        .stride = stride,
    };
    parallel_for(workers, part.height, encode_row, &work);
}

/* The layer `display`. */
static ps_result write_png(const struct image *image, const char *path, struct workers *workers,
                           struct error *error)
{
    size_t stride = 3 * image->width, bytes = image->height * stride;
    const struct rectangle all = {image->window.left, image->window.top, image->width,
                                  image->height};
    uint8_t *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "a PNG");
    output_encode(image, all, rgb, stride, workers);
    ps_result result = image_write_png(path, image->width, image->height, rgb, image->attributes,
                                       image->attribute_count, error);
    free(rgb);
    return result;
}

ps_result output_kept_layers(const struct image *image, const struct output_options *options,
                             struct image *kept, struct error *error)
{
    size_t bytes = image->channel_count * sizeof *image->channels;
    *kept = *image;
    kept->channels = malloc(bytes + 1);
    kept->channel_count = 0;
    if (!kept->channels)
        return error_memory(error, bytes, "the picture's channels");
    for (size_t i = 0; i < image->channel_count; i++)
        if (layers_keep(output_options_layers(options), image->channels[i].name))
            kept->channels[kept->channel_count++] = image->channels[i];
    return PS_OK;
}

static ps_result write_exr(const struct image *image, const char *path,
                           const struct output_options *options, struct workers *workers,
                           struct error *error)
{
    struct image kept;
    ps_result result = output_kept_layers(image, options, &kept, error);
    if (result == PS_OK)
        result = image_write_exr(&kept, path, options->compression, workers, error);
    free(kept.channels);
    return result;
}

ps_result output_write(const struct image *image, const char *path,
                       const struct output_options *options, struct workers *workers,
                       struct error *error)
{
    return output_holds_layers(path) ? write_exr(image, path, options, workers, error)
                                     : write_png(image, path, workers, error);
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
    size_t length = (size_t)(path_name(path) - path);
    char *folder = length > 0 ? strndup(path, length) : strdup(".");
    bool good = folder && access(folder, W_OK | X_OK) == 0;
    if (!good)
        error_set(error, PS_ERROR_IO, "can't write '%s': %s", path, strerror(errno));
    free(folder);
    return good;
}

static bool is_file(const struct stat *file, const char *path)
{
    struct stat other;
    return stat(path, &other) == 0 && other.st_dev == file->st_dev && other.st_ino == file->st_ino;
}

static const char *role_in(const struct scene_description *description, const struct stat *file)
{
    for (size_t i = 0; i < description->texture_count; i++)
        if (!description->textures[i].bytes && is_file(file, description->textures[i].path))
            return "a picture that the scene reads";
    for (size_t i = 0; i < description->file_count; i++)
        if (is_file(file, description->files[i]))
            return "a file of the scene";
    return NULL;
}

bool output_check_not_input(const char *path, const char *option,
                            const struct scene_description *description, struct error *error)
{
    struct stat file;
    const char *role = stat(path, &file) == 0 ? role_in(description, &file) : NULL;
    if (role)
        error_set(error, PS_ERROR_INVALID, "%s is %s; give %s another name", path, role, option);
    return !role;
}

static void print_next(void *stream, const char *word)
{
    fputc(' ', stream);
    shell_word_print(stream, word);
}

static void print_command(FILE *stream, const struct image *image, const char *scene_path,
                          const struct scene_options *options,
                          const struct render_settings *settings, uint32_t passes)
{
    fprintf(stream, "psplat render ");
    shell_word_print_path(stream, strcmp(scene_path, "<stdin>") == 0 ? "-" : scene_path);
    scene_options_each_word(options, print_next, stream);
    fprintf(stream, " --size %zux%zu", image->window.picture_width, image->window.picture_height);
    if (settings->tile > 0)
        fprintf(stream, " --tile %" PRIu32, settings->tile);
    else if (settings->crop.width > 0)
        fprintf(stream, " --crop %s", image_attribute(image, "psplat.crop"));
    fprintf(stream, " --passes ");
    if (settings->first_pass > 0)
        fprintf(stream, "%" PRIu32 ":", settings->first_pass);
    fprintf(stream, "%" PRIu32 " --seed %" PRIu64, settings->first_pass + passes, settings->seed);
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
        shell_word_print(stream, word);
    }
}

static ps_result set_command(struct image *image, const char *scene_path,
                             const struct scene_options *options,
                             const struct render_settings *settings, uint32_t passes,
                             struct error *error)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return error_memory(error, 4096, "the picture's description");
    print_command(stream, image, scene_path, options, settings, passes);
    fclose(stream);
    ps_result result = image_set_attribute(image, "psplat.command", text, error);
    free(text);
    return result;
}

ps_result output_describe(struct image *image, const char *scene_path,
                          const struct scene_options *options,
                          const struct render_settings *settings, uint32_t passes, bool repeatable,
                          struct error *error)
{
    char number[32];
    snprintf(number, sizeof number, "%" PRIu32, passes);
    ps_result result = facts_of_settings(image, scene_path, settings, error);
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.passes", number, error);
    return result == PS_OK && repeatable
               ? set_command(image, scene_path, options, settings, passes, error)
               : result;
}
