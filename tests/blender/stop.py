"""A render that goes on until it is interrupted, with its frame kept in FOLDER.

blender -b --factory-startup --python stop.py -- FOLDER
"""

import os
import sys

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes

bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.enable("psplat_render", default_set=True)
scenes.point()
scene = bpy.context.scene
scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = 'PSPLAT', 640, 360
scene.psplat.frames, scene.psplat.passes, scene.psplat.options = sys.argv[-1], 1000000, "-p injection=photon:count=2000"
bpy.ops.render.render()
print("RENDERED")
