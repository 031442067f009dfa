/* mesh_fixture.h: imports mesh files from memory or from tests/data. */
#ifndef TESTS_MESH_FIXTURE_H
#define TESTS_MESH_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/import.h"

struct imported {
    ps_result result;
    struct scene_description fragment;
    struct mesh_report report;
    struct error error;
};

static inline struct mesh_request request_all(const char *path)
{
    return (struct mesh_request){
        .path = path,
        .geometry = true,
        .materials = true,
        .camera = true,
        .lights = true,
        .unit = 1,
        .bump_scale = 1,
        .up = 1,
        .placement = AFFINE_IDENTITY,
        .origin = {"scene.psd", 3, 5},
    };
}

/* By which a picture's kind is known. */
#define PNG_START "\x89PNG\r\n\x1a\n"

static inline struct mesh_memory_file text_file(const char *path, const char *text)
{
    return (struct mesh_memory_file){path, text, strlen(text)};
}

static inline struct imported import_files(const struct mesh_request *request,
                                           const struct mesh_memory_file *files, size_t count)
{
    struct imported imported;
    imported.error.text[0] = '\0';
    imported.result = mesh_import_memory(request, files, count, &imported.fragment,
                                         &imported.report, &imported.error);
    if (imported.result != PS_OK)
        assert_true(imported.error.text[0] != '\0');
    return imported;
}

static inline struct imported import_text(const char *path, const char *text)
{
    struct mesh_request request = request_all(path);
    struct mesh_memory_file file = text_file(path, text);
    return import_files(&request, &file, 1);
}

static inline struct imported import_disk(const struct mesh_request *request)
{
    struct imported imported;
    imported.error.text[0] = '\0';
    imported.result = mesh_import(request, &imported.fragment, &imported.report, &imported.error);
    return imported;
}

static inline void expect_success(const struct imported *imported)
{
    if (imported->result != PS_OK)
        fail_msg("%s", imported->error.text);
}

/* It failed that way, with these words. */
static inline void expect_failure(const struct imported *imported, ps_result result,
                                  const char *words)
{
    assert_int_equal(imported->result, result);
    if (!strstr(imported->error.text, words))
        fail_msg("expected \"%s\" in \"%s\"", words, imported->error.text);
    assert_int_equal(imported->fragment.object_count, 0);
    assert_null(imported->fragment.meshes);
}

static inline void release_imported(struct imported *imported)
{
    scene_description_release(&imported->fragment);
}

static inline const char *data_path(const char *name)
{
    static char path[4096];
    const char *source = getenv("PSPLAT_SOURCE");
    snprintf(path, sizeof path, "%s/tests/data/%s", source ? source : ".", name);
    return path;
}

static inline void expect_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g", value, expected);
}

static inline void expect_vector(ps_vec3 v, double x, double y, double z)
{
    const double tolerance = 2e-6 * (1 + fabs(x) + fabs(y) + fabs(z));
    if (!(fabs(v.x - x) <= tolerance && fabs(v.y - y) <= tolerance && fabs(v.z - z) <= tolerance))
        fail_msg("(%.9g, %.9g, %.9g) is not (%.9g, %.9g, %.9g)", (double)v.x, (double)v.y,
                 (double)v.z, x, y, z);
}

static inline void expect_color(ps_rgb c, double r, double g, double b)
{
    expect_vector((ps_vec3){c.r, c.g, c.b}, r, g, b);
}

static inline const struct material_description *material_named(const struct imported *imported,
                                                                const char *name)
{
    for (size_t i = 0; i < imported->fragment.material_count; i++)
        if (strcmp(imported->fragment.materials[i].name, name) == 0)
            return &imported->fragment.materials[i];
    fail_msg("no material %s", name);
    return NULL;
}

static inline const struct mesh_description *mesh_of(const struct imported *imported, size_t object)
{
    return &imported->fragment.meshes[imported->fragment.objects[object].mesh];
}

/* In the scene. */
static inline ps_vec3 corner(const struct imported *imported, size_t object, size_t triangle, int k)
{
    const struct mesh_description *mesh = mesh_of(imported, object);
    return affine_point(&imported->fragment.objects[object].placement,
                        mesh->vertices[mesh->triangles[triangle][k]]);
}

/* By the winding, in the scene. */
static inline ps_vec3 front_of(const struct imported *imported, size_t object, size_t triangle)
{
    ps_vec3 a = corner(imported, object, triangle, 0);
    ps_vec3 wound = ps_cross(ps_subtract(corner(imported, object, triangle, 1), a),
                             ps_subtract(corner(imported, object, triangle, 2), a));
    double side = affine_determinant(&imported->fragment.objects[object].placement);
    return ps_normalize(ps_scale(wound, side < 0 ? -1.0f : 1.0f));
}

#endif
