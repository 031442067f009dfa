"""What the engine does beside the picture: passes, transparency, regions, messages, errors, and frames that are kept.

blender -b --factory-startup --python-exit-code 1 --python check.py -- FOLDER
"""

import math
import os
import sys
from types import SimpleNamespace

import addon_utils
import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes

addon_utils.enable("psplat_render", default_set=True)
import psplat_render

FOLDER = sys.argv[sys.argv.index("--") + 1]
FAST = "--quality draft -p injection=photon:count=2000"
failures = []


def expect(true, text):
    if not true:
        failures.append(text)
        print("FAILED:", text)


def prepare(build=scenes.point, options=FAST):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("psplat_render", default_set=True)
    build()
    scene = bpy.context.scene
    scene.render.engine, scene.psplat.options = 'PSPLAT', options
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = (
        'OPEN_EXR_MULTILAYER', 'RGBA', '32', 'NONE')
    return scene


def render(scene, name="check.exr"):
    """The channels of the render, without the name of the layer."""
    scene.render.filepath = os.path.join(FOLDER, name)
    bpy.ops.render.render(write_still=True)
    channels = psplat_render.read_exr(scene.render.filepath)
    return {channel.split(".", 1)[1]: pixels for channel, pixels in channels.items()}


def error_of(scene):
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        return str(error)
    return ""


def check_passes():
    """Those that both engines have are Cycles' own."""
    scene = prepare()
    scene.psplat.layers = {'DIRECT', 'INDIRECT', 'ALBEDO', 'ERROR', 'WEIGHT'}
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
    ours = render(scene)
    light = sum(numpy.stack([ours[f"{name}.{letter}"] for letter in "RGB"]) for name in ("Direct", "Indirect"))
    combined = numpy.stack([ours[f"Combined.{letter}"] for letter in "RGB"])
    expect(numpy.allclose(light, combined, atol=1e-4), "direct and indirect light are the picture")
    expect(0.6 < numpy.median(ours["Albedo.G"]) < 0.75, "the albedo is that of the walls")
    expect("Error.X" in ours and ours["Weight.X"].min() >= 0, "psplat's own passes are there")
    expect((ours["Combined.A"] == 1).all(), "a picture that is not transparent is opaque")
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = 'CYCLES', 1, False
    theirs = render(scene)
    for name in ("Depth.Z", "Normal.X", "Normal.Y", "Normal.Z", "Position.X", "Position.Y", "Position.Z"):
        apart = numpy.abs(ours[name] - theirs[name])
        expect(numpy.median(apart) < 0.02, f"{name} is that of Cycles, not {numpy.median(apart)} off")


def check_transparency_and_region():
    scene = prepare(scenes.instances)
    scene.render.film_transparent = True
    whole = render(scene)
    expect(whole["Combined.A"][-1].max() == 0 and whole["Combined.A"][0].min() == 1, "the sky is transparent")
    expect(whole["Combined.R"][-1].max() == 0, "a transparent sky is black")
    scene = prepare(options=FAST + " -p denoiser=none")
    whole = render(scene)
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.5, 1
    part = render(scene)
    expect(part["Combined.G"].shape == (36, 64) and part["Combined.G"][:18].max() == 0, "a region is the rest's place")
    expect(numpy.array_equal(part["Combined.G"][18:, 16:48], whole["Combined.G"][18:, 16:48]), "a region is its part")
    scene.render.use_crop_to_border = True
    expect(numpy.array_equal(render(scene)["Combined.G"], whole["Combined.G"][18:, 16:48]), "a cropped region is its part")


def check_errors():
    expect("'z'" in error_of(prepare(options="--passes z")), "psplat's errors are told")
    for options in ("--size 9x9", "--help", "--layers=none", "-qo x.exr"):
        expect("set by the add-on" in error_of(prepare(options=options)), f"{options} is refused")
    expect("another size" in error_of(prepare(options=FAST + " --set image.width=20")), "another size is told")
    expect("No closing quotation" in error_of(prepare(options='"')), "a quote that is left open is told")
    scene = prepare()
    scene.camera = None
    expect(error_of(scene) != "", "a scene without a camera is an error")
    scene = prepare()
    bpy.context.preferences.addons["psplat_render"].preferences.program = "/nowhere/psplat"
    expect("/nowhere/psplat" in error_of(scene), "a program that is not there is told")
    bpy.context.preferences.addons["psplat_render"].preferences.program = "/bin/true"
    expect("without a picture" in error_of(scene), "a program that writes nothing is told")
    bpy.context.preferences.addons["psplat_render"].preferences.program = ""
    take_world, psplat_render.Exporter.take_world = psplat_render.Exporter.take_world, None
    expect("NoneType" in error_of(scene), "a fault of the add-on is an error")
    psplat_render.Exporter.take_world = take_world
    scene.camera.scale = 0, 0, 0
    expect(scene.camera.name in error_of(scene), "a camera that looks nowhere is told by its name")
    scene.camera.scale = 1, 1, 1
    expect(psplat_render.progress_of("[1]") is None and psplat_render.progress_of("hello") is None,
           "other lines than progress are passed over")
    expect(error_of(scene) == "", "after errors a render is a render")


def check_strategies():
    names = psplat_render.strategies("estimator")(None, None, "")
    expect("gather" in names and "pathtrace" in names, "psplat's strategies are suggested")
    scene = prepare()
    scene.psplat.estimator, scene.psplat.bounces, scene.psplat.passes = "ambient:color=0", 1, 2
    expect(error_of(scene) != "", "parameters of strategies reach psplat")
    scene.psplat.estimator = "pathtrace:samples=1"
    expect(error_of(scene) == "", "strategies reach psplat")


def check_frames():
    scene = prepare()
    kept = os.path.join(FOLDER, "frames")
    scene.psplat.frames, scene.frame_start, scene.frame_end = kept, 1, 2
    box = bpy.data.objects["Box"]
    box.keyframe_insert("location", frame=1)
    box.location.x = -0.6
    box.keyframe_insert("location", frame=2)
    scene.render.filepath = os.path.join(FOLDER, "animation-")
    pictures = [os.path.join(kept, "Scene", "ViewLayer", f"{frame:04d}", "picture.exr") for frame in (1, 2)]

    def times():
        bpy.ops.render.render(animation=True)
        return [os.stat(path).st_mtime_ns for path in pictures]

    first = times()
    one, two = (psplat_render.read_exr(path)["G"] for path in pictures)
    expect(not numpy.array_equal(one, two), "frames differ")
    expect(times() == first, "frames that are whole are not rendered again")
    written = psplat_render.read_exr(os.path.join(FOLDER, "animation-0002.exr"))["ViewLayer.Combined.G"]
    expect(numpy.array_equal(written, two), "a frame that was kept is the picture")
    scene.psplat.seed = 7
    expect(all(a != b for a, b in zip(times(), first)), "other settings make frames anew")
    psplat_render.Frames(os.path.dirname(pictures[0])).write("another", True)
    os.remove(os.path.join(os.path.dirname(pictures[1]), "picture.exr"))
    bpy.ops.render.render(animation=True)
    expect(all(map(os.path.isfile, pictures)), "frames that are not whole are made whole")
    os.truncate(pictures[0], 5000)
    with open(os.path.join(os.path.dirname(pictures[1]), "state.json"), "w", encoding="utf-8") as file:
        file.write("[1]")
    bpy.ops.render.render(animation=True)
    expect(len(psplat_render.read_exr(pictures[0])["G"]) == 36, "a damaged picture is made anew")
    names = [("a", "b"), ("a/b", "c"), ("a:b", "c"), ("..", "c"), ("a", "B/.")]
    places = [psplat_render.Frames.place(SimpleNamespace(name_full=one, frame_current=1, frame_subframe=part),
                                         SimpleNamespace(name=other)) for one, other in names for part in (0, 0.5)]
    expect(len(set(places)) == 10 and places[1] == ("a", "b", "0001.5000"), "frames have folders of their own")
    expect(all(".." not in place for place in places), "frames stay in their folder")


def check_unknown():
    """Warnings of shaders go to Blender's console; the shell looks for them."""
    def build():
        scenes.point()
        scenes.add("Velvet", scenes.cube("Velvet", 0.2, scenes.material("Velvet", "ShaderNodeBsdfVelvet")))
        # A name that would be a formula, and one that others have.
        for name in ("=1+", "1+", "White / 1"):
            scenes.add(name, scenes.cube(name, 0.2, scenes.diffuse(name, 0.5, 0.5, 0.5)))
        bpy.data.objects["Box"].scale.z = 0
        scenes.add("Line", scenes.mesh("Line", [(0, 0, 1), (1, 0, 1), (2, 0, 1)], [(0, 1, 2)], None))
        scenes.add("Nothing", bpy.data.meshes.new("Nothing"))
        scenes.light('AREA', (0, 0, 2)).scale.x = 0
        scenes.light('SUN', (0, 0, 2)).scale = 0, 0, 0
        scenes.light('POINT', (math.nan, 0, 2)).name = "Nowhere"
        scenes.add("Far", scenes.cube("Far", 0.2, None), (0, 0, math.nan))
        hole = scenes.cube("Hole", 0.2, None)
        hole.vertices[0].co.x = math.nan
        scenes.add("Hole", hole)
    expect(error_of(prepare(build)) == "", "what psplat does not know, or has no extent, is left out")


for check in (check_passes, check_transparency_and_region, check_errors, check_strategies, check_frames, check_unknown):
    check()
if failures:
    raise SystemExit(f"{len(failures)} checks failed")
