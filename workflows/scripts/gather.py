"""All rows into the catalogue, the tables and the scene."""
import csv
import json
import os
from pathlib import Path

import catalogue
import geopackage
import rows as kept_rows
import scene

COLUMNS = [
    ("id", "TEXT"),
    ("scan", "TEXT"),
    ("plot", "TEXT"),
    ("x", "REAL"),
    ("y", "REAL"),
    ("z", "REAL"),
    ("height_m", "REAL"),
    ("dbh_m", "REAL"),
    ("crown_radius_m", "REAL"),
    ("volume_m3", "REAL"),
    ("fidelity", "REAL"),
    ("explained", "REAL"),
    ("leaf_kind", "TEXT"),
    ("nodes", "INTEGER"),
    ("triangles", "INTEGER"),
    ("leaves", "INTEGER"),
    ("code", "INTEGER"),
    ("error", "TEXT"),
    ("warnings", "TEXT"),
]
DECIMALS = {"x": 3, "y": 3, "z": 3, "volume_m3": 5}


def read_rows(batches, plots):
    """Every tree's row, and one for each plot that could not be split."""
    rows = []
    for path in batches:
        plot = Path(path).stem.rsplit("-", 1)[0]
        for row in kept_rows.read_job(path):
            if plot in plots:
                row["plot"] = plot
            rows.append(row)
    for plot, status in plots.items():
        if status["code"] != 0:
            rows.append({"id": plot, "scan": status["scan"], "plot": plot, **{k: status[k] for k in ("code", "error")}})
    return sorted(rows, key=lambda row: row["id"])


def values_of(row):
    """In the order of COLUMNS."""
    known = dict(row)
    known.update(zip("xyz", row["frame"]["origin"] if "frame" in row else (None,) * 3))
    known["warnings"] = " ".join(row.get("warnings", []))
    values = [known.get(name) for name, _ in COLUMNS]
    return [
        round(value, DECIMALS.get(name, 4)) if isinstance(value, float) else value
        for value, (name, _) in zip(values, COLUMNS)
    ]


def write_table(path, rows):
    part = Path(f"{path}.part")
    with open(part, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([name for name, _ in COLUMNS])
        table.writerows([["" if value is None else value for value in values_of(row)] for row in rows])
    os.replace(part, path)


def read_baked(bakes):
    """{tree's id: its row}."""
    return {row["id"]: row for path in bakes for row in kept_rows.read_job(path)}


def warn_of(made, baked):
    """A tree that could not be baked is there, but not in the scene."""
    for row in made:
        if baked[row["id"]]["code"] != 0:
            row["warnings"] = [*row["warnings"], f"It is not in the scene: {baked[row['id']]['error']}"]


def main(job):
    plots = {Path(path).parent.name: json.loads(Path(path).read_text(encoding="utf-8")) for path in job.input.plots}
    rows = read_rows(job.input.batches, plots)
    made = [row for row in rows if row["code"] == 0]
    baked = read_baked(job.input.bakes) if job.config["godot"] else None
    if baked is not None:
        warn_of(made, baked)
    write_table("trees.csv", rows)
    # The engine takes tables for translations otherwise.
    Path("trees.csv.import").write_text('[remap]\n\nimporter="keep"\n', encoding="utf-8")
    places = [(row["frame"]["origin"] if "frame" in row else None, values_of(row)) for row in rows]
    geopackage.write("trees.gpkg", COLUMNS, places, int(job.params.epsg))
    standing = scene.write(made, list(plots), job.params.title, baked)
    trees = [dict(zip([name for name, _ in COLUMNS], values_of(row))) for row in rows]
    catalogue.write("catalogue.html", trees, standing, job.params.title)


main(snakemake)  # noqa: F821
