# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws planar tiles in perspective, with hidden surfaces removed."""

import numpy

WIDTH = 1000  # [px]
OVERSAMPLING = 3
OUTLINE = 0.9  # [px]
GRAZING = 0.02  # least cosine between the normal of a tile and the ray to it


def unit(vector):
    return vector / numpy.linalg.norm(vector)


def normals_of(tiles):
    """Unit normals (n x 3) of tiles (n x 4 x 3), towards the sensor that saw them."""
    normals = numpy.cross(tiles[:, 3] - tiles[:, 0], tiles[:, 1] - tiles[:, 0])
    return normals / numpy.linalg.norm(normals, axis=1, keepdims=True)


class Viewpoint:
    """A camera that looks along `forward` at tiles (n x 4 x 3), `distance` times their spread away.
    Those that face it fill a picture WIDTH wide and as high as they want."""

    def __init__(self, tiles, forward, up, distance=2.6):
        right = unit(numpy.cross(forward, up))
        self._axes = numpy.array([right, numpy.cross(forward, right), forward])
        low, high = tiles.min(axis=(0, 1)), tiles.max(axis=(0, 1))
        spread = 0.5 * numpy.linalg.norm(high - low)
        self.eye = 0.5 * (low + high) - distance * spread * forward
        self._focal, self._offset = 1.0, numpy.zeros(2)
        tangents, _ = self.project(tiles[self.incidence(tiles) > GRAZING].reshape(-1, 3))
        low, high = tangents.min(axis=0), tangents.max(axis=0)
        self._focal = WIDTH / (high - low)[0]
        self._offset = -low * self._focal
        self.size = WIDTH, int(numpy.ceil((high - low)[1] * self._focal))

    def incidence(self, tiles):
        """Cosines (n) between the normals of tiles (n x 4 x 3) and the rays to them, negative where
        only a back shows."""
        to_eye = self.eye - tiles.mean(axis=1)
        rays = to_eye / numpy.linalg.norm(to_eye, axis=1, keepdims=True)
        return numpy.sum(normals_of(tiles) * rays, axis=1)

    def project(self, points):
        """Pixels (n x 2) and depths (n) of points (n x 3)."""
        seen = (points - self.eye) @ self._axes.T
        return seen[:, :2] / seen[:, 2:] * self._focal + self._offset, seen[:, 2]


class PlanePicture:
    """Tiles in perspective, the nearer ones hiding those behind."""

    def __init__(self, viewpoint):
        self._viewpoint = viewpoint
        width, height = (OVERSAMPLING * side for side in viewpoint.size)
        self._colors = numpy.ones((height, width, 3))
        self._nearness = numpy.zeros((height, width))  # [1/m]

    def draw(self, tiles, color, up):
        """Tiles (n x 4 x 3), clockwise as a sensor saw them, lit from above and from the viewer.
        Backs do not show: the wall between a viewer and a room would hide the room."""
        incidence = self._viewpoint.incidence(tiles)
        brightness = 0.6 + 0.25 * incidence + 0.25 * numpy.maximum(0.0, normals_of(tiles) @ up)
        for i in numpy.flatnonzero(incidence > GRAZING):
            self._fill(tiles[i], numpy.minimum(1.0, brightness[i] * numpy.array(color)))

    def _fill(self, tile, color):
        pixels, depths = self._viewpoint.project(tile)
        pixels = pixels * OVERSAMPLING
        shape = numpy.array(self._nearness.shape[::-1])
        low = numpy.clip(numpy.floor(pixels.min(axis=0)).astype(int), 0, shape)
        high = numpy.clip(numpy.ceil(pixels.max(axis=0)).astype(int) + 1, 0, shape)
        x, y = numpy.meshgrid(numpy.arange(low[0], high[0]) + 0.5,
                              numpy.arange(low[1], high[1]) + 0.5)
        inside = distance_inside(pixels, x, y)
        # On a plane, inverse depth is linear over the picture.
        system = numpy.column_stack([pixels[:3], numpy.ones(3)])
        coefficients = numpy.linalg.solve(system, 1.0 / depths[:3])
        nearness = coefficients[0] * x + coefficients[1] * y + coefficients[2]
        window = slice(low[1], high[1]), slice(low[0], high[0])
        visible = (inside >= 0.0) & (nearness > self._nearness[window])
        outline = numpy.where(inside < OUTLINE * OVERSAMPLING, 0.72, 1.0)
        self._nearness[window][visible] = nearness[visible]
        self._colors[window][visible] = (outline[..., None] * color)[visible]

    def pixels(self):
        """Height x width x 3, in [0, 1]."""
        width, height = self._viewpoint.size
        blocks = self._colors.reshape(height, OVERSAMPLING, width, OVERSAMPLING, 3)
        return blocks.mean(axis=(1, 3))


def distance_inside(corners, x, y):
    """How far [px] pixels lie inside a convex polygon (n x 2, clockwise), negative outside."""
    distance = numpy.full(x.shape, numpy.inf)
    for (x0, y0), (x1, y1) in zip(corners, numpy.roll(corners, -1, axis=0)):
        length = max(1e-9, numpy.hypot(x1 - x0, y1 - y0))
        side = ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length
        distance = numpy.minimum(distance, side)
    return distance
