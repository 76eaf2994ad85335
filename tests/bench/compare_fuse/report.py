# SPDX-License-Identifier: BSD-3-Clause
"""Writes the rows of compare_fuse.py as CSV, JSON, Markdown and a picture."""
import csv
import json

NAMES = {"ours": "pixelsynth fuse", "open3d_tsdf": "Open3D TSDF",
         "open3d_voxel": "Open3D voxel_down_sample", "pcl_voxel": "PCL VoxelGrid",
         "pcl_uniform": "PCL UniformSampling"}
COLOURS = {"ours": "#c0392b", "open3d_tsdf": "#2471a3", "open3d_voxel": "#5dade2",
           "pcl_voxel": "#1e8449", "pcl_uniform": "#82e0aa"}


def flat(row):
    """A row with its scores as plain columns: f_1cm, acc_2cm, psnr_r4, ..."""
    out = {key: value for key, value in row.items() if key != "score"}
    score = row.get("score", {})
    for entry in score.get("cloud_scores", []):
        name = f"{100 * entry['threshold']:g}cm"
        out[f"accuracy_{name}"] = entry["accuracy"]
        out[f"completeness_{name}"] = entry["completeness"]
        out[f"f_{name}"] = entry["f_score"]
    for view in score.get("views", []):
        for key, value in view.items():
            if key != "radius":
                out[f"{key}_r{view['radius']:g}"] = value
    return out


def write_csv(path, rows):
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)


def table(rows, columns):
    """Markdown; columns are (title, function of a row)."""
    lines = ["| " + " | ".join(title for title, _ in columns) + " |",
             "|---" * len(columns) + "|"]
    lines += ["| " + " | ".join(cell(row) for _, cell in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(key, form, scale=1.0):
    return lambda row: form.format(scale * row[key]) if row.get(key) is not None else "–"


def setting_text(row):
    if row["method"] == "ours":
        return f"`{row['setting']}`" if row["setting"] else "default"
    return f"{1000 * row['setting']:.2f} mm"


def columns(radius):
    r = f"r{radius:g}"
    return [
        ("method", lambda row: NAMES[row["method"]]),
        ("setting", setting_text),
        ("points", number("points", "{:,.0f}")),
        ("all frames, s", number("all_seconds", "{:.1f}")),
        ("all frames, peak MiB", number("all_peak_mib", "{:.0f}")),
        ("without held-out, s", number("seconds", "{:.1f}")),
        ("accuracy 1 cm", number("accuracy_1cm", "{:.3f}")),
        ("completeness 1 cm", number("completeness_1cm", "{:.3f}")),
        ("F 1 cm", number("f_1cm", "{:.3f}")),
        ("F 2 cm", number("f_2cm", "{:.3f}")),
        ("hit, %", number(f"hit_{r}", "{:.1f}", 100)),
        ("PSNR, dB", number(f"psnr_{r}", "{:.2f}")),
        ("depth median %, first", number(f"first_median_rel_{r}", "{:.2f}", 100)),
        ("depth median %, expected", number(f"expected_median_rel_{r}", "{:.2f}", 100)),
        ("AbsRel %, first", number(f"first_abs_rel_{r}", "{:.2f}", 100)),
        ("AbsRel %, expected", number(f"expected_abs_rel_{r}", "{:.2f}", 100)),
    ]


def write_markdown(path, machine, matched, sweep, radii):
    with open(path, "w") as file:
        file.write(f"# Fusing, compared\n\n{machine}\n")
        for radius in radii:
            file.write(f"\n## At one number of points; views splatted at radius {radius:g} px\n\n")
            file.write(table(matched, columns(radius)))
        for radius in radii if sweep else []:
            file.write(f"\n## Over resolutions, radius {radius:g} px\n\n")
            wanted = [c for c in columns(radius) if not c[0].startswith("all frames")]
            file.write(table(sweep, wanted))


def draw(path, rows, radius):
    """Curves: F-score, PSNR and depth error against points and against seconds."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    shown = [("f_1cm", "F-score at 1 cm"), (f"psnr_r{radius:g}", "PSNR of left-out views, dB"),
             (f"expected_abs_rel_r{radius:g}", "AbsRel of left-out depth")]
    figure, axes = plt.subplots(len(shown), 2, figsize=(11, 12), sharey="row")
    for line, (key, title) in zip(axes, shown):
        for axis, (x, label) in zip(line, [("points", "points"), ("seconds", "seconds")]):
            for method, name in NAMES.items():
                chosen = sorted((row for row in rows if row["method"] == method and key in row),
                                key=lambda row: row["points"])
                axis.plot([row[x] for row in chosen], [row[key] for row in chosen], "o-",
                          color=COLOURS[method], label=name, lw=2 if method == "ours" else 1)
            axis.set_xscale("log")
            axis.set_xlabel(label)
            axis.grid(alpha=0.3, which="both")
        line[0].set_ylabel(title)
    axes[0][0].legend(fontsize=8)
    figure.suptitle(f"Every 10th frame left out; views splatted at radius {radius:g} px")
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def write_all(folder, machine, matched, sweep, radii):
    matched = [flat(row) for row in matched]
    sweep = [flat(row) for row in sweep]
    rows = [dict(row, table="matched") for row in matched]
    rows += [dict(row, table="sweep") for row in sweep]
    write_csv(folder / "compare_fuse.csv", rows)
    (folder / "compare_fuse.json").write_text(
        json.dumps({"machine": machine, "rows": rows}, indent=1))
    write_markdown(folder / "compare_fuse.md", machine, matched, sweep, radii)
    for radius in radii:
        draw(folder / f"compare_fuse_r{radius:g}.png", matched + sweep, radius)
