"""What `./dev forest` made of the scans of make_scans.py: OUT. Prints what is wrong, and ends with 1."""
import csv
import json
import math
import re
import sqlite3
import struct
import sys
from pathlib import Path

PLACES = [(0.0, 0.0), (7.0, 2.0), (2.0, 8.0)]
wrong = []


def expect(holds, sentence):
    if not holds:
        wrong.append(sentence)


def check_rows(rows):
    by_name = {row["id"]: row for row in rows}
    expect(len(rows) == 9 and len(by_name) == 9, f"9 rows are expected, not {sorted(by_name)}")
    broken = by_name.pop("broken", {})
    expect(broken.get("code") == "1", f"the broken scan's exit code is {broken.get('code')}")
    expect(broken.get("error", "").startswith("'broken.ply' is cut off"), f"its sentence: {broken.get('error')}")
    for name, row in by_name.items():
        expect(row["code"] == "0", f"{name}: {row['error']}")
        expect(row["code"] == "0" and 4 < float(row["height_m"]) < 8, f"{name} is {row['height_m']} m high")
        expect(row["code"] == "0" and float(row["fidelity"]) > 0.9, f"{name} is true by {row['fidelity']}")
    expect(abs(float(by_name["forked"]["x"]) - 470600) < 0.5, "the LAZ file's tree has lost its place")
    return by_name


def check_places(by_name):
    plot = [row for name, row in by_name.items() if name.startswith("slope_tree_")]
    expect(len(plot) == 3, f"the plot has {len(plot)} trees")
    for x, y in PLACES:
        away = min(math.dist((float(r["x"]) - 470600, float(r["y"]) - 3810200), (x, y)) for r in plot)
        expect(away < 0.3, f"no tree of the plot stands at {x} {y}, the nearest {away:.2f} m off")


def check_package(path, rows):
    base = sqlite3.connect(path)
    expect(base.execute("PRAGMA application_id").fetchone()[0] == 0x47504B47, "trees.gpkg is no GeoPackage")
    found = base.execute("SELECT id, geom, height_m, error FROM trees ORDER BY id").fetchall()
    expect([name for name, *_ in found] == [row["id"] for row in rows], "trees.gpkg and trees.csv name other trees")
    for (name, geometry, height, _), row in zip(found, rows):
        if row["code"] != "0":
            expect(geometry is None, f"{name} has a place in trees.gpkg")
            continue
        expect(geometry[:4] == b"GP\0\x01" and len(geometry) == 37, f"{name} has no point in trees.gpkg")
        (x,) = struct.unpack_from("<d", geometry, 13)
        expect(abs(x - float(row["x"])) < 2e-3, f"{name} stands elsewhere in trees.gpkg")
        expect(height == float(row["height_m"]), f"{name} has another height in trees.gpkg")


def check_catalogue(text, rows):
    expect(not re.search(r"(src|href)\s*=\s*[\"']?(https?:)?//", text), "the catalogue wants the network")
    data, _ = json.JSONDecoder().raw_decode(text[text.index("const data = ") + 13 :])
    expect([tree["id"] for tree in data["trees"]] == [row["id"] for row in rows], "the catalogue has other trees")
    for tree in data["trees"]:
        has = (tree["picture"] or "").startswith("data:image/jpeg;base64,")
        expect(has == (tree["code"] == 0), f"{tree['id']}: picture {has}")


def check_models(out):
    models = out / "models"
    pictures = {re.sub(r"_[0-9a-f]{12}\.", ".", path.name) for path in (models / "textures").iterdir()}
    count = len(list(models.glob("*.glb")))
    expect(count == 8, f"{count} models")
    expect(len(list(models.glob("*.txt"))) == 8, "not each model has its skeleton")
    expect(len(list((models / "textures").iterdir())) < 5 * count, f"each tree has pictures of its own: {pictures}")
    expect((models / ".gdignore").exists(), "the engine would import every model")


def check_scenes(out):
    """Each tree is baked, and weighs little, since what all of a kind have in common is there once."""
    scenes = sorted((out / "trees").iterdir())
    expect([path.suffix for path in scenes] == [".scn", ".tscn"] * 8, f"trees/ holds {[path.name for path in scenes]}")
    largest = max(path.stat().st_size for path in scenes)
    expect(largest < 2_000_000, f"a tree has {largest} bytes")
    kinds = {}
    for path in (out / "shared").iterdir():
        kind = re.sub(r"_[0-9a-f]{12}\.", ".", path.name)
        kinds[kind] = kinds.get(kind, 0) + 1
    expect(kinds.pop("card.tres", 0) <= 8, f"each tree has leaf cards of its own: {kinds}")
    expect(max(kinds.values()) == 1, f"of one kind of trees something is there twice: {kinds}")
    expect({"generic_bark.tres", "generic_leaf.tres", "baked_tree.gd"} < set(kinds), f"shared/ holds {sorted(kinds)}")


def main(out):
    with open(out / "trees.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    check_places(check_rows(rows))
    check_package(out / "trees.gpkg", rows)
    check_catalogue((out / "catalogue.html").read_text(encoding="utf-8"), rows)
    check_models(out)
    check_scenes(out)
    print("\n".join(wrong))
    return bool(wrong)


sys.exit(main(Path(sys.argv[1])))
