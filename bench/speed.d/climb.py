"""climb.py: climbs the methods' ladders side by side.

Runs are paired: on each rung every method is rendered once, then every method again, so that what else the
machine does disturbs all alike. A method stops when its error is below the smallest target, its time is
spent, or its ladder ends.
"""
import os

from render import median_run


class Climber:
    """One method on its way up: the points measured so far, and the runs of the rung it is on."""

    def __init__(self, method, rungs):
        self.method, self.rungs = method, rungs
        self.points, self.spent, self.why = [], 0.0, None
        self.runs, self.errors = [], []

    def begin_rung(self, number):
        self.runs, self.errors = [], []
        if not self.why and number >= len(self.rungs):
            self.why = "ladder's end"

    def wants_run(self, budget):
        return not self.why and (not self.runs or self.spent < budget)

    def end_rung(self, number, smallest_target, budget):
        """The rung's medians become a point."""
        if not self.runs:
            return None
        order = sorted(range(len(self.errors)), key=lambda i: self.errors[i][0])
        error, measured, bias = self.errors[order[len(order) // 2]]
        point = {"rung": self.rungs[number], "repeats": len(self.runs), "error": error,
                 "measured_error": measured, "bias": bias, **median_run(self.runs)}
        self.points.append(point)
        if error <= smallest_target:
            self.why = "smallest error reached"
        elif self.spent >= budget:
            self.why = "time spent"
        return point


def climb(plan, climbers, render, say):
    """`plan`: repeats, budget (seconds a ladder), targets, rungs (at most). `render(method, rung, repeat)` gives
    a run and its (error, measured error, bias)."""
    most = max((len(climber.rungs) for climber in climbers), default=0)
    for number in range(min(most, plan.rungs)):
        for climber in climbers:
            climber.begin_rung(number)
        for repeat in range(plan.repeats):
            for climber in [c for c in climbers if c.wants_run(plan.budget)]:
                run, errors = render(climber.method, climber.rungs[number], repeat)
                climber.runs.append(run)
                climber.errors.append(errors)
                climber.spent += run.wall
        for climber in climbers:
            point = climber.end_rung(number, min(plan.targets), plan.budget)
            if point:
                say(f"  {climber.method.name}: {rung_text(point['rung'])}: {point['wall_rendering_seconds']:.2f} s, "
                    f"{100 * point['error']:.2f} %")
    for climber in climbers:
        climber.why = climber.why or "ladder's end"


def rung_text(rung):
    return " ".join(f"{key}={value}" for key, value in rung.items())


class PictureErrors:
    """Errors of pictures; those of another number of threads are the same picture, and are known."""

    def __init__(self, psplat, reference, folder):
        self.psplat, self.reference, self.known = psplat, reference, {}
        self.picture = os.path.join(folder, "picture.exr")

    def render(self, words, threads, seed):
        words = [*words, "--seed", str(seed)]
        run = self.psplat.render([*words, "--threads", str(threads), "--layers", "indirect"], self.picture)
        key = " ".join(words)
        if key not in self.known:
            self.known[key] = self.reference.error(self.picture)
        return run, self.known[key]
