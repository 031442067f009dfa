"""reference.py: converged pictures to measure errors against.

A reference is two path-traced halves, A and B, of independent noise. With T the picture under test and
|x| a norm over all pixels and channels,

    (T - A) . (T - B) = (|T - A|^2 + |T - B|^2 - |A - B|^2) / 2

has the squared error against the true picture as its mean: the noise of A and B, independent of each other
and of T, falls out. So errors near the reference's own noise are right too, and no averaging of pictures is
needed. |A - B| / 2 is the noise of the halves' mean, which the report states. What noise leaves of the products
is small, being a mean over many pixels, but not nothing: errors below a quarter of the noise count as a quarter.
"""
import hashlib
import json
import math
import os

from table import ROOT

SEEDS = (1001, 1002)  # of the halves; no measured render has one of them
LAYER = ("--layer", "indirect")
TRUSTED = 0.25  # of the noise: the least error that is believed


class Reference:
    def __init__(self, psplat, halves, samples):
        self.psplat, self.halves, self.samples = psplat, halves, samples
        difference = psplat.compare(*halves, *LAYER)[0]
        self.noise = difference / 2
        self.variance = difference ** 2 / 2  # of the mean square of the distances to the halves

    def summary(self):
        return {"samples": self.samples, "noise": self.noise, "least_error": TRUSTED * self.noise}

    def error(self, picture):
        """Relative RMSE as measured, the same without the reference's variance, and the mean ratios."""
        (a, bias_a), (b, bias_b) = (self.psplat.compare(half, picture, *LAYER) for half in self.halves)
        measured = (a * a + b * b) / 2
        error = math.sqrt(max(measured - self.variance, (TRUSTED * self.noise) ** 2))
        return error, math.sqrt(measured), [(x + y) / 2 for x, y in zip(bias_a, bias_b)]


def _digest(scene):
    """Of the scene and of the parts that scenes are made of, so that no reference outlives a change of them."""
    library = os.path.join(ROOT, "scenes/library")
    parts = sorted(os.path.join(library, name) for name in os.listdir(library)) if os.path.isdir(library) else []
    digest = hashlib.sha1()
    for path in [scene.file] + parts:
        with open(path, "rb") as file:
            digest.update(file.read())
    if scene.needs:
        digest.update(f"{scene.mesh} {os.path.getsize(scene.mesh)}".encode())
    return digest.hexdigest()


SMOOTH_SAMPLES = 32  # of a pass, of a smooth reference


def _words(scene, samples, smooth):
    """Of one half: those of a measured picture, whose pixels see one point, or means over pixels by many passes."""
    if smooth:
        return [scene.file, "--plugin", "denoiser=none", "--passes", str(max(1, samples // 2 // SMOOTH_SAMPLES)),
                "--plugin", f"estimator=pathtrace:samples={min(SMOOTH_SAMPLES, samples // 2)}"]
    return [*scene.words, "--plugin", f"estimator=pathtrace:samples={max(1, samples // 2 // scene.passes)}"]


def picture_path(folder, scene, size, bounces):
    return os.path.join(folder, f"{scene.name}-{size}-{bounces}-picture.exr")


def _render(psplat, words, path, say):
    """Where psplat is interrupted it writes what there is: only a whole picture gets the name, and is used again."""
    unfinished = os.path.splitext(path)[0] + ".unfinished.exr"
    run = psplat.render(words, unfinished)
    os.replace(unfinished, path)
    say(f"reference {os.path.basename(path)}: {run.wall:.1f} s")


def make_picture(psplat, folder, scene, size, bounces, samples, say):
    """One to look at, denoised, with as many samples as a half of the reference that `make` has made."""
    path = picture_path(folder, scene, size, bounces)
    if os.path.exists(path):
        say(f"reference {os.path.basename(path)}: reused")
        return path
    words = [word for word in _words(scene, samples, False) if word != "--plugin=denoiser=none"]
    _render(psplat, [*words, "--plugin", "denoiser=regression", "--size", size, "--bounces", bounces], path, say)
    return path


def make(psplat, folder, scene, size, bounces, samples, say, smooth=False):
    """Reads the reference from the folder, or renders what of it is not there (or no longer right)."""
    name = f"{scene.name}-{size}-{bounces}{'-smooth' if smooth else ''}"
    stamp_path = os.path.join(folder, f"{name}.json")
    stamp = {"samples": samples, "scene": _digest(scene)}
    halves = [os.path.join(folder, f"{name}-{letter}.exr") for letter in "ab"]
    os.makedirs(folder, exist_ok=True)
    known = {}
    if os.path.exists(stamp_path):
        with open(stamp_path, encoding="utf-8") as file:
            known = json.load(file)
    if known != stamp:
        for path in [stamp_path, picture_path(folder, scene, size, bounces)] + halves:
            if os.path.exists(path):
                os.remove(path)
        with open(stamp_path, "w", encoding="utf-8") as file:
            json.dump(stamp, file)
    for path, seed in zip(halves, SEEDS):
        if os.path.exists(path):
            say(f"reference {os.path.basename(path)}: reused")
            continue
        words = _words(scene, samples, smooth)
        _render(psplat, [*words, "--size", size, "--seed", str(seed), "--bounces", bounces], path, say)
    return Reference(psplat, halves, samples)
