# SPDX-License-Identifier: BSD-3-Clause
"""Runs each way of fusing an RGB-D folder as a child process, and measures it from outside."""
import dataclasses
import json
import math
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
TOLERANCE = 0.02  # of the number of points
PEERS = ["open3d_tsdf", "open3d_voxel", "pcl_voxel", "pcl_uniform"]


class Failed(Exception):
    """A program did not do what it was asked; the message says what it said."""


@dataclasses.dataclass(frozen=True)
class Programs:
    """Where the programs and the data are."""

    build: pathlib.Path
    walk: pathlib.Path

    def fuse_command(self, method, setting, hold_out, cloud):
        """The command that fuses; `setting` is our options as text, or a peer's leaf in metres."""
        held = ["--hold-out", str(hold_out)]
        if method == "ours":
            return [self.build / "apps/pixelsynth", "fuse", self.walk, "-o", cloud, *held,
                    *setting.split()]
        library, name = method.split("_")
        if library == "open3d":
            start = ["/usr/bin/python3", HERE / "open3d_fuse.py"]
        else:
            start = [self.build / "tests/bench/pcl_fuse"]
        return [*start, name, self.walk, cloud, "--leaf", str(setting), *held]

    def score(self, cloud, hold_out, radii):
        command = [self.build / "tests/bench/score_cloud", cloud, "--walk", self.walk,
                   "--hold-out", str(hold_out), "--radius", *radii]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode:
            raise Failed(done.stderr.strip())
        return json.loads(done.stdout)


def ply_points(path):
    """The number of vertices that a PLY's header promises."""
    with open(path, "rb") as file:
        for line in file:
            words = line.split()
            if words[:2] == [b"element", b"vertex"]:
                return int(words[2])
            if words == [b"end_header"]:
                break
    raise Failed(f"{path}: no vertices in the header")


def inner_seconds(method, cloud, output):
    """Seconds of reading and fusing as the program itself counted them, without writing."""
    if method == "ours":
        report = json.loads(cloud.with_suffix(".report.json").read_text())
        return report["seconds"]["total"]
    return json.loads(output.strip().splitlines()[-1])["seconds"]


def measured_fuse(programs, method, setting, hold_out, cloud):
    """Fuses once. Returns points, wall seconds of the whole process and its peak memory in MiB."""
    command = [str(word) for word in programs.fuse_command(method, setting, hold_out, cloud)]
    log = cloud.with_suffix(".log")
    with open(log, "w+") as output:
        start = time.perf_counter()
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                 stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        seconds = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read()
    if child.returncode:
        raise Failed(f"{method} at {setting}: {text.strip() or child.returncode}")
    row = {"method": method, "setting": setting, "hold_out": hold_out,
           "points": ply_points(cloud), "seconds": seconds,
           "inner_seconds": inner_seconds(method, cloud, text),
           "peak_mib": usage.ru_maxrss / 1024}
    print(f"  {method:13s} {str(setting):26s} {row['points']:9d} points {seconds:7.2f} s "
          f"{row['peak_mib']:6.0f} MiB", file=sys.stderr)
    return row


def next_leaf(known, target):
    """The leaf that a straight line through (log leaf, log points) gives for the target; surfaces
    have as many voxels as the leaf to the power of -2, which serves while one pair is known."""
    by_distance = sorted(known.items(), key=lambda pair: abs(math.log(pair[1] / target)))
    leaf, points = by_distance[0]
    slope = -2.0
    if len(by_distance) > 1:
        other_leaf, other_points = by_distance[1]
        if other_points != points:
            slope = math.log(other_points / points) / math.log(other_leaf / leaf)
            slope = min(max(slope, -4.0), -1.0)
    return round(leaf * math.exp(math.log(target / points) / slope), 7)


class LeafSearch:
    """Finds the leaf at which a peer gives a wished number of points; remembers what it has seen
    in a file. Numbers of points are all that is kept from one run to the next."""

    def __init__(self, path, programs, hold_out):
        self.path = path
        self.programs = programs
        self.hold_out = hold_out
        self.known = json.loads(path.read_text()) if path.exists() else {}

    def _entries(self, method):
        key = f"{method} {self.programs.walk} {self.hold_out}"
        return self.known.setdefault(key, {})

    def note(self, row):
        self._entries(row["method"])[str(row["setting"])] = row["points"]
        self.path.write_text(json.dumps(self.known, indent=1))

    def _guess(self, method, target):
        known = {float(leaf): points for leaf, points in self._entries(method).items()}
        if not known:
            return 0.01
        leaf = min(known, key=lambda leaf: abs(known[leaf] - target))
        near = abs(known[leaf] - target) <= TOLERANCE * target
        return leaf if near else next_leaf(known, target)

    def find(self, method, target, cloud, tries=8):
        """Fuses into `cloud`, until it has `target` points. Returns the measured row."""
        for _ in range(tries):
            leaf = self._guess(method, target)
            row = measured_fuse(self.programs, method, leaf, self.hold_out, cloud)
            self.note(row)
            if abs(row["points"] - target) <= TOLERANCE * target:
                return row
        raise Failed(f"{method}: no leaf gives {target} points")
