/* command_info.c: psplat info: how a picture was made. */
#include "cli/command.h"
#include "image/image.h"

#include <stdio.h>
#include <string.h>

static void print_info(const char *path, const struct image *image)
{
    printf("%s: %zux%zu\n", path, image->width, image->height);
    printf("channels:");
    for (size_t i = 0; i < image->channel_count; i++)
        printf(" %s", image->channels[i].name);
    printf("\n");
    for (size_t i = 0; i < image->attribute_count; i++)
        if (strcmp(image->attributes[i].name, "psplat.command") != 0)
            printf("%s: %s\n", image->attributes[i].name, image->attributes[i].value);
    const char *command = image_attribute(image, "psplat.command");
    if (command)
        printf("to repeat it:\n%s\n", command);
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
        if (image_read_exr(arguments[i].value, &image, &error) != PS_OK) {
            print_error(error.text);
            return STATUS_FAILED;
        }
        print_info(arguments[i].value, &image);
        image_release(&image);
    }
    return STATUS_OK;
}

const struct command command_info = {
    .name = "info",
    .operands = "PICTURE.exr...",
    .summary = "tells how a picture was made, and the command that repeats it",
    .run = run,
};
