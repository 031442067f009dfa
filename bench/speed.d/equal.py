"""equal.py: pictures of all methods at equal time.

Steps of a ladder are far apart: numbers between two of them are interpolated in the logarithms, as times are in curve.py.
What such a step takes is measured again. A method whose ladder begins above the time, or ends below it, shows that end.
"""
import math
import os
import shutil
import subprocess

from climb import rung_text
from render import median_run

COLUMNS = 3


def _number_between(a, b, part):
    """Of two numbers, as the table writes them; words that are none stay."""
    try:
        x, y = float(a), float(b)
    except ValueError:
        return a
    if x == y or x <= 0 or y <= 0:
        return a
    number = math.exp((1 - part) * math.log(x) + part * math.log(y))
    return str(round(number)) if a.isdigit() and b.isdigit() else f"{number:.3g}"


def rung_at(points, seconds):
    """The step that takes so long, from points (seconds, rung) in the ladder's order."""
    if seconds <= points[0][0]:
        return points[0][1]
    for (time_a, a), (time_b, b) in zip(points, points[1:]):
        if time_a <= seconds <= time_b:
            part = math.log(seconds / time_a) / math.log(time_b / time_a) if time_b > time_a else 1.0
            return {key: _number_between(a[key], b[key], part) for key in a}
    return points[-1][1]


def measure(climbers, seconds, seconds_of, render, view):
    """A dictionary for each method: its step, time, error and picture. `render` is as for climb; `view(name)` keeps the
    picture just rendered, and says where."""
    results = []
    for climber in climbers:
        rung = rung_at([(seconds_of(point), point["rung"]) for point in climber.points], seconds)
        run, (error, _, bias) = render(climber.method, rung, 0)
        results.append({"name": climber.method.name, "rung": rung, "error": error, "bias": bias, **median_run([run]),
                        "picture": view(climber.method.name)})
    return results


def label(result, seconds_of):
    return f"{result['name']}, {seconds_of(result):.2g} s, {100 * result['error']:.2g} %"


def rows(group, seconds_of):
    for result in group["equal"]:
        yield [result["name"], rung_text(result["rung"]), f"{seconds_of(result):.2g}", f"{100 * result['error']:.3g} %",
               " ".join(f"{ratio:.3f}" for ratio in result["bias"]), f"{result['own_bytes'] / 1e6:.1f}"]


class Views:
    """Indirect light of pictures, as PNG files in a folder."""

    def __init__(self, psplat, folder, prefix, exposure):
        self.psplat, self.folder, self.prefix, self.exposure = psplat, folder, prefix, exposure

    def keep(self, picture, name):
        path = os.path.join(self.folder, f"{self.prefix}-{name}.png")
        self.psplat.view(picture, path, "--layer", "indirect", "--exposure", self.exposure)
        return path

    def sheet(self, path, labelled, say):
        """All of them (file, label) on one sheet, by ImageMagick, where it is there."""
        if not shutil.which("montage"):
            say("no sheet of pictures: there is no montage (ImageMagick)")
            return
        words = [word for file, text in labelled for word in ("-label", text, file)]
        subprocess.run(["montage", *words, "-tile", f"{COLUMNS}x", "-geometry", "+2+2", "-quality", "85", path], check=True)
