"""What `trainer` answers to a pair, and whether it is right."""

import json
import subprocess
from pathlib import Path

import numpy as np

from .pair import HEADER

TRAINER_LIMIT_S = 300


def write(folder, pair):
    """The files of a pair, as `diagnose` takes them."""
    reference, recording, toml, told = pair
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in (("reference.csv", reference), ("real.csv", recording)):
        np.savetxt(folder / name, rows, delimiter=",", header=HEADER, comments="", fmt="%.9g")
    (folder / "joint.toml").write_text(toml)
    (folder / "pair.json").write_text(json.dumps(told, indent=1))


def trainer(binary, folder, *words):
    return subprocess.run([binary, *words, "--quiet"], cwd=folder, capture_output=True, text=True, timeout=TRAINER_LIMIT_S)


def ask(binary, folder, model):
    """Exit status and JSON of the diagnosis; with `model`, of a model fitted to the reference."""
    reference = ("--simulation", "reference.csv")
    if model:
        fitted = trainer(binary, folder, "fit", "reference.csv", "--joint", "joint.toml", "-o", "model.frk")
        if fitted.returncode not in (0, 4):
            return {"status": fitted.returncode, "error": "fit: " + fitted.stderr.strip()}
        reference = ("--model", "model.frk")
    run = trainer(binary, folder, "diagnose", "real.csv", *reference, "--joint", "joint.toml", "--json", "answer.json", "-o", "improved.frk")
    (folder / "told.txt").write_text(run.stdout + run.stderr)
    if run.returncode not in (0, 1) and not Path(folder, "answer.json").exists():
        return {"status": run.returncode, "error": run.stderr.strip()}
    return {"status": run.returncode, **summary(json.loads((folder / "answer.json").read_text()))}


def summary(answer):
    findings = [
        {
            "effect": finding["effect"],
            "probability": finding["probability"],
            "alternatives": {rival["effect"]: rival["probability"] for rival in finding["alternatives"]},
        }
        for finding in answer["findings"]
    ]
    held_out, sealed = answer["fit"].get("held_out"), answer.get("sealed")
    return {
        "verdict": answer["verdict"],
        "findings": findings,
        "health": [note for note in answer["health"] if note["blocking"] and note.get("effect")],
        "in_simulation": (answer.get("given") or {}).get("holds", []),
        "notes": [note["code"] for note in answer["health"]],
        "held_out": held_out and [held_out["ratio"], *held_out["ci95"]],
        "sealed": sealed and [sealed["ratio"], *(sealed["ci95"] or [])],
        "seconds": answer["seconds"],
    }


def named(answer):
    """Every fault of the measurement and every finding in the order told: its first name, and the set it is stated as."""
    findings = [(finding["effect"], {finding["effect"], *finding["alternatives"]}) for finding in answer.get("findings", [])]
    notes = [note["effect"] for note in answer.get("health", [])]
    return [(note, {note}) for note in dict.fromkeys(notes) if not any(note in names for _, names in findings)] + findings


def judge(told, answer):
    """Whether the pair is answered rightly: the first name, the first set, and the sets that miss the truth."""
    truth, beside = set(told.get("names", ())), set(told.get("beside", ()))
    counted = [(name, names) for name, names in named(answer) if names & truth or not names & beside]
    name, names = counted[0] if counted else (None, set())
    return {
        "alarm": answer["status"] != 0,
        "first": name in truth,
        "right": bool(names & truth),
        "anywhere": any(names & truth for _, names in counted),
        "size": len(names),
        "wrong": [[name, *sorted(names - {name})] for name, names in counted if not names & truth],
    }
