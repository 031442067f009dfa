#!/usr/bin/env python3
"""render.py: an example: renders a scene by psplat's library from Python, with nothing but ctypes.

    python3 render.py scene.psd picture.exr [OPTION=VALUE...]      # as size=640x360, passes=4

Where the library is not installed for all, LD_LIBRARY_PATH names its folder.
"""
import ctypes
import sys
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_size_t, c_uint32, c_void_p

PS_OK, PS_CANCELLED = 0, 4


class Error(ctypes.Structure):
    _fields_ = [("result", c_int), ("line", c_int32), ("column", c_int32), ("has_place", c_int32),
                ("file", c_char * 1024), ("message", c_char * 32768)]


class Progress(ctypes.Structure):
    _fields_ = [("stage", c_char_p), ("fraction", c_double), ("error", c_double), ("passes", c_uint32)]


PROGRESS = ctypes.CFUNCTYPE(None, c_void_p, POINTER(Progress))
CANCELLED = ctypes.CFUNCTYPE(c_int, c_void_p)
PASS = ctypes.CFUNCTYPE(None, c_void_p, c_void_p, c_uint32)
LISTENER = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p)


class Callbacks(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("user", c_void_p),
                ("progress", PROGRESS), ("cancelled", CANCELLED), ("each_pass", PASS)]


psplat = ctypes.CDLL("libpsplat.so.0")
for name, result, arguments in [
        ("scene_create", c_void_p, []),
        ("scene_destroy", None, [c_void_p]),
        ("scene_set", c_int, [c_void_p, c_char_p, c_char_p, POINTER(Error)]),
        ("scene_listen", None, [c_void_p, LISTENER, c_void_p]),
        ("scene_load", c_int, [c_void_p, c_char_p, POINTER(Error)]),
        ("rendering_picture", c_int, [c_void_p, POINTER(c_void_p), POINTER(Error)]),
        ("render", c_int, [c_void_p, POINTER(Callbacks), POINTER(c_void_p), POINTER(Error)]),
        ("picture_destroy", None, [c_void_p]),
        ("picture_width", c_size_t, [c_void_p]),
        ("picture_height", c_size_t, [c_void_p]),
        ("picture_channel", POINTER(c_float), [c_void_p, c_char_p]),
        ("picture_write", c_int, [c_void_p, c_char_p, POINTER(Error)])]:
    function = getattr(psplat, "psplat_" + name)
    function.restype, function.argtypes = result, arguments


def check(result, error):
    if result != PS_OK:
        raise RuntimeError(error.message.decode())


def mean(picture, channel):
    """The mean of a channel: samples are plain floats, row by row."""
    samples = psplat.psplat_picture_channel(picture, channel)
    count = psplat.psplat_picture_width(picture) * psplat.psplat_picture_height(picture)
    return sum(samples[:count]) / count


def show_pass(user, rendering, passes):
    """Between passes there is a picture of those so far, and it may be looked at, or given to a viewer."""
    picture = c_void_p()
    if psplat.psplat_rendering_picture(rendering, byref(picture), None) == PS_OK:
        print("mean of R after %u: %.6f" % (passes, mean(picture, b"R")))
    psplat.psplat_picture_destroy(picture)


def render(path, output, options):
    error, picture = Error(), c_void_p()
    # Kept in names: what C calls must not be collected.
    listener = LISTENER(lambda user, kind, message: print(message.decode(), file=sys.stderr))
    callbacks = Callbacks(size=ctypes.sizeof(Callbacks), progress=PROGRESS(
        lambda user, progress: print(f"{100 * progress[0].fraction:3.0f} % {progress[0].stage.decode()}",
                                     file=sys.stderr)), each_pass=PASS(show_pass))
    scene = psplat.psplat_scene_create()
    try:
        psplat.psplat_scene_listen(scene, listener, None)
        for option in options:
            name, has_value, value = option.partition("=")
            check(psplat.psplat_scene_set(scene, name.encode(), value.encode() if has_value else None,
                                          byref(error)), error)
        check(psplat.psplat_scene_load(scene, path.encode(), byref(error)), error)
        check(psplat.psplat_render(scene, byref(callbacks), byref(picture), byref(error)), error)
        print("mean of R: %.6f" % mean(picture, b"R"))
        check(psplat.psplat_picture_write(picture, output.encode(), byref(error)), error)
    finally:
        psplat.psplat_picture_destroy(picture)
        psplat.psplat_scene_destroy(scene)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit("usage: render.py SCENE.psd PICTURE.exr [OPTION=VALUE...]")
    try:
        render(sys.argv[1], sys.argv[2], sys.argv[3:])
    except RuntimeError as reason:
        sys.exit(str(reason))
