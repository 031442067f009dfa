/* command_info.c: psplat info: how a picture was made. */
#include "cli/command.h"
#include "job/error_estimate.h"
#include "job/film_file.h"

#include <stdio.h>
#include <string.h>

/* What is estimated of a picture by its layer, of a film by the variance of its passes. */
static ps_result print_error_estimate(const char *path, const struct image *image,
                                      struct error *error)
{
    double estimate = error_estimate_of_picture(image);
    const char *undenoised = "";
    if (image_attribute(image, "psplat.film")) {
        struct film_sum film;
        ps_result result = film_file_sums(path, image, &film, error);
        if (result != PS_OK)
            return result;
        estimate = error_estimate_of_film(&film);
        undenoised = ", not denoised";
        film_sum_release(&film);
    }
    if (estimate >= 0.0)
        printf("estimated error of the indirect light%s: %.3g %%\n", undenoised, 100.0 * estimate);
    return PS_OK;
}

static void print_info(const char *path, const struct image *image)
{
    const struct picture_window *window = &image->window;
    printf("%s: %zux%zu", path, image->width, image->height);
    if (window->picture_width > image->width || window->picture_height > image->height)
        printf(" at %zu,%zu of %zux%zu", window->left, window->top, window->picture_width,
               window->picture_height);
    printf("\n");
    printf("channels:");
    for (size_t i = 0; i < image->channel_count; i++)
        printf(" %s", image->channels[i].name);
    printf("\n");
    for (size_t i = 0; i < image->attribute_count; i++)
        if (strcmp(image->attributes[i].name, "psplat.command") != 0)
            printf("%s: %s\n", image->attributes[i].name, image->attributes[i].value);
}

static void print_command(const struct image *image)
{
    const char *command = image_attribute(image, "psplat.command");
    if (command)
        printf("to repeat it:\n%s\n", command);
    else if (image_attribute(image, "psplat.scaled_from"))
        printf("made in less time than a pass takes: no command repeats it\n");
    else if (image_attribute(image, "psplat.version"))
        printf(
            "interrupted in its first pass, or made from other pictures: no command repeats it\n");
    else
        printf("not made by psplat: nothing says how to repeat it\n");
}

static int run(const struct argument *arguments, size_t count)
{
    if (count == 0) {
        print_error("info: which picture? Try 'psplat info --help'.");
        return STATUS_USAGE;
    }
    for (size_t i = 0; i < count; i++) {
        struct image image = {0};
        struct error error;
        ps_result result = image_read_exr(arguments[i].value, &image, &error);
        if (result == PS_OK) {
            print_info(arguments[i].value, &image);
            result = print_error_estimate(arguments[i].value, &image, &error);
        }
        if (result == PS_OK)
            print_command(&image);
        image_release(&image);
        if (result != PS_OK) {
            print_error(error.text);
            return STATUS_FAILED;
        }
    }
    return STATUS_OK;
}

const struct command command_info = {
    .name = "info",
    .operands = "PICTURE.exr...",
    .summary = "tells how a picture was made, and the command that repeats it",
    .run = run,
};
