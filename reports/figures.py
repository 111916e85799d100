"""Draws figures 6 to 9 of the paper from folders of runs, as PNG and SVG. ./figures --help

The drawing is gnuplot's, in the .gp files beside this one; what stands in a run's log is read by
nextview_search and nextview_picture.
"""

import argparse
import collections
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "reports"), str(ROOT / "lcmtypes")]
import experiment_table  # noqa: E402
from program_version import program_version  # noqa: E402

DESCRIPTION = """\
Draws the paper's figures 6, 7, 8 and 9 from runs, as PNG and SVG:
  figure-6-SCENE  the points of one range image, and the positions the search for the next view tried,
                  each with a line along its best direction as long as its fitness
  figure-7-SCENE  (figure-8-columns for that room) positions tried, fitness, mean quality and Occupied
                  area per view, quality off and on side by side; of several runs the mean and, shaded,
                  the least and the most
  figure-9-SCENE  the Occupied voxels after 15 views, with the sensor's path and poses
DIR is the folder of a run, or of an experiment with all its runs. Where several strategies or sensors are
among them, the figures bear their names too.
"""

# What a run is; folder: where it lies; strategy: with the sensor, where an experiment names one.
Run = collections.namedtuple("Run", "folder scene strategy quality seed search")

QUANTITIES = ("evaluations", "fitness", "mean_quality", "occupied_area_m2")


class FigureError(Exception):
    """What cannot be drawn, and why."""


def program(programs, name, *arguments):
    """What one of our programs says on stdout."""
    try:
        said = subprocess.run([str(programs / name), *map(str, arguments)], capture_output=True,
                              text=True, check=False)
    except OSError as error:
        raise FigureError(f"{error}: build nextview again") from error
    if said.returncode != 0:
        raise FigureError(said.stderr.strip() or f"{name} ended with status {said.returncode}")
    return said.stdout


def run_folders(folders):
    """The folders of runs among and in these."""
    found = []
    for folder in map(pathlib.Path, folders):
        inside = [file.parent for file in sorted(folder.glob("*/run.lcmlog"))
                  if not file.parent.name.endswith(".part")]
        if (folder / "run.lcmlog").exists():
            found.append(folder)
        elif inside:
            found.extend(inside)
        else:
            raise FigureError(f"{folder}: neither the folder of a run, with a run.lcmlog, nor of an "
                              "experiment")
    return found


def read_run(folder, programs, view):
    """view: which view's search; None: the largest of the first ones."""
    search = json.loads(program(programs, "nextview_search", folder,
                                *(["--view", view] if view else [])))
    scene, strategy = search["scene"], search["strategy"]
    file = folder / "experiment.json"
    if file.exists():  # a run of an experiment has names of its own for them
        labels = json.loads(file.read_text(encoding="utf-8"))
        scene, strategy = labels["scene"], labels["strategy"]
        if labels["sensor"] != "default":
            strategy += "-" + labels["sensor"]
    return Run(folder, scene, strategy, search["quality"], search["seed"], search)


def curve(runs, column):
    """Per view, over the runs that have taken it: (view, mean, least, most)."""
    values = collections.defaultdict(list)
    for rows in runs:
        for row in rows:
            if row[column] is not None:
                values[int(row["view"])].append(row[column])
    return [(view, statistics.fmean(of), min(of), max(of)) for view, of in sorted(values.items())]


def gnuplot(script, variables, out):
    """Runs a script twice, for OUT.png and OUT.svg; heights and widths in pixels."""
    width, height = variables.pop("size")
    terminals = {
        "png": f"set terminal pngcairo size {width},{height} font 'Sans,10' background rgb 'white'",
        "svg": f"set terminal svg size {width},{height} font 'Sans,10' background rgb 'white'",
    }
    for kind, terminal in terminals.items():
        file = f"{out}.{kind}"
        settings = dict(variables, terminal_options=terminal, out=file)
        lines = "".join(f"{name} = {json.dumps(value, ensure_ascii=False)}\n"
                        for name, value in settings.items())
        said = subprocess.run(["gnuplot", "-"], text=True, capture_output=True, check=False,
                              errors="surrogateescape",  # file names need not be UTF-8
                              input=f"{lines}load {json.dumps(str(ROOT / 'reports' / script))}\n")
        if said.returncode != 0 or not os.path.exists(file) or os.path.getsize(file) == 0:
            raise FigureError(f"gnuplot could not draw {file}: {said.stderr.strip()}")
        print(file)


def write_rows(file, rows):
    file.write_text("".join(" ".join(f"{value:.7g}" for value in row) + "\n" for row in rows),
                    encoding="utf-8")
    return str(file)


def edges(least, most):
    """The edges of a box, as gnuplot draws lines: points, blank lines between."""
    corners = [(least, most)[bit] for bit in (0, 1)]
    lines = []
    for axis in range(3):
        for rest in range(4):
            ends = []
            for end in (0, 1):
                bits = [rest & 1, rest >> 1]
                bits.insert(axis, end)
                ends.append(" ".join(f"{corners[bit][i]:.7g}" for i, bit in enumerate(bits)))
            lines.append("\n".join(ends) + "\n")
    return "\n\n".join(lines)


def draw_search(run, out, scratch):
    search = run.search
    tried = [trial for trial in search["tried"]
             if trial["fitness"] is not None and trial["fitness"] >= 0.0]
    if not tried:
        raise FigureError(f"{run.folder}: no position that was tried for view {search['view']} was "
                          "feasible: name another --view")
    # The longest line is a sixth of the longest side of the room, whatever a strategy's values are.
    sides = [b - a for a, b in zip(search["workspace_min_m"], search["workspace_max_m"])]
    length = max(sides) / 6 / max(trial["fitness"] for trial in tried + [{"fitness": 1e-9}])

    def row(trial):
        return trial["position_m"] + [length * trial["fitness"] * d for d in trial["direction"]]

    best = max(tried, key=lambda trial: trial["fitness"])
    box = scratch / "box"
    box.write_text(edges(search["workspace_min_m"], search["workspace_max_m"]), encoding="utf-8")
    gnuplot("figure_search.gp", {
        "size": (1300, 620),
        "points": write_rows(scratch / "points", search["points_m"]),
        "lines": write_rows(scratch / "lines", map(row, tried)),
        "best_file": write_rows(scratch / "best", [row(best)]),
        "from_file": write_rows(scratch / "from", [search["from_m"]]),
        "box": str(box),
        "heading": f"{run.scene}, strategy {run.strategy}, seed {run.seed}: the search for view "
                   f"{search['view']}, {len(tried)} feasible positions of "
                   f"{len(search['tried'])}, best fitness {best['fitness']:.2f}",
    }, out)


def draw_curves(scene, runs, out, scratch):
    heading = f"Recovery of {scene}, strategy {runs[0].strategy}"
    if len({run.seed for run in runs}) > 1:
        heading += ": mean over the seeds; shaded, the least to the most"
    variables = {"size": (1200, 1150), "heading": heading}
    area = positions = 0.0
    for quality in ("off", "on"):
        of = [run for run in runs if run.quality == (quality == "on")]
        rows = [experiment_table.read_views(run.folder / "views.csv") for run in of]
        views = max((len(of_run) for of_run in rows), default=0)
        file = scratch / f"curves-{quality}"
        curves = [curve(rows, column) for column in QUANTITIES]
        file.write_text("\n\n".join(
            "".join(" ".join(f"{value:.7g}" for value in point) + "\n" for point in points) or "NaN\n"
            for points in curves), encoding="utf-8")
        area = max([area] + [most for _, _, _, most in curves[3]])
        positions = max([positions] + [most for _, _, _, most in curves[0]])
        seeds = f"{len(of)} seeds" if len(of) > 1 else "1 seed"
        variables |= {f"data_{quality}": str(file) if of else "", f"views_{quality}": views,
                      f"label_{quality}": f"quality {quality}, {seeds}"}
    # The paper's axes end at 140 m2 and 70 positions.
    variables["area_most"] = max(140.0, 20.0 * -(-area // 20.0))
    variables["positions_most"] = max(70.0, 20.0 * -(-positions // 20.0))
    if not (variables["data_off"] and variables["data_on"]):
        variables["size"] = (640, 1150)
    gnuplot("figure_curves.gp", variables, out)


def draw_recovered(scene, runs, views, programs, out, scratch):
    """The first run with quality off and the first with it on."""
    first = {}
    for run in runs:
        first.setdefault(run.quality, run)
    pictures = []
    names = []
    for quality in sorted(first):
        run = first[quality]
        picture = scratch / f"recovered-{quality}.png"
        program(programs, "nextview_picture", run.folder, picture, "--views", views, "--occupied-only",
                "--width", 1000, "--height", 760)
        pictures.append(str(picture))
        names.append(f"\"quality {'on' if quality else 'off'}, seed {run.seed}\"")
    gnuplot("figure_recovered.gp", {
        "size": (700 * len(pictures), 600),
        "pictures": " ".join(pictures), "names": " ".join(names), "count": len(pictures),
        "columns": len(pictures), "rows": 1,
        "heading": f"{scene} after {views} views, strategy {runs[0].strategy}: Occupied voxels, path and poses",
    }, out)


def main(arguments):
    parser = argparse.ArgumentParser(prog="./figures", description=DESCRIPTION, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR")
    parser.add_argument("--out", metavar="DIR", help="where the figures go; default: the first DIR")
    parser.add_argument("--view", type=int, metavar="N",
                        help="whose search figure 6 shows, from 2; default: of the first 15 the one that "
                             "tried most positions")
    parser.add_argument("--recovered-views", type=int, default=15, metavar="N",
                        help="after how many views figure 9 is; default: 15, the paper's")
    parser.add_argument("--programs", default=str(ROOT / "build" / "release" / "bin"), metavar="DIR",
                        help="folder of nextview_search and nextview_picture")
    parser.add_argument("--version", action="version", version="%(prog)s " + program_version())
    options = parser.parse_args(arguments)
    if options.recovered_views < 1:
        parser.error("--recovered-views: at least 1")
    if options.view is not None and options.view < 2:
        parser.error("--view: view 1 is the scan at the start, for which nothing was searched")
    programs = pathlib.Path(options.programs)
    out = pathlib.Path(options.out or options.folders[0])
    runs = [read_run(folder, programs, options.view) for folder in run_folders(options.folders)]
    out.mkdir(parents=True, exist_ok=True)
    several = len({run.strategy for run in runs}) > 1
    groups = collections.defaultdict(list)
    for run in sorted(runs, key=lambda run: run.seed):
        groups[run.scene, run.strategy].append(run)
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        for (scene, strategy), of in sorted(groups.items()):
            name = re.sub(r"[^A-Za-z0-9_.+-]", "_", scene + ("-" + strategy if several else ""))
            draw_search(of[0], out / f"figure-6-{name}", scratch)
            draw_curves(scene, of, out / f"figure-{8 if scene == 'columns' else 7}-{name}", scratch)
            draw_recovered(scene, of, options.recovered_views, programs, out / f"figure-9-{name}",
                           scratch)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (FigureError, experiment_table.TableError, OSError) as error:
        print(f"figures: {error}", file=sys.stderr)
        sys.exit(1)
