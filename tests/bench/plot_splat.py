#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the scaling of bench_splat from its JSON: plot_splat.py splat.json splat.png"""
import json
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

PEERS = {"pcl_range_image_planar": "PCL RangeImagePlanar (depth alone)",
         "vtk_points": "VTK points", "vtk_point_gaussian": "VTK Gaussian splats"}


def cases(path):
    """Yields (name, points, size, radius, milliseconds); with repetitions, the medians."""
    for run in json.load(open(path))["benchmarks"]:
        if run.get("error_occurred") or run.get("aggregate_name", "median") != "median":
            continue
        if run["run_type"] == "iteration" and run.get("repetitions", 1) > 1:
            continue
        name, *arguments = run["run_name"].split("/")
        values = dict(word.split(":") for word in arguments if ":" in word)
        yield (name, int(values["points"]), int(values["size"]), int(values["radius"]),
               run["real_time"])


def draw(rows, path):
    ours = [row for row in rows if row[0] == "splat"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5))
    for size in sorted({row[2] for row in ours}):
        line = sorted((points, ms) for _, points, s, radius, ms in ours
                      if s == size and radius == 4)
        left.plot(*zip(*line), "o-", label=f"splat, {size} x {size}")
    for marker, (name, title) in zip("^sv", PEERS.items()):
        peer = [row for row in rows if row[0] == name]
        left.plot([row[1] for row in peer], [row[4] for row in peer], marker, color="0.4", ms=8,
                  label=title)
        for row in peer:
            left.annotate(f"{row[2]} x {row[2]}", (row[1], row[4]), fontsize=7, xytext=(7, -2),
                          textcoords="offset points")
    left.set(xscale="log", yscale="log", xlabel="points", ylabel="milliseconds", title="radius 4")
    for points, size in sorted({row[1:3] for row in ours if row[3] != 4}):  # the radii's cases
        line = sorted((row[3], row[4]) for row in ours if row[1:3] == (points, size))
        right.plot(*zip(*line), "o-", label=f"{points:,} points, {size} x {size}")
    right.set(xlabel="radius, pixels", ylabel="milliseconds", yscale="log")
    for axis in (left, right):
        axis.grid(alpha=0.3, which="both")
        axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    draw(list(cases(sys.argv[1])), sys.argv[2])
