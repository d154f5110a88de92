"""Some scans into trees, one after the other. One that fails is a row with its sentence.

A tree that an earlier run has finished stays as it is: a row says of what scan, options and program it was made.
"""
import csv
import hashlib
import json
import os
import shutil
from pathlib import Path

import models
import pictures
import program
import rows


def key_of(scan, words, version):
    """What a tree depends on."""
    digest = hashlib.sha256(json.dumps([*words, version]).encode())
    with open(scan, "rb") as file:
        digest.update(hashlib.file_digest(file, "sha256").digest())
    return digest.hexdigest()


def plot_warnings(scan):
    """What there is to say of a tree that was cut out of a plot."""
    table = Path(scan).parent / "trees.csv"
    if not (Path(scan).parent / "plot.json").exists():
        return []
    with open(table, newline="", encoding="utf-8") as file:
        said = next(row["warnings"] for row in csv.DictReader(file) if row["file"] == Path(scan).name)
    return [f"In its plot: {said}."] if said else []


def frame_words(scan):
    """A plot's trees stand as the plot does."""
    plot = Path(scan).parent / "plot.json"
    if not plot.exists():
        return []
    frame = json.loads(plot.read_text(encoding="utf-8"))["frame"]
    return ["--one-tree", "--up", frame["up"], "--scale", repr(frame["metres_per_unit"])]


def words_of(scan, options):
    words = ["--leaves", str(options["leaves"]), "--levels", str(options["levels"]), "--seed", str(options["seed"])]
    return words + str(options["more"]).split() + frame_words(scan)


def row_of(name, scan, report):
    """The figures that do not change from run to run."""
    row = {"id": name, "scan": Path(scan).name, "code": 0, "error": ""}
    for figure in ("height_m", "dbh_m", "crown_radius_m", "volume_m3", "stems", "nodes", "triangles", "leaves"):
        row[figure] = report[figure]
    row["fidelity"] = report["fidelity"]["R_s"]
    row["explained"] = report["fidelity"]["explained"]
    row["leaf_kind"] = report["options"]["leaves"]
    row["warnings"] = plot_warnings(scan) + report["warnings"]
    row["frame"] = {"origin": report["origin"], "up": report["up"], "metres_per_unit": report["metres_per_unit"]}
    return row


def failed(name, scan, code, sentence):
    return {"id": name, "scan": Path(scan).name, "code": code, "error": sentence, "warnings": []}


def reconstruct(name, scan, treerec, words, threads, seconds):
    """The tree's row. Its files come into models/ when they are whole."""
    part = Path("work/parts") / name
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    model = part / f"{name}.glb"
    after = ["-o", str(model), "-o", str(part / f"{name}.txt"), "--report", str(part / "report.json")]
    after += ["--picture", str(part / "picture.png"), "--pictures-beside", "--quiet", "--threads", str(threads)]
    code, sentence = program.run_on(scan, [treerec, "reconstruct"], after + words, seconds)
    if code != 0:
        shutil.rmtree(part)
        return failed(name, scan, code, sentence)
    row = row_of(name, scan, json.loads((part / "report.json").read_text(encoding="utf-8")))
    Path("work/pictures").mkdir(exist_ok=True)
    pictures.take(part / "picture.png", Path("work/pictures") / f"{name}.jpg")
    Path("models").mkdir(exist_ok=True)
    # The engine is to leave what other programs read: it would import each.
    Path("models/.gdignore").touch()
    models.share(model, Path("models/textures"))
    for made in (part / f"{name}.txt", model):
        os.replace(made, Path("models") / made.name)
    shutil.rmtree(part)
    return row


def row_for(name, scan, job):
    words = words_of(scan, job.params.options)
    try:
        key = key_of(scan, words, job.params.program)
    except OSError as error:
        return failed(name, scan, 1, f"'{Path(scan).name}' cannot be read: {error.strerror}.")
    row = rows.kept("work/rows", name, key, [Path("models") / f"{name}.glb", Path("work/pictures") / f"{name}.jpg"])
    if row is None:
        row = reconstruct(name, scan, job.config["treerec"], words, job.threads, job.config["timeout"])
        rows.keep("work/rows", key, row)
    return row


def main(job):
    rows.write_job(job.output[0], [row_for(name, scan, job) for name, scan in job.params.trees])


main(snakemake)  # noqa: F821
