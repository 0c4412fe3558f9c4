#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables and figures of "Compute-Bound and Low-Bandwidth Distributed 3D Graph-SLAM", measured
anew, each beside what the paper says."""

import argparse
import html
import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first
import numpy  # noqa: E402
from compress_runs import Sequence  # noqa: E402
from plane_picture import PlanePicture, Viewpoint, unit  # noqa: E402

COARSE, FINE = 0.0131, 0.0027  # the paper's tolerances [m]
# The paper's fit: 24 px tiles, one tolerance for all depths, no test along the ray, 32 B a plane.
PAPER_TILES = {"initial_tile": 24, "acceptance": "fixed", "lambda": 0}
HALLWAY_PAIR = (360, 380)  # images of its corner
TARGET_COLOR, SOURCE_COLOR = (0.25, 0.5, 0.8), (0.95, 0.58, 0.18)
KB = 1e-3


class Page:
    """Figures and tables in their order, as one HTML page beside the pictures."""

    def __init__(self, folder):
        self.folder = folder
        self._parts = []

    def heading(self, text):
        self._parts.append(f"<h2>{html.escape(text)}</h2>")

    def note(self, text):
        self._parts.append(f"<p>{html.escape(text)}</p>")

    def figure(self, name, figure, paper):
        figure.tight_layout()
        figure.savefig(self.folder / f"{name}.png", dpi=110)
        plt.close(figure)
        self._parts.append(f'<img src="{name}.png" alt="{name}"><p class="paper">The paper: '
                           f"{html.escape(paper)}</p>")
        print(f"written {self.folder / name}.png")

    def table(self, header, rows):
        cells = lambda row, tag: "".join(f"<{tag}>{html.escape(str(c))}</{tag}>" for c in row)
        body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
        self._parts.append(f"<table><tr>{cells(header, 'th')}</tr>{body}</table>")

    def write(self):
        style = ("body{font-family:sans-serif;max-width:70em;margin:2em auto;padding:0 1em}"
                 "img{max-width:100%}td,th{padding:.2em .8em;text-align:right;border-bottom:1px "
                 "solid #ccc}td:first-child,th:first-child{text-align:left}"
                 ".paper{color:#555;font-style:italic}")
        title = "Compute-bound and low-bandwidth distributed 3D graph-SLAM, measured anew"
        path = self.folder / "index.html"
        path.write_text(f"<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>{title}"
                        f"</title><style>{style}</style></head><body><h1>{title}</h1>"
                        + "\n".join(self._parts) + "</body></html>\n", encoding="utf-8")
        print(f"written {path}")


def figure_1(page, sequence):
    """The scene, its depth and its planes."""
    with tempfile.TemporaryDirectory() as folder:
        pictures = sequence.draw(folder, texture="color")
        figure, axes = plt.subplots(1, 4, figsize=(16, 3.6))
        panels = (("color", "scene"), ("sensor", "dense depth"), ("tiles", "planes"),
                  ("texture", "planes with their texture"))
        for axis, (kind, title) in zip(axes, panels):
            axis.imshow(plt.imread(pictures[kind]))
            axis.set_title(title)
            axis.axis("off")
    page.figure(f"figure_1_{sequence.name}", figure,
                "Fig. 1, a building's hallway: scene, dense cloud, planes.")


def move(points, pose):
    """Points (... x 3), moved by a 4 x 4 matrix."""
    pose = numpy.array(pose)
    return points @ pose[:3, :3].T + pose[:3, 3]


def from_above(up):
    """A direction to look along: from behind the camera, above it and to its right."""
    view = numpy.array([0.0, -0.01, 1.0])  # of a camera that looks straight down, the upper edge
    ahead = unit(view - (view @ up) * up)
    return unit(ahead - 0.45 * numpy.cross(ahead, up) - 0.6 * up)


def titles_of(pair):
    """What is known of an alignment's guess and of its result."""
    titles = ["guess", "aligned by ICaP"]
    for i, key in enumerate(("guess_error", "error")):
        if key in pair:
            error = pair[key]
            titles[i] += (f", {1e3 * error['metres']:.0f} mm and {error['degrees']:.1f}\u00b0 "
                          "off the truth")
    status = pair["status"].replace("_", " ")
    return titles[0], f"{titles[1]}, RMS {pair['rms_mm']:.0f} mm, {status}"


def figure_2(page, sequence):
    """Two plane clouds before and after their alignment."""
    pair = sequence.aligned_pair()
    up, target, source = (numpy.array(pair[key]) for key in ("up_target", "target", "source"))
    moved = [move(source, pair[key]) for key in ("T_target_source_guess", "T_target_source")]
    view = Viewpoint(numpy.concatenate([target, *moved]), from_above(up), up)
    width, height = view.size
    figure, axes = plt.subplots(1, 2, figsize=(14, 0.5 + 7 * height / width))
    for axis, tiles, title in zip(axes, moved, titles_of(pair)):
        picture = PlanePicture(view)
        picture.draw(target, TARGET_COLOR, up)
        picture.draw(tiles, SOURCE_COLOR, up)
        axis.imshow(picture.pixels())
        axis.set_title(title)
        axis.axis("off")
    page.figure(f"figure_2_{sequence.name}", figure,
                "Fig. 2, two plane clouds before and after their alignment.")


def table_1(page, sequence):
    """Bytes of an image."""
    rows = [("depth image, float32", *(["1228.80"] * 3), "0.00")]
    for label, flags in (
            ("the paper's planes, 32 B each", {**PAPER_TILES, "min_tile": 8, "tolerance": COARSE,
                                               "encoding": "raw"}),
            ("the same planes, compact", {**PAPER_TILES, "min_tile": 8, "tolerance": COARSE}),
            ("as shipped", {}),
            ("lossless depth", {"encoding": "lossless"})):
        size = sequence.compress(**flags)["bytes"] * KB
        rows.append((label, *(f"{v:.2f}" for v in (size.mean(), size.min(), size.max(), size.std()))))
    rows.append(("the paper, depth image", "1200", "1200", "1200", "0"))
    rows.append(("the paper, planes", "44", "36", "50", "4"))
    page.table(("Table 1, KB an image", "mean", "min", "max", "std dev"), rows)


def budget_curve(sequence, tolerance):
    """Area, bytes and planes of a growing time budget, up to what the whole fit takes."""
    flags = {**PAPER_TILES, "min_tile": 8, "tolerance": tolerance}
    whole = numpy.median(sequence.compress(**flags)["fit_ms"])
    budgets = numpy.linspace(0.2, 2.0, 10) * whole
    return budgets, [sequence.compress(**flags, time_budget=f"{1e-3 * budget:.7f}")
                     for budget in budgets]


def draw_band(axis, x, columns, key, factor, **style):
    mean = numpy.array([c[key].mean() for c in columns]) * factor
    spread = numpy.array([c[key].std() for c in columns]) * factor
    line, = axis.plot(x, mean, **style)
    axis.fill_between(x, mean - spread, mean + spread, alpha=0.15, color=line.get_color())


def figure_3(page, sequence):
    """What a time budget buys."""
    figure, (area, planes) = plt.subplots(1, 2, figsize=(13, 5))
    size = area.twinx()
    for tolerance, dashes in ((COARSE, "-"), (FINE, "--")):
        budgets, columns = budget_curve(sequence, tolerance)
        style = {"linestyle": dashes, "label": f"{1e3 * tolerance:.1f} mm"}
        draw_band(area, budgets, columns, "coverage", 100.0, color="tab:blue", **style)
        draw_band(size, budgets, columns, "raw_bytes", KB, color="tab:red", **style)
        draw_band(size, budgets, columns, "bytes", KB, color="tab:green", **style)
        draw_band(planes, budgets, columns, "planes", 1.0, color="tab:blue", **style)
        plain = numpy.array(sequence.peers(tolerance=tolerance, min_tile=8)["paper"])
        area.plot(plain[:, 0], 100.0 * plain[:, 1], linestyle=dashes, color="tab:grey")
        planes.plot(plain[:, 0], plain[:, 2], linestyle=dashes, color="tab:grey",
                    label=f"{1e3 * tolerance:.1f} mm, the paper's algorithm")
    for axis in (area, planes):
        axis.set_xscale("log")
        axis.set_xlabel("time budget [ms]")
    area.set_ylabel("area fitted [%] (blue; grey: the paper's algorithm)")
    size.set_ylabel("KB an image (red: 32 B a plane, green: compact)")
    planes.set_ylabel("planes an image")
    planes.legend()
    page.figure(f"figure_3_{sequence.name}", figure,
                "Fig. 3, on an i5-6200U: 30 ms fit 75 % of the area at 2.7 mm in some 10 KB, 80 ms "
                "nearly all of it at 13.1 mm.")


def figure_4(page, sequence):
    """Rate and distortion."""
    figure, axis = plt.subplots(figsize=(8, 5.5))
    grid = [sequence.compress(**{**PAPER_TILES, "initial_tile": side}, min_tile=side, tolerance=1.0,
                              encoding="raw") for side in (40, 32, 24, 16, 12, 8, 6, 5, 4, 3)]
    codec = [sequence.compress(tolerance=0.003 * factor, min_tile=side)
             for factor, side in ((0.25, 2), (0.5, 2), (0.5, 4), (1, 4), (2, 4), (4, 4), (8, 4))]
    for label, columns, marker in (("blocks of one size, 32 B a plane", grid, "o-"),
                                   ("this codec, tolerance from 0.75 to 24 mm at 1 m", codec, "s-")):
        axis.plot([c["bytes"].mean() * KB for c in columns],
                  [c["depth_error_mm"].mean() for c in columns], marker, label=label)
    for name, points in sequence.peers(peers=True).get("peers", {}).items():
        axis.plot([p[0] * KB for p in points], [p[1] for p in points], "^:", label=name)
    axis.set(xscale="log", yscale="log", xlabel="KB an image", ylabel="mean depth error [mm]")
    axis.legend()
    page.figure(f"figure_4_{sequence.name}", figure,
                "Fig. 4: the elbow of its curve lies at 1.2 mm and some 40 KB.")


def figure_5(page, sequence):
    """What each level of the quadtree adds."""
    sides = (24, 12, 6, 3, 2)
    runs = [sequence.compress(**PAPER_TILES, min_tile=side, tolerance=COARSE) for side in sides]
    levels = numpy.arange(1, len(sides) + 1)
    figure, area = plt.subplots(figsize=(8, 5))
    size = area.twinx()
    error = {"capsize": 3}
    for axis, offset, key, factor, color in ((area, -0.25, "coverage", 100.0, "tab:blue"),
                                             (size, 0.0, "raw_bytes", KB, "tab:red"),
                                             (size, 0.25, "bytes", KB, "tab:green")):
        axis.bar(levels + offset, [r[key].mean() * factor for r in runs], 0.24, color=color,
                 yerr=[r[key].std() * factor for r in runs], **error)
    area.set_xticks(levels, [f"{level}: to {side} px\n{run['fit_ms'].mean():.2f} ms"
                             for level, side, run in zip(levels, sides, runs)])
    area.set_ylabel("area fitted [%] (blue)")
    size.set_ylabel("KB an image (red: 32 B a plane, green: compact)")
    page.figure(f"figure_5_{sequence.name}", figure,
                "Fig. 5: area and bytes balance between levels 3 and 4; level 5 adds little area and "
                "many bytes.")


def table_2(page, seed=1):
    """A hallway's whole map."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["rosrun", "planecloud_slam", "replay", f"hallway:{seed}", "--output", folder],
                       check=True, stdout=subprocess.DEVNULL)
        report = json.loads((pathlib.Path(folder) / "report.json").read_text(encoding="utf-8"))
        robot = next(iter(report["robots"].values())) if isinstance(report["robots"], dict) \
            else report["robots"][0]
    keyframes, path = robot["keyframes"], robot["path_m"]
    total = robot["keyframe_bytes"]["total"]
    page.table(("Table 2", "keyframes", "path [m]", "depth images", "whole messages", "KB a metre"),
               ((f"hallway:{seed}", keyframes, f"{path:.1f}",
                 f"{keyframes * 640 * 480 * 4 / 2**20:.1f} MiB", f"{total / 1e6:.3f} MB",
                 f"{KB * total / path:.1f}"),
                ("the paper", 189, "15", "221.48 MiB", "7.48 MiB (planes alone)", "523")))


def render_hallway(folder, seed):
    bag = pathlib.Path(folder) / "hallway.bag"
    subprocess.run(["rosrun", "planecloud_slam", "make_hallway_bag", "--output", bag, "--seed",
                    str(seed), "--duration", "30", "--noise", "astra"], check=True)
    return bag


OF_AN_INPUT = (figure_1, figure_2, table_1, figure_3, figure_4, figure_5)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("figures"),
                        help="folder for PNGs and index.html, default figures")
    parser.add_argument("--images", type=int, default=40, help="taken of each input, default 40")
    parser.add_argument("--every", type=int, default=7, help="take each N-th image, default 7")
    parser.add_argument("--pair", type=int, nargs=2, metavar="N", default=(0, 30),
                        help="numbers of the images of an INPUT that figure_2 aligns, default 0 30")
    parser.add_argument("--only", metavar="NAME",
                        choices=[make.__name__ for make in (*OF_AN_INPUT, table_2)],
                        help="one of them alone: figure_1 to figure_5, table_1, table_2")
    parser.add_argument("inputs", nargs="*", metavar="INPUT", help="bag or TUM folder")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    page = Page(arguments.output)
    wanted = lambda make: arguments.only in (None, make.__name__)
    with tempfile.TemporaryDirectory() as folder:
        inputs = [(path, pathlib.Path(path).stem, arguments.pair) for path in arguments.inputs]
        if any(map(wanted, OF_AN_INPUT)):
            inputs.insert(0, (render_hallway(folder, 1), "hallway", HALLWAY_PAIR))
        for path, name, pair in inputs:
            sequence = Sequence(path, name, arguments.every, arguments.images, pair)
            page.heading(name)
            for make in filter(wanted, OF_AN_INPUT):
                make(page, sequence)
    if wanted(table_2):
        page.heading("The hallway's map")
        table_2(page)
    page.write()


if __name__ == "__main__":
    sys.exit(main())
