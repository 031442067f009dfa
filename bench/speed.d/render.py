"""render.py: runs psplat, and tells what a run took: wall and processor seconds, memory, stages."""
import json
import os
import re
import statistics
import subprocess
import time

from table import ROOT, fail

# What each method's indirect light takes; the rest (G-buffer, direct light, files) is the same for all but denoisers of
# direct light.
INDIRECT_STAGES = ("estimate", "normalize", "denoise")
COMMON_MEMORY = ("ray tracer", "G-buffer", "film")


class Run:
    """One render: seconds by stage, counters, bytes (as --stats writes them), and the process as a whole.

    The system counts the memory of this program, from which the process began, into `peak`: some 16 MB.
    """

    def __init__(self, stats, wall, usage, instructions):
        self.stages, self.counters, self.bytes = (stats[key] for key in ("seconds", "counters", "bytes"))
        self.wall, self.instructions = wall, instructions
        self.cpu = usage.ru_utime + usage.ru_stime
        self.peak = 1024 * usage.ru_maxrss
        files = self.stages.get("load", 0.0) + self.stages.get("write", 0.0)
        self.wall_rendering = wall - files
        # Stages are in wall seconds, which other processes stretch: their share of the processor seconds is taken off.
        self.cpu_rendering = self.cpu * (1 - files / wall)
        self.indirect = sum(self.stages.get(stage, 0.0) for stage in INDIRECT_STAGES)

    def own_bytes(self):
        """Photons, maps, bins, photon map: what the method alone holds."""
        own = sum(value for name, value in self.bytes.items() if name not in COMMON_MEMORY)
        return own + self.counters.get("photon tree bytes", 0)


def run_process(words, log):
    """Wall seconds, resource usage, and what was written to either stream, which goes to the file `log`."""
    with open(log, "wb") as file:
        start = time.perf_counter()
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=file, stderr=file)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except KeyboardInterrupt:
            process.kill()
            raise
        wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    with open(log, encoding="utf-8", errors="replace") as file:
        text = file.read()
    if process.returncode != 0:
        fail(f"status {process.returncode} of {' '.join(words)}\n{text}")
    return wall, usage, text


class Psplat:
    """The program, and a folder for what it writes."""

    def __init__(self, folder, program=None, count_instructions=True):
        self.program = program or os.environ.get("PSPLAT") or os.path.join(ROOT, "build/bin/psplat")
        self.folder = folder
        if not os.access(self.program, os.X_OK):
            fail(f"no program '{self.program}': build psplat, or name it with --psplat or in PSPLAT")
        os.makedirs(folder, exist_ok=True)
        self.perf = count_instructions and self._perf_counts()

    def _perf_counts(self):
        try:
            _, text = self._wait(["perf", "stat", "-x,", "-e", "instructions:u", "true"])[1:]
        except FileNotFoundError:
            return False
        return _instructions(text) is not None

    def _wait(self, words):
        return run_process(words, os.path.join(self.folder, "log.txt"))

    def render(self, words, output):
        """`words`: scene and options; `output`: the EXR file."""
        stats = os.path.join(self.folder, "stats.json")
        command = [self.program, "render", "--quiet", *words, "--output", output, "--stats", stats]
        if self.perf:
            command = ["perf", "stat", "-x,", "-e", "instructions:u", *command]
        wall, usage, text = self._wait(command)
        with open(stats, encoding="utf-8") as file:
            return Run(json.load(file), wall, usage, _instructions(text) if self.perf else None)

    def callgrind(self, words):
        """Instructions of a whole process, on valgrind's processor; about 50 times as slow as a render."""
        command = [self.program, "render", "--quiet", *words, "--output", os.path.join(self.folder, "callgrind.exr")]
        try:
            text = self._wait(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command])[2]
        except FileNotFoundError:
            fail("--callgrind needs valgrind")
        found = re.search(r"Collected : (\d+)", text)
        return int(found.group(1)) if found else None

    def compare(self, reference, picture, *options):
        """rel_rmse, and the channels' mean ratios."""
        text = self._wait([self.program, "compare", reference, picture, *options,
                           "--metric", "rel_rmse", "--metric", "bias"])[2]
        numbers = {line.split()[0]: [float(word) for word in line.split()[1:]] for line in text.splitlines()}
        return numbers["rel_rmse"][0], numbers["bias"]

    def resolve(self, film, picture, *choices):
        """A film's picture, by other normalization or denoiser."""
        words = [word for choice in choices for word in ("--plugin", choice)]
        self._wait([self.program, "resolve", "--quiet", film, *words, "--output", picture])

    def view(self, picture, output, *options):
        self._wait([self.program, "view", picture, *options, "--output", output])

    def info(self, path):
        return self._wait([self.program, "info", path])[2]

    def version(self):
        return self._wait([self.program, "--version"])[2].strip()


def _instructions(text):
    found = re.search(r"^(\d+),[^,]*,instructions", text, re.MULTILINE)
    return int(found.group(1)) if found else None


def median_run(runs):
    """Medians of the numbers of some runs of one command, as a dictionary for a JSON file."""
    def median(numbers):
        return statistics.median(list(numbers))
    result = {
        "indirect_seconds": median(run.indirect for run in runs),
        "wall_rendering_seconds": median(run.wall_rendering for run in runs),
        "cpu_rendering_seconds": median(run.cpu_rendering for run in runs),
        "wall_seconds": median(run.wall for run in runs),
        "cpu_seconds": median(run.cpu for run in runs),
        "peak_bytes": median(run.peak for run in runs),
        "own_bytes": median(run.own_bytes() for run in runs),
        "stages": {name: median(run.stages.get(name, 0.0) for run in runs) for name in runs[0].stages},
        "all_indirect_seconds": [run.indirect for run in runs],
        "all_wall_seconds": [run.wall for run in runs],
        "instructions": None,
    }
    if all(run.instructions is not None for run in runs):
        result["instructions"] = median(run.instructions for run in runs)
    return result


def machine():
    """The machine and its load, for the head of a report."""
    model = "unknown processor"
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), model)
    except OSError:
        pass
    return {"processor": model, "processors": os.cpu_count(), "load": os.getloadavg()[0],
            "date": time.strftime("%Y-%m-%d %H:%M")}
