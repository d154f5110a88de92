"""Arrays in and out of the library. Internal."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _treerec


class Mesh(NamedTuple):
    """Triangles: metres, Y up, the tree's base at the origin; front faces turn counter-clockwise, as in glTF."""

    vertices: npt.NDArray[np.float32]
    """(V, 3)"""
    normals: npt.NDArray[np.float32]
    """(V, 3)"""
    tangents: npt.NDArray[np.float32]
    """(V, 4): along u; the last is the sign of the bitangent"""
    uvs: npt.NDArray[np.float32]
    """(V, 2): v downwards in the picture"""
    triangles: npt.NDArray[np.uint32]
    """(T, 3): rows of the vertices"""


class Leaves(NamedTuple):
    """Placements of leaf cards: metres, Y up."""

    positions: npt.NDArray[np.float32]
    """(L, 3): where the petiole leaves the bark"""
    axes: npt.NDArray[np.float32]
    """(L, 3, 3): rows are unit vectors across the leaf, from its base to its tip, and out of its upper face"""
    sizes: npt.NDArray[np.float32]
    """(L,): metres"""
    hues: npt.NDArray[np.float32]
    """(L,): 0..1 of the kind's range of colours"""
    kinds: npt.NDArray[np.uint8]
    """(L,): 0 for the tree's own kind of leaves, else the number of one that wood of the tree has of its own"""


def mesh_of(arrays: tuple[Any, ...]) -> Mesh:
    return Mesh(*arrays)


def leaves_of(arrays: tuple[Any, ...]) -> Leaves:
    return Leaves(*arrays)


def numbers_of(name: str, values: npt.ArrayLike, what: str) -> npt.NDArray[Any]:
    """An array of (N, 3) numbers. Raises Error with a sentence."""
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise _treerec.Error("%s is no array: its rows are not of one length." % name) from error
    if array.ndim != 2 or array.shape[1] != 3:
        raise _treerec.Error("%s has the shape %s; it must be (N, 3): %s." % (name, array.shape, what))
    if array.dtype.kind not in "fiu":
        raise _treerec.Error("%s is an array of %s; it must be of numbers." % (name, array.dtype))
    return array


def as_cloud(points: _treerec.Cloud | npt.ArrayLike, colors: npt.ArrayLike | None) -> _treerec.Cloud:
    if isinstance(points, _treerec.Cloud):
        if colors is not None:
            raise _treerec.Error("The cloud has its own colours; colors is for an array of points.")
        return points
    if isinstance(points, (str, bytes)) or hasattr(points, "__fspath__"):
        raise _treerec.Error("points is a path; read_cloud() reads the file.")
    places = numbers_of("points", points, "x, y and z of each point")
    shades, white = np.empty((0, 3), np.float32), 0.0
    if colors is not None:
        given = numbers_of("colors", colors, "red, green and blue of each point")
        if len(given) != len(places):
            raise _treerec.Error("There are %d points, but %d colours; it must be one each." % (len(places), len(given)))
        white = {"uint8": 255.0, "uint16": 65535.0}.get(given.dtype.name, 0.0)
        shades = np.ascontiguousarray(given, np.float32)
    return _treerec.cloud_from_arrays(np.ascontiguousarray(places, np.float64), shades, white, None)
