"""A plot into trees; status.json says which, or why there are none."""
import csv
import json
from pathlib import Path

import program


def split(treerec, plot, folder, options, threads, seconds):
    after = [str(folder / "trees"), "--quiet", "--threads", str(threads)]
    after += ["--tile", str(options["tile"]), "--least-height", str(options["least_height"])]
    code, sentence = program.run_on(plot, [treerec, "split"], after, seconds)
    trees = []
    if code == 0:
        with open(folder / "trees" / "trees.csv", newline="", encoding="utf-8") as table:
            trees = [row["id"] for row in csv.DictReader(table)]
    return {"scan": Path(plot).name, "code": code, "error": sentence, "trees": trees}


def main(job):
    status = Path(job.output[0])
    treerec, seconds = job.config["treerec"], job.config["timeout"]
    done = split(treerec, job.input[0], status.parent, job.params.options, job.threads, seconds)
    status.write_text(json.dumps(done, indent=1) + "\n", encoding="utf-8")


main(snakemake)  # noqa: F821
