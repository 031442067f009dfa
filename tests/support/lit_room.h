/* lit_room.h: a room with things in it under lights of every kind, for tests of injections. */
#ifndef TESTS_SUPPORT_LIT_ROOM_H
#define TESTS_SUPPORT_LIT_ROOM_H

#define SCENE_HEAD                                                                                 \
    "psd: 1\ncamera: {location: [0, 1.5, 6], look_at: [0, 1, 0]}\n"                                \
    "image: {width: 16, height: 9}\n"                                                              \
    "materials:\n"                                                                                 \
    "  white: {diffuse: 0.7}\n"                                                                    \
    "  red: {diffuse: [0.6, 0.1, 0.05]}\n"                                                         \
    "  blue: {diffuse: [0.1, 0.2, 0.8]}\n"                                                         \
    "  black: {diffuse: 0}\n"                                                                      \
    "  mirror: {mirror: 0.9}\n"                                                                    \
    "  glass: {dielectric: {ior: 1.5}}\n"                                                          \
    "  gloss: {glossy: {diffuse: 0.4, specular: 0.3, roughness: 0.4}}\n"

/* Floor, two walls that meet, a box and a ball; open above and in front. */
#define ROOM_OBJECTS                                                                               \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: white}\n"     \
    "  - quad: {corners: [[-2, 0, -2], [2, 0, -2], [2, 3, -2], [-2, 3, -2]], material: red}\n"     \
    "  - quad: {corners: [[-2, 0, 2], [-2, 0, -2], [-2, 3, -2], [-2, 3, 2]], material: blue}\n"    \
    "  - box: {corners: [[-1.2, 0, -1], [-0.4, 0.9, 0]], rotate: [0, 20, 0], material: white}\n"   \
    "  - sphere: {center: [0.9, 0.6, 0.2], radius: 0.6, material: red}\n"

#define LIGHTS "lights:\n"
#define SPOT                                                                                       \
    "  - spotlight: {location: [0.3, 2.8, 0.9], point_at: [0, 0, 0], radius: 20, falloff: 50, "    \
    "intensity: [9, 8, 7]}\n"
#define TIGHT_SPOT                                                                                 \
    "  - spotlight: {location: [0.3, 2.8, 0.9], point_at: [0, 0, 0], radius: 20, falloff: 50, "    \
    "tightness: 20, intensity: 9}\n"
#define WIDE_SPOT                                                                                  \
    "  - spotlight: {location: [0.3, 1.5, 0.9], point_at: [-1, 1, -1], radius: 60, falloff: 85, "  \
    "intensity: 9}\n"
#define POINT "  - point: {location: [0.3, 1.5, 0.9], intensity: [9, 8, 7]}\n"
#define SUN "  - sun: {direction: [-1, -2, -1], irradiance: [5, 4, 3], angle: 0}\n"
#define WIDE_SUN "  - sun: {direction: [-1, -2, -1], irradiance: [5, 4, 3], angle: 20}\n"
#define RECTANGLE                                                                                  \
    "  - rectangle: {corners: [[-0.5, 2.5, 0], [0.5, 2.5, 0], [0.5, 2.5, 1]], power: 40, "         \
    "both_sides: yes}\n"
#define BALL "  - sphere: {location: [1, 2, 1], radius: 0.2, power: [30, 20, 10]}\n"
#define SKY "  - sky: {radiance: [1, 2, 3]}\n"

struct lit_scene {
    const char *name, *text;
};

static const struct lit_scene lit_rooms[] = {
    {"spotlight", SCENE_HEAD LIGHTS SPOT ROOM_OBJECTS},
    {"spotlight, tight", SCENE_HEAD LIGHTS TIGHT_SPOT ROOM_OBJECTS},
    {"spotlight, wide", SCENE_HEAD LIGHTS WIDE_SPOT ROOM_OBJECTS},
    {"point", SCENE_HEAD LIGHTS POINT ROOM_OBJECTS},
    {"sun", SCENE_HEAD LIGHTS SUN ROOM_OBJECTS},
    {"sun of 20 degrees", SCENE_HEAD LIGHTS WIDE_SUN ROOM_OBJECTS},
    {"rectangle", SCENE_HEAD LIGHTS RECTANGLE ROOM_OBJECTS},
    {"sphere", SCENE_HEAD LIGHTS BALL ROOM_OBJECTS},
    {"sky", SCENE_HEAD LIGHTS SKY ROOM_OBJECTS},
    {"spotlight, sun and sphere", SCENE_HEAD LIGHTS SPOT SUN BALL ROOM_OBJECTS},
};
#define LIT_ROOMS (sizeof lit_rooms / sizeof lit_rooms[0])

#endif
