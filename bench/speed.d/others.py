"""others.py: scenes of many triangles, or many lights, for psplat, POV-Ray and Blender's Cycles, and how each renders them.

Triangles: the wavy square of geometry.py under a sun. Lights: as many point lights as are asked for, a unit above a floor of
8 x 8 on which 16 boxes stand, all together as bright as one. psplat reads the mesh as glTF, POV-Ray as a mesh2 in its own
language; Blender is given the numbers themselves, which is faster than its importers. Lights are written out one by one.
"""
import array
import math
import os
import shutil

from geometry import grid, triangles_scene
from render import run_process
from table import FOLDER

EYE = {"triangles": (0, 2, -2), "lights": (0, 5, -8)}
ANGLE = 50  # degrees across
INTENSITY = 8.0
BOXES = [(-3 + 2 * i, -3 + 2 * k) for i in range(4) for k in range(4)]  # middles; 0.6 wide, 0.8 high


def light_places(number):
    """Side by side, in a square."""
    side = math.ceil(math.sqrt(number))
    return [(8 * (i % side + 0.5) / side - 4, 1.0, 8 * (i // side + 0.5) / side - 4) for i in range(number)]


def mesh_side(number):
    return max(1, round(math.sqrt(number / 2)))


def write(path, lines):
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


class Renderer:
    """`scene(folder, series, number)` writes a scene, and gives its path; `render` gives processor seconds and bytes."""

    name = program = None
    is_random = True

    def __init__(self, psplat):
        self.psplat = psplat

    def is_there(self):
        return shutil.which(self.program) is not None

    def run(self, words):
        _, usage, _ = run_process(words, os.path.join(self.psplat.folder, "log.txt"))
        return usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss


class Splatter(Renderer):
    name = "psplat"

    def is_there(self):
        return True

    def scene(self, folder, series, number):
        if series == "triangles":
            return triangles_scene(folder, number)
        boxes = [f"  - box: {{corners: [[{x - 0.3}, 0, {z - 0.3}], [{x + 0.3}, 0.8, {z + 0.3}]], material: grey}}" for x, z in BOXES]
        lights = [f"  - point: {{location: [{x:.5g}, {y}, {z:.5g}], intensity: {INTENSITY / number:.6g}}}"
                  for x, y, z in light_places(number)]
        return write(os.path.join(folder, "lights.psd"), [
            "psd: 1", "camera: {location: [0, 5, -8], look_at: [0, 0, 0]}", "materials: {grey: {diffuse: 0.7}}", "lights:", *lights,
            "objects:", "  - quad: {corners: [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], material: grey}", *boxes])

    def render(self, scene, width, height, seed, picture):
        return self.run([self.psplat.program, "render", scene, "--quiet", "--size", f"{width}x{height}", "--threads", "1", "--passes", "1",
                         "--bounces", "1", "--seed", str(seed), "--set", "render.aa_samples=1", "--set", f"camera.angle={ANGLE}", "--layers", "none",
                         "--plugin", "denoiser=none", "--plugin", "estimator=pathtrace:samples=1", "--output", picture])


class PovRay(Renderer):
    name = program = "povray"
    is_random = False

    def scene(self, folder, series, number):
        x, y, z = EYE[series]
        head = ["#version 3.7;", "global_settings { assumed_gamma 1 }",
                f"camera {{ perspective location <{x}, {y}, {z}> right x * image_width / image_height look_at <0, 0, 0> angle {ANGLE} }}",
                "#declare Grey = texture { pigment { rgb 0.7 } finish { diffuse 1 ambient 0 } }"]
        return write(os.path.join(folder, f"{series}.pov"), head + (self.mesh(number) if series == "triangles" else self.lights(number)))

    @staticmethod
    def mesh(number):
        positions, corners = grid(mesh_side(number))
        places = [f"<{x:.7g},{y:.7g},{z:.7g}>" for x, y, z in zip(*[iter(positions)] * 3)]
        faces = [f"<{a},{b},{c}>" for a, b, c in zip(*[iter(corners)] * 3)]
        return ["light_source { <0, 1000, -200> rgb 1 parallel point_at <0, 0, 0> }",
                f"mesh2 {{ vertex_vectors {{ {len(places)},", ",\n".join(places), f"}} face_indices {{ {len(faces)},", ",\n".join(faces),
                "} texture { Grey } }"]

    @staticmethod
    def lights(number):
        boxes = [f"box {{ <{x - 0.3}, 0, {z - 0.3}>, <{x + 0.3}, 0.8, {z + 0.3}> texture {{ Grey }} }}" for x, z in BOXES]
        return ["box { <-4, -0.01, -4>, <4, 0, 4> texture { Grey } }", *boxes,
                *(f"light_source {{ <{x:.5g}, {y}, {z:.5g}> rgb {INTENSITY / number:.6g} fade_distance 1 fade_power 2 }}"
                  for x, y, z in light_places(number))]

    def render(self, scene, width, height, seed, picture):
        return self.run([self.program, f"+I{scene}", f"+O{picture}.png", f"+W{width}", f"+H{height}", "-D", "-A", "+WT1"])


class Cycles(Renderer):
    name = "Cycles"
    program = "blender"

    def scene(self, folder, series, number):
        path = os.path.join(folder, f"{series}-blender")
        if series == "triangles":
            return self.write_mesh(path + ".mesh", *grid(mesh_side(number)))
        return write(path + ".txt", [" ".join(map(str, place)) for place in light_places(number)])

    @staticmethod
    def write_mesh(path, positions, corners):
        with open(path, "wb") as file:
            array.array("I", (len(positions), len(corners))).tofile(file)
            positions.tofile(file)
            corners.tofile(file)
        return path

    def render(self, scene, width, height, seed, picture):
        return self.run([self.program, "--background", "--factory-startup", "--threads", "1", "--python-exit-code", "1", "--python",
                         os.path.join(FOLDER, "cycles.py"), "--", scene, width, height, str(seed), picture, str(ANGLE), str(INTENSITY)])


RENDERERS = (Splatter, PovRay, Cycles)
