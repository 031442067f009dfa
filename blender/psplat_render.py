# SPDX-License-Identifier: GPL-2.0-or-later
# This file uses Blender's Python interface, and so is under Blender's licence; the rest of psplat is under the MIT licence.
"""psplat as a render engine of Blender 3.4.

A render writes what the dependency graph holds as psplat reads it: one glTF file for each mesh, and a scene (psd(5)) with the
camera, lights, world, materials and places. It runs the program psplat, shows its progress, and hands the layers of its picture
to Blender.

Geometry comes from the evaluated dependency graph and not from Blender's own glTF exporter: engines run in a thread, where
operators must not be called, and the exporter of Blender 3.4 leaves out instances of geometry nodes and particles.

Units: metres, watts and linear Rec. 709, in both programs. Blender's z is up; (x, y, z) there is (x, z, -y) in psplat.
"""

bl_info = {
    "name": "psplat",
    "author": "The psplat authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "location": "Render Properties > Render Engine",
    "description": "Renders indirect light by photon splatting, with the program psplat",
}

import hashlib
import json
import math
import os
import re
import selectors
import shlex
import signal
import struct
import subprocess
import tempfile
import traceback
import urllib.parse
import zlib

import bpy
import mathutils
import numpy

# --- files ---------------------------------------------------------------------------------------


def color_layer(mesh, name):
    """A color attribute of a mesh, by its name or, where that is empty, the one for renders; or None."""
    if name is None or not len(mesh.color_attributes):
        return None
    return mesh.color_attributes.get(name) if name else mesh.color_attributes[mesh.color_attributes.render_color_index]


def write_glb(path, mesh, normals, materials):
    """Writes an evaluated mesh as binary glTF 2, its triangles grouped by material.

    `materials`: for each slot glTF's material, with a "colors" that names the color attribute of the mesh that it is multiplied
    with, or None. A dict with a "file" is a texture of it, with its sampler and its transform. Returns False where no triangle
    has an area, and writes nothing then.
    """
    mesh.calc_loop_triangles()
    corner_count, triangle_count = len(mesh.loops), len(mesh.loop_triangles)
    places = numpy.empty(len(mesh.vertices) * 3, numpy.float32)
    mesh.vertices.foreach_get("co", places)
    vertices = numpy.empty(corner_count, numpy.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    triangles = numpy.empty(triangle_count * 3, numpy.int32)
    mesh.loop_triangles.foreach_get("loops", triangles)
    slots = numpy.empty(triangle_count, numpy.int32)
    mesh.loop_triangles.foreach_get("material_index", slots)
    slots = numpy.clip(slots, 0, len(materials) - 1)

    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "materials": [],
        "accessors": [],
        "bufferViews": [],
    }
    parts = []

    def accessor(array, component, kind, **more):
        data = numpy.ascontiguousarray(array).tobytes()
        document["bufferViews"].append(
            {"buffer": 0, "byteOffset": sum(map(len, parts)), "byteLength": len(data)})
        document["accessors"].append({"bufferView": len(parts), "componentType": component, "count": len(array),
                                      "type": kind, **more})
        parts.append(data)
        return len(parts) - 1

    def with_textures(value):
        if not isinstance(value, dict):
            return value
        if "file" not in value:
            return {key: with_textures(part) for key, part in value.items() if key != "colors"}
        textures = document.setdefault("textures", [])
        document.setdefault("images", []).append({"uri": value["file"]})
        document.setdefault("samplers", []).append(value["sampler"])
        textures.append({"source": len(textures), "sampler": len(textures)})
        return {"index": len(textures) - 1, "extensions": {"KHR_texture_transform": value["transform"]}}

    def attributes_of(slot):
        attribute = color_layer(mesh, materials[slot]["colors"])
        if not attribute:
            return attributes
        colors = numpy.empty(len(attribute.data) * 4, numpy.float32)
        attribute.data.foreach_get("color", colors)
        colors = colors.reshape(-1, 4)
        colors[:, 3] = 1
        colors = colors if attribute.domain == 'CORNER' else colors[vertices]
        return {**attributes, "COLOR_0": accessor(colors, 5126, "VEC4")}

    def upright_rows(array):
        array = array.reshape(-1, 3)
        return numpy.stack([array[:, 0], array[:, 2], -array[:, 1]], axis=1)

    triangles = triangles.reshape(-1, 3).astype(numpy.uint32)
    corners = places.reshape(-1, 3)[vertices][triangles].astype(float)
    areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    triangles, slots = triangles[areas > 0], slots[areas > 0]
    if not len(triangles):
        return False
    document["materials"] = [with_textures(material) for material in materials]
    positions = upright_rows(places)[vertices]
    attributes = {
        "POSITION": accessor(positions, 5126, "VEC3", min=positions.min(axis=0).tolist(),
                             max=positions.max(axis=0).tolist()),
        "NORMAL": accessor(upright_rows(normals), 5126, "VEC3"),
    }
    if mesh.uv_layers.active:
        uv = numpy.empty(corner_count * 2, numpy.float32)
        mesh.uv_layers.active.data.foreach_get("uv", uv)
        uv = uv.reshape(-1, 2)
        attributes["TEXCOORD_0"] = accessor(numpy.stack([uv[:, 0], 1 - uv[:, 1]], axis=1), 5126, "VEC2")
    document["meshes"] = [{"primitives": [
        {"attributes": attributes_of(slot), "material": int(slot),
         "indices": accessor(triangles[slots == slot].reshape(-1), 5125, "SCALAR")}
        for slot in numpy.unique(slots)]}]
    binary = b"".join(parts)
    document["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return True


def write_png(path, pixels):
    """Writes pixels of 0..1, of shape (height, width, 4), the lowest row first, in 8 bits as they are."""
    rows = (numpy.clip(pixels[::-1], 0, 1) * 255 + 0.5).astype(numpy.uint8)
    height, width = rows.shape[:2]
    lines = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), rows.reshape(height, -1)], axis=1)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(lines.tobytes(), 1)) + chunk(b"IEND", b""))


def write_exr(path, channels):
    """Writes a map of channels to arrays (height, width), the lowest row first, as OpenEXR of 32-bit scan lines, not packed."""
    names = sorted(channels, key=str.encode)
    lines = numpy.stack([channels[name][::-1] for name in names], axis=1).astype("<f4")
    height, _, width = lines.shape
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in names) + b"\0"
    long_names = 0x400 if any(len(name.encode()) > 31 for name in names) else 0
    header = struct.pack("<II", 20000630, 2 | long_names)
    for name, kind, value in ((b"channels", b"chlist", listed), (b"compression", b"compression", b"\0"),
                              (b"dataWindow", b"box2i", window), (b"displayWindow", b"box2i", window),
                              (b"lineOrder", b"lineOrder", b"\0"), (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
                              (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
                              (b"screenWindowWidth", b"float", struct.pack("<f", 1))):
        header += name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    size = len(names) * width * 4
    places = len(header) + 8 * height + numpy.arange(height) * (size + 8)
    with open(path, "wb") as file:
        file.write(header + places.astype("<u8").tobytes())
        for y in range(height):
            file.write(struct.pack("<ii", y, size) + lines[y].tobytes())


def read_exr(path):
    """Reads what psplat writes with --compression none: a map of channels to arrays (height, width), the lowest row first."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = {}, 8
    while data[at]:
        name_end = data.index(b"\0", at)
        kind_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<i", data, kind_end + 1)[0]
        attributes[data[at:name_end].decode()] = data[kind_end + 5:kind_end + 5 + size]
        at = kind_end + 5 + size
    names, channels = [], attributes["channels"]
    while channels[0]:
        end = channels.index(b"\0")
        if struct.unpack_from("<i", channels, end + 1)[0] != 2:
            raise ValueError("a channel that is not of 32-bit numbers")
        names.append(channels[:end].decode())
        channels = channels[end + 17:]
    if attributes["compression"] != b"\0":
        raise ValueError("a packed file")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    line = numpy.dtype([("y", "<i4"), ("size", "<i4"), ("values", "<f4", (len(names), width))])
    lines = numpy.frombuffer(data, line, height, at + 1 + 8 * height)
    order = numpy.argsort(-lines["y"])
    return {name: lines["values"][order, i] for i, name in enumerate(names)}


# --- the scene -----------------------------------------------------------------------------------

UPRIGHT = mathutils.Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))


def upright(vector):
    """A place or a direction in psplat's coordinates."""
    return [vector[0], vector[2], -vector[1]]


def upright_matrix(matrix):
    """The 12 numbers of a placement in psplat's coordinates."""
    rows = UPRIGHT @ matrix @ UPRIGHT.inverted()
    return [value for row in rows[:3] for value in row]


def scaled(value, factor):
    """A colour, a number or a picture, multiplied."""
    if isinstance(value, dict):
        image = dict(value["image"])
        image["color"] = scaled(image.get("color", 1), factor)
        return {"image": image}
    if isinstance(value, (int, float)) and isinstance(factor, (int, float)):
        return value * factor
    return [a * b for a, b in zip(three(value), three(factor))]


def three(value):
    return [value] * 3 if isinstance(value, (int, float)) else list(value)


def within(value, most=1.0):
    """Colours and numbers from 0 to `most`; pictures as they are."""
    if isinstance(value, dict):
        return value
    if isinstance(value, (int, float)):
        return min(max(value, 0.0), most)
    return [min(max(number, 0.0), most) for number in value]


def is_black(value):
    return not isinstance(value, dict) and not any(three(value))


def node_of(socket):
    """The node and the output that a socket takes its value from, or None."""
    while socket.is_linked:
        link = socket.links[0]
        if link.from_node.type != 'REROUTE':
            return link.from_node, link.from_socket
        socket = link.from_node.inputs[0]
    return None


class Exporter:
    """Writes one view layer into `folder`. `warn` is called with each text once."""

    def __init__(self, depsgraph, folder, warn):
        self.depsgraph, self.scene, self.folder = depsgraph, depsgraph.scene_eval, folder
        self.said, self.warn_user = set(), warn
        self.owner = ""  # the material, light or world whose nodes are read, for warnings
        self.materials, self.images, self.meshes, self.lights = {}, {}, {}, []
        self.sources = {}  # pictures of Blender, by the files
        self.names = {}  # names of materials in the scene, by Blender's
        self.gltf = {}  # materials that glTF says and psd(5) does not, by the names
        self.digest = hashlib.sha256()

    def warn(self, text):
        if text not in self.said:
            self.said.add(text)
            self.warn_user(text)

    def is_finite(self, name, numbers):
        """Whether numbers, in dicts and lists, are finite. Else warns that what has that name is left out."""
        try:
            json.dumps(numbers, allow_nan=False)
        except ValueError:
            self.warn(f"{name} is left out: it has numbers that are not finite")
            return False
        return True

    def write(self, view):
        """Writes scene.psd and the files that it names, and makes `digest` that of all."""
        if self.scene.render.use_motion_blur:
            self.warn("psplat has no motion blur")
        self.take_objects()
        self.take_world()
        description = {"psd": 1, "camera": view.description(self.scene.camera, self.warn),
                       "image": {"width": view.width, "height": view.height},
                       "lights": self.lights, "materials": self.materials}
        description["groups"], description["objects"] = self.place_meshes()
        text = json.dumps(description, indent=1, ensure_ascii=False, allow_nan=False)
        with open(os.path.join(self.folder, "scene.psd"), "w", encoding="utf-8") as file:
            file.write(text + "\n")
        self.digest.update(text.encode())

    # --- objects ---

    def take_objects(self):
        for instance in self.depsgraph.object_instances:
            found = instance.object
            if not instance.show_self:
                continue
            if found.type == 'LIGHT':
                self.take_light(found, instance.matrix_world)
            elif found.type in {'MESH', 'CURVE', 'SURFACE', 'META', 'FONT'}:
                self.take_mesh(found, instance.matrix_world)
            elif found.type in {'CURVES', 'POINTCLOUD', 'VOLUME', 'GPENCIL'}:
                self.warn(f"{found.name}: psplat does not render objects of the kind {found.type.lower()}")

    def take_mesh(self, found, matrix):
        if not self.is_finite(found.name, upright_matrix(matrix)):
            return
        slots = [slot.material for slot in found.material_slots] or [None]
        # What is flattened has no inverse, and psplat wants one of each placement.
        flat = matrix.copy() if abs(matrix.determinant()) <= 1e-6 * matrix.median_scale ** 3 else None
        key = (found.data.as_pointer(), found.type == 'MESH' or found.name_full, found.visible_camera,
               tuple(material.name_full if material else "" for material in slots), flat and tuple(upright_matrix(flat)))
        if key not in self.meshes:
            names = [self.take_material(slot) for slot in slots]
            self.meshes[key] = {"entry": self.write_mesh(found, names, flat), "places": []}
        self.meshes[key]["places"].append(upright_matrix(mathutils.Matrix() if flat else matrix))

    def write_mesh(self, found, names, flat):
        """Writes an object's mesh. Returns what a scene says of it, or None where it has no triangles."""
        mesh = found.to_mesh()
        try:
            if mesh is None or not mesh.polygons:
                return None
            if flat:
                mesh.transform(flat)
            if not self.has_finite_corners(found.name, mesh):
                return None
            mesh.calc_normals_split()
            normals = numpy.empty(len(mesh.loops) * 3, numpy.float32)
            mesh.loops.foreach_get("normal", normals)
            file = f"mesh-{len(self.meshes)}.glb"
            materials = [self.gltf.get(name, {"name": name, "colors": None}) for name in names]
            for material in materials:
                if material["colors"] is not None and not color_layer(mesh, material["colors"]):
                    self.warn(f"{found.name}: no color attribute '{material['colors']}' for {material['name']}: it is white")
            if not write_glb(os.path.join(self.folder, file), mesh, normals, materials):
                self.warn(f"{found.name} is left out: none of its faces has an area")
                return None
        finally:
            found.to_mesh_clear()
        self.take_file(file)
        entry = {"file": file, "materials": {name: name for name in names if name not in self.gltf}}
        return entry if found.visible_camera else {**entry, "camera": False}

    def has_finite_corners(self, name, mesh):
        vertices = numpy.empty(len(mesh.vertices) * 3, numpy.float32)
        mesh.vertices.foreach_get("co", vertices)
        uv = numpy.empty(len(mesh.loops) * 2 if mesh.uv_layers.active else 0, numpy.float32)
        if len(uv):
            mesh.uv_layers.active.data.foreach_get("uv", uv)
        return self.is_finite(name, [float(vertices.sum(dtype=float)), float(uv.sum(dtype=float))])

    def place_meshes(self):
        """Groups and objects: a mesh that stands in several places is a group."""
        groups, objects = {}, []
        for mesh in self.meshes.values():
            entry, places = mesh["entry"], mesh["places"]
            if entry and len(places) == 1:
                objects.append({"mesh": {**entry, "matrix": places[0]}})
            elif entry:
                groups[entry["file"]] = [{"mesh": entry}]
                objects += [{"instance": {"of": entry["file"], "matrix": place}} for place in places]
        return groups, objects

    def take_file(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            self.digest.update(file.read())

    # --- lights ---

    def take_light(self, found, matrix):
        light, visible, known = found.data, found.visible_camera, len(self.lights)
        if light.type != 'POINT' and matrix.col[2].xyz.length == 0:
            self.warn(f"{found.name} is left out: it is scaled to nothing, and shines in no direction")
            return
        self.add_light(light, matrix, visible)
        if not self.is_finite(found.name, self.lights[known:]):
            del self.lights[known:]

    def add_light(self, light, matrix, visible):
        color = [light.color[i] * light.energy for i in range(3)]
        if light.use_nodes:
            color = scaled(color, self.light_nodes(light))
        location, direction = upright(matrix.translation), upright(-matrix.col[2].xyz.normalized())
        if light.type == 'SUN':
            self.lights.append({"sun": {"direction": direction, "angle": min(math.degrees(light.angle), 180.0),
                                        "irradiance": within(color, math.inf)}})
        elif light.type == 'AREA':
            self.take_area_light(light, matrix, color, visible)
        elif light.type == 'SPOT':
            self.take_spot(light, location, direction, color)
        elif light.shadow_soft_size > 0:
            self.lights.append({"sphere": {"location": location, "radius": light.shadow_soft_size,
                                           "power": within(color, math.inf), "visible": visible}})
        else:
            self.lights.append({"point": {"location": location, "power": within(color, math.inf)}})

    def light_nodes(self, light):
        """The colour that the nodes of a light multiply it by."""
        self.owner = light.name
        output = light.node_tree.get_output_node('CYCLES')
        found = node_of(output.inputs["Surface"]) if output else None
        if not found or found[0].type != 'EMISSION':
            self.warn(f"{light.name}: nodes of lights other than Emission are left out")
            return 1.0
        factor = scaled(self.constant(found[0].inputs["Color"]), self.constant(found[0].inputs["Strength"]))
        return within(factor, math.inf)

    def take_spot(self, light, location, direction, color):
        """Cycles' cone: I = W / 4 pi on the axis, times the cosine to it, times a cubic of the cosine towards the edge."""
        if light.shadow_soft_size > 0:
            self.warn(f"{light.name}: shadows of spots are hard in psplat, as of Radius 0")
        half = min(max(light.spot_size / 2, 1e-3), math.radians(89.9))
        inner = math.cos(half) + (1 - math.cos(half)) * light.spot_blend
        radius = min(max(math.degrees(math.acos(min(inner, 1.0))), 0.01), math.degrees(half))
        self.lights.append({"spotlight": {
            "location": location, "point_at": [location[i] + direction[i] for i in range(3)],
            "radius": radius, "falloff": math.degrees(half), "tightness": 1,
            "intensity": within(scaled(color, 1 / (4 * math.pi)), math.inf)}})

    def take_area_light(self, light, matrix, color, visible):
        """Cycles' area lights have a radiance of W / 4 A, and so a power of pi / 4 W."""
        if light.spread < math.radians(179.9):
            self.warn(f"{light.name}: area lights spread over 180 degrees in psplat")
        height = light.size_y if light.shape in {'RECTANGLE', 'ELLIPSE'} else light.size
        across, along = matrix.col[0].xyz * (light.size / 2), matrix.col[1].xyz * (height / 2)
        area = 4 * across.cross(along).length
        if area == 0:
            self.warn(f"{light.name} is left out: it has no area")
            return
        middle, color = matrix.translation, within(scaled(color, math.pi / 4), math.inf)
        if light.shape in {'SQUARE', 'RECTANGLE'} and abs(across.dot(along)) < 1e-5 * area:
            # Counter-clockwise seen from -z, to which area lights shine.
            corners = [middle - across - along, middle - across + along, middle + across + along,
                       middle + across - along]
            if matrix.is_negative:
                corners.reverse()
            self.lights.append({"rectangle": {"corners": [upright(corner) for corner in corners], "power": color,
                                              "visible": visible}})
            return
        if light.shape == 'ELLIPSE' or abs(across.length - along.length) > 1e-4 * across.length:
            self.warn(f"{light.name}: an area light that is neither a rectangle nor round counts as a disc of its area")
        self.lights.append({"disc": {"location": upright(middle), "direction": upright(-matrix.col[2].xyz.normalized()),
                                     "radius": math.sqrt(area / 4), "power": color, "visible": visible}})

    def take_world(self):
        world = self.scene.world
        if not world:
            return
        self.owner = world.name
        sky = {"radiance": within(list(world.color), math.inf)}
        output = world.node_tree.get_output_node('CYCLES') if world.use_nodes else None
        if output:
            sky = self.background(world, node_of(output.inputs["Surface"]))
        if self.scene.render.film_transparent:
            sky["visible"] = False
        if not is_black(sky["radiance"]) and self.is_finite(world.name, sky):
            self.lights.append({"sky": sky})

    def background(self, world, found):
        if not found:
            return {"radiance": 0}
        if found[0].type != 'BACKGROUND':
            self.warn(f"{world.name}: of worlds, psplat knows Background alone")
            return {"radiance": 0}
        color, strength = found[0].inputs["Color"], self.constant(found[0].inputs["Strength"])
        source = node_of(color)
        if not source or source[0].type != 'TEX_ENVIRONMENT':
            return {"radiance": within(scaled(self.constant(color), strength), math.inf)}
        node, turn = source[0], 0.0
        if node.projection != 'EQUIRECTANGULAR' or not node.image:
            self.warn(f"{world.name}: of pictures of the world, psplat knows equirectangular ones alone")
            return {"radiance": 0}
        mapping = node_of(node.inputs["Vector"])
        if mapping and mapping[0].type == 'MAPPING':
            turn = mapping[0].inputs["Rotation"].default_value[2]
            if any(mapping[0].inputs["Rotation"].default_value[:2]):
                self.warn(f"{world.name}: the picture of the world turns about z alone")
        # The middle of the picture lies towards x in Blender, and towards -z in psplat, which is y in Blender. A mapping
        # turns directions before they are looked up, so that the picture turns the other way.
        return {"radiance": max(strength, 0.0), "file": self.image_file(node.image),
                "rotate": -90 - math.degrees(turn)}

    # --- values and pictures ---

    def constant(self, socket):
        """A colour or a number that does not vary."""
        found = node_of(socket)
        value = socket.default_value
        if found and found[0].type in {'RGB', 'VALUE'}:
            value = found[1].default_value
        elif found:
            self.warn(f"{self.owner}: {socket.name} of {socket.node.name}: {found[0].name} is left out; "
                      "the value of the socket counts")
        if not self.is_finite(f"{self.owner}: {socket.name} of {socket.node.name}",
                              value if isinstance(value, (int, float)) else list(value)):
            return 0.0
        return float(value) if isinstance(value, (int, float)) else [float(number) for number in value[:3]]

    def value(self, socket):
        """A colour or a number, or the picture that it comes from."""
        found = node_of(socket)
        channel = None
        if found and found[0].type in {'SEPARATE_COLOR', 'SEPRGB'} and found[1].name[0] in "RGB":
            channel = found[1].name[0].lower()
            found = node_of(found[0].inputs[0])
        if not found or found[0].type != 'TEX_IMAGE' or not found[0].image:
            return self.constant(socket)
        node, image = found
        if image.name == "Alpha":
            channel = "a"
        pattern = {"file": self.image_file(node.image), "encoding": self.encoding(node.image)}
        if channel:
            pattern["channel"] = channel
        pattern["wrap"] = {'REPEAT': "repeat", 'EXTEND': "clamp", 'CLIP': "clamp", 'MIRROR': "mirror"}[node.extension]
        if node.interpolation == 'Closest':
            pattern["interpolate"] = "nearest"
        if node.projection != 'FLAT':
            self.warn(f"{self.owner}: {node.name}: pictures lie by UV coordinates alone")
        self.take_mapping(node, pattern)
        return {"image": pattern}

    def take_mapping(self, node, pattern):
        found = node_of(node.inputs["Vector"])
        if found and found[0].type == 'MAPPING' and found[0].vector_type in {'POINT', 'TEXTURE'}:
            mapping = found[0]
            found = node_of(mapping.inputs["Vector"])
            place, turn, scale = (mapping.inputs[name].default_value for name in ("Location", "Rotation", "Scale"))
            if any(turn) or mapping.vector_type == 'TEXTURE':
                self.warn(f"{self.owner}: {mapping.name}: rotation is left out")
            else:
                pattern["repeat"], pattern["offset"] = list(scale[:2]), list(place[:2])
        if not found:
            self.warn(f"{self.owner}: {node.name}: without a vector, its picture lies by UV coordinates")
        elif found[0].type not in {'TEX_COORD', 'UVMAP'} or found[1].name != "UV":
            self.warn(f"{self.owner}: {node.name}: its picture lies by the active UV map")

    @staticmethod
    def encoding(image):
        if image.is_float or image.colorspace_settings.name != 'sRGB':
            return "linear"
        return "srgb"

    def image_file(self, image):
        """The file of a picture: its own where psplat reads it, or a copy in the folder."""
        if image.name_full not in self.images:
            path = bpy.path.abspath(image.filepath_raw, library=image.library)
            plain = image.source == 'FILE' and not image.packed_file and not image.is_dirty
            if plain and os.path.isfile(path) and path.lower().endswith((".png", ".jpg", ".jpeg")):
                self.images[image.name_full] = path
                status = os.stat(path)
                self.digest.update(f"{path} {status.st_size} {status.st_mtime_ns}".encode())
            else:
                self.images[image.name_full] = self.copy_image(image)
            self.sources[self.images[image.name_full]] = image
        return self.images[image.name_full]

    def pixels(self, image):
        """Those of a picture of Blender, of shape (height, width, 4), the lowest row first."""
        width, height = image.size
        if not width or not height:
            self.warn(f"{image.name}: the picture can't be read; it counts as white")
            return numpy.ones((1, 1, 4), numpy.float32)
        pixels = numpy.empty(width * height * image.channels, numpy.float32)
        image.pixels.foreach_get(pixels)
        pixels = pixels.reshape(height, width, -1)
        if image.channels == 4:
            return pixels
        full = numpy.ones((height, width, 4), numpy.float32)
        full[:, :, :3] = pixels[:, :, :min(image.channels, 3)]
        return full

    def copy_image(self, image):
        pixels = self.pixels(image)
        name = f"image-{len(self.images)}" + (".exr" if image.is_float else ".png")
        if image.is_float:
            write_exr(os.path.join(self.folder, name), dict(zip("RGBA", numpy.moveaxis(pixels, -1, 0))))
        else:
            write_png(os.path.join(self.folder, name), pixels)
        self.take_file(name)
        return name

    # --- materials ---

    def take_material(self, material):
        """The name that a material of Blender has in the scene."""
        key = material.name_full if material else ""
        if key not in self.names:
            name = key.lstrip("=") or "default"
            while name in self.materials or name in self.gltf:
                name += "'"
            self.names[key] = name
            self.materials[name] = {}  # taken, before mixes add theirs
            self.materials[name] = self.description(material, name)
            if name in self.gltf:
                del self.materials[name]
        return self.names[key]

    def description(self, material, name):
        if not material:
            return {"diffuse": 0.8}
        self.owner = material.name
        if not material.use_nodes:
            return {"diffuse": within(list(material.diffuse_color[:3]))}
        output = material.node_tree.get_output_node('CYCLES')
        if not output:
            return {"diffuse": 0}
        for socket in ("Volume", "Displacement"):
            if output.inputs[socket].is_linked:
                self.warn(f"{material.name}: {socket.lower()} is left out")
        found = node_of(output.inputs["Surface"])
        if found and found[0].type == 'BSDF_PRINCIPLED' and self.is_gltf(found[0]):
            self.gltf[name] = self.gltf_material(found[0], name)
            return {}
        surface = self.surface(output.inputs["Surface"], name)
        if not is_black(surface.get("emission", 0)):
            surface["emission_both"] = True
        return surface

    def surface(self, socket, name):
        """What a shader is as a material of psd(5)."""
        found = node_of(socket)
        if not found:
            return {"diffuse": 0}
        node = found[0]
        shaders = {
            'BSDF_PRINCIPLED': self.principled, 'BSDF_DIFFUSE': self.diffuse, 'BSDF_GLOSSY': self.metal,
            'BSDF_GLASS': self.glass, 'EMISSION': self.emission, 'MIX_SHADER': self.mix_shader,
            'ADD_SHADER': self.add_shader, 'BSDF_TRANSPARENT': lambda node, name: {"diffuse": 0, "opacity": 0},
        }
        if node.type not in shaders:
            self.warn(f"{self.owner}: {node.name}: psplat does not know this shader; it counts as grey")
            return {"diffuse": 0.5}
        return shaders[node.type](node, name)

    def diffuse(self, node, name):
        return {"diffuse": within(self.value(node.inputs["Color"])), **self.relief(node)}

    def metal(self, node, name):
        return {"metal": {"color": within(self.value(node.inputs["Color"])), "roughness": self.roughness(node)},
                **self.relief(node)}

    def roughness(self, node):
        return within(self.value(node.inputs["Roughness"]))

    def glass(self, node, name):
        if self.roughness(node) != 0:
            self.warn(f"{self.owner}: {node.name}: glass is smooth in psplat")
        return {"dielectric": {"ior": self.constant(node.inputs["IOR"]),
                               "color": within(self.value(node.inputs["Color"]))}, **self.relief(node)}

    def emission(self, node, name):
        return {"diffuse": 0, "emission": self.shine(node.inputs["Color"], node.inputs["Strength"])}

    def shine(self, color, strength):
        strength = self.constant(strength)
        if strength <= 0:
            return 0
        return within(scaled(self.value(color), strength), math.inf)

    def warn_of_layers(self, node):
        for unknown in ("Subsurface", "Sheen", "Clearcoat", "Anisotropic"):
            if node.inputs[unknown].is_linked or node.inputs[unknown].default_value > 0:
                self.warn(f"{self.owner}: {unknown} of {node.name} is left out")

    def principled(self, node, name):
        inputs = node.inputs
        self.warn_of_layers(node)
        base = within(self.value(inputs["Base Color"]))
        metallic, transmission = (within(self.constant(inputs[key])) for key in ("Metallic", "Transmission"))
        weights = (metallic, (1 - metallic) * (1 - transmission), (1 - metallic) * transmission)
        kinds = (lambda: {"metal": {"color": base, "roughness": self.roughness(node)}},
                 lambda: self.plastic(node, base),
                 lambda: self.glass_of_principled(node, base))
        result = self.mixed(name, [(weight, kind()) for weight, kind in zip(weights, kinds) if weight > 0])
        shine = self.shine(inputs["Emission"], inputs["Emission Strength"])
        if not is_black(shine):
            result["emission"] = shine
        opacity = within(self.value(inputs["Alpha"]))
        if opacity != 1:
            result = self.with_holes(result, opacity)
        return {**result, **self.relief(node)}

    def with_holes(self, surface, opacity):
        if not isinstance(opacity, dict) and 0 < opacity < 1:
            self.warn(f"{self.owner}: a share of transparency above 1/2 is a hole, and one below is none")
        return {**surface, "opacity": opacity}

    @staticmethod
    def color_attribute(node):
        """The color attribute that a Principled BSDF takes its base color from, or None."""
        found = node_of(node.inputs["Base Color"])
        if found and found[0].type == 'VERTEX_COLOR':
            return found[0].layer_name
        return found[0].attribute_name if found and found[0].type == 'ATTRIBUTE' else None

    def is_gltf(self, node):
        """Whether a Principled BSDF wants what in psplat only materials of glTF have: metalness from a picture, opacity by chance,
        or colors of the mesh. Those have no glass, and shine from the front alone."""
        inputs = node.inputs
        shines = inputs["Emission Strength"].default_value > 0 and any(inputs["Emission"].default_value[:3])
        if inputs["Emission"].is_linked or shines or inputs["Transmission"].is_linked or inputs["Transmission"].default_value > 0:
            return False
        return (self.color_attribute(node) is not None or isinstance(self.value(inputs["Metallic"]), dict)
                or not inputs["Alpha"].is_linked and inputs["Alpha"].default_value < 1)

    def gltf_material(self, node, name):
        """A Principled BSDF as glTF has it."""
        self.warn_of_layers(node)
        inputs, colors = node.inputs, self.color_attribute(node)
        metallic, roughness, alpha = (within(self.value(inputs[key])) for key in ("Metallic", "Roughness", "Alpha"))
        base = 1.0 if colors is not None else within(self.value(inputs["Base Color"]))
        root = math.sqrt(within(self.constant(inputs["Specular"])) * 0.08)
        shading = {"baseColorFactor": [1, 1, 1, 1]}
        result = {"name": name, "colors": colors, "pbrMetallicRoughness": shading,
                  "extensions": {"KHR_materials_ior": {"ior": (1 + root) / (1 - root)}}}
        if isinstance(base, dict):
            shading["baseColorTexture"] = self.texture(base["image"])
        else:
            shading["baseColorFactor"][:3] = three(base)
        if isinstance(alpha, dict):
            self.warn(f"{self.owner}: alpha from a picture is left out beside metalness from one, or color attributes")
        elif alpha < 1:
            shading["baseColorFactor"][3], result["alphaMode"] = alpha, "BLEND"
        if isinstance(metallic, dict) or isinstance(roughness, dict):
            shading["metallicRoughnessTexture"] = self.packed(metallic, roughness)
        else:
            shading["metallicFactor"], shading["roughnessFactor"] = metallic, roughness
        relief = self.relief(node)
        if "normal_map" in relief:
            result["normalTexture"] = self.texture(relief["normal_map"])
        elif relief:
            self.warn(f"{self.owner}: bumps are left out beside metalness from a picture, color attributes, or an alpha below 1")
        return result

    def texture(self, image):
        """glTF's texture of a picture of psd(5). glTF counts v from above."""
        wrap = {"repeat": 10497, "clamp": 33071, "mirror": 33648}[image["wrap"]]
        filtering = 9728 if image.get("interpolate") == "nearest" else 9729
        (across, up), (right, above) = image.get("repeat", (1, 1)), image.get("offset", (0, 0))
        path = os.path.relpath(os.path.join(self.folder, image["file"]), self.folder)
        return {"file": urllib.parse.quote(path),
                "sampler": {"wrapS": wrap, "wrapT": wrap, "magFilter": filtering},
                "transform": {"scale": [across, up], "offset": [right, 1 - up - above]}}

    def packed(self, metallic, roughness):
        """The texture of metalness and roughness, which glTF has in blue and green of one picture; it lies as the first does."""
        pictures = [value["image"] for value in (metallic, roughness) if isinstance(value, dict)]
        if len({json.dumps([picture.get(key) for key in ("repeat", "offset", "wrap")]) for picture in pictures}) > 1:
            self.warn(f"{self.owner}: metalness and roughness from pictures lie alike")
        planes = [self.numbers(value["image"]) if isinstance(value, dict) else numpy.full((1, 1), value)
                  for value in (roughness, metallic)]
        height, width = (max(plane.shape[axis] for plane in planes) for axis in (0, 1))
        pixels = numpy.ones((height, width, 4))
        for channel, plane in zip((1, 2), planes):
            rows, columns = (numpy.arange(size) * plane.shape[axis] // size for axis, size in ((0, height), (1, width)))
            pixels[:, :, channel] = plane[rows][:, columns]
        name = f"packed-{len(self.gltf)}.png"
        write_png(os.path.join(self.folder, name), pixels)
        self.take_file(name)
        return self.texture({**pictures[0], "file": name})

    def numbers(self, picture):
        """The pixels of a picture where a number is wanted."""
        pixels = self.pixels(self.sources[picture["file"]])
        if picture["encoding"] == "srgb":
            rgb = pixels[:, :, :3]
            pixels[:, :, :3] = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        if picture.get("channel"):
            return pixels[:, :, "rgba".index(picture["channel"])]
        return pixels[:, :, :3].mean(axis=2)

    def plastic(self, node, base):
        """A coat over a diffuse base. Cycles adds the coat's light, and takes nothing from the base's; psplat's coat lets pass
        what it does not reflect. So the base is as much lighter as the coat takes at right angles."""
        specular = within(self.constant(node.inputs["Specular"])) * 0.08
        if specular == 0:
            return {"diffuse": base}
        if not isinstance(base, dict):
            base = within(scaled(base, 1 / (1 - specular)))
        return {"glossy": {"diffuse": base, "specular": specular, "roughness": self.roughness(node)}}

    def glass_of_principled(self, node, base):
        if self.roughness(node) != 0:
            self.warn(f"{self.owner}: {node.name}: glass is smooth in psplat")
        return {"dielectric": {"ior": self.constant(node.inputs["IOR"]), "color": base}}

    def mixed(self, name, parts):
        """A material of (weight, material); emission and relief of the parts go to the whole."""
        parts = [(weight, part) for weight, part in parts if weight > 0]
        if len(parts) == 1 and parts[0][0] == 1:
            return parts[0][1]
        whole, shares = {}, []
        for number, (weight, part) in enumerate(parts):
            shine = part.pop("emission", 0)
            if not is_black(shine):
                whole["emission"] = self.sum(name, whole.get("emission", 0), scaled(shine, weight))
            whole.update({key: part.pop(key) for key in ("bump", "normal_map") if key in part})
            if is_black(part.get("diffuse", 1)):
                continue
            key = f"{name} / {number + 1}"
            while key in self.materials:
                key += "'"
            self.materials[key] = part
            shares.append({"material": key, "weight": weight})
        return {"mix": shares, **whole} if shares else {"diffuse": 0, **whole}

    def sum(self, name, one, other):
        if is_black(one):
            return other
        if isinstance(one, dict) or isinstance(other, dict):
            self.warn(f"{name}: of a sum of pictures the first counts")
            return one
        return [a + b for a, b in zip(three(one), three(other))]

    def mix_shader(self, node, name):
        share = within(self.value(node.inputs["Fac"]))
        sockets = node.inputs[1:3]
        holes = [bool(found and found[0].type == 'BSDF_TRANSPARENT') for found in map(node_of, sockets)]
        if all(holes):
            return self.surface(sockets[0], name)
        if holes[0]:
            return self.with_holes(self.surface(sockets[1], name), share)
        if isinstance(share, dict):
            self.warn(f"{self.owner}: {node.name}: shaders mix by a number alone; half of each counts")
            share = 0.5
        if holes[1]:
            return self.with_holes(self.surface(sockets[0], name), 1 - share)
        return self.mixed(name, [(1 - share, self.surface(sockets[0], name + " / A")),
                                 (share, self.surface(sockets[1], name + " / B"))])

    def add_shader(self, node, name):
        one, other = (self.surface(socket, name) for socket in node.inputs[:2])
        if not is_black(one.get("diffuse", 1)):
            one, other = other, one
        if not is_black(one.get("diffuse", 1)):
            self.warn(f"{self.owner}: {node.name}: only emission can be added; the first shader counts")
            return other
        return {**other, "emission": self.sum(name, one.get("emission", 0), other.get("emission", 0))}

    def relief(self, node):
        """The keys for a normal map or bumps."""
        found = node_of(node.inputs["Normal"])
        if found and found[0].type == 'NORMAL_MAP':
            picture = self.value(found[0].inputs["Color"])
            if isinstance(picture, dict):
                return {"normal_map": {"file": picture["image"]["file"], "wrap": picture["image"]["wrap"]}}
        elif found and found[0].type == 'BUMP':
            height = self.value(found[0].inputs["Height"])
            if isinstance(height, dict):
                size = self.constant(found[0].inputs["Strength"]) * self.constant(found[0].inputs["Distance"])
                return {"bump": scaled(height, -size if found[0].invert else size)}
        if found:
            self.warn(f"{self.owner}: {found[0].name}: psplat takes normals and bumps from pictures alone")
        return {}


# --- the view ------------------------------------------------------------------------------------


class View:
    """The camera and the part of the picture that is rendered.

    psplat's pictures have their camera's axis in their middle. A shifted one is a part of a larger picture, whose size is rounded
    to pixels, and so is a render region.
    """

    def __init__(self, scene):
        render = scene.render
        self.part = [int(render.resolution_x * render.resolution_percentage / 100),
                     int(render.resolution_y * render.resolution_percentage / 100)]
        data = scene.camera.data
        wide = data.sensor_fit == 'HORIZONTAL' or data.sensor_fit == 'AUTO' and self.part[0] >= self.part[1]
        self.fit = self.part[0] if wide else self.part[1]
        self.sensor = data.sensor_height if data.sensor_fit == 'VERTICAL' else data.sensor_width
        right, up = round(2 * data.shift_x * self.fit), round(2 * data.shift_y * self.fit)
        self.width, self.height = self.part[0] + abs(right), self.part[1] + abs(up)
        self.crop = [max(right, 0), max(-up, 0), *self.part]
        if render.use_border:
            left, bottom = (int(edge * size) for edge, size in
                            zip((render.border_min_x, render.border_min_y), self.part))
            across, above = (int(edge * size) for edge, size in
                             zip((render.border_max_x, render.border_max_y), self.part))
            self.crop = [self.crop[0] + left, self.crop[1] + self.part[1] - above, across - left, above - bottom]
            self.part = self.crop[2:]
        self.pixel_aspect = render.pixel_aspect_x != render.pixel_aspect_y

    def options(self):
        if self.crop == [0, 0, self.width, self.height]:
            return []
        return ["--crop", ",".join(map(str, self.crop))]

    def description(self, camera, warn):
        data, matrix = camera.data, camera.matrix_world.normalized()
        location, forward = matrix.translation, -matrix.col[2].xyz
        if not math.isfinite(sum(location) + sum(forward)) or forward.length == 0:
            raise RenderError(f"{camera.name}: its place is not finite, or it is scaled to nothing")
        focus = data.dof.focus_distance
        if data.dof.focus_object:
            focus = (data.dof.focus_object.matrix_world.translation - location).dot(forward)
        if self.pixel_aspect:
            warn("psplat's pixels are square")
        result = {"location": upright(location), "look_at": upright(location + forward), "up": upright(matrix.col[1])}
        if data.type == 'ORTHO':
            return {**result, "projection": "orthographic", "width": data.ortho_scale * self.width / self.fit}
        if data.type != 'PERSP':
            warn("psplat has no panoramic cameras")
        slope = self.sensor / (2 * data.lens) * self.width / self.fit
        result["angle"] = math.degrees(2 * math.atan(slope))
        if data.dof.use_dof:
            result.update(aperture=data.lens / (2000 * data.dof.aperture_fstop), focus=max(focus, 1e-3))
        return result


# --- the program ---------------------------------------------------------------------------------

KINDS = ("estimator", "injection", "stratification", "visibility", "filter", "normalization", "denoiser")

# Of passes: channels in psplat's pictures, and Blender's kind. The first three are Blender's own, which view layers turn on.
PASSES = {
    "Depth": (("Z",), 'VALUE'),
    "Normal": (("N.X", "N.Y", "N.Z"), 'VECTOR'),
    "Position": (("P.X", "P.Y", "P.Z"), 'VECTOR'),
    "Direct": (("direct.R", "direct.G", "direct.B"), 'COLOR'),
    "Indirect": (("indirect.R", "indirect.G", "indirect.B"), 'COLOR'),
    "Albedo": (("albedo.R", "albedo.G", "albedo.B"), 'COLOR'),
    "Error": (("error",), 'VALUE'),
    "Weight": (("weight",), 'VALUE'),
}
SWITCHES = {"Depth": "use_pass_z", "Normal": "use_pass_normal", "Position": "use_pass_position"}
LETTERS = {'COLOR': "RGB", 'VECTOR': "XYZ", 'VALUE': "X"}

# Options of psplat that are not the user's: they say what the add-on reads.
OWN_OPTIONS = {"--output", "--layers", "--compression", "--progress", "--size", "--crop", "--preview", "--help", "--version"}


class RenderError(Exception):
    """What the user is told of a render that failed."""


def program():
    addon = bpy.context.preferences.addons.get(__name__)
    return bpy.path.abspath(addon.preferences.program) if addon and addon.preferences.program else "psplat"


def ask(*words):
    """What psplat prints, or RenderError."""
    try:
        return subprocess.run([program(), *words], check=True, capture_output=True, text=True, timeout=60).stdout
    except (OSError, subprocess.SubprocessError) as error:
        raise RenderError(f"psplat can't be run: {error}; its path is in the add-on's preferences") from error


def wanted_passes(scene, layer):
    return [name for name in PASSES
            if (getattr(layer, SWITCHES[name]) if name in SWITCHES else name.upper() in scene.psplat.layers)]


def progress_of(line):
    """What a line says of psplat's progress, or None: plugins may print other things."""
    try:
        report = json.loads(line)
    except ValueError:
        return None
    return report if isinstance(report, dict) and report.keys() >= {"stage", "fraction", "bytes"} else None


class Job:
    """One run of psplat in `folder`, which holds the scene. `tick(report)` is called several times a second, with what psplat
    last said of its progress or None; where it returns True, psplat is to stop with the picture so far."""

    def __init__(self, folder, options):
        self.picture = os.path.join(folder, "picture.exr")
        self.words = [program(), "render", "scene.psd", *options, "--output", "picture.exr", "--compression", "none",
                      "--progress", "json"]
        self.folder, self.messages = folder, []

    def run(self, tick):
        """Returns whether the picture is whole, and not that of a render that was stopped.

        psplat has a session of its own: ^C in a terminal would reach it beside the signal that `watch` sends, and the second ends
        it at once. Where Blender is killed, psplat ends at its next line of progress, whose pipe is then broken.
        """
        try:
            process = subprocess.Popen(self.words, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, start_new_session=True)
        except OSError as error:
            raise RenderError(f"psplat can't be run: {error}; its path is in the add-on's preferences") from error
        try:
            stopped = self.watch(process, tick)
            status = process.wait()
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            process.stdout.close()
            process.stderr.close()
        stopped = stopped or status in (130, 143)  # by somebody else
        if status != 0 and not stopped:
            errors = [line for line in self.messages if "error:" in line] or self.messages[-3:]
            raise RenderError("\n".join(errors) or f"psplat ended with status {status}")
        if status == 0 and not os.path.isfile(self.picture):
            raise RenderError("psplat ended without a picture")
        return status == 0 and not stopped

    def watch(self, process, tick):
        """Reads what psplat prints, until it ends."""
        stopped, rest = False, {process.stdout: b"", process.stderr: b""}
        with selectors.DefaultSelector() as selector:
            for stream in rest:
                selector.register(stream, selectors.EVENT_READ)
            while selector.get_map():
                report = None
                for key, _ in selector.select(0.1):
                    data = os.read(key.fd, 65536)
                    *lines, rest[key.fileobj] = (rest[key.fileobj] + data).split(b"\n")
                    lines = [line.decode(errors="replace") for line in lines]
                    if key.fileobj is process.stderr:
                        self.messages += lines
                    else:
                        report = next(filter(None, map(progress_of, reversed(lines))), report)
                    if not data:
                        selector.unregister(key.fileobj)
                if tick(report) and not stopped:
                    stopped = True
                    process.send_signal(signal.SIGINT)
        return stopped


class Frames:
    """A folder that keeps frames: each in a folder of its own, with its scene, picture and film, and a digest of what it was made
    from. A frame whose digest is the same is taken as it is, or gone on with where it was stopped."""

    def __init__(self, folder):
        self.folder, self.state = folder, os.path.join(folder, "state.json")

    @staticmethod
    def place(scene, layer):
        """The folders of a frame: of its scene, its layer, and itself. Names that differ have folders that do."""
        names = (urllib.parse.quote(name, safe="").replace(".", "%2E") for name in (scene.name_full, layer.name))
        part = f"{scene.frame_subframe:.4f}"[1:] if scene.frame_subframe else ""
        return (*names, f"{scene.frame_current:04d}{part}")

    def prepare(self, digest):
        """Returns whether the picture is there. Else what belongs to another digest, or is damaged, is removed."""
        try:
            with open(self.state, encoding="utf-8") as file:
                state = json.load(file)
        except (OSError, ValueError):
            state = None
        if isinstance(state, dict) and state.get("digest") == digest:
            try:
                read_exr(os.path.join(self.folder, "picture.exr"))
                return state.get("whole") is True
            except FileNotFoundError:
                self.write(digest, False)
                return False
            except (OSError, ValueError, LookupError, struct.error):
                pass
        for name in ("picture.exr", "film.exr"):
            if os.path.exists(os.path.join(self.folder, name)):
                os.remove(os.path.join(self.folder, name))
        self.write(digest, False)
        return False

    def write(self, digest, whole):
        with open(self.state + ".new", "w", encoding="utf-8") as file:
            json.dump({"digest": digest, "whole": whole}, file)
        os.replace(self.state + ".new", self.state)


# --- the engine ----------------------------------------------------------------------------------


class PsplatEngine(bpy.types.RenderEngine):
    """psplat in Blender's list of render engines."""

    bl_idname = "PSPLAT"
    bl_label = "psplat"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", 'COLOR')
        for name in wanted_passes(scene, renderlayer):
            channels, kind = PASSES[name]
            self.register_pass(scene, renderlayer, name, len(channels), self.letters(name), kind)

    @staticmethod
    def letters(name):
        return "Z" if name == "Depth" else LETTERS[PASSES[name][1]]

    def render(self, depsgraph):
        try:
            self.render_layer(depsgraph)
        except Exception as error:  # Blender takes any that leaves here for a render that went well
            text = str(error)
            if not isinstance(error, RenderError):
                traceback.print_exc()
                text = f"the add-on failed: {type(error).__name__}: {error}; the console has more"
            self.report({'ERROR'}, text)
            self.error_set(text)

    def render_layer(self, depsgraph):
        scene = depsgraph.scene_eval
        kept = bpy.path.abspath(scene.psplat.frames)
        if not kept:
            with tempfile.TemporaryDirectory(prefix="psplat-") as folder:
                self.render_in(depsgraph, folder, None)
            return
        folder = os.path.join(kept, *Frames.place(scene, depsgraph.view_layer_eval))
        try:
            os.makedirs(folder, exist_ok=True)
        except OSError as error:
            raise RenderError(f"the folder of frames can't be made: {error}") from error
        self.render_in(depsgraph, folder, Frames(folder))

    def render_in(self, depsgraph, folder, frames):
        scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
        self.update_stats("", "psplat: writing the scene")
        view, exporter = View(scene), Exporter(depsgraph, folder, lambda text: self.report({'WARNING'}, text))
        exporter.write(view)
        passes = wanted_passes(scene, layer)
        options = self.options(scene, passes) + view.options()
        whole, digest = False, None
        if frames:
            exporter.digest.update(json.dumps([options, ask("--version")]).encode())
            digest = exporter.digest.hexdigest()
            whole = frames.prepare(digest)
            options += ["--checkpoint", "film.exr", "--resume"]
        job, failed = Job(folder, options), True
        result = self.begin(layer.name, view, passes)
        try:
            if not whole:
                whole = job.run(self.ticker(job, result, view, scene, passes))
                self.tell(job)
                if frames and whole:
                    frames.write(digest, True)
            if os.path.exists(job.picture):
                self.show(job.picture, result, view, scene, passes)
            failed = False
        finally:
            self.end_result(result, cancel=failed)

    def begin(self, layer, view, passes):
        for name in passes:
            if name not in SWITCHES:
                self.add_pass(name, len(PASSES[name][0]), self.letters(name), layer=layer)
        return self.begin_result(0, 0, *view.part, layer=layer)

    def options(self, scene, passes):
        settings = scene.psplat
        layers = {PASSES[name][0][0].split(".")[0] for name in passes}
        if scene.render.film_transparent:
            layers.add("Z")
        if "Depth" in passes:
            layers.add("P")
        options = ["--quality", settings.quality.lower()]
        for key in ("passes", "bounces", "seed"):
            if getattr(settings, key):
                options += [f"--{key}", str(getattr(settings, key))]
        if settings.error > 0:
            options += ["--error", f"{settings.error:g}%"]
        if settings.time:
            options += ["--time", settings.time]
        for kind in KINDS:
            if getattr(settings, kind):
                options += ["--plugin", f"{kind}={getattr(settings, kind)}"]
        if scene.render.threads_mode == 'FIXED':
            options += ["--threads", str(scene.render.threads)]
        options += ["--write-every", "2s"]
        try:
            words = shlex.split(settings.options)
        except ValueError as error:
            raise RenderError(f"Options: {error}") from error
        for word in words:
            if word.split("=")[0] in OWN_OPTIONS or re.match("-q*[oh]", word):
                raise RenderError(f"Options: {word} is set by the add-on")
        return options + words + ["--layers", ",".join(sorted(layers)) or "none"]

    def ticker(self, job, result, view, scene, passes):
        """The function that a job calls: shows progress, and the pictures on the way."""
        shown = [0]

        def tick(report):
            if report:
                left = report.get("seconds_left")
                text = f"psplat: {report['stage']}" + (f", {left:.0f} s left" if left else "")
                self.update_stats("", text)
                self.update_progress(report["fraction"])
                self.update_memory_stats(memory_used=report["bytes"] / 1e6)
            changed = os.stat(job.picture).st_mtime_ns if os.path.exists(job.picture) else 0
            if changed > shown[0]:
                shown[0] = changed
                self.show(job.picture, result, view, scene, passes)
                self.update_result(result)
            return self.test_break()

        return tick

    def tell(self, job):
        for line in job.messages:
            if "warning:" in line:
                self.report({'WARNING'}, line)

    def show(self, path, result, view, scene, passes):
        """Hands the layers of a picture to Blender."""
        channels = read_exr(path)
        if channels["R"].shape != tuple(view.part[::-1]):
            raise RenderError("psplat's picture has another size than Blender's: what sets it among Options?")
        black = numpy.zeros(view.part[::-1], numpy.float32)
        alpha = black + 1
        if scene.render.film_transparent:
            alpha = numpy.isfinite(channels["Z"]).astype(numpy.float32)
        layers = {"Combined": [channels["R"], channels["G"], channels["B"], alpha]}
        for name in passes:
            layers[name] = [channels[channel] for channel in PASSES[name][0]]
        for name in ("Normal", "Position"):
            if name in layers:
                x, y, z = layers[name]
                layers[name] = [x, -z, y]
        if "Depth" in layers:
            layers["Depth"] = [self.depth(channels, scene.camera)]
        # Passes take pixels one by one from Python, but whole from a file.
        layer = result.layers[0]
        named = {f"{layer.name}.{name}.{letter}": pixels for name, arrays in layers.items()
                 for letter, pixels in zip("RGBA" if name == "Combined" else self.letters(name), arrays)}
        with tempfile.NamedTemporaryFile(suffix=".exr") as file:
            write_exr(file.name, named)
            result.load_from_file(file.name)

    @staticmethod
    def depth(channels, camera):
        """Distance along the axis of the camera, as Blender's own engines have it, and 1e10 where there is nothing."""
        matrix = camera.matrix_world.normalized()
        location, forward = matrix.translation, -matrix.col[2].xyz
        x, y, z = (channels[name] for name in ("P.X", "P.Y", "P.Z"))
        depth = (x - location[0]) * forward[0] + (-z - location[1]) * forward[1] + (y - location[2]) * forward[2]
        return numpy.where(numpy.isfinite(channels["Z"]), depth, 1e10)


# --- settings ------------------------------------------------------------------------------------

known_strategies = {}  # by program and kind, so that psplat is asked once


def strategies(kind):
    """The function that completes names of strategies of a kind."""

    def search(settings, context, text):
        key = (program(), kind)
        if key not in known_strategies:
            try:
                listed = ask("plugins", kind)
            except RenderError:
                return []
            known_strategies[key] = re.findall(r"^ +([a-z]\w*) ", listed, re.MULTILINE)
        return [name for name in known_strategies[key] if text.lower() in name]

    return search


def strategy(kind, what):
    return bpy.props.StringProperty(
        name=kind.capitalize(), search=strategies(kind), search_options={'SUGGESTION'},
        description=f"{what}. NAME or NAME:KEY=VALUE,...; empty: psplat's default")


class PsplatSettings(bpy.types.PropertyGroup):
    """Options of psplat(1), which has more of each."""

    quality: bpy.props.EnumProperty(
        name="Quality", default='NORMAL', description="How much work the picture is worth",
        items=[(name.upper(), name.capitalize(), "") for name in ("draft", "normal", "high", "final")])
    passes: bpy.props.IntProperty(name="Passes", min=0, max=1000000, description="Number of passes; 0: by quality")
    time: bpy.props.StringProperty(name="Time", description="Make passes until this time is used up: 90s, 10m, 2h")
    error: bpy.props.FloatProperty(name="Error", min=0, subtype='PERCENTAGE', precision=2, soft_max=20,
                                   description="Make passes until the indirect light is no farther off; 0: not so")
    bounces: bpy.props.IntProperty(name="Bounces", min=0, max=1000,
                                   description="How many diffuse surfaces indirect light may meet; 0: all")
    seed: bpy.props.IntProperty(name="Seed", min=0, description="Start of the random numbers")
    estimator: strategy("estimator", "What turns photons into light on the picture")
    injection: strategy("injection", "What makes indirect light sources")
    stratification: strategy("stratification", "What merges neighbouring photons")
    visibility: strategy("visibility", "What decides what a photon lights")
    filter: strategy("filter", "What weighs a splat by distance from its axis")
    normalization: strategy("normalization", "What turns what was gathered into radiance")
    denoiser: strategy("denoiser", "What smooths the indirect light")
    options: bpy.props.StringProperty(name="Options", description="More options of psplat(1), as on the command line")
    frames: bpy.props.StringProperty(
        name="Keep Frames", subtype='DIR_PATH',
        description="Folder for scenes, pictures and films of frames: what is whole and unchanged is not rendered "
                    "again, and what was stopped goes on. Empty: nothing is kept")
    layers: bpy.props.EnumProperty(
        name="Layers", options={'ENUM_FLAG'}, description="Passes of psplat's own",
        items=[(name.upper(), name, "", 1 << i)
               for i, name in enumerate(name for name in PASSES if name not in SWITCHES)])


class PsplatPreferences(bpy.types.AddonPreferences):
    """Where the program is."""

    bl_idname = __name__

    program: bpy.props.StringProperty(name="psplat", subtype='FILE_PATH',
                                      description="The program; empty: psplat, by PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


class PsplatPanel(bpy.types.Panel):
    """Settings of the render."""

    bl_idname = "RENDER_PT_psplat"
    bl_label = "psplat"
    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = "render"
    COMPAT_ENGINES = {PsplatEngine.bl_idname}
    keys = ("quality", "passes", "time", "error", "bounces", "seed", *KINDS, "options", "frames")

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context):
        self.layout.use_property_split = True
        for key in self.keys:
            self.layout.prop(context.scene.psplat, key)


class PsplatLayersPanel(bpy.types.Panel):
    """Passes."""

    bl_idname = "VIEWLAYER_PT_psplat"
    bl_label = "Passes"
    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = "view_layer"
    COMPAT_ENGINES = {PsplatEngine.bl_idname}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context):
        self.layout.use_property_split = True
        for key in SWITCHES.values():
            self.layout.prop(context.view_layer, key)
        self.layout.column().prop(context.scene.psplat, "layers", expand=True)


CLASSES = (PsplatPreferences, PsplatSettings, PsplatEngine, PsplatPanel, PsplatLayersPanel)
# Of Eevee, whose lights, worlds and materials have the same keys.
SHARED_PANELS = {"EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light", "DATA_PT_EEVEE_light_distance"}


def shared_panels():
    for panel in bpy.types.Panel.__subclasses__():
        if hasattr(panel, "COMPAT_ENGINES") and (
                'BLENDER_RENDER' in panel.COMPAT_ENGINES or panel.__name__ in SHARED_PANELS):
            yield panel


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.psplat = bpy.props.PointerProperty(type=PsplatSettings)
    for panel in shared_panels():
        panel.COMPAT_ENGINES.add(PsplatEngine.bl_idname)


def unregister():
    for panel in shared_panels():
        panel.COMPAT_ENGINES.discard(PsplatEngine.bl_idname)
    del bpy.types.Scene.psplat
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
