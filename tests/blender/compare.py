"""Renders scenes.py in Blender, with Cycles and with psplat, and compares the pictures.

blender -b --factory-startup --python-exit-code 1 --python compare.py -- FOLDER [--samples N] [--options TEXT]
    [--limit PERCENT] [--blocks PERCENT] [SCENE]...

Writes NAME-cycles.exr and NAME-psplat.exr to FOLDER and prints a line for each scene: its means, how far psplat's is from Cycles',
and how far blocks of 8x8 pixels are from Cycles', as the root of the mean square over the mean. Fails where a mean is farther off
than the one limit, or blocks than the other.
"""

import argparse
import os
import sys

import addon_utils
import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes

addon_utils.enable("psplat_render", default_set=True)
import psplat_render


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("psplat_render", default_set=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 128, 72
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = 'OPEN_EXR', 'RGBA', '32', 'NONE'
    return scene


def cycles(scene, samples):
    scene.render.engine = 'CYCLES'
    keys = {"samples": samples, "use_denoising": False, "use_adaptive_sampling": False, "max_bounces": 32,
            "diffuse_bounces": 32, "glossy_bounces": 32, "transmission_bounces": 32, "sample_clamp_indirect": 0,
            "blur_glossy": 0, "light_sampling_threshold": 0, "pixel_filter_type": 'BOX', "filter_width": 1}
    for key, value in keys.items():
        setattr(scene.cycles, key, value)


def psplat(scene, options):
    scene.render.engine = 'PSPLAT'
    scene.psplat.options = options


def picture(scene, path):
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    channels = psplat_render.read_exr(path)
    return numpy.stack([channels[name] for name in "RGB"], axis=-1)


def blocks(pixels):
    height, width = (size // 8 * 8 for size in pixels.shape[:2])
    return pixels[:height, :width].reshape(height // 8, 8, width // 8, 8, 3).mean(axis=(1, 3))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--options", default="")
    parser.add_argument("--limit", type=float, default=1000)
    parser.add_argument("--blocks", type=float, default=1000)
    parser.add_argument("scene", nargs="*")
    arguments = parser.parse_intermixed_args(sys.argv[sys.argv.index("--") + 1:])
    failures = []
    for build in scenes.SCENES:
        name = build.__name__
        if arguments.scene and name not in arguments.scene:
            continue
        scene = empty_scene()
        build()
        cycles(scene, arguments.samples)
        path = os.path.join(arguments.folder, name + "-cycles.exr")
        reference = picture(scene, path)
        psplat(scene, arguments.options)
        test = picture(scene, os.path.join(arguments.folder, name + "-psplat.exr"))
        off = 100 * (test.mean() / reference.mean() - 1)
        apart = 100 * numpy.sqrt(((blocks(test) - blocks(reference)) ** 2).mean()) / reference.mean()
        print(f"SCENE {name:14} cycles {reference.mean():.4f} psplat {test.mean():.4f} off {off:+.2f} % blocks {apart:.2f} %",
              flush=True)
        if not abs(off) <= arguments.limit or not apart <= arguments.blocks:
            failures.append(name)
    if failures:
        raise SystemExit("FAILED: " + ", ".join(failures))


main()
