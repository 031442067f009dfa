"""Scenes by which psplat in Blender is compared with Cycles; compare.py renders them.

Each function fills an empty scene. Rooms are 4 m wide and 3 m high, and open towards the camera, at negative y. Area lights hang
where little light comes back to them: they are black bodies in psplat, and light passes them in Cycles.
"""

import math

import bpy
import numpy


def add(name, data, location=(0, 0, 0), rotation=(0, 0, 0)):
    placed = bpy.data.objects.new(name, data)
    placed.location, placed.rotation_euler = location, [math.radians(angle) for angle in rotation]
    bpy.context.scene.collection.objects.link(placed)
    return placed


def material(name, shader, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(shader), tree.nodes.new("ShaderNodeOutputMaterial")
    for key, value in inputs.items():
        socket = node.inputs[key.replace("_", " ")]
        socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def diffuse(name, *color):
    return material(name, "ShaderNodeBsdfDiffuse", Color=color)


def mesh(name, vertices, faces, surface, smooth=False):
    made = bpy.data.meshes.new(name)
    made.from_pydata(vertices, [], faces)
    made.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    made.materials.append(surface)
    return made


def quad(name, corners, surface, uv=False):
    made = mesh(name, corners, [(0, 1, 2, 3)], surface)
    if uv:
        made.uv_layers.new().data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    return made


def cube(name, size, surface):
    h = size / 2
    vertices = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh(name, vertices, faces, surface)


def ball(name, radius, surface, rows=48):
    columns = 2 * rows
    vertices = [(0, 0, radius), (0, 0, -radius)]
    for row in range(1, rows):
        for column in range(columns):
            u, v = 2 * math.pi * column / columns, math.pi * row / rows
            vertices.append((radius * math.sin(v) * math.cos(u), radius * math.sin(v) * math.sin(u), radius * math.cos(v)))

    def at(row, column):
        return 0 if row == 0 else 1 if row == rows else 2 + (row - 1) * columns + column % columns

    faces = []
    for row in range(rows):
        for column in range(columns):
            corners = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)]
            faces.append(tuple(dict.fromkeys(corners)))
    return mesh(name, vertices, faces, surface, smooth=True)


def camera(location=(0, -6, 1.5), rotation=(90, 0, 0), **keys):
    data = bpy.data.cameras.new("Camera")
    data.lens = 40
    for key, value in keys.items():
        setattr(data, key, value)
    bpy.context.scene.camera = add("Camera", data, location, rotation)


def light(kind, location, rotation=(0, 0, 0), **keys):
    data = bpy.data.lights.new("Light", kind)
    for key, value in keys.items():
        setattr(data, key, value)
    return add("Light", data, location, rotation)


def world(color=(0, 0, 0), strength=1.0):
    made = bpy.data.worlds.new("World")
    made.use_nodes = True
    node = made.node_tree.nodes["Background"]
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (*color, 1), strength
    bpy.context.scene.world = made
    return made.node_tree, node


def floor(surface, half=5):
    add("Floor", quad("Floor", [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], surface))


def room(ceiling=True):
    white, red, green = diffuse("White", 0.7, 0.7, 0.7), diffuse("Red", 0.6, 0.07, 0.05), diffuse("Green", 0.1, 0.45, 0.1)
    walls = {"Floor": (white, [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)]),
             "Back": (white, [(-2, 2, 0), (2, 2, 0), (2, 2, 3), (-2, 2, 3)]),
             "Left": (red, [(-2, -2, 0), (-2, 2, 0), (-2, 2, 3), (-2, -2, 3)]),
             "Right": (green, [(2, -2, 0), (2, -2, 3), (2, 2, 3), (2, 2, 0)])}
    if ceiling:
        walls["Ceiling"] = (white, [(-2, -2, 3), (-2, 2, 3), (2, 2, 3), (2, -2, 3)])
    for name, (surface, corners) in walls.items():
        add(name, quad(name, corners, surface))
    camera()
    return white


def point():
    white = room()
    world()
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))
    light('POINT', (-0.5, -0.5, 2.2), energy=100, shadow_soft_size=0.1)


def sun():
    white = room(ceiling=False)
    world()
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))
    light('SUN', (0, 0, 5), (30, 20, 10), energy=5, angle=math.radians(5))


def spot():
    white = room()
    world()
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))
    light('SPOT', (0.5, -0.5, 2.8), (10, -15, 0), energy=200, spot_size=math.radians(70), spot_blend=0.4, shadow_soft_size=0)


def area():
    white = room()
    world()
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))
    light('AREA', (-0.8, 0, 2.99), energy=40, shape='RECTANGLE', size=1.2, size_y=0.6)
    light('AREA', (1.6, -1.5, 1.2), (90, 0, 40), energy=20, shape='DISK', size=0.8, color=(1, 0.6, 0.3))


def world_color():
    white = room(ceiling=False)
    world((0.4, 0.6, 1.0), 2)
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))


def sky_pixels(height=64):
    """Dim sky over dark ground, a large warm lamp and a small blue one, none of it symmetrical."""
    pixels = numpy.zeros((height, 2 * height, 4), numpy.float32)
    pixels[:, :, 3] = 1
    pixels[height // 2:, :, :3] = (0.2, 0.3, 0.5)
    pixels[:height // 2, :, :3] = (0.1, 0.08, 0.05)
    pixels[height * 5 // 8:height * 7 // 8, height // 4:height // 2, :3] = (12, 8, 4)
    pixels[height * 9 // 16:height * 5 // 8, height * 3 // 2:height * 25 // 16, :3] = (10, 20, 80)
    return pixels


def world_picture():
    white = diffuse("White", 0.7, 0.7, 0.7)
    floor(white)
    add("Box", cube("Box", 1, white), (0.9, 0.3, 0.5), (0, 0, 25))
    add("Ball", ball("Ball", 0.8, white), (-0.8, 0.3, 0.8))
    image = bpy.data.images.new("Sky", 128, 64, float_buffer=True)
    image.pixels.foreach_set(sky_pixels().reshape(-1))
    tree, background = world(strength=1.5)
    picture, mapping, place = (tree.nodes.new(name) for name in
                               ("ShaderNodeTexEnvironment", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    picture.image = image
    mapping.inputs["Rotation"].default_value[2] = math.radians(40)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], background.inputs["Color"])
    camera((0, -6, 2), (80, 0, 0))


def principled():
    room(ceiling=False)
    world((0.5, 0.5, 0.5))
    shader = "ShaderNodeBsdfPrincipled"
    surfaces = [material("Gold", shader, Base_Color=(0.9, 0.6, 0.2), Metallic=1.0, Roughness=0.25),
                material("Plastic", shader, Base_Color=(0.1, 0.3, 0.7), Roughness=0.5),
                material("Polish", shader, Base_Color=(0.6, 0.1, 0.1), Roughness=0.1),
                material("Half", shader, Base_Color=(0.5, 0.6, 0.5), Roughness=0.4, Metallic=0.5)]
    for number, surface in enumerate(surfaces):
        add("Ball", ball("Ball", 0.45, surface), (-1.5 + number, 0.2, 0.45))
    light('AREA', (0, -0.5, 2.99), energy=80, size=0.5)


def picture_pixels(size=32):
    """A letter F on a gradient of colours."""
    pixels = numpy.ones((size, size, 4), numpy.float32)
    ramp = numpy.linspace(0.2, 0.9, size)
    pixels[:, :, 0], pixels[:, :, 2] = ramp[None, :], ramp[:, None]
    pixels[:, :, 1] = 0.4
    pixels[4:28, 8:12, :3] = pixels[24:28, 8:24, :3] = pixels[14:18, 8:20, :3] = 0.9
    return pixels


def texture():
    white = room()
    world()
    image = bpy.data.images.new("F", 32, 32)
    image.pixels.foreach_set(picture_pixels().reshape(-1))
    surface = material("Picture", "ShaderNodeBsdfPrincipled", Specular=0.0, Roughness=0.5)
    tree = surface.node_tree
    picture, mapping, place = (tree.nodes.new(name) for name in
                               ("ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    picture.image = image
    mapping.inputs["Scale"].default_value = (2, 1, 1)
    mapping.inputs["Location"].default_value = (0.25, 0.1, 0)
    tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    add("Poster", quad("Poster", [(-1.5, 0, 0), (1.5, 0, 0), (1.5, 0, 1.5), (-1.5, 0, 1.5)], surface, uv=True), (0, 1.5, 0.8))
    add("Box", cube("Box", 0.6, white), (0.6, 0.3, 0.3), (0, 0, 25))
    light('POINT', (0.5, -0.8, 2.2), energy=100, shadow_soft_size=0.1)


def picture_node(tree, pixels, socket, colors='Non-Color'):
    image = bpy.data.images.new("Map", *pixels.shape[1::-1])
    image.colorspace_settings.name = colors
    image.pixels.foreach_set(pixels.reshape(-1))
    picture, mapping, place = (tree.nodes.new(name) for name in
                               ("ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    picture.image = image
    mapping.inputs["Scale"].default_value, mapping.inputs["Location"].default_value = (1.5, 1.2, 1), (0.1, 0.3, 0)
    tree.links.new(place.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], socket)


def maps():
    """Metalness and roughness from pictures of different sizes, a color attribute, and a pane of alpha 0.4."""
    white = room(ceiling=False)
    world((0.5, 0.5, 0.5))
    shader = "ShaderNodeBsdfPrincipled"
    plate = material("Plate", shader, Base_Color=(0.9, 0.6, 0.3), Specular=0.0)
    inputs = plate.node_tree.nodes["Principled BSDF"].inputs
    letter = numpy.ones((32, 32, 4), numpy.float32)
    letter[:, :, :3] = (picture_pixels()[:, :, 1:2] > 0.5)
    picture_node(plate.node_tree, letter, inputs["Metallic"])
    rough = numpy.ones((2, 8, 4), numpy.float32)
    rough[:, :, :3] = numpy.linspace(0.2, 0.6, 8)[None, :, None]
    picture_node(plate.node_tree, rough, inputs["Roughness"])
    add("Plate", quad("Plate", [(-1, 0, 0), (1, 0, 0), (1, 0, 1.5), (-1, 0, 1.5)], plate, uv=True), (-0.6, 1.5, 0.8), (-15, 0, 0))
    painted = material("Painted", shader, Specular=0.0)
    node = painted.node_tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "Paint"
    painted.node_tree.links.new(node.outputs["Color"], painted.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    data = cube("Box", 1, painted)
    paint = data.color_attributes.new("Paint", 'FLOAT_COLOR', 'POINT')
    paint.data.foreach_set("color", [value for vertex in data.vertices
                                     for value in (*(0.2 + 0.6 * (number > 0) for number in vertex.co), 1)])
    add("Box", data, (-0.9, 0.3, 0.5), (0, 0, 25))
    pane = material("Pane", shader, Base_Color=(0.2, 0.3, 0.8), Specular=0.0, Alpha=0.4)
    add("Pane", quad("Pane", [(-0.6, 0, 0), (0.6, 0, 0), (0.6, 0, 1.2), (-0.6, 0, 1.2)], pane), (1, -0.5, 0.2))
    add("Ball", ball("Ball", 0.4, white), (1, 0.4, 0.4))
    light('SUN', (0, 0, 5), (20, 25, 10), energy=3, angle=0.05)


def emission():
    white = room()
    world()
    add("Box", cube("Box", 1, white), (0.6, 0.3, 0.5), (0, 0, 25))
    lamp = material("Lamp", "ShaderNodeEmission", Color=(1.0, 0.8, 0.5), Strength=15.0)
    add("Lamp", quad("Lamp", [(-0.4, -0.4, 0), (0.4, -0.4, 0), (0.4, 0.4, 0), (-0.4, 0.4, 0)], lamp), (-0.6, 0, 2.3), (20, 10, 0))


def glass():
    room(ceiling=False)
    world()
    add("Ball", ball("Ball", 0.6, material("Glass", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.5)), (0.5, 0, 0.8))
    water = material("Water", "ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.9, 1.0), Transmission=1.0, Roughness=0.0, IOR=1.33)
    add("Water", cube("Water", 0.7, water), (-0.9, 0.2, 0.45), (0, 0, 30))
    light('AREA', (0, -0.3, 2.99), energy=60, size=1.5)


def instances():
    """A collection, one of its own kind in it, geometry nodes, and particles."""
    white = diffuse("White", 0.7, 0.7, 0.7)
    blue = diffuse("Blue", 0.1, 0.2, 0.7)
    floor(white)
    world((0.3, 0.3, 0.3))
    kept = bpy.data.collections.new("Kept")
    for location, data in (((0, 0, 0.2), cube("Small", 0.4, blue)), ((0, 0, 0.6), ball("Top", 0.2, white))):
        placed = bpy.data.objects.new(data.name, data)
        placed.location = location
        kept.objects.link(placed)
    for number in range(5):
        empty = add("Placed", None, (-2 + number, 0.2 * number, 0), (0, 0, 20 * number))
        empty.instance_type, empty.instance_collection = 'COLLECTION', kept
        empty.scale = (1, 1, 1 + 0.3 * number)
    points = add("Points", mesh("Points", [(x, 1.8, 0.15) for x in (-1.5, -0.5, 0.5, 1.5)], [], blue))
    points.modifiers.new("Nodes", 'NODES').node_group = cubes_on_points(kept.objects[0])
    emitter = add("Emitter", quad("Emitter", [(-2, -1.5, 0.02), (2, -1.5, 0.02), (2, -1, 0.02), (-2, -1, 0.02)], white))
    settings = emitter.modifiers.new("Particles", 'PARTICLE_SYSTEM').particle_system.settings
    settings.type, settings.count, settings.hair_length = 'HAIR', 30, 1
    settings.render_type, settings.instance_object, settings.particle_size = 'OBJECT', kept.objects[1], 0.3
    light('SUN', (0, 0, 5), (40, 10, 0), energy=3, angle=0.02)
    camera((0, -6, 2.5), (72, 0, 0))


def cubes_on_points(found):
    tree = bpy.data.node_groups.new("Cubes", 'GeometryNodeTree')
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    start, end, info, on = (tree.nodes.new(name) for name in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeObjectInfo", "GeometryNodeInstanceOnPoints"))
    info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = found, True
    tree.links.new(start.outputs[0], on.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], on.inputs["Instance"])
    tree.links.new(on.outputs["Instances"], end.inputs[0])
    return tree


def orthographic():
    point()
    bpy.data.objects.remove(bpy.context.scene.camera)
    camera((3, -5, 4), (60, 0, 30), type='ORTHO', ortho_scale=6, shift_x=-0.15)


def shifted():
    point()
    data = bpy.context.scene.camera.data
    data.shift_x, data.shift_y, data.sensor_fit, data.sensor_height, data.lens = 0.15, -0.1, 'VERTICAL', 20, 30


SCENES = (point, sun, spot, area, world_color, world_picture, principled, texture, emission, glass, maps, instances, orthographic,
          shifted)
