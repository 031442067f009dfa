/* importer.c: see importer.h. */
#include "pbrt/importer.h"

#include "base/input_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LARGEST_COORDINATE 1e30 /* floats hold it, and its products with what scenes have */
#define SMALLEST_DETERMINANT 1e-30

void importer_error(struct importer *importer, const struct origin *origin, int width,
                    const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    diagnostics_report_list(importer->sink, SEVERITY_ERROR, origin, width, format, arguments);
    va_end(arguments);
}

void importer_report_memory(struct importer *importer)
{
    if (!importer->no_memory)
        importer_error(importer, NULL, 0, "out of memory");
    importer->no_memory = importer->stopped = true;
}

bool importer_grow(struct importer *importer, void **items, size_t *capacity, size_t wanted,
                   size_t size)
{
    return scene_text_grow(items, capacity, wanted, size) || importer_no_memory(importer);
}

void importer_warn(struct importer *importer, const struct origin *origin, int width,
                   const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (!warnings_report(&importer->warnings, importer->sink, origin, width, format, arguments))
        importer_report_memory(importer);
    va_end(arguments);
}

const struct statement *importer_keep(struct importer *importer, struct statement *statement)
{
    struct statement *kept = malloc(sizeof *kept);
    if (!kept || !importer_grow(importer, (void **)&importer->kept, &importer->kept_capacity,
                                importer->kept_count + 1, sizeof *importer->kept)) {
        free(kept);
        importer_no_memory(importer);
        return NULL;
    }
    *kept = *statement;
    *statement = (struct statement){0};
    importer->kept[importer->kept_count++] = kept;
    return kept;
}

bool importer_placement(struct importer *importer, const struct transform *ctm,
                        const struct origin *origin, int width, struct transform *placement)
{
    struct transform mirror = transform_scale(1, 1, importer->mirror), inverse;
    *placement = transform_compose(&mirror, ctm);
    double largest = 0.0;
    for (int i = 0; i < 12; i++) {
        double value = fabs(placement->m[i / 4][i % 4]);
        largest = value <= LARGEST_COORDINATE ? fmax(largest, value) : INFINITY;
    }
    if (largest <= LARGEST_COORDINATE &&
        fabs(transform_determinant(placement)) >= SMALLEST_DETERMINANT &&
        transform_invert(placement, &inverse))
        return true;
    importer_error(importer, origin, width,
                   "the transform of this place has no inverse, or too large numbers");
    return false;
}

FILE *importer_objects(struct importer *importer)
{
    return importer->current_object ? importer->scene.group.stream : importer->scene.objects.stream;
}

static char *join(struct importer *importer, const char *folder, const char *name)
{
    bool absolute = name[0] == '/';
    size_t size = strlen(folder) + strlen(name) + 3;
    char *path = malloc(size);
    if (!path) {
        importer_no_memory(importer);
        return NULL;
    }
    snprintf(path, size, "%s%s", absolute ? "" : folder, name);
    return path;
}

char *importer_file_name(struct importer *importer, const char *name)
{
    return join(importer, importer->options->from_output, name);
}

char *importer_file_path(struct importer *importer, const char *name)
{
    char *path = join(importer, importer->options->scene_folder, name);
    if (!path || scene_text_note(&importer->scene, path))
        return path;
    free(path);
    importer_no_memory(importer);
    return NULL;
}

void importer_check_file(struct importer *importer, const struct place *place, const char *path)
{
    const char *folder = importer->options->folder;
    struct input_file file;
    struct error error;
    if (input_file_open(path, folder, &file, &error) == PS_OK)
        close(file.descriptor);
    else if (folder)
        importer_error(importer, place->origin, place->width, "%.200s: %s", path, error.text);
    else
        importer_warn(importer, place->origin, place->width, "%.200s: %s", path, error.text);
}
