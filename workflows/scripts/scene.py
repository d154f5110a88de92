"""The forest as a scene of the engine, with every tree at its place on its plot's ground."""
import json
import os
import struct
from pathlib import Path

import models
import numpy
import places

MOST_VERTICES = 256  # of the ground's mesh, along either side

PROJECT = """; Opens this folder in the engine by itself. Leave it out where trees/ and the scene go into a project.
config_version=5

[application]

config/name={name}
run/main_scene="res://forest.tscn"
config/features=PackedStringArray("4.6")
"""

SURROUNDINGS = """[sub_resource type="ProceduralSkyMaterial" id="sky_material"]

[sub_resource type="Sky" id="sky"]
sky_material = SubResource("sky_material")

[sub_resource type="Environment" id="surroundings"]
background_mode = 2
sky = SubResource("sky")
tonemap_mode = 2

[node name="Forest" type="Node3D"]

[node name="WorldEnvironment" type="WorldEnvironment" parent="."]
environment = SubResource("surroundings")

[node name="Sun" type="DirectionalLight3D" parent="."]
transform = Transform3D(0.77, -0.44, 0.46, 0, 0.72, 0.69, -0.64, -0.53, 0.56, 0, 50, 0)
shadow_enabled = true
"""


def read_exr(path):
    """Of the kind that treerec writes: one channel of floats, without compression."""
    data = Path(path).read_bytes()
    at = data.index(b"dataWindow\0box2i\0") + 21
    width, height = (number + 1 for number in struct.unpack_from("<2i", data, at + 8))
    rows = data.index(b"screenWindowWidth\0float\0") + 24 + 4 + 4 + 1 + 8 * height
    lines = numpy.frombuffer(data, dtype="<f4", offset=rows).reshape(height, width + 2)
    return lines[:, 2:]


def ground_of(plot):
    """(the ground's description and heights) of a plot's folder, or nothing."""
    ground = json.loads((plot / "plot.json").read_text(encoding="utf-8")).get("ground")
    return (ground, read_exr(plot / ground["file"])) if ground else None


def write_ground_model(path, ground, heights):
    """A mesh as fine as the heightmap, but for large ones."""
    depth, width = heights.shape
    step = max(1, -(-max(width, depth) // MOST_VERTICES))
    columns = numpy.unique(numpy.append(numpy.arange(0, width, step), width - 1))
    rows = numpy.unique(numpy.append(numpy.arange(0, depth, step), depth - 1))
    if len(columns) < 2 or len(rows) < 2:
        return False
    x, z = numpy.meshgrid(columns, rows)
    heights = heights[numpy.ix_(rows, columns)]
    first = ground["first_pixel_m"]
    grid = numpy.stack([first[0] + ground["pixel_m"] * x, heights, first[1] + ground["pixel_m"] * z], axis=2)
    along_z, along_x = numpy.gradient(heights.astype(float), rows * ground["pixel_m"], columns * ground["pixel_m"])
    normals = numpy.stack([-along_x, numpy.ones_like(along_x), -along_z], axis=2)
    normals /= numpy.linalg.norm(normals, axis=2, keepdims=True)
    corner = (numpy.arange(len(rows) - 1)[:, None] * len(columns) + numpy.arange(len(columns) - 1)).ravel()
    down, right = corner + len(columns), corner + 1
    triangles = numpy.stack([corner, down, right, right, down, down + 1], axis=1)
    models.write_ground(path, grid.reshape(-1, 3), normals.reshape(-1, 3), triangles)
    return True


def extent_of(standing, ground):
    """Along x, of trees and ground."""
    edges = [place[0] for place in standing]
    if ground:
        first = ground[0]["first_pixel_m"][0]
        edges += [first, first + ground[0]["pixel_m"] * ground[0]["width"]]
    return min(edges), max(edges)


def write_level_ground(path, standing):
    """Under trees in rows."""
    room = 10.0
    left, right, back, front = (f(place[axis] for place in standing) for axis in (0, 2) for f in (min, max))
    width, depth = right - left + 2 * room, front - back + 2 * room
    # A square grid of pixels, as a heightmap has, a metre each.
    heights = numpy.zeros((int(depth) + 1, int(width) + 1), dtype="<f4")
    write_ground_model(path, {"pixel_m": 1.0, "first_pixel_m": [left - room, back - room]}, heights)


def groups_of(rows, plots):
    """[(name, ground's file or nothing, [(row, place)], (lowest, highest) x)]: each plot, and loose scans."""
    groups = []
    for plot in plots:
        own = [row for row in rows if row.get("plot") == plot]
        if not own:
            continue
        folder = Path("work/plots") / plot / "trees"
        origin = json.loads((folder / "plot.json").read_text(encoding="utf-8"))["frame"]["origin"]
        ground, model = ground_of(folder), f"ground_{plot}.glb"
        if ground:
            Path(f"ground_{plot}.exr").write_bytes((folder / ground[0]["file"]).read_bytes())
        if not ground or not write_ground_model(model, *ground):
            model = None
        standing = [places.to_scene(row["frame"], origin) for row in own]
        groups.append((plot, model, list(zip(own, standing)), extent_of(standing, ground)))
    loose = [row for row in rows if "plot" not in row]
    if loose:
        standing, flat = places.place_trees(loose)
        model = "ground_scans.glb" if flat else None
        if flat:
            write_level_ground(model, standing)
        groups.append(("scans", model, list(zip(loose, standing)), extent_of(standing, None)))
    return groups


def transform(x, y, z):
    numbers = ", ".join(f"{value:.4g}" if abs(value) < 1e-4 else f"{value:.4f}" for value in (x, y, z))
    return f"transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, {numbers})\n"


def scene_text(groups, shifts):
    files = [model for _, model, _, _ in groups if model]
    files += sorted({f"trees/{row['id']}.tscn" for _, _, trees, _ in groups for row, _ in trees if row["baked"]})
    text = f"[gd_scene load_steps={len(files) + 4} format=3]\n\n"
    for number, file in enumerate(files):
        text += f'[ext_resource type="PackedScene" path="{file}" id="{number}"]\n'
    text += "\n" + SURROUNDINGS
    number_of = {file: number for number, file in enumerate(files)}
    for (name, model, trees, _), shift in zip(groups, shifts):
        text += f'\n[node name="{name}" type="Node3D" parent="."]\n' + transform(shift, 0, 0)
        if model:
            text += f'\n[node name="Ground" parent="{name}" instance=ExtResource("{number_of[model]}")]\n'
        for row, place in trees:
            if not row["baked"]:
                continue
            number = number_of[f"trees/{row['id']}.tscn"]
            text += f'\n[node name="{row["id"]}" parent="{name}" instance=ExtResource("{number}")]\n'
            text += transform(*place)
    return text


def write_scene(groups, shifts, title):
    """forest.tscn, and a project around it where there is none."""
    text = scene_text(groups, shifts)
    project = Path("project.godot")
    if not project.exists():
        project.write_text(PROJECT.format(name=json.dumps(title)), encoding="utf-8")
    part = Path("forest.tscn.part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, "forest.tscn")


def clear_shared(needed):
    """Of what trees have in common, what no tree needs any more goes."""
    for path in Path("shared").glob("*_????????????.*"):
        if path.name not in needed:
            path.unlink()


def write(rows, plots, title, baked):
    """The ground, and the scene where an engine has baked its trees ({id: row}; None without an engine). Returns where
    in it they stand: {id: (x, z)}."""
    for row in rows:
        row["baked"] = baked is not None and baked[row["id"]]["code"] == 0
    groups = groups_of(rows, plots)
    shifts = places.beside([extent for *_, extent in groups])
    # The engine is to leave what is not for games.
    Path("work/.gdignore").touch()
    if baked is None:
        # One of an earlier run would show other trees.
        Path("forest.tscn").unlink(missing_ok=True)
    else:
        write_scene(groups, shifts, title)
        clear_shared({name for row in baked.values() for name in row.get("shared", [])})
    return {
        row["id"]: (round(x + shift, 3), round(z, 3))
        for (_, _, trees, _), shift in zip(groups, shifts)
        for row, (x, _, z) in trees
    }
