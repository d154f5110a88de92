"""A job's trees into scenes of the engine, with levels of detail: by an engine without a window.

A tree that ends the engine, or takes it too long, is a row with a sentence, and another engine goes on behind it.
"""
import hashlib
import json
import os
import signal
import subprocess
import tempfile
import threading
from pathlib import Path

import rows

SCRIPT = Path(__file__).parent.parent / "engine" / "bake.gd"
ENDINGS = (".tscn", ".scn")  # what a tree is
START = 60  # seconds that an engine may take to start


def skeleton_of(name):
    return Path("models") / f"{name}.txt"


def key_of(tree, options, version):
    digest = hashlib.sha256(json.dumps([tree["leaf_kind"], options, version], sort_keys=True).encode())
    digest.update(skeleton_of(tree["id"]).read_bytes())
    return digest.hexdigest()


def failed(name, code, sentence):
    return {"id": name, "code": code, "error": sentence, "triangles": [], "shared": []}


class Engine:
    """An engine at work on some trees. It is ended when a tree takes too long."""

    def __init__(self, job, trees):
        options = job.params.options
        out = Path("trees").resolve()
        out.mkdir(exist_ok=True)
        work = {"out": str(out), "shared": str(Path("shared").resolve()), "levels": options["scene_levels"]}
        work["trees"] = [
            {
                "id": tree["id"],
                "skeleton": str(skeleton_of(tree["id"]).resolve()),
                "leaves": tree["leaf_kind"],
                "seed": options["seed"],
            }
            for tree in trees
        ]
        self.seconds = job.config["timeout"]
        self.folder = tempfile.TemporaryDirectory(dir="work")
        path = Path(self.folder.name).resolve() / "job.json"
        path.write_text(json.dumps(work), encoding="utf-8")
        words = [job.config["godot"], "--headless", "--path", job.config["project"], "--script", str(SCRIPT)]
        self.errors = open(Path(self.folder.name) / "errors.txt", "w+", encoding="utf-8", errors="replace")
        # A group of its own: an engine may be a script that starts one.
        self.process = subprocess.Popen(
            [*words, "--", str(path)],
            stdout=subprocess.PIPE,
            stderr=self.errors,
            text=True,
            errors="replace",
            start_new_session=True,
        )
        self.gave_up = False
        self.timer = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.wait_for(None)
        self.kill()
        self.process.stdout.close()
        self.process.wait()
        self.errors.close()
        self.folder.cleanup()

    def kill(self):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def give_up(self):
        self.gave_up = True
        self.kill()

    def wait_for(self, seconds):
        if self.timer is not None:
            self.timer.cancel()
        self.timer = None
        if seconds is not None:
            self.timer = threading.Timer(seconds, self.give_up)
            self.timer.daemon = True
            self.timer.start()

    def said(self):
        self.errors.flush()
        self.errors.seek(0)
        lines = [line.strip() for line in self.errors.read().splitlines()]
        return next((line for line in lines if line.startswith(("ERROR: ", "SCRIPT ERROR: "))), "")

    def rows(self):
        """Yields the rows of trees in their order, up to one that ended the engine."""
        current = None
        self.wait_for(START + self.seconds)
        for line in self.process.stdout:
            if line.startswith("BEGIN "):
                current = line[6:].strip()
                self.wait_for(self.seconds)
            elif line.startswith("DONE "):
                current = None
                yield json.loads(line[5:])
        code = self.process.wait()
        self.wait_for(None)
        if current is None and code == 0:
            return
        if current is None:
            raise SystemExit(f"The engine ended with {code} and without a tree. {self.said()}")
        if self.gave_up:
            yield failed(current, 124, f"Baking took more than {self.seconds} s and was given up.")
        else:
            yield failed(current, code if code != 0 else -1, f"The engine ended ({code}) while it baked this tree.")


def main(job):
    trees = [row for row in rows.read_job(job.input[0]) if row["code"] == 0]
    keys = {tree["id"]: key_of(tree, job.params.options, job.params.program) for tree in trees}
    done = {}
    for tree in trees:
        name = tree["id"]
        row = rows.kept("work/baked", name, keys[name], [Path("trees") / f"{name}{ending}" for ending in ENDINGS])
        if row is not None:
            done[name] = row
    left = [tree for tree in trees if tree["id"] not in done]
    while left:
        before = len(left)
        with Engine(job, left) as engine:
            for row in engine.rows():
                rows.keep("work/baked", keys[row["id"]], row)
                done[row["id"]] = row
        left = [tree for tree in left if tree["id"] not in done]
        if len(left) == before:
            raise SystemExit("The engine ended and had baked no tree.")
    rows.write_job(job.output[0], [done[tree["id"]] for tree in trees])


main(snakemake)  # noqa: F821
