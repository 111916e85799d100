"""The table of an experiment: what views.csv and summary.json of its runs come to, beside the paper.

P25 to P29 are the facts of the paper, see docs/paper.md.
"""

import csv
import json
import math
import pathlib
import statistics

LEVEL = 0.95  # of the area at the run's end: where the Occupied area has levelled off
GOOD_QUALITY = 0.9
EDGE_VIEWS = 10  # how many views the fitness "first" and "last" is the mean of
COVERAGES = (0.90, 0.95, 0.99)

# Name, unit and digits of every row, in the order of the table.
METRICS = (
    ("views", "", 1),
    ("level_view", "", 1),
    ("occupied_area", "m2", 1),
    ("mean_quality", "", 3),
    ("quality_90_view", "", 1),
    ("quality_90_ratio", "", 2),
    ("largest_quality_fall", "", 4),
    ("positions_tried", "", 1),
    ("most_positions_tried", "", 1),
    ("first_fitness", "", 3),
    ("last_fitness", "", 3),
    ("view_time", "s", 4),
    ("plan_time", "s", 4),
    ("map_memory", "MB", 2),
    ("planner_memory", "MB", 1),
    ("surface_coverage", "", 4),
    ("path", "m", 1),
    ("coverage_90_view", "", 1),
    ("coverage_90_path", "m", 1),
    ("coverage_95_view", "", 1),
    ("coverage_95_path", "m", 1),
    ("coverage_99_view", "", 1),
    ("coverage_99_path", "m", 1),
    ("coverage_curve_area", "", 4),
)

MEANINGS = {
    "views": "views taken",
    "level_view": f"view at which the Occupied area reaches {LEVEL:.0%} of its last value",
    "occupied_area": "Occupied area at the end",
    "mean_quality": "mean quality at the end",
    "quality_90_view": f"view at which, the area levelled off, the mean quality reaches {GOOD_QUALITY}",
    "quality_90_ratio": "that view over the view at which the area levels off with quality off",
    "largest_quality_fall": "largest fall of the mean quality after the area has levelled off",
    "positions_tried": 'positions tried a view, the paper\'s "iterations"',
    "most_positions_tried": "most positions tried for one view",
    "first_fitness": f"mean fitness of the first {EDGE_VIEWS} views chosen",
    "last_fitness": f"mean fitness of the last {EDGE_VIEWS} views",
    "view_time": "time a view takes, whole loop",
    "plan_time": "median time of a decision",
    "map_memory": "voxel map",
    "planner_memory": "planner's process, peak",
    "surface_coverage": "surface coverage at the end",
    "path": "path length",
    "coverage_curve_area": "area under the curve of coverage per view, 0 to 1",
}
for share in COVERAGES:
    percent = round(100 * share)
    MEANINGS[f"coverage_{percent}_view"] = f"views to {percent} % of surface coverage"
    MEANINGS[f"coverage_{percent}_path"] = f"path to {percent} % of surface coverage"

# What the paper says of its own rooms, by scene and quality; of its plots only the axes can be read.
_OF_BOTH = {
    "positions_tried": "0 to 70",
    "most_positions_tried": "at most 70",
    "first_fitness": "0 to 2",
    "last_fitness": "declines",
    "map_memory": "0.75",
}
_WITH_QUALITY = {
    "views": "300",
    "quality_90_ratio": "4",
    "largest_quality_fall": "0",
    "mean_quality": "above 0.9",
}
PAPER = {
    ("boxes", "off"): _OF_BOTH | {"views": "60", "level_view": "35", "occupied_area": "89"},
    ("columns", "off"): _OF_BOTH | {"views": "60", "level_view": "60", "occupied_area": "134"},
    ("boxes", "on"): _OF_BOTH
    | _WITH_QUALITY
    | {"level_view": "35", "occupied_area": "89", "view_time": "14.7"},
    ("columns", "on"): _OF_BOTH
    | _WITH_QUALITY
    | {"level_view": "60", "occupied_area": "134", "view_time": "16.4"},
}


class TableError(Exception):
    """A run whose artefacts cannot be read; says which file and why."""


def read_views(file):
    """The rows of a views.csv as numbers; None where a cell is blank or no number."""

    def number(text):
        try:
            return float(text)
        except (TypeError, ValueError):
            return None

    with open(file, newline="", encoding="utf-8") as lines:
        rows = [{name: number(cell) for name, cell in row.items()} for row in csv.DictReader(lines)]
    wanted = {"view", "fitness", "evaluations", "plan_s", "mean_quality", "occupied_area_m2",
              "surface_coverage", "path_length_m"}
    if not rows or not wanted <= rows[0].keys():
        raise TableError(f"{file}: is no views.csv of a run with at least one view")
    return rows


def first_view(rows, column, least):
    """The number of the first view whose column is at least that; None when none is."""
    for row in rows:
        if row[column] is not None and row[column] >= least:
            return row["view"]
    return None


def path_to(rows, view):
    """Metres driven up to and with a view; None without one."""
    if view is None:
        return None
    return sum(row["path_length_m"] for row in rows if row["view"] <= view)


def level_view(rows):
    return first_view(rows, "occupied_area_m2", LEVEL * rows[-1]["occupied_area_m2"])


def _mean_of_known(values):
    known = [value for value in values if value is not None]
    return statistics.fmean(known) if known else None


def _largest_fall(values):
    return max((before - after for before, after in zip(values, values[1:]) if after < before),
               default=0.0)


def _curve_area(rows, budget):
    """The mean coverage over all views of the budget, the last one counting on to its end."""
    if any(row["surface_coverage"] is None for row in rows):
        return None
    coverage = [row["surface_coverage"] for row in rows][:budget]
    return (sum(coverage) + (budget - len(coverage)) * coverage[-1]) / budget


def metrics_of(rows, summary, budget):
    """What one run comes to, by the names of METRICS; None where it cannot be told. The ratio, which
    takes two runs, is left to add_ratios.

    rows: as of read_views; summary: the run's summary.json; budget: how many views it could take.
    """
    last = rows[-1]
    chosen = rows[1:]
    recovered = [row for row in rows if row["view"] >= level_view(rows)]
    metrics = {
        "views": len(rows),
        "level_view": level_view(rows),
        "occupied_area": last["occupied_area_m2"],
        "mean_quality": last["mean_quality"],
        "quality_90_view": first_view(recovered, "mean_quality", GOOD_QUALITY),
        "largest_quality_fall": _largest_fall([row["mean_quality"] for row in recovered]),
        "positions_tried": _mean_of_known(row["evaluations"] for row in chosen),
        "most_positions_tried": max((row["evaluations"] or 0 for row in chosen), default=None),
        "first_fitness": _mean_of_known(row["fitness"] for row in chosen[:EDGE_VIEWS]),
        "last_fitness": _mean_of_known(row["fitness"] for row in chosen[-EDGE_VIEWS:]),
        "view_time": summary["first_goal_to_last_commit_s"] / len(rows),
        "plan_time": summary["plan_s_median"],
        "map_memory": summary["map_memory_bytes"] / 1e6,
        "planner_memory": summary["peak_memory_bytes"]["planner"] / 1e6,
        "surface_coverage": last["surface_coverage"],
        "path": path_to(rows, last["view"]),
        "coverage_curve_area": _curve_area(rows, budget),
    }
    for share in COVERAGES:
        view = first_view(rows, "surface_coverage", share)
        metrics[f"coverage_{round(100 * share)}_view"] = view
        metrics[f"coverage_{round(100 * share)}_path"] = path_to(rows, view)
    return metrics


def read_run(folder):
    """The labels and metrics of one complete run of an experiment."""
    folder = pathlib.Path(folder)
    try:
        labels = json.loads((folder / "experiment.json").read_text(encoding="utf-8"))
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        metrics = metrics_of(read_views(folder / "views.csv"), summary, labels["views"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise TableError(f"{folder}: not a complete run of an experiment ({error}); remove it and "
                         "run the experiment again") from error
    return labels, metrics


def runs_of(folder):
    """The complete runs of an experiment, by name, each with its labels and all its metrics."""
    runs = [read_run(file.parent) for file in sorted(pathlib.Path(folder).glob("*/experiment.json"))]
    add_ratios(runs)
    return runs


def add_ratios(runs):
    """P28: how many times as many views a good quality takes as any. Runs of the same seed are
    compared."""
    recovered = {}
    for labels, metrics in runs:
        if labels["quality"] == "off":
            key = (labels["scene"], labels["strategy"], labels["sensor"], labels["seed"])
            recovered[key] = metrics["level_view"]
    for labels, metrics in runs:
        key = (labels["scene"], labels["strategy"], labels["sensor"], labels["seed"])
        good = metrics["quality_90_view"]
        metrics["quality_90_ratio"] = (
            good / recovered[key] if labels["quality"] == "on" and good and key in recovered else None)


def table_of(runs):
    """One entry for each metric of each group of runs that differ in their seed only."""
    groups = {}
    for labels, metrics in runs:
        key = (labels["scene"], labels["sensor"], labels["quality"], labels["strategy"])
        groups.setdefault(key, []).append(metrics)
    table = []
    for (scene, sensor, quality, strategy), group in sorted(groups.items()):
        for metric, unit, digits in METRICS:
            values = [metrics[metric] for metrics in group if metrics[metric] is not None]
            table.append({
                "scene": scene, "sensor": sensor, "quality": quality, "strategy": strategy,
                "metric": metric, "unit": unit, "digits": digits,
                "paper": PAPER.get((scene, quality), {}).get(metric, "") if sensor == "default" else "",
                "mean": statistics.fmean(values) if values else None,
                "deviation": statistics.stdev(values) if len(values) > 1 else None,
                "least": min(values, default=None), "most": max(values, default=None),
                "known": len(values), "runs": len(group),
            })
    return table


CSV_COLUMNS = ("scene", "sensor", "quality", "strategy", "metric", "unit", "paper", "mean",
               "deviation", "least", "most", "known", "runs")


def write_csv(table, out):
    writer = csv.DictWriter(out, CSV_COLUMNS, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    for entry in table:
        writer.writerow({name: f"{value:.9g}" if isinstance(value, float) else value
                         for name, value in entry.items()})


def _cell(entry):
    """Mean +- standard deviation; of how many runs, where not of all."""
    if entry["mean"] is None:
        return "–"
    digits = entry["digits"]
    text = f"{entry['mean']:.{digits}f}"
    if entry["deviation"] is not None:
        text += f" ± {entry['deviation']:.{digits}f}"
    if entry["known"] < entry["runs"]:
        text += f" ({entry['known']} of {entry['runs']})"
    return text


def write_readable(table, out):
    """In Markdown whose columns stand below each other: a block for each scene, sensor and quality,
    in it a column for each strategy beside the paper's."""
    blocks = {}
    for entry in table:
        key = (entry["scene"], entry["sensor"], entry["quality"])
        blocks.setdefault(key, {}).setdefault(entry["strategy"], {})[entry["metric"]] = entry
    for (scene, sensor, quality), strategies in blocks.items():
        heading = ["", "the paper"]
        for name, entries in strategies.items():
            runs = entries["views"]["runs"]
            heading.append(f"strategy {name}, {runs} seed" + ("" if runs == 1 else "s"))
        lines = [heading]
        for metric, unit, _ in METRICS:
            entries = [strategy[metric] for strategy in strategies.values()]
            if all(entry["mean"] is None for entry in entries) and not entries[0]["paper"]:
                continue
            lines.append([MEANINGS[metric] + (f", {unit}" if unit else ""), entries[0]["paper"]]
                         + [_cell(entry) for entry in entries])
        widths = [max(len(line[i]) for line in lines) for i in range(len(heading))]
        lines.insert(1, ["-" * width for width in widths])
        with_sensor = "" if sensor == "default" else f", sensor {sensor}"
        out.write(f"**{scene}, quality {quality}{with_sensor}**\n\n")
        for line in lines:
            out.write("| " + " | ".join(text.ljust(width) for text, width in zip(line, widths)) + " |\n")
        out.write("\n")


def write_runs(runs, out):
    """A row for each run."""
    names = [metric for metric, _, _ in METRICS]
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["scene", "sensor", "quality", "strategy", "seed"] + names)
    for labels, metrics in runs:
        cells = [metrics[name] for name in names]
        writer.writerow([labels[name] for name in ("scene", "sensor", "quality", "strategy", "seed")]
                        + [f"{cell:.9g}" if isinstance(cell, float) and math.isfinite(cell) else cell
                           for cell in cells])
