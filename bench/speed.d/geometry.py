"""geometry.py: scenes of as many triangles, or instances of a mesh, as are asked for, as binary glTF and a .psd beside it."""
import array
import json
import math
import os
import struct

TREE_SIDE = 30  # squares along a side of the mesh that is instanced: 1800 triangles


def grid(side):
    """Positions and corners of a wavy square of 2 * side**2 triangles in -1..1."""
    at = [2 * i / side - 1 for i in range(side + 1)]
    waves = [0.1 * math.sin(9 * x) for x in at]
    positions, corners = array.array("f"), array.array("I")
    for z in at:
        height = math.cos(7 * z)
        for x, wave in zip(at, waves):
            positions.extend((x, wave * height, z))
    for row in range(side):
        for first in range(row * (side + 1), row * (side + 1) + side):
            above = first + side + 1
            corners.extend((first, above + 1, first + 1, first, above, above + 1))
    return positions, corners


def write_glb(path, side, places):
    """The square; with `places`, an array of coordinates, one instance at each of them."""
    positions, corners = grid(side)
    data = [positions.tobytes(), corners.tobytes(), places.tobytes()]
    starts = [sum(len(part) for part in data[:i]) for i in range(3)]
    node = {"mesh": 0}
    views = range(3 if places else 2)
    accessors = [(5126, len(positions) // 3, "VEC3"), (5125, len(corners), "SCALAR"), (5126, len(places) // 3, "VEC3")]
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [node],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": sum(len(part) for part in data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": starts[i], "byteLength": len(data[i])} for i in views],
        "accessors": [{"bufferView": i, "componentType": accessors[i][0], "count": accessors[i][1],
                       "type": accessors[i][2]} for i in views]}
    if places:
        root["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
        node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}}
    root["accessors"][0].update({"min": [-1, -0.1, -1], "max": [1, 0.1, 1]})
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    length = root["buffers"][0]["byteLength"]
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + length))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", length, 0x004E4942))
        for part in data:
            file.write(part)


def write_scene(folder, name, side, places, eye):
    """The path of the .psd."""
    write_glb(os.path.join(folder, name + ".glb"), side, places)
    path = os.path.join(folder, name + ".psd")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"""psd: 1
camera: {{location: {eye}, look_at: [0, 0, 0]}}
materials: {{grey: {{diffuse: [0.7, 0.7, 0.7]}}}}
lights: [{{sun: {{direction: [0, -1, 0.2], irradiance: [3, 3, 3]}}}}]
objects: [{{mesh: {{file: {name}.glb, material: grey}}}}]
""")
    return path


def triangles_scene(folder, number):
    """Of the square number of triangles next to it."""
    return write_scene(folder, "triangles", max(1, round(math.sqrt(number / 2))), array.array("f"), [0, 2, -2])


def instances_scene(folder, number):
    """Side by side, in a square."""
    side = math.ceil(math.sqrt(number))
    places = array.array("f")
    for i in range(number):
        places.extend((3 * (i % side - side // 2), 0, 3 * (i // side - side // 2)))
    return write_scene(folder, "instances", TREE_SIDE, places, [0, 2 * side, -3 * side])
