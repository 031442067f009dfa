/* lit_floor.h: a wall that no lamp reaches, before a floor with one patch lit by a spotlight. */
#ifndef TESTS_SUPPORT_LIT_FLOOR_H
#define TESTS_SUPPORT_LIT_FLOOR_H

/* The scene's beginning; more objects may follow. `CAMERA`: between braces; `MORE_MATERIALS`:
 * beside `white`, after a comma. */
#define LIT_FLOOR(CAMERA, MORE_MATERIALS)                                                          \
    "psd: 1\n"                                                                                     \
    "camera: {" CAMERA "}\n"                                                                       \
    "image: {width: 96, height: 64}\n"                                                             \
    "materials: {white: {diffuse: 0.7}" MORE_MATERIALS "}\n"                                       \
    "lights: [spotlight: {location: [0, 3, 1.2], point_at: [0, 0, 1.2], radius: 12, falloff: 14, " \
    "intensity: 100}]\n"                                                                           \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, 0], [-9, 0, 0]], material: white}\n"       \
    "  - quad: {corners: [[-9, 0, 0], [9, 0, 0], [9, 9, 0], [-9, 9, 0]], material: white}\n"

#endif
