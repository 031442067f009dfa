/* library_fixture.h: a small scene by psplat.h, whose failures are the test's. */
#ifndef TESTS_LIBRARY_FIXTURE_H
#define TESTS_LIBRARY_FIXTURE_H

#include "scratch.h"

#include <psplat/psplat.h>

#define OBJECTS                                                                                    \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}\n"                     \
    "image: {width: 32, height: 18}\n"                                                             \
    "materials: {white: {diffuse: [0.7, 0.6, 0.5]}}\n"                                             \
    "lights:\n"                                                                                    \
    "  - spotlight: {location: [0, 3, -1], point_at: [0, 0, 0], radius: 40, falloff: 50, "         \
    "intensity: [10, 10, 10]}\n"                                                                   \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: white}\n"     \
    "  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}\n"
#define RENDER                                                                                     \
    "render:\n"                                                                                    \
    "  injection: {photon: {count: 1000}}\n"
#define SCENE OBJECTS RENDER

static inline void set(psplat_scene *scene, const char *option, const char *value)
{
    psplat_error error;
    if (psplat_scene_set(scene, option, value, &error) != PS_OK)
        fail_msg("%s=%s: %s", option, value ? value : "", error.message);
}

static inline void load(psplat_scene *scene, const char *text)
{
    psplat_error error;
    if (psplat_scene_load_text(scene, text, strlen(text), NULL, &error) != PS_OK)
        fail_msg("%s", error.message);
}

#endif
