# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs `compress` and the benches that measure beside it, and reads what they say."""

import csv
import json
import pathlib
import subprocess
import tempfile

import numpy

COLUMNS = ("planes", "bytes", "raw_bytes", "coverage", "point_plane_mm", "depth_error_mm", "fit_ms",
           "encode_ms")


def words(flags):
    """As on a command line; True stands for a flag without a value."""
    result = []
    for key, value in flags.items():
        result.append("--" + key.replace("_", "-"))
        if value is not True:
            result.append(str(value))
    return result


class Sequence:
    """An input of `compress`, how much of it is taken and which two images are aligned."""

    def __init__(self, path, name, every, images, pair):
        self.path, self.name, self._pair = str(path), name, pair
        self._selection = ["--every", str(every), "--max-images", str(images)]

    def compress(self, **flags):
        """A column of numbers, one for each image, by its name; flags as in `compress --help`."""
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "images.csv"
            self._run(["--csv", table], flags)
            with table.open(encoding="utf-8") as lines:
                rows = list(csv.DictReader(lines))
        return {key: numpy.array([float(row[key]) for row in rows]) for key in COLUMNS}

    def draw(self, folder, **flags):
        """The pictures of the first image that is taken, by their kind."""
        self._run(["--pictures", folder], flags)
        first = sorted(pathlib.Path(folder).glob("*_tiles.png"))[0]
        prefix = str(first)[:-len("tiles.png")]
        return {path.stem.rsplit("_", 1)[-1]: path
                for path in pathlib.Path(folder).glob(pathlib.Path(prefix).name + "*.png")}

    def peers(self, **flags):
        """What `bench_figures` measures of the paper's algorithm and of other codecs."""
        return self._measure("bench_figures", [*self._selection, *words(flags)])

    def aligned_pair(self):
        """What `bench_aligned_pair` makes of the two."""
        return self._measure("bench_aligned_pair", ["--pair", *map(str, self._pair)])

    def _measure(self, bench, arguments):
        result = subprocess.run(["rosrun", "planecloud_slam", bench, self.path, *arguments],
                                check=True, text=True, stdout=subprocess.PIPE)
        return json.loads(result.stdout)

    def _run(self, arguments, flags):
        command = ["rosrun", "planecloud_slam", "compress", self.path, *self._selection]
        command += [str(argument) for argument in arguments]
        subprocess.run(command + words(flags), check=True, stdout=subprocess.DEVNULL)
