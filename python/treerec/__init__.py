"""Scanned trees: a point cloud in, a tree as arrays, measures, scores and game-ready models out.

>>> import treerec
>>> tree = treerec.reconstruct(treerec.read_cloud("oak.laz"))
>>> tree.measure()["dbh_m"], tree.positions.shape
>>> tree.write_glb("oak.glb", leaves="oak")

docs/python.md tells more.
"""

from __future__ import annotations

import atexit
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _treerec, usd
from ._arrays import Leaves, Mesh, as_cloud, leaves_of, mesh_of
from ._treerec import Cancelled, Cloud, Error, __version__

__all__ = [
    "Cancelled", "Cloud", "Error", "GUESS", "Leaves", "MEASURED", "Mesh", "TRUNK", "Tree",
    "__version__", "cloud", "grammars", "grow", "leaf_presets", "lstring", "read_cloud", "read_tree",
    "reconstruct", "set_threads",
]

# Bits of Tree.flags: on the trunk; the radius was fitted to points; the wood to the parent bridges a gap.
TRUNK, MEASURED, GUESS = 1, 2, 4

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[float, str], Union[bool, None]]
Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
Floats = npt.NDArray[np.float64]

# Its threads can't be joined while the library is unloaded, and a child that is forked would wait for them.
atexit.register(_treerec.end_idle_threads)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_treerec.end_idle_threads)


class Tree:
    """A rooted tree of nodes, parents before children. It does not change, and its arrays are read-only."""

    __slots__ = ("_tree",)

    def __init__(self, tree: _treerec.Tree) -> None:
        self._tree = tree

    def __len__(self) -> int:
        return len(self._tree)

    def __repr__(self) -> str:
        return "<treerec.Tree: %d nodes, %.2f m high>" % (len(self), float(np.ptp(self.positions[:, 1])))

    @property
    def positions(self) -> Floats:
        """(N, 3): metres, Y up, from the tree's base."""
        return self._tree.positions

    @property
    def scan_positions(self) -> Floats:
        """(N, 3): in the scan's own coordinates, axes and unit."""
        return self._tree.scan_positions

    @property
    def radii(self) -> Floats:
        """(N,): metres, of the wood from the parent to the node."""
        return self._tree.radii

    @property
    def parents(self) -> npt.NDArray[np.int32]:
        """(N,): the row of each node's parent; -1 for the root, which is row 0."""
        return self._tree.parents

    @property
    def flags(self) -> npt.NDArray[np.uint8]:
        """(N,): TRUNK, MEASURED and GUESS, added up."""
        return self._tree.flags

    @property
    def origin(self) -> tuple[float, float, float]:
        """Where the base stands, in the scan's coordinates."""
        return self._tree.origin

    @property
    def up(self) -> str:
        """The scan's axis to the sky."""
        return self._tree.up

    @property
    def metres_per_unit(self) -> float:
        """Of the scan's unit."""
        return self._tree.metres_per_unit

    @property
    def warnings(self) -> list[str]:
        """Sentences: what the reconstruction, or the reader, had to guess or to leave out."""
        return self._tree.warnings

    @property
    def cleaned_points(self) -> npt.NDArray[np.float32] | None:
        """(M, 3): the points that the tree was made of, in its own metres, or None for one of no scan."""
        return self._tree.cleaned_points

    @property
    def cleaned_leaf(self) -> npt.NDArray[np.bool_] | None:
        """(M,): which of them are leaves, or what grows around the base."""
        return self._tree.cleaned_leaf

    def report(self) -> dict[str, Any] | None:
        """What `treerec reconstruct --report` tells, or None for a tree that was not made of a scan."""
        report: dict[str, Any] | None = self._tree.report()
        if report is not None:
            # Of the model's file, which is not made yet.
            for key in ("triangles", "leaves"):
                report.pop(key, None)
        return report

    def measure(self) -> dict[str, Any]:
        """Height, DBH, crown, lengths, wood and branches by order, with the keys of `treerec info --json`."""
        measures: dict[str, Any] = self._tree.measure()
        return measures

    def score(
        self, scan: Cloud | npt.ArrayLike, *, noise: float = 0.0, tolerance: float = 0.02,
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """How well the tree explains points in the scan's coordinates: the keys of `treerec score --json`.

        noise: the scan's, and tolerance: how far from the bark a point is explained; metres.
        """
        for name, value in (("noise", noise), ("tolerance", tolerance)):
            if not 0.0 <= value <= 10.0:
                raise Error("%s is metres from 0 to 10, not %r." % (name, value))
        score: dict[str, Any] = self._tree.score(as_cloud(scan, None), noise, tolerance, progress)
        return score

    def write(
        self, path: Path, *, leaves: str = "auto", seed: int | None = None, levels: int = 1,
        pictures_beside: bool = False, progress: Progress | None = None,
    ) -> None:
        """Writes what the path's ending names: .glb .gltf .obj (bark and leaves), .txt (tree file), .csv (QSM
        cylinders), .ply (skeleton), .lstring, or .usd .usda .usdc .usdz (bark and leaves; needs Pixar's usd-core).

        leaves: one of leaf_presets(), or auto. levels: of detail, 1 to 5. pictures_beside: of a .glb, in a folder.
        """
        if not usd.is_usd(path):
            self._tree.write(os.fspath(path), leaves, seed, levels, pictures_beside, progress)
            return
        usd.library()
        with tempfile.TemporaryDirectory() as folder:
            model = os.path.join(folder, "tree.glb")
            self._tree.write(model, leaves, seed, levels, False, progress)
            usd.convert(model, path)

    def write_glb(
        self, path: Path, leaves: str = "auto", *, seed: int | None = None, levels: int = 1,
        progress: Progress | None = None,
    ) -> None:
        """The tree with bark and leaves as a binary glTF: metres, Y up, base at the origin."""
        if not os.fspath(path).lower().endswith(".glb"):
            raise Error("'%s' does not end in .glb." % os.fspath(path))
        self.write(path, leaves=leaves, seed=seed, levels=levels, progress=progress)

    def mesh(self, *, leaves: str = "auto", seed: int | None = None, progress: Progress | None = None) -> Mesh:
        """The bark, as it is in models. Twigs that leaves hang on are part of it, so it asks which leaves."""
        return mesh_of(self._tree.mesh(leaves, seed, progress))

    def leaves(self, leaves: str = "auto", *, seed: int | None = None, progress: Progress | None = None) -> Leaves:
        """Where leaves stand, and how."""
        return leaves_of(self._tree.leaves(leaves, seed, progress))

    def lstring(
        self, *, dialect: Literal["turtle", "paper"] = "turtle", accuracy: float = 1e-5, flags: bool = True
    ) -> str:
        """The tree as an L-string, below a heading that says where it stands; lstring() reads it."""
        return self._tree.lstring(dialect, accuracy, flags)


def read_cloud(
    path: Path, *, columns: str | Sequence[str] = "", classes: str | Sequence[int] = "",
    progress: Progress | None = None,
) -> Cloud:
    """Reads PLY, LAS, LAZ (where LASzip is), PCD, COLMAP's points3D or text.

    columns: of text, such as "x,y,z,r,g,b". classes: of LAS, such as "2,4-5" or "all".
    """
    return _treerec.read_cloud(os.fspath(path), _list(columns), _list(classes), progress)


def cloud(points: npt.ArrayLike, colors: npt.ArrayLike | None = None) -> Cloud:
    """A cloud of arrays: (N, 3) places of any origin, and colours of 0..255, 0..65535 or 0..1, or none."""
    return as_cloud(points, colors)


def reconstruct(
    points: Cloud | npt.ArrayLike,
    colors: npt.ArrayLike | None = None,
    *,
    progress: Progress | None = None,
    up: Literal["auto"] | Axis | None = None,
    scale: float | None = None,
    unit: Literal["m", "cm", "mm", "km", "ft", "us-ft", "in", "yd"] | None = None,
    height: float | None = None,
    length: Sequence[float] | None = None,
    skeleton: Literal["geodesic", "delaunay", "flood"] | None = None,
    spanning_tree: Literal["paths", "minimum"] | None = None,
    flood: Literal["ours", "paper"] | None = None,
    voxel: float | None = None,
    radii: Literal["measured", "linear", "davinci"] | None = None,
    complete: bool = False,
    prune: Literal["paper", "leader"] | None = None,
    spacing: float | None = None,
    seed: int | None = None,
    no_clean: bool = False,
    no_clean_colors: bool = False,
    no_clean_outliers: bool = False,
    no_clean_fragments: bool = False,
    no_clean_ground: bool = False,
    tree: int | None = None,
    tree_at: Sequence[float] | None = None,
    one_tree: bool = False,
    all_wood: bool = False,
) -> Tree:
    """Makes a tree of a cloud, or of an array of points: (N, 3), of any origin.

    The options are those of `treerec reconstruct --help`; None leaves one to the program. progress is called with the
    share that is done and a stage's name; where it returns False, Cancelled is raised. Other Python threads run on
    meanwhile.
    """
    given = {
        "up": up, "scale": scale, "unit": unit, "height": height, "length": length, "skeleton": skeleton,
        "spanning_tree": spanning_tree, "flood": flood, "voxel": voxel, "radii": radii, "complete": complete,
        "prune": prune, "spacing": spacing, "seed": seed, "no_clean": no_clean, "no_clean_colors": no_clean_colors,
        "no_clean_outliers": no_clean_outliers, "no_clean_fragments": no_clean_fragments,
        "no_clean_ground": no_clean_ground, "tree": tree, "tree_at": tree_at, "one_tree": one_tree,
        "all_wood": all_wood,
    }
    return Tree(_treerec.reconstruct(as_cloud(points, colors), _words(given), progress))


def read_tree(
    path: Path, *, up: Axis = "z", tree: int | None = None, dialect: Literal["turtle", "paper"] | None = None
) -> Tree:
    """Reads a tree file, a table of nodes or of cylinders (TreeQSM and others), a skeleton PLY, SWC, MTG or an L-string.

    up: of files that don't say. tree: which of several, from 1; None takes the largest.
    """
    if tree is not None and tree < 1:
        raise Error("tree is a number from 1, not %r." % tree)
    return Tree(_treerec.read_tree(os.fspath(path), up, tree or 0, dialect or ""))


def grow(
    source: Path,
    *,
    progress: Progress | None = None,
    seed: int | None = None,
    iterations: int | None = None,
    most_nodes: int | None = None,
    most_seconds: float | None = None,
    dialect: Literal["turtle", "paper"] | None = None,
    angle: float | None = None,
    step: float | None = None,
    radius: float | None = None,
    vary_angle: float | None = None,
    vary_length: float | None = None,
) -> Tree:
    """Grows a tree by a grammar's or an L-string's file, or by one of grammars(); `treerec grow --help` has the options."""
    given = {
        "seed": seed, "iterations": iterations, "most_nodes": most_nodes, "most_seconds": most_seconds,
        "dialect": dialect, "angle": angle, "step": step, "radius": radius, "vary_angle": vary_angle,
        "vary_length": vary_length,
    }
    return Tree(_treerec.grow(os.fspath(source), "", _words(given), progress))


def lstring(text: str, **options: Any) -> Tree:
    """The same as grow() for a text in memory: an L-string, or a grammar."""
    if not text.strip():
        raise Error("The text is empty: it draws no tree.")
    progress = options.pop("progress", None)
    return Tree(_treerec.grow("text", text, _words(options), progress))


def leaf_presets() -> list[str]:
    """What leaves= may be."""
    return _treerec.leaf_presets()


def grammars() -> list[str]:
    """What ships with the library and grow() knows by name."""
    return _treerec.grammars()


def set_threads(threads: int | None) -> None:
    """How many threads all calls use; None: one per core. It changes nothing else."""
    if threads is not None and not 1 <= threads <= 1024:
        raise Error("threads is a whole number from 1 to 1024, or None, not %r." % threads)
    _treerec.set_threads(threads or 0)


def _list(value: str | Sequence[object]) -> str:
    return value if isinstance(value, str) else ",".join(map(str, value))


def _word(value: object) -> str:
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, str):
        return ",".join(_word(part) for part in value)
    return str(value)


def _words(options: Mapping[str, object]) -> list[str]:
    words: list[str] = []
    for name, value in options.items():
        if value is None or value is False or value is np.False_:
            continue
        words.append("--" + name.replace("_", "-"))
        if not isinstance(value, (bool, np.bool_)):
            words.append(_word(value))
    return words
