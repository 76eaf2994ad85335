#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what bench_nn and bench_outpaint measured:
plot_nn.py nn.json nn.png  or  plot_nn.py outpaint.json outpaint.png"""
import json
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKERS = {"f32 direct": "o", "f32 Winograd": "*", "bf16 direct": "s", "bf16 Winograd": "D"}
SMALLEST = 1e-7  # an error of 0 is drawn here


def draw_networks(data, path):
    figure, axis = plt.subplots(figsize=(9, 5.5))
    names = list(dict.fromkeys(row["module"] for row in data["modules"]))
    for color, name in zip(plt.cm.tab10.colors, names):
        rows = [row for row in data["modules"] if row["module"] == name]
        axis.plot([row["ms"] for row in rows], [max(row["error"], SMALLEST) for row in rows], "-",
                  color=color, lw=0.7, label=name)
        for row in rows:
            axis.plot(row["ms"], max(row["error"], SMALLEST), MARKERS[row["variant"]], color=color,
                      ms=11 if row["variant"] == "f32 Winograd" else 6)
    for variant, marker in MARKERS.items():
        axis.plot([], [], marker, color="0.3", label=variant)
    axis.set(xscale="log", yscale="log", xlabel="milliseconds of one forward",
             ylabel="worst error over the largest value", title="against f32 direct")
    axis.axhline(1e-4, color="0.5", ls=":", lw=1)
    finish(figure, [axis], path)


def draw_sampler(data, path):
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.5))
    for axis, rows, key, title in (
            (axes[0], data["by_completions"], "completions", "450 missing cells"),
            (axes[1], data["by_cells"], "cells", "50 completions")):
        axis.plot([row[key] for row in rows], [row["seconds"] for row in rows], "o-", color="C3",
                  label="seconds")
        axis.set(xlabel="missing cells" if key == "cells" else key, ylabel="seconds", title=title)
        memory = axis.twinx()
        memory.plot([row[key] for row in rows], [row["mib"] for row in rows], "s--", color="C0",
                    label="MiB (right)")
        memory.set(ylabel="MiB", ylim=(0, None))
        axis.set(ylim=(0, None))
        axis.plot([], [], "s--", color="C0", label="MiB (right)")
    finish(figure, axes, path)


def finish(figure, axes, path):
    for axis in axes:
        axis.grid(alpha=0.3, which="both")
        axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    data = json.load(open(sys.argv[1]))
    (draw_networks if "modules" in data else draw_sampler)(data, sys.argv[2])


if __name__ == "__main__":
    main()
