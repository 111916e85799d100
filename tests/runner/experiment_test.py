"""What ./experiment makes of its command line, and that it goes on where it was interrupted: with a
program in place of nextview_run that leaves a run of two views at once and keeps count."""

import contextlib
import io
import json
import os
import pathlib
import signal
import stat
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "runner"))
import experiment  # noqa: E402

FAKE_RUN = """#!/bin/bash
here=$(cd "$(dirname "$0")" && pwd)
echo "$*" >> "$here/calls"
case "$*" in *"$(cat "$here/fails")"*) echo "nextview_run: it broke"; exit ${STATUS-6};; esac
case "$*" in *"$(cat "$here/hangs")"*) exec sleep 600;; esac
while [ $# -gt 0 ]; do [ "$1" = --out ] && out=$2; shift; done
mkdir "$out" || exit 1
cat > "$out/views.csv" <<X
view,fitness,evaluations,plan_s,mean_quality,occupied_area_m2,surface_coverage,path_length_m
1,,,,0.7,10,0.5,0
2,1,9,0.1,0.95,20,1,3
X
echo '{"first_goal_to_last_commit_s":1,"plan_s_median":1,"map_memory_bytes":1,"peak_memory_bytes":{"planner":1}}' > "$out/summary.json"
echo "room, seed 1: 2 views, view_limit. Done."
"""

# In place of ssh: logs in on a "host" that is this machine. The first word that is no option is its name.
FAKE_SSH = """#!/bin/bash
while [ "${1#-}" != "$1" ]; do shift; done
shift
[ "$1" = -- ] && shift
export SHELL=/bin/bash  # as sshd has it; what GNU parallel sends there starts it
exec bash -c "$*"
"""


def planned(*arguments):
    options, _ = experiment.parse(list(arguments))
    return experiment.planned_runs(options)


class CommandLine(unittest.TestCase):
    def test_the_four_experiments_of_the_paper(self):
        runs = planned("--seeds", "1")
        self.assertEqual([(name, " ".join(labels["options"])) for name, labels in runs], [
            ("boxes-paper-default-off-seed1", "boxes --strategy paper --views 60 --seed 1"),
            ("boxes-paper-default-on-seed1", "boxes --strategy paper --quality --views 300 --seed 1"),
            ("columns-paper-default-off-seed1", "columns --strategy paper --views 60 --seed 1"),
            ("columns-paper-default-on-seed1", "columns --strategy paper --quality --views 300 --seed 1"),
        ])

    def test_lists_of_names_and_options(self):
        runs = planned("--scenes", "boxes", "flat=my flats/flat.dae --start 1 2 1.2".replace("my flats", "'my flats'"),
                       "--strategies", "surface", "mine=--planner ./mine", "--sensors", "default", "wide=--aperture 80",
                       "panorama", "--quality", "off", "--seeds", "3-4", "--views", "7", "9",
                       "--run-options", "--range-noise-m 0.01")
        self.assertEqual(len(runs), 2 * 2 * 3 * 1 * 2)
        options = dict((name, labels["options"]) for name, labels in runs)
        self.assertEqual(options["flat-mine-wide-off-seed4"],
                         ["my flats/flat.dae", "--start", "1", "2", "1.2", "--planner", "./mine",
                          "--aperture", "80", "--range-noise-m", "0.01", "--views", "7", "--seed", "4"])
        self.assertEqual(options["boxes-surface-panorama-off-seed3"],
                         ["boxes", "--strategy", "surface", "--sensor", "panorama", "--range-noise-m", "0.01",
                          "--views", "7", "--seed", "3"])

    def test_what_is_behind_two_dashes_goes_to_parallel(self):
        _, for_parallel = experiment.parse(["--seeds", "2", "--", "-j", "3", "--sshlogin", "anna"])
        self.assertEqual(for_parallel, ["-j", "3", "--sshlogin", "anna"])

    def test_wrong_lines_say_what_is_wrong(self):
        for arguments, words in (
                (["--scenes", "a/b.dae"], "--scenes: 'a/b.dae' does not begin with a name"),
                (["--scenes", "boxes", "boxes"], "--scenes: boxes is there twice"),
                (["--strategies", "=x"], "--strategies: '=x' does not begin with a name"),
                (["--strategies", "x='"], "No closing quotation"),
                (["--run-options", "'"], "--run-options: No closing quotation"),
                (["--seeds", "0"], "--seeds: '0'"),
                (["--seeds", "5-3"], "--seeds: '5-3'"),
                (["--seeds", "some"], "neither a number of seeds nor a range"),
                (["--views", "0", "5"], "--views: a run takes at least one view")):
            with self.assertRaises(experiment.UsageError, msg=arguments) as raised:
                planned(*arguments)
            self.assertIn(words, str(raised.exception))
        for arguments in (["--seed", "3"], ["--quality", "maybe"], ["--views", "5"], ["boxes"]):
            with self.assertRaises(SystemExit, msg=arguments) as raised, \
                    contextlib.redirect_stderr(io.StringIO()):
                planned(*arguments)
            self.assertEqual(raised.exception.code, 2)


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        (self.path / "programs").mkdir()
        self.program("programs/nextview_run", FAKE_RUN)
        self.fail_at("nothing")
        self.hang_at("nothing")

    def program(self, name, text):
        file = self.path / name
        file.write_text(text, encoding="utf-8")
        file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return file

    def fail_at(self, words):
        """Runs whose options hold these words fail."""
        (self.path / "programs" / "fails").write_text(words, encoding="utf-8")

    def hang_at(self, words):
        """Runs whose options hold these words go on and on."""
        (self.path / "programs" / "hangs").write_text(words, encoding="utf-8")

    def calls(self):
        file = self.path / "programs" / "calls"
        if not file.exists():
            return []
        calls = file.read_text(encoding="utf-8").splitlines()
        file.unlink()
        return sorted(calls)

    def command(self, *arguments):
        own, _, for_parallel = " ".join(arguments).partition(" -- ")
        return [sys.executable, "-B", str(ROOT / "runner" / "experiment.py"), "--out", str(self.path / "out"),
                "--programs", str(self.path / "programs"), *own.split(), "--", *for_parallel.split()]

    def experiment(self, *arguments, **environment):
        return subprocess.run(self.command(*arguments), capture_output=True, text=True, check=False,
                              env=os.environ | environment)

    def test_what_is_there_is_not_run_again_and_more_is_added(self):
        said = self.experiment("--scenes room --seeds 2")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertEqual(len(self.calls()), 4)
        self.assertIn("4 runs, of which 0 are there already", said.stdout)
        self.assertIn("4/4, 0 s left: room-paper-default-", said.stdout)
        self.assertIn(": 2 views, view_limit", said.stdout)
        table = (self.path / "out" / "table.md").read_text(encoding="utf-8")
        self.assertIn("**room, quality on**", table)
        self.assertIn(table, said.stdout)
        self.assertIn("quality_90_view,,,2,0,2,2,2,2", (self.path / "out" / "table.csv").read_text())
        self.assertEqual(len((self.path / "out" / "runs.csv").read_text().splitlines()), 5)

        again = self.experiment("--scenes room --seeds 2")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(self.calls(), [])
        self.assertIn("4 runs, of which 4 are there already", again.stdout)

        more = self.experiment("--scenes room --seeds 3 --strategies paper surface --quality off")
        self.assertEqual(more.returncode, 0, more.stderr)
        self.assertEqual(len(self.calls()), 4, "seed 3 of paper and three of surface")
        self.assertIn("| strategy paper, 3 seeds | strategy surface, 3 seeds |", more.stdout)

    def test_a_run_that_failed_is_tried_again(self):
        self.fail_at("--seed 2")
        said = self.experiment("--scenes room --seeds 3 --quality off")
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn("room-paper-default-off-seed2 failed with status 6: nextview_run: it broke", said.stdout)
        self.assertIn("1 of 3 runs failed; the same command tries them again", said.stderr)
        self.assertIn("paper, 2 seeds", said.stdout, "the others are in the table")
        self.calls()
        self.fail_at("nothing")
        said = self.experiment("--scenes room --seeds 3 --quality off")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(len(self.calls()), 1)
        self.assertIn("paper, 3 seeds", said.stdout)

    def test_goes_on_where_it_was_interrupted(self):
        self.hang_at("--seed 3")
        running = subprocess.Popen(self.command("--scenes room --seeds 4 --quality off -- -j 1"),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = ""
        while not line.startswith("2/4"):
            line = running.stdout.readline()
            self.assertNotEqual(line, "", "it ended by itself")
        running.send_signal(signal.SIGINT)
        _, errors = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 130)
        self.assertIn("interrupted; the same command goes on from here", errors)
        self.calls()
        self.hang_at("nothing")
        said = self.experiment("--scenes room --seeds 4 --quality off")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertIn("4 runs, of which 2 are there already", said.stdout)
        self.assertEqual(["--seed 3" in call or "--seed 4" in call for call in self.calls()], [True, True])

    def test_what_an_interrupted_run_has_left_is_no_run(self):
        for name in ("room-paper-default-off-seed1.part", "room-paper-default-off-seed1"):
            (self.path / "out" / name).mkdir(parents=True)
        said = self.experiment("--scenes room --seeds 1 --quality off")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertEqual(len(self.calls()), 1)
        self.assertEqual([file.name for file in (self.path / "out").iterdir() if file.is_dir()],
                         ["room-paper-default-off-seed1"])

    def test_other_options_under_an_old_name_are_refused(self):
        self.assertEqual(self.experiment("--scenes room --seeds 1").returncode, 0)
        self.calls()
        said = self.experiment("--scenes room --seeds 1 --run-options=--range-noise-m=0.1")
        self.assertEqual(said.returncode, 2)
        self.assertIn("was run with other options", said.stderr)
        self.assertEqual(self.calls(), [])

    def test_a_dry_run_runs_nothing(self):
        said = self.experiment("--scenes room --seeds 1 --dry-run")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(said.stdout.splitlines()[0],
                         "room-paper-default-off-seed1: room --strategy paper --views 60 --seed 1")
        self.assertFalse((self.path / "out").exists())

    def test_a_program_that_is_not_there_is_named(self):
        (self.path / "programs" / "nextview_run").unlink()
        said = self.experiment("--seeds 1")
        self.assertEqual(said.returncode, 2)
        self.assertIn("no nextview_run is in", said.stderr)

    def test_another_parallel_is_refused(self):
        self.program("parallel", "#!/bin/sh\necho not the one\n")
        said = self.experiment("--seeds 1", PATH=f"{self.path}:{os.environ['PATH']}")
        self.assertEqual(said.returncode, 2)
        self.assertIn("is not GNU parallel", said.stderr)

    def test_other_hosts_are_set_up_once_and_send_their_runs_home(self):
        # The host has a folder of its own. Here the results go to the same place below our root, which
        # must be in it to have one.
        ssh = self.program("ssh", FAKE_SSH)
        host = self.path / "host"
        (host / "runner").mkdir(parents=True)
        (host / "runner" / "experiment_run").symlink_to(ROOT / "runner" / "experiment_run")
        self.program("host/run", f"#!/bin/sh\necho set up >> {self.path}/set-up\n")
        (ROOT / "build").mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=ROOT / "build") as out:
            said = self.experiment("--scenes room --seeds 2 --quality off --out", out,
                                   f"-- --ssh {ssh} --sshlogin 2/host --workdir {host}")
            self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
            self.assertEqual((self.path / "set-up").read_text(), "set up\n", "once for all runs")
            self.assertEqual(len(self.calls()), 2)
            self.assertIn("paper, 2 seeds", said.stdout)
            there = pathlib.Path("build", pathlib.Path(out).name, "room-paper-default-off-seed2", "views.csv")
            self.assertTrue((host / there).exists(), "it was run there")
            self.assertTrue((ROOT / there).exists(), "and has come home")


if __name__ == "__main__":
    unittest.main()
