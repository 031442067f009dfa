"""cycles.py: run by Blender: a scene of others.py by Cycles. Arguments: a .mesh or a list of lights, width, height, seed,
picture, angle across, intensity."""
import array
import math
import sys

import bpy
from mathutils import Vector

SCENE, WIDTH, HEIGHT, SEED, PICTURE, ANGLE, INTENSITY = sys.argv[sys.argv.index("--") + 1:]


def y_up(x, y, z):
    """From coordinates with y up, as glTF's become Blender's."""
    return Vector((x, -z, y))


def grey():
    material = bpy.data.materials.new("grey")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (0.7, 0.7, 0.7, 1)
    material.node_tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_box(corners, material):
    """Between two corners with y up."""
    (x0, y0, z0), (x1, y1, z1) = corners
    points = [y_up(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
    mesh = bpy.data.meshes.new("box")
    mesh.from_pydata(points, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    mesh.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("box", mesh))


def add_lights(places):
    light = bpy.data.lights.new("point", "POINT")
    light.energy = 4 * math.pi ** 2 * float(INTENSITY) / len(places)
    light.shadow_soft_size = 0
    for place in places:
        item = bpy.data.objects.new("point", light)
        item.location = y_up(*place)
        bpy.context.collection.objects.link(item)


def read_lights():
    with open(SCENE, encoding="utf-8") as file:
        add_lights([tuple(map(float, line.split())) for line in file])
    material = grey()
    add_box(((-4, -0.01, -4), (4, 0, 4)), material)
    for x in (-3, -1, 1, 3):
        for z in (-3, -1, 1, 3):
            add_box(((x - 0.3, 0, z - 0.3), (x + 0.3, 0.8, z + 0.3)), material)
    return y_up(0, 5, -8)


def read_triangles():
    sizes, positions, corners = array.array("I"), array.array("f"), array.array("I")
    with open(SCENE, "rb") as file:
        sizes.fromfile(file, 2)
        positions.fromfile(file, sizes[0])
        corners.fromfile(file, sizes[1])
    positions[1::3], positions[2::3] = array.array("f", (-z for z in positions[2::3])), positions[1::3]
    mesh = bpy.data.meshes.new("square")
    mesh.vertices.add(sizes[0] // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(sizes[1])
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(sizes[1] // 3)
    mesh.polygons.foreach_set("loop_start", array.array("i", range(0, sizes[1], 3)))
    mesh.polygons.foreach_set("loop_total", array.array("i", [3]) * (sizes[1] // 3))
    mesh.update(calc_edges=True)
    mesh.materials.append(grey())
    bpy.context.collection.objects.link(bpy.data.objects.new("square", mesh))
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 3, 0
    bpy.context.collection.objects.link(bpy.data.objects.new("sun", sun))
    return y_up(0, 2, -2)


def main():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    eye = read_triangles() if SCENE.endswith(".mesh") else read_lights()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(float(ANGLE))
    camera.location = eye
    camera.rotation_euler = (-eye).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(camera)
    scene = bpy.context.scene
    scene.camera = camera
    scene.world = None
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = int(WIDTH), int(HEIGHT), 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = PICTURE
    cycles = scene.cycles
    cycles.samples, cycles.seed, cycles.max_bounces = 1, int(SEED), 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    bpy.ops.render.render(write_still=True)


main()
