"""What usd.py needs of a binary glTF (specification 2.0, sections 3.6 and 4), as treerec and its addon write it."""

from __future__ import annotations

import json
import pathlib
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from ._treerec import Error

_MAGIC, _JSON, _BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    """A model whose pictures are inside. Throws Error for what isn't one."""

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        try:
            data = path.read_bytes()
        except OSError as error:
            raise Error("'%s' could not be read: %s." % (path, error.strerror)) from error
        if len(data) < 20 or struct.unpack_from("<II", data) != (_MAGIC, 2):
            raise Error("'%s' is no binary glTF 2.0 (.glb)." % path)
        chunks: dict[int, bytes] = {}
        at = 12
        while at + 8 <= len(data):
            length, kind = struct.unpack_from("<II", data, at)
            if at + 8 + length > len(data):
                raise Error("'%s' is cut off." % path)
            chunks.setdefault(kind, data[at + 8 : at + 8 + length])
            at += 8 + length
        try:
            self.json: dict[str, Any] = json.loads(chunks[_JSON])
        except (KeyError, ValueError) as error:
            raise Error("'%s' is damaged: its JSON can't be read." % path) from error
        self._binary = chunks.get(_BINARY, b"")

    def levels(self) -> list[dict[str, Any]]:
        """The meshes of the levels of detail, the finest first (MSFT_lod), as the JSON has them."""
        nodes = self.json.get("nodes", [])
        finest = [node for node in nodes if node.get("name", "").endswith("_LOD0") and "mesh" in node]
        if not finest:
            raise Error("'%s' is not a model of treerec: it has no tree with levels of detail." % self._path)
        ids = finest[0].get("extensions", {}).get("MSFT_lod", {}).get("ids", [])
        found = [finest[0]] + [nodes[i] for i in ids]
        return [self.json["meshes"][node["mesh"]] for node in found if "mesh" in node]

    def extras(self) -> dict[str, Any]:
        """What the model says of its tree."""
        for node in self.json.get("nodes", []):
            if node.get("extras") and "MSFT_screencoverage" not in node["extras"]:
                extras: dict[str, Any] = node["extras"]
                return extras
        return {}

    def values(self, accessor: int) -> npt.NDArray[Any]:
        """(N, width) numbers, or (N,); normalized ones as 0..1."""
        told = self.json["accessors"][accessor]
        kind = np.dtype(_COMPONENTS[told["componentType"]])
        width, count = _WIDTHS[told["type"]], told["count"]
        view = self._view(told["bufferView"])
        start = told.get("byteOffset", 0)
        stride = self.json["bufferViews"][told["bufferView"]].get("byteStride", 0)
        if stride not in (0, kind.itemsize * width) or start + kind.itemsize * width * count > len(view):
            raise Error("'%s' is damaged: numbers of it lie beyond its end." % self._path)
        values = np.frombuffer(view, kind, width * count, start)
        if told.get("normalized"):
            values = values.astype(np.float32) / np.iinfo(kind).max
        return values.reshape(count, width) if width > 1 else values

    def picture(self, texture: int) -> tuple[str, bytes]:
        """Its file's name and its bytes."""
        image = self.json["images"][self.json["textures"][texture]["source"]]
        if "bufferView" not in image:
            raise Error("'%s' has its pictures in files of their own; write it with them inside." % self._path)
        ending = ".jpg" if image.get("mimeType") == "image/jpeg" else ".png"
        return image.get("name", "picture%d" % texture) + ending, bytes(self._view(image["bufferView"]))

    def repeats(self, texture: int) -> bool:
        """Whether it goes on beyond its edges."""
        sampler = self.json["textures"][texture].get("sampler")
        wrap: int = 10497 if sampler is None else self.json["samplers"][sampler].get("wrapS", 10497)
        return wrap == 10497

    def _view(self, number: int) -> memoryview:
        view = self.json["bufferViews"][number]
        start, length = view.get("byteOffset", 0), view["byteLength"]
        if start + length > len(self._binary):
            raise Error("'%s' is damaged: parts of it lie beyond its end." % self._path)
        return memoryview(self._binary)[start : start + length]
