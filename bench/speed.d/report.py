"""report.py: what bench/speed found, as Markdown."""
import equal
from climb import rung_text
from curve import error_at, ratio_text, reach_text, time_to

BUDGETS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)  # seconds
STAGES = ("inject", "stratify", "place", "maps", "bin", "splat", "join")


def markdown_table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows] + [""]


def percent(number):
    return f"{100 * number:.3g} %"


def is_ours(name):
    return name.startswith(("gather", "splat"))


def seconds_of(point, threads):
    """Of the processor on one thread, of the clock on more."""
    return point["cpu_rendering_seconds" if threads == 1 else "wall_rendering_seconds"]


def curve_of(method, group):
    return [(seconds_of(point, group["threads"]), point["error"]) for point in method["points"]]


def curves_csv(results):
    """A line for each point: its group's number, method, seconds, error in percent."""
    lines = ["group,method,seconds,error"]
    for number, group in enumerate(results["groups"]):
        for method in group["methods"]:
            lines += [f"{number},{method['name']},{seconds:.6g},{100 * error:.6g}"
                      for seconds, error in curve_of(method, group)]
    return "\n".join(lines)


def _errors(group):
    rows = []
    for method in group["methods"]:
        errors = (error_at(curve_of(method, group), seconds) for seconds in BUDGETS)
        rows.append([method["name"], *(percent(error) if error else "" for error in errors)])
    return markdown_table(["method", *(f"{seconds:g} s" for seconds in BUDGETS)], rows)


def _times(group, targets):
    rows = []
    for method in group["methods"]:
        curve = curve_of(method, group)
        seconds, least = min(curve, key=lambda point: point[1])
        rows.append([method["name"], *(reach_text(time_to(curve, target)) for target in targets),
                     f"{percent(least)} in {seconds:.3g} s ({method['stopped']})"])
    return markdown_table(["method", *map(percent, targets), "least error"], rows)


def _ratios(group, targets):
    """Every row of ours against every peer."""
    rows = []
    curves = {method["name"]: curve_of(method, group) for method in group["methods"]}
    for peer in (name for name in curves if not is_ours(name)):
        for ours in filter(is_ours, curves):
            rows.append([peer, ours, *(ratio_text(time_to(curves[peer], target), time_to(curves[ours], target))
                                       for target in targets)])
    return markdown_table(["against", "method", *map(percent, targets)], rows) if rows else []


def _points(group):
    rows = []
    for method in group["methods"]:
        for point in method["points"]:
            stages = point["stages"]
            bound = "<= " if point["error"] <= group["reference"]["least_error"] else ""
            rows.append([method["name"], rung_text(point["rung"]), bound + percent(point["error"]),
                         " ".join(f"{ratio:.3f}" for ratio in point["bias"]),
                         f"{seconds_of(point, group['threads']):.3g}", f"{point['indirect_seconds']:.3g}",
                         " ".join(f"{stages[name]:.2g}" if name in stages else "-" for name in STAGES),
                         f"{point['own_bytes'] / 1e6:.1f}", _instructions(point)])
    return markdown_table(["method", "rung", "error", "bias", "seconds", "of indirect light", " ".join(STAGES), "own MB",
                  "G instructions"], rows)


def _instructions(point):
    count = point["instructions"] or point.get("callgrind_instructions")
    return f"{count / 1e9:.3g}" if count else "-"


def _counted(bounces):
    return {"1": "1 bounce"}.get(bounces, f"{bounces} bounces")


def _equal(group):
    rows = equal.rows(group, lambda point: seconds_of(point, group["threads"]))
    return markdown_table(["method", "rung", "seconds", "error", "bias", "own MB"], rows)


def _reference(group, targets):
    reference = group["reference"]
    text = (f"Reference: path tracing, two halves of {reference['samples'] // 2} samples; noise of their mean "
            f"{percent(reference['noise'])}, taken out of the errors.")
    if reference["noise"] > min(targets):
        text += " **That is much for the smallest error: use more samples.**"
    return text


def group_title(group):
    return (f"{group['scene']}, {group['size']}, {_counted(group['bounces'])}, {group['threads']} "
            f"thread{'s' if group['threads'] != 1 else ''}"
            f"{', denoiser=' + group['denoiser'] if group['denoiser'] else ''}")


def markdown(results):
    head, targets = results["machine"], results["targets"]
    lines = ["# Time to an error", "",
             f"{head['date']}, {results['version']}, {head['processors']} x {head['processor']}, load "
             f"{head['load']:.1f} at the start; medians of {results['repeats']}, methods by turns.",
             "Error: relative RMSE of the indirect layer. Seconds: of the whole process but for loading and writing files; of "
             "the processor on one thread, of the clock on more.",
             "Times between rungs by interpolation in the logarithms, never past the ends of a ladder. "
             f"Instructions: {results['instructions']}.", ""]
    for name, why in results["skipped"].items():
        lines += [f"Left out: {name}: {why}.", ""]
    for group in results["groups"]:
        lines += [f"## {group_title(group)}", "", _reference(group, targets), ""]
        lines += ["Error after a time:", ""] + _errors(group)
        lines += ["Time to an error:", ""] + _times(group, targets)
        ratios = _ratios(group, targets)
        if ratios:
            lines += ["How many times as long the other takes:", ""] + ratios
        lines += ["All points:", ""] + _points(group)
        if "equal" in group:
            lines += ["Steps in between, at about equal time:", ""] + _equal(group)
    return "\n".join(lines)
