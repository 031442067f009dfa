"""curve.py: from points (seconds, error) to the time that an error takes, and to ratios of such times.

Between neighbouring rungs a curve is a straight line in the logarithms. It is never continued past its ends:
an error that the cheapest rung is already below takes "at most" that rung's time, and one that no rung gets
below is not reached.
"""
import math
from collections import namedtuple

AT, WITHIN, NEVER = "at", "within", "never"

# seconds: for WITHIN an upper bound; for NEVER what was spent without reaching the error, a lower bound.
Reach = namedtuple("Reach", "kind seconds")


def time_to(points, target):
    """Of several crossings the one that takes the least time; None where there are no points."""
    if not points:
        return None
    if points[0][1] <= target:
        return Reach(WITHIN, points[0][0])
    crossings = [_between(a, b, target) for a, b in zip(points, points[1:]) if a[1] > target >= b[1]]
    if crossings:
        return Reach(AT, min(crossings))
    return Reach(NEVER, max(seconds for seconds, _ in points))


def error_at(points, seconds):
    """Between the rungs on either side; None before the first and after the last."""
    for a, b in zip(points, points[1:]):
        if a[0] <= seconds <= b[0]:
            part = math.log(seconds / a[0]) / math.log(b[0] / a[0]) if b[0] > a[0] else 1.0
            return math.exp((1 - part) * math.log(a[1]) + part * math.log(b[1]))
    return None


def _between(a, b, target):
    part = math.log(a[1] / target) / math.log(a[1] / b[1])
    return math.exp((1 - part) * math.log(a[0]) + part * math.log(b[0]))


def reach_text(reach):
    if reach is None:
        return "no measurement"
    if reach.kind == NEVER:
        return "not reached"
    return ("<= " if reach.kind == WITHIN else "") + f"{reach.seconds:.3g} s"


def ratio_text(peer, ours):
    """How many times as long as ours the peer takes; a bound where one of them is one."""
    if peer is None or ours is None:
        return "no measurement"
    if ours.kind == NEVER:
        return "not reached"
    ratio = f"{peer.seconds / ours.seconds:.3g}x"
    if peer.kind == AT:
        return ("> " if ours.kind == WITHIN else "") + ratio
    if peer.kind == NEVER:
        return "> " + ratio
    return "< " + ratio if ours.kind == AT else "both at once"


def exponent(points):
    """Slope of the line through the points (x, y) in the logarithms, by least squares."""
    logs = [(math.log(x), math.log(y)) for x, y in points if y > 0]
    mean_x, mean_y = (sum(column) / len(logs) for column in zip(*logs))
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread if spread else math.nan
