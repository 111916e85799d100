#!/usr/bin/env python3
"""Follows the voxel map of a running run by NEXTVIEW_MAP_BLOCKS (docs/map-blocks.md), and says view by view how many
voxels it has of each label, beside what the mapper says.

    follow_map.py LCM_URL RUN [--all]
"""

import argparse
import collections
import math
import sys
import time

from nextview_bus import Bus, nextview, program_version

OCCUPIED = 4
LABELS = ("unmarked", "occluded", "occlusion_plane", "empty", "occupied")
ASK_EVERY_S = 0.2


class FollowedMap:
    """The map put together from its blocks."""

    def __init__(self):
        self.view = 0        # it is whole as of this view
        self.blocks = {}     # index -> (view, 512 labels, qualities of its Occupied voxels)
        self.came = collections.defaultdict(set)  # (since, view) -> parts
        self.window_voxels = 0

    def take(self, message):
        self.window_voxels = math.prod(message.window_size)
        surface = 0
        for index, labels in zip(message.block_index, message.block_label):
            occupied = labels.count(OCCUPIED)
            qualities = message.surface_quality[surface:surface + occupied]
            surface += occupied
            # Whole blocks: the same again changes nothing, and of two the one of the later view stays.
            if index not in self.blocks or self.blocks[index][0] <= message.view:
                self.blocks[index] = message.view, labels, qualities
        came = self.came[message.since_view, message.view]
        came.add(message.part)
        if len(came) == message.parts and message.since_view <= self.view:
            self.view = max(self.view, message.view)

    def counts(self):
        """Voxels by label, and the mean quality of the Occupied ones."""
        counts = [sum(labels.count(label) for _, labels, _ in self.blocks.values())
                  for label in range(len(LABELS))]
        # Blocks reach beyond the window, and what has none is Unmarked.
        counts[0] = self.window_voxels - sum(counts[1:])
        quality = sum(sum(qualities) for _, _, qualities in self.blocks.values())
        return counts, quality / counts[OCCUPIED] if counts[OCCUPIED] else 0.0


class Follower:
    def __init__(self, bus, in_steps):
        self.bus = bus
        self.in_steps = in_steps
        self.map = FollowedMap()
        self.commits = {}
        self.stopped = False
        self.compared = self.different = 0
        bus.on(nextview.map_blocks_t, self.take)
        bus.on(nextview.commit_t, self.take_commit)
        bus.on(nextview.stop_t, lambda stop: setattr(self, "stopped", True))

    def ask(self):
        self.bus.request(nextview.map_blocks_t, self.map.view if self.in_steps else 0)

    def take_commit(self, commit):
        self.commits[commit.view] = commit
        self.ask()

    def take(self, message):
        before = self.map.view
        self.map.take(message)
        if self.map.view > before:
            self.compare()
            if not self.in_steps:
                self.map.blocks.clear()

    def compare(self):
        commit = self.commits.get(self.map.view)
        if commit is None:
            return
        counts, quality = self.map.counts()
        of_mapper = [getattr(commit, label + "_voxels") for label in LABELS]
        same = counts == of_mapper and abs(quality - commit.mean_quality) < 1e-6
        self.compared += 1
        self.different += not same
        print(f"view {self.map.view}:", *(f"{label} {count}" for label, count in zip(LABELS, counts)),
              f"quality {quality:.3f}", "as the mapper says" if same else f"but the mapper says {of_mapper}",
              flush=True)

    def run(self):
        """Until the run ends."""
        asked = time.monotonic()
        while not self.stopped:
            self.bus.handle(ASK_EVERY_S)
            if time.monotonic() - asked > ASK_EVERY_S and self.map.view < max(self.commits, default=1):
                self.ask()
                asked = time.monotonic()
        print(f"{self.compared} views compared, {self.different} different")
        return 0 if self.compared and not self.different else 1


def main():
    parser = argparse.ArgumentParser(prog="follow_map.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lcm_url", metavar="LCM_URL")
    parser.add_argument("run", metavar="RUN", type=int)
    parser.add_argument("--all", action="store_true", help="ask for the whole map each time, not for what has changed")
    parser.add_argument("--version", action="version", version="%(prog)s " + program_version())
    options = parser.parse_args()
    sys.exit(Follower(Bus(options.lcm_url, options.run, "follower"), not options.all).run())


if __name__ == "__main__":
    main()
