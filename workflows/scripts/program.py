"""Runs treerec, and says how it ended."""
import subprocess
import tempfile
from pathlib import Path

import convert


def run(words, seconds):
    """(exit code, sentence): 0 and nothing, or what was wrong."""
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return 124, f"It took more than {seconds} s and was given up."
    if done.returncode == 0:
        return 0, ""
    if done.returncode < 0:
        return done.returncode, f"treerec was ended by signal {-done.returncode}."
    lines = [line for line in done.stderr.splitlines() if line and not line.startswith(("Warning:", "usage:"))]
    return done.returncode, lines[-1] if lines else "treerec ended without a word."


def run_on(scan, before, after, seconds):
    """The same with the scan, or what is made of it, between the words. The sentence calls it by its name alone."""
    if not convert.needs(scan):
        code, sentence = run([*before, scan, *after], seconds)
        return code, sentence.replace(str(scan), Path(scan).name)
    with tempfile.TemporaryDirectory(dir=".") as folder:
        las = Path(folder) / (Path(scan).stem + ".las")
        try:
            convert.to_las(scan, las)
        except ValueError as error:
            return 1, str(error).replace(str(scan), Path(scan).name)
        code, sentence = run([*before, str(las), *after], seconds)
        return code, sentence.replace(str(las), Path(scan).name)
