"""command.py: what the command lines of bench/speed, bench/marks and bench/scaling share."""
import argparse
import json
import os
import shutil
import subprocess
import sys

from table import FOLDER, ROOT, fail

WORK = os.path.join(ROOT, "build/speed")


def say(text):
    """Progress, beside the report on the standard output."""
    print(text, file=sys.stderr, flush=True)


def words(text):
    return text.split(",")


def whole_numbers(text):
    return [int(word) for word in text.split(",")]


def percentages(text):
    """Relative errors, from the largest down: "10,6,3" percent."""
    numbers = sorted((float(word) / 100 for word in text.split(",")), reverse=True)
    if numbers[-1] <= 0:
        raise ValueError
    return numbers


def make_parser(description, files, repeats="runs of each, of which the median counts; default: 3"):
    """`repeats`: what the option --repeats means; None where there is none."""
    parser = argparse.ArgumentParser(description=description)
    add = parser.add_argument
    if repeats:
        add("--repeats", type=int, metavar="N", help=repeats)
    add("--quick", action="store_true", help="a small part, which shows that all works")
    add("--psplat", metavar="FILE", help="the program; default: $PSPLAT, or that in build/bin")
    add("--work", default=WORK, metavar="DIR", help="for pictures, which may be large; default: build/speed")
    add("--out", default=WORK, metavar="DIR", help=f"for {files}; default: build/speed")
    return parser


def add_mesh(parser):
    parser.add_argument("--mesh", metavar="FILE",
                        help="conference.obj of the LBNL conference room; default: that scene is left out")


def present(scenes, skipped):
    """The scenes that can be rendered; of the others one line each, and an entry in the dictionary `skipped`."""
    for scene in scenes:
        if scene.missing():
            skipped[scene.name] = scene.missing()
            say(f"left out: {scene.name}: {scene.missing()}")
    return [scene for scene in scenes if scene.name not in skipped]


def parse(parser, full, quick):
    """Options that were not given are those of the full or of the quick measurement."""
    plan = parser.parse_args()
    for name, value in (quick if plan.quick else full).items():
        if getattr(plan, name) is None:
            setattr(plan, name, value)
    if hasattr(plan, "repeats") and plan.repeats < 1:
        fail("--repeats is at least 1")
    os.makedirs(plan.out, exist_ok=True)
    return plan


def write_json(path, results):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)
        file.write("\n")


def write_text(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.rstrip("\n") + "\n")


def draw(script, picture, **given):
    """By gnuplot, where it is there: `picture`, an SVG, with a script of speed.d that is given these words."""
    if not shutil.which("gnuplot"):
        say("not drawn: there is no gnuplot")
        return
    words = "; ".join(f"{name}='{value}'" for name, value in {"svg": picture, **given}.items())
    subprocess.run(["gnuplot", "-e", words, os.path.join(FOLDER, script)], check=True)


def report(path, text):
    """Into the file, and on the standard output."""
    write_text(path, text)
    print(text.rstrip("\n"))


def run(main):
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("interrupted; what was measured in whole is in the folder of --out")
