"""Rows of a job, one file each, that say what a tree was made of: who is stopped goes on from there."""
import json
import os
from pathlib import Path


def write_whole(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)


def keep(folder, key, row):
    write_whole(Path(folder) / f"{row['id']}.json", json.dumps({"key": key, "row": row}, indent=1) + "\n")


def kept(folder, name, key, made):
    """The row of an earlier run, if that made the same of the same and its files are there. What ended by a signal or
    for want of time may do better next time."""
    path = Path(folder) / f"{name}.json"
    if not path.exists():
        return None
    known = json.loads(path.read_text(encoding="utf-8"))
    row = known["row"]
    if known["key"] != key or not (row["code"] == 1 or (row["code"] == 0 and all(file.exists() for file in made))):
        return None
    return row


def write_job(path, rows):
    write_whole(Path(path), json.dumps(rows, indent=1) + "\n")


def read_job(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))
