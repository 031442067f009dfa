# Makes blender.glb, which tests/unit/test_mesh_blender.c reads. Run with Blender 3.4:
#
#     blender --background --factory-startup --python tests/data/make_blender_fixture.py
#
# All numbers that the test expects are stated here, in Blender's space (z up, metres, watts).

import math
import os

import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 1600, 900


def add(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1), parent=None):
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    thing.rotation_euler = [math.radians(angle) for angle in rotation]
    thing.scale = scale
    thing.parent = parent
    scene.collection.objects.link(thing)
    return thing


def material(name, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def mesh(name, vertices, faces, made_of, uv=None, smooth=False):
    made = bpy.data.meshes.new(name)
    made.from_pydata(vertices, [], faces)
    made.materials.append(made_of)
    if uv:
        layer = made.uv_layers.new(name="UVMap")
        for loop in made.loops:
            layer.data[loop.index].uv = uv[loop.vertex_index]
    for polygon in made.polygons:
        polygon.use_smooth = smooth
    return made


# A picture of 4 x 2 pixels: red at the bottom left, green at the bottom right, blue at the top left,
# white at the top right, black between.
picture = bpy.data.images.new("corners", 4, 2)
black = [0, 0, 0, 1]
picture.pixels = (
    [1, 0, 0, 1] + black + black + [0, 1, 0, 1] + [0, 0, 1, 1] + black + black + [1, 1, 1, 1]
)
picture.pack()

textured = material("textured", Roughness=0.9)
image = textured.node_tree.nodes.new("ShaderNodeTexImage")
image.image = picture
shader = textured.node_tree.nodes["Principled BSDF"]
textured.node_tree.links.new(image.outputs["Color"], shader.inputs["Base Color"])

metal = material("metal", Base_Color=(0.9, 0.6, 0.2, 1), Metallic=1, Roughness=0.25)
rough = material("rough", Base_Color=(0.2, 0.4, 0.6, 1), Roughness=0.75)
glowing = material("glowing", Emission=(1, 0.5, 0.25, 1), Emission_Strength=8)

# A quad in the xy plane that faces up; u along x, v along y.
quad = mesh(
    "quad",
    [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)],
    [(0, 1, 2, 3)],
    textured,
    uv=[(0, 0), (1, 0), (1, 1), (0, 1)],
)
add("floor", quad, scale=(4, 4, 1))

tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
sides = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
pivot = add("pivot", None, location=(1, 2, 3), rotation=(0, 0, 90), scale=(2, 2, 2))
add("child", mesh("solid", tetrahedron, sides, metal), location=(1, 0, 0), scale=(1, 1, 0.5), parent=pivot)

shape = mesh("shape", tetrahedron, sides, rough, smooth=True)
add("plain", shape, location=(-2, 0, 0))
add("mirrored", shape, location=(-2, 2, 0), scale=(-1, 1, 1))

lamp = mesh("lamp", [(-1, 1, 0), (1, 1, 0), (1, -1, 0), (-1, -1, 0)], [(0, 1, 2, 3)], glowing)
add("ceiling lamp", lamp, location=(0, 0, 6))

# 40 degrees across; looks along -z of its own, so that 60 degrees about x tilts it up from straight
# down, and 30 about z turns it to the left.
camera = bpy.data.cameras.new("view")
camera.sensor_fit = "HORIZONTAL"
camera.angle = math.radians(40)
scene.camera = add("view", camera, location=(3, -6, 5), rotation=(60, 0, 30))

wide = bpy.data.cameras.new("plan")
wide.type = "ORTHO"
wide.ortho_scale = 12
add("plan", wide, location=(0, 0, 10))

point = bpy.data.lights.new("bulb", "POINT")
point.energy, point.color = 100, (1, 0.5, 0.25)
add("bulb", point, location=(0, 1, 4))
add("same bulb", point, location=(3, 1, 4))

spot = bpy.data.lights.new("spot", "SPOT")
spot.energy, spot.spot_size, spot.spot_blend = 50, math.radians(60), 0.25
add("spot", spot, location=(2, 0, 3), rotation=(90, 0, 0))

sun = bpy.data.lights.new("sun", "SUN")
sun.energy = 3
add("sun", sun, location=(0, 0, 20), rotation=(0, 45, 0))

bpy.ops.export_scene.gltf(
    filepath=os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender.glb"),
    export_format="GLB",
    export_cameras=True,
    export_lights=True,
)
