"""A pair as files, what `trainer` answers to it, and whether that is right."""

import json
import resource
import shlex
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from .pair import REFERENCES

# Processor time of one command: a busy machine changes no answer.
TRAINER_LIMIT_S = 300


def write(folder, reference, recording, toml, truth):
    """The files of a pair; the truth comes last, so that a pair that has it is complete."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, columns in ((REFERENCES[truth["reference"]], reference), ("real.csv", recording)):
        if name:
            np.savetxt(folder / name, np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="", fmt="%.9g")
    (folder / "joint.toml").write_text(toml)
    (folder / "truth.json").write_text(json.dumps(truth, indent=1, default=float) + "\n")


class Trainer:
    """One program with what is added to every diagnosis, in a folder of its own: pairs are only read."""

    def __init__(self, binary, extra, scratch):
        self.binary, self.extra, self.scratch = str(binary), shlex.split(extra), Path(scratch)

    def run(self, *words):
        command = [self.binary, *map(str, words), "--quiet"]
        return subprocess.run(command, cwd=self.scratch, capture_output=True, text=True, preexec_fn=limited)

    def ask(self, folder, reference):
        """Exit status, JSON and processor time of the diagnosis; behind a model, of one fitted to the other recording."""
        joint, compared = ("--joint", folder / "joint.toml"), ()
        if reference == "model":
            fitted = self.run("fit", folder / REFERENCES[reference], *joint, "-o", "model.frk")
            if fitted.returncode not in (0, 4):
                return {"status": fitted.returncode, "error": "fit: " + fitted.stderr.strip()}
            compared = ("--model", "model.frk")
        elif REFERENCES[reference]:
            compared = ("--simulation", folder / REFERENCES[reference])
        before = processor_seconds()
        told = self.run("diagnose", folder / "real.csv", *compared, *joint, "--json", "answer.json", "-o", "improved.frk", *self.extra)
        answer, cost = self.scratch / "answer.json", processor_seconds() - before
        if told.returncode not in (0, 1) and not answer.exists():
            return {"status": told.returncode, "error": told.stderr.strip(), "processor_s": cost}
        return {"status": told.returncode, "processor_s": cost, **summary(json.loads(answer.read_text()))}


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (TRAINER_LIMIT_S, TRAINER_LIMIT_S))


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


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


def score(folder, binary, extra):
    """The truth about a pair that was written, the answer to it, and the judgement."""
    told = json.loads((folder / "truth.json").read_text())
    with tempfile.TemporaryDirectory() as scratch:
        answer = Trainer(binary, extra, scratch).ask(folder.resolve(), told["reference"])
    return {"pair": folder.name, **told, **answer, **judge(told, answer)}
