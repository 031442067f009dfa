/* option_rows.h: rows that the tables of several commands have in common. */
#ifndef CLI_OPTION_ROWS_H
#define CLI_OPTION_ROWS_H

#include "cli/command.h"

/* The files of a picture. */
#define OUTPUT_OPTIONS                                                                             \
    {'o', "output", "FILE", "write FILE (.exr or .png); may be given several times"},              \
        {0, "layers", "NAME,...",                                                                  \
         "layers of EXR files beside the picture; or none, or all (default), which is all but "    \
         "display"},                                                                               \
    {                                                                                              \
        0, "compression", "NAME",                                                                  \
            "compression of EXR files, all lossless: " PSPLAT_COMPRESSIONS "; default: zip"        \
    }

/* What changes a scene as it is read. */
#define SCENE_OPTIONS                                                                              \
    {0, "param", "NAME=VALUE", "give a parameter of the scene a value"},                           \
        {0, "set", "KEY.KEY=VALUE", "set a value in the scene; items of lists count from 0"},      \
        {0, "camera", "NAME", "look through another camera of the scene"},                         \
        {0, "restrict", "DIR", "refuse files outside of DIR to the scene"},                        \
        {0, "cache", "DIR", "keep what is made of meshes and pictures in DIR for the next time"},  \
        {0, "texture-memory", "SIZE",                                                              \
         "memory for the scene's pictures, as 500M or 8G; with --cache the rest stays on disk"},   \
    {                                                                                              \
        0, "allow-scene-plugins", NULL, "let the scene run plugins that it names by a path"        \
    }

/* And what it is rendered with. */
#define RENDER_OPTIONS                                                                             \
    {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]", "use another strategy, or other parameters"},     \
        SCENE_OPTIONS, {0, "size", "WxH", "width and height of the picture in pixels"},            \
        {0, "quality", "NAME",                                                                     \
         "draft, normal, high or final: how many samples, where none are given"},                  \
        {0, "bounces", "N|all", "surfaces that indirect light may meet, for every estimator"},     \
        {0, "seed", "N", "seed of the random numbers"},                                            \
        {'t', "threads", "N", "threads; the picture does not depend on them"},                     \
        {0, "isa", "NAME",                                                                         \
         "instruction set: baseline, avx2 or avx512; default: the best there is"},                 \
        {0, "batch", "N", "splats held in memory at a time; the picture does not depend on it"},   \
        {0, "direct", "rays|shadowmap",                                                            \
         "how direct light finds shadows; area lights: by rays alone"},                            \
        {0, "direct-resolution", "N", "pixels along the side of each of these shadow maps"},       \
        {0, "exposure", "STOPS", "brightness of what is shown: a factor of 2^STOPS"},              \
    {                                                                                              \
        'q', "quiet", NULL, "print only warnings and errors"                                       \
    }

#endif
