/* shape.c: see shape.h. */
#include "pbrt/shape.h"

#include "base/text.h"
#include <stdlib.h>
#include <string.h>

/* The path by which the scene names a mesh's file; what is compressed has to be unpacked beside it.
 * To be freed; NULL: reported. */
static char *name_mesh(struct importer *importer, const struct place *place, const char *name)
{
    size_t length = strlen(name);
    bool packed = text_has_suffix(name, ".gz");
    char *unpacked = strndup(name, packed ? length - 3 : length);
    char *path = importer_file_path(importer, name);
    char *shown = unpacked ? importer_file_name(importer, unpacked) : NULL;
    char *read = unpacked ? importer_file_path(importer, unpacked) : NULL;
    if (path && shown && read) {
        importer_check_file(importer, place, path);
        if (packed)
            importer_warn(
                importer, place->origin, place->width,
                "'%.200s' is compressed; the scene names '%.200s': unpack it with gunzip -k", name,
                shown);
    } else {
        importer_no_memory(importer);
    }
    free(unpacked);
    free(path);
    free(read);
    return shown;
}

/* A PLY file stays where it is. */
static void ply_mesh(struct importer *importer, const struct statement *statement)
{
    const char *name = statement_string(importer, statement, "filename");
    struct place place = statement_place(statement, NULL);
    struct transform placement;
    FILE *out = importer_objects(importer);
    if (!name) {
        importer_error(importer, place.origin, place.width,
                       "Shape plymesh: \"string filename\" is missing");
        return;
    }
    char *path = name_mesh(importer, &place, name);
    if (path &&
        importer_placement(importer, &importer->state.ctm, place.origin, place.width, &placement)) {
        struct surface surface = material_surface(importer, statement, -1.0);
        if (importer->state.reverse && surface.one_sided)
            importer_warn(importer, place.origin, place.width,
                          "Shape plymesh: ReverseOrientation is left out: the file's front stays");
        if (surface.material) {
            fputs("  - mesh: {file: ", out);
            put_path(out, path);
            fputs(", use: [geometry]", out);
            surface_finish(importer, out, &surface, &placement);
        }
    }
    free(path);
}

static void curve(struct importer *importer, const struct statement *statement)
{
    static const char *const names[] = {"P",      "N",     "width", "width0",    "width1",
                                        "degree", "basis", "type",  "splitdepth"};
    statement_ignore(statement, names, sizeof names / sizeof names[0]);
    importer_warn(importer, &statement->origin, statement->width,
                  "Shape curve has no counterpart: left out");
}

static const struct {
    const char *name;
    void (*add)(struct importer *importer, const struct statement *statement);
} kinds[] = {
    {"trianglemesh", triangle_mesh_add},  {"plymesh", ply_mesh},
    {"loopsubdiv", loop_subdivision_add}, {"bilinearmesh", bilinear_mesh_add},
    {"heightfield", height_field_add},    {"curve", curve},
};

void shape_add(struct importer *importer, const struct statement *statement)
{
    bool found = quadric_add(importer, statement);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0] && !found; i++)
        if (strcmp(statement->kind, kinds[i].name) == 0) {
            kinds[i].add(importer, statement);
            found = true;
        }
    if (found)
        statement_report_unused(importer, statement);
    else
        importer_warn(importer, &statement->origin, statement->width,
                      "Shape '%.40s' has no counterpart: left out", statement->kind);
}
