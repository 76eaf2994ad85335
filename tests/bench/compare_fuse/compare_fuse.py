#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares `pixelsynth fuse` with Open3D and PCL at the same number of points, in one run.

Every 10th frame (index % 10 == 5) is left out of every method; clouds are scored against the
left-out frames with one program, score_cloud. Our first setting fixes the number of points; each
peer's voxel size is searched for until it gives the same number within 2 %. Times are of whole
processes, from start to the cloud on disk.

Writes compare_fuse.csv, .json, .md and pictures into --output. See README.md.
"""
import argparse
import pathlib
import platform
import statistics
import sys
import tempfile

import methods
import report

ROOT = pathlib.Path(__file__).resolve().parents[3]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--walk", type=pathlib.Path, default=ROOT.parent / "shared/rgbd/walk",
                        help="RGB-D folder")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="folder")
    parser.add_argument("--hold-out", type=int, default=10)
    parser.add_argument("--radius", type=float, nargs="+", default=[2, 4],
                        help="pixels, of the splats that views are drawn with")
    parser.add_argument("--ours", nargs="+", metavar="OPTIONS",
                        default=["", "--spacing 0.0075", "--spacing 0.01", "--spacing 0.015",
                                 "--spacing 0.02", "--spacing 0.03"],
                        help="settings of ours, each one quoted; the first fixes the points; "
                             "'' = the default; write --ours=\"--spacing 0.01\" for one alone")
    parser.add_argument("--leaves", type=float, nargs="*",
                        default=[0.03, 0.02, 0.015, 0.01, 0.0075],
                        help="metres, of the peers, for the curves; none = the table alone")
    parser.add_argument("--repeats", type=int, default=3,
                        help="timed runs over all frames for each method; the median counts")
    parser.add_argument("--peers", nargs="*", choices=methods.PEERS, default=methods.PEERS)
    parser.add_argument("--scratch", type=pathlib.Path, help="folder for clouds; they are removed")
    return parser.parse_args()


class Comparison:
    def __init__(self, args, scratch):
        self.args = args
        self.cloud = scratch / "cloud.ply"
        self.programs = methods.Programs(args.build.resolve(), args.walk.resolve())
        self.search = methods.LeafSearch(args.output / "leaves.json", self.programs, args.hold_out)
        self.radii = [f"{radius:g}" for radius in args.radius]

    def scored(self, method, fuse):
        """Calls fuse(), which measures a row and leaves its cloud, and scores that; None (and a
        message) when it cannot be done."""
        try:
            row = fuse()
            row["score"] = self.programs.score(self.cloud, self.args.hold_out, self.radii)
            return row
        except methods.Failed as error:
            print(f"  left out: {method}: {error}", file=sys.stderr)
            return None

    def fused(self, method, setting):
        """A scored row at one setting, without the held-out frames."""
        return self.scored(method, lambda: methods.measured_fuse(
            self.programs, method, setting, self.args.hold_out, self.cloud))

    def matched(self):
        ours = self.fused("ours", self.args.ours[0])
        if ours is None:
            raise SystemExit(1)
        rows = [ours]
        for method in self.args.peers:
            rows.append(self.scored(method, lambda name=method: self.search.find(
                name, ours["points"], self.cloud)))
        return [row for row in rows if row]

    def time_all_frames(self, rows):
        """Turn by turn, so that a slow minute of the machine falls on all methods alike."""
        runs = [[] for _ in rows]
        for _ in range(self.args.repeats):
            for row, own in zip(rows, runs):
                try:
                    own.append(methods.measured_fuse(self.programs, row["method"], row["setting"],
                                                     0, self.cloud))
                except methods.Failed as error:
                    print(f"  left out: {row['method']}: {error}", file=sys.stderr)
        for row, own in zip(rows, runs):
            for name in ("points", "seconds", "inner_seconds", "peak_mib") if own else ():
                row[f"all_{name}"] = statistics.median(run[name] for run in own)

    def sweep(self):
        rows = [self.fused("ours", setting) for setting in self.args.ours[1:]]
        for leaf in self.args.leaves:
            rows += [self.fused(method, leaf) for method in self.args.peers]
        return [row for row in rows if row]


def machine():
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line]
    return f"{len(model)} x {model[0]}, {platform.platform()}"


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=args.scratch) as scratch:
        comparison = Comparison(args, pathlib.Path(scratch))
        print("at one number of points:", file=sys.stderr)
        matched = comparison.matched()
        print("all frames, timed:", file=sys.stderr)
        comparison.time_all_frames(matched)
        report.write_all(args.output, machine(), matched, [], args.radius)
        print("over resolutions:", file=sys.stderr)
        sweep = comparison.sweep()
        report.write_all(args.output, machine(), matched, sweep, args.radius)
    print((args.output / "compare_fuse.md").read_text())


if __name__ == "__main__":
    main()
