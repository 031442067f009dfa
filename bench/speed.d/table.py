"""table.py: the tables of scenes and methods (scenes.ini, methods.ini, marks.ini; they say how to read them)."""
import configparser
import copy
import fnmatch
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))


def fail(message):
    sys.exit(f"{os.path.basename(sys.argv[0])}: error: {message}")


def _read(path):
    parser = configparser.ConfigParser(delimiters=(":",), interpolation=None)
    parser.optionxform = str
    with open(path, encoding="utf-8") as file:
        parser.read_file(file)
    return parser


def choose(all_names, wanted, what):
    """The wanted names, in the table's order; all where none, or "all", is wanted."""
    wanted = [] if wanted == ["all"] else wanted
    unknown = [name for name in wanted or [] if name not in all_names]
    if unknown:
        fail(f"no {what} '{unknown[0]}'; there are: {', '.join(all_names)}")
    return [name for name in all_names if not wanted or name in wanted]


# Where methods say nothing: splats as they are, and pixels whose light is that of one point.
BASE = ["--plugin=estimator=splat", "--plugin=denoiser=none", "--set=render.aa_samples=1"]


class Scene:
    """What psplat is to render, and its words: file and parameters."""

    def __init__(self, name, section, mesh=None):
        self.name = name
        self.file = os.path.join(ROOT, section["file"])
        self.needs = section.get("needs")
        self.mesh = os.path.abspath(mesh) if mesh else None
        self.passes = int(section.get("passes", 1))
        self.exposure = section.get("exposure", "1.5")
        options = section.get("options", "").split() + [f"--passes={self.passes}"]
        self.words = [self.file, *BASE] + [word.format(mesh=self.mesh) for word in options]

    def missing(self):
        """Why the scene can't be rendered, or None."""
        if not self.needs:
            return None
        if not self.mesh:
            return f"--mesh names no {self.needs}"
        return None if os.path.exists(self.mesh) else f"there is no {self.mesh}"


def read_scenes(wanted=None, mesh=None):
    table = _read(os.path.join(FOLDER, "scenes.ini"))
    return [Scene(name, table[name], mesh) for name in choose(table.sections(), wanted, "scene")]


class Method:
    """A row of the table: a name and the steps of its quality, each a dictionary."""

    def __init__(self, name, section):
        self.name = name
        self.options = section["options"].split()
        self.ladders = {key: value for key, value in section.items() if key != "options"}

    def denoised_by(self, denoiser):
        """The same method, through another denoiser."""
        other = copy.copy(self)
        other.options = [word for word in self.options if not word.startswith("denoiser=")] + [f"denoiser={denoiser}"]
        return other

    def rungs(self, scene):
        """From cheap to dear; empty where the method has none for this scene."""
        for pattern, text in self.ladders.items():
            if fnmatch.fnmatchcase(scene, pattern):
                lines = [line.split() for line in text.splitlines() if line.strip()]
                return [dict(word.split("=", 1) for word in line) for line in lines]
        return []

    def words(self, rung, bounces):
        """The words for psplat that one step stands for."""
        words = []
        for option in self.options:
            option = option.format(bounces=bounces, **rung)
            words += [option] if option.startswith("-") else ["--plugin", option]
        return words


def read_methods(path, wanted=None):
    try:
        table = _read(path)
    except OSError as error:
        fail(error)
    return [Method(name, table[name]) for name in choose(table.sections(), wanted, "method")]
