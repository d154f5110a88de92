"""Models that share their pictures, and a model of the ground: GLB (Khronos, "glTF 2.0", section 4)."""
import hashlib
import json
import os
import shutil
import struct
from pathlib import Path


def read_glb(path):
    data = Path(path).read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def write_glb(path, scene, rest):
    """rest: the chunks behind the JSON."""
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) + struct.pack("<I4s", len(text), b"JSON")
    part = Path(path).with_name(Path(path).name + ".part")
    part.write_bytes(head + text + rest)
    os.replace(part, path)


def share(model, folder):
    """Trees of one kind have the same pictures: each is kept once, under its digest. model: will lie beside folder."""
    scene, rest = read_glb(model)
    folder.mkdir(parents=True, exist_ok=True)
    for image in scene.get("images", []):
        picture = model.parent / image["uri"]
        digest = hashlib.sha256(picture.read_bytes()).hexdigest()[:12]
        kept = folder / f"{picture.stem}_{digest}{picture.suffix}"
        if not kept.exists():
            # Several jobs may bring the same one.
            part = kept.with_name(f"{kept.name}.{os.getpid()}.part")
            shutil.copyfile(picture, part)
            os.replace(part, kept)
        image["uri"] = f"{folder.name}/{kept.name}"
    write_glb(model, scene, rest)


def write_ground(path, places, normals, triangles):
    """A mesh whose faces bodies collide with, by the ending -col that the engine's importer knows."""
    arrays = [places.astype("<f4"), normals.astype("<f4"), triangles.astype("<u4")]
    views, at = [], 0
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": array.nbytes})
        at += array.nbytes
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(places), "type": "VEC3"},
        {"bufferView": 1, "componentType": 5126, "count": len(normals), "type": "VEC3"},
        {"bufferView": 2, "componentType": 5125, "count": triangles.size, "type": "SCALAR"},
    ]
    accessors[0]["min"], accessors[0]["max"] = places.min(axis=0).tolist(), places.max(axis=0).tolist()
    soil = {"name": "Soil", "pbrMetallicRoughness": {"baseColorFactor": [0.055, 0.065, 0.03, 1], "metallicFactor": 0}}
    scene = {
        "asset": {"version": "2.0", "generator": "Godot tree reconstruction (workflows)"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "Ground-col", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "materials": [soil],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": at}],
    }
    data = b"".join(array.tobytes() for array in arrays)
    write_glb(path, scene, struct.pack("<I4s", len(data), b"BIN\0") + data)
