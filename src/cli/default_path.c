#include "cli/default_path.h"

#include "base/path.h"
#include "base/text.h"
#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *default_path(const char *scene_path, const char *suffix)
{
    const char *name = strcmp(scene_path, "-") == 0 ? "stdin" : path_name(scene_path);
    size_t length = strlen(name);
    if (text_has_suffix(name, ".psd") || psplat_scene_is_model(name))
        length = (size_t)(strrchr(name, '.') - name);
    size_t bytes = length + strlen(suffix) + 1;
    char *path = malloc(bytes);
    if (path)
        snprintf(path, bytes, "%.*s%s", (int)length, name, suffix);
    else
        print_error("out of memory");
    return path;
}
