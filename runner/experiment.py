"""Runs experiments: every scene with every strategy, sensor, quality and seed, spread over cores and
hosts by GNU parallel, and writes the table of what they come to. ./experiment --help"""

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "reports"), str(ROOT / "lcmtypes")]
import experiment_table  # noqa: E402
from program_version import program_version  # noqa: E402

NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+]*")
HOSTS = ("-S", "--sshlogin", "--slf", "--sshloginfile")

DESCRIPTION = """\
Runs the paper's experiments: each room with quality off (60 views) and on (300 views) over several
seeds, and writes what they come to beside what the paper says. Scenes, strategies and sensors are
lists, so the same command compares planners. What is there already is not run again: a command that
was interrupted is given again, and one with more seeds or strategies adds to the table.
"""
EPILOGUE = """\
An entry of a list is a NAME that ./run knows, or NAME=OPTIONS, a name of yours and what ./run is given
for it; files are named as seen from the repository's root:
  ./experiment                                            the paper's four experiments, 5 seeds
  ./experiment --strategies paper surface --seeds 10      two planners side by side
  ./experiment --strategies surface 'mine=--planner ./my_planner'
  ./experiment --scenes boxes 'flat=flat.dae --start 1 2 1.2' --sensors default 'wide=--aperture 80'
  ./experiment --seeds 100 -- --sshlogin 8/anna,8/otto,:  on other hosts too, see README

Status: 0 all runs are there; 1 one of them failed, and the same command tries it again; 2 a command
line that cannot be right; 130 interrupted.
"""


class UsageError(Exception):
    """A command line that cannot be right; says what to do."""


def entry(text, option):
    """NAME or NAME=OPTIONS -> (name, options of ./run)."""
    name, equals, options = text.partition("=")
    if not NAME.fullmatch(name):
        raise UsageError(f"{option}: {text!r} does not begin with a name of letters, digits, _ . +; "
                         f"for a file or options write NAME=OPTIONS")
    try:
        return name, shlex.split(options) if equals else None
    except ValueError as error:
        raise UsageError(f"{option}: {text!r}: {error}") from error


def entries(texts, option, options_of_name):
    """Of a whole list; what a plain name stands for is said by options_of_name."""
    found = {}
    for text in texts:
        name, options = entry(text, option)
        if name in found:
            raise UsageError(f"{option}: {name} is there twice")
        found[name] = options_of_name(name) if options is None else options
    return found


def seeds(text):
    """"5" -> 1 to 5, "3-7" -> 3 to 7."""
    match = re.fullmatch(r"(?:(\d+)-)?(\d+)", text)
    first, last = (int(match[1] or 1), int(match[2])) if match else (1, 0)
    if not 0 <= first <= last:
        raise UsageError(f"--seeds: {text!r} is neither a number of seeds nor a range such as 3-7")
    return range(first, last + 1)


def parse(arguments):
    """The options, and what is behind -- for GNU parallel."""
    at = arguments.index("--") if "--" in arguments else len(arguments)
    parser = argparse.ArgumentParser(
        prog="./experiment", description=DESCRIPTION, epilog=EPILOGUE,
        usage="./experiment [OPTIONS] [-- OPTIONS OF GNU PARALLEL]",
        formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--scenes", nargs="+", default=["boxes", "columns"], metavar="SCENE",
                        help="default: boxes columns")
    parser.add_argument("--strategies", nargs="+", default=["paper"], metavar="STRATEGY",
                        help="default: paper")
    parser.add_argument("--sensors", nargs="+", default=["default"], metavar="SENSOR",
                        help="default: default, the one ./run has")
    parser.add_argument("--quality", nargs="+", choices=["off", "on"], default=["off", "on"],
                        help="default: off on")
    parser.add_argument("--seeds", default="5", metavar="N|A-B", help="default: 5, which is 1-5")
    parser.add_argument("--views", nargs=2, type=int, default=[60, 300], metavar=("OFF", "ON"),
                        help="most views with quality off and on; default: 60 300, the paper's")
    parser.add_argument("--run-options", default="", metavar="OPTIONS",
                        help="of ./run, for every run, such as '--range-noise-m 0.01'")
    parser.add_argument("--out", default=None, metavar="DIR",
                        help="where runs and table go; default: runs/experiment")
    parser.add_argument("--dry-run", action="store_true", help="only say which runs there would be")
    parser.add_argument("--programs", default="build/release/bin", metavar="DIR",
                        help="folder of nextview_run; default: build/release/bin")
    parser.add_argument("--version", action="version", version="%(prog)s " + program_version())
    options = parser.parse_args(arguments[:at])
    if min(options.views) < 1:
        raise UsageError("--views: a run takes at least one view")
    return options, arguments[at + 1:]


def folder_of(out):
    """Relative to the root where it lies in it, so that it means the same on every host."""
    folder = pathlib.Path(out).absolute() if out else ROOT / "runs" / "experiment"
    return folder.relative_to(ROOT) if folder.is_relative_to(ROOT) else folder


def planned_runs(options):
    """All runs of the experiment: (name, labels)."""
    lists = [
        entries(options.scenes, "--scenes", lambda name: [name]),
        entries(options.strategies, "--strategies", lambda name: ["--strategy", name]),
        entries(options.sensors, "--sensors",
                lambda name: [] if name == "default" else ["--sensor", name]),
    ]
    try:
        for_all = shlex.split(options.run_options)
    except ValueError as error:
        raise UsageError(f"--run-options: {error}") from error
    views = dict(zip(("off", "on"), options.views))
    runs = []
    for scene, of_scene in lists[0].items():
        for strategy, of_strategy in lists[1].items():
            for sensor, of_sensor in lists[2].items():
                for quality in dict.fromkeys(options.quality):
                    for seed in seeds(options.seeds):
                        given = (of_scene + of_strategy + of_sensor + for_all
                                 + (["--quality"] if quality == "on" else [])
                                 + ["--views", str(views[quality]), "--seed", str(seed)])
                        labels = {"scene": scene, "strategy": strategy, "sensor": sensor,
                                  "quality": quality, "seed": seed, "views": views[quality],
                                  "options": given}
                        name = f"{scene}-{strategy}-{sensor}-{quality}-seed{seed}"
                        runs.append((name, labels))
    return runs


def is_there(out, name, labels):
    """Whether a run is complete. One of the same name and other options is not ours to replace."""
    file = ROOT / out / name / "experiment.json"
    if not file.exists():
        return False
    try:
        had = json.loads(file.read_text(encoding="utf-8"))["options"]
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{file}: cannot be read ({error}): remove {file.parent}") from error
    if had != labels["options"]:
        raise UsageError(f"{file.parent} was run with other options ({shlex.join(had)}): name another "
                         "--out, or another NAME=")
    return True


def make_folder(out):
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"--out: {out} cannot be made: {error.strerror}: name another folder") from error


def check_parallel():
    """moreutils has another program of that name."""
    try:
        said = subprocess.run(["parallel", "--version"], capture_output=True, text=True, check=False)
    except OSError as error:
        raise UsageError(f"parallel cannot be started ({error}): type apt-get install parallel") from error
    if not said.stdout.startswith("GNU parallel"):
        raise UsageError("parallel in PATH is not GNU parallel: type apt-get install parallel")


def on_hosts(for_parallel):
    return any(option.startswith(host) for option in for_parallel for host in HOSTS)


def set_up_hosts(for_parallel):
    """Once on every host, before several runs there would do it at once."""
    if not on_hosts(for_parallel):
        return
    print("Setting up every host (./run --version in the same folder)", flush=True)
    said = subprocess.run(["parallel", "--will-cite", "--workdir", ".", *for_parallel, "--nonall",
                           "./run", "--version"], cwd=ROOT, check=False)
    if said.returncode != 0:
        raise UsageError("not every host could be set up: each needs nextview in the same folder below "
                         "the home directory, or the same --workdir")


def carry_out(out, programs, todo, for_parallel):
    """Lets GNU parallel do the runs, and says how far they are. -> how many are not done"""
    done = 0
    start = time.monotonic()
    with tempfile.NamedTemporaryFile("w", suffix=".tsv", encoding="utf-8") as jobs:
        for name, labels in todo:
            folder = str(out / name)
            command = ["runner/experiment_run", str(programs / "nextview_run"), folder,
                       json.dumps(labels, ensure_ascii=True), *labels["options"]]
            if any("\t" in word or "\n" in word for word in command):
                raise UsageError("options hold neither tabs nor line ends")
            jobs.write(f"{folder}\t{shlex.join(command)}\n")
        jobs.flush()
        home = ["--return", "{1}"] if on_hosts(for_parallel) else []
        parallel = subprocess.Popen(
            ["parallel", "--will-cite", "--line-buffer", "--workdir", ".", *home, *for_parallel,
             "--colsep", "\t", "-a", jobs.name, "bash", "-c", "{2}"],
            cwd=ROOT, stdout=subprocess.PIPE, text=True)
        try:
            for line in parallel.stdout:
                done += " failed with status " not in line
                left_s = (time.monotonic() - start) / max(done, 1) * (len(todo) - done)
                print(f"{done}/{len(todo)}, {left_s:.0f} s left: {line.rstrip()}", flush=True)
            parallel.wait()
        except KeyboardInterrupt:
            parallel.terminate()
            parallel.wait()
            raise
    return sum(not (ROOT / out / name / "experiment.json").exists() for name, _ in todo)


def write_table(out):
    """-> the readable one"""
    folder = ROOT / out
    runs = experiment_table.runs_of(folder)
    table = experiment_table.table_of(runs)
    for name, write, what in (("runs.csv", experiment_table.write_runs, runs),
                              ("table.csv", experiment_table.write_csv, table),
                              ("table.md", experiment_table.write_readable, table)):
        with open(folder / name, "w", encoding="utf-8") as file:
            write(what, file)
    return (folder / "table.md").read_text(encoding="utf-8")


def main(arguments):
    options, for_parallel = parse(arguments)
    out = folder_of(options.out)
    runs = planned_runs(options)
    todo = [(name, labels) for name, labels in runs if not is_there(out, name, labels)]
    if options.dry_run:
        for name, labels in todo:
            print(f"{name}: {shlex.join(labels['options'])}")
        return 0
    programs = pathlib.Path(options.programs)
    if not os.access(ROOT / programs / "nextview_run", os.X_OK):
        raise UsageError(f"--programs: no nextview_run is in {programs}: build it with ./run --version")
    print(f"{len(runs)} runs, of which {len(runs) - len(todo)} are there already", flush=True)
    missing = 0
    if todo:
        check_parallel()
        make_folder(ROOT / out)
        set_up_hosts(for_parallel)
        missing = carry_out(out, programs, todo, for_parallel)
    print("\n" + write_table(out) + "\n".join(
        str(out / name) for name in ("table.md", "table.csv", "runs.csv")))
    if missing:
        print(f"experiment: {missing} of {len(runs)} runs failed; the same command tries them again",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        print("\nexperiment: interrupted; the same command goes on from here", file=sys.stderr)
        sys.exit(130)
    except UsageError as error:
        print(f"experiment: {error}", file=sys.stderr)
        sys.exit(2)
    except (OSError, experiment_table.TableError) as error:
        print(f"experiment: {error}", file=sys.stderr)
        sys.exit(1)
