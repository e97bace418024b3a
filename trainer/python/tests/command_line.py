"""The command line as a user calls it, every JSON that it writes held against its published schema."""

import json
import os
import pathlib
import subprocess

import jsonschema

ROOT = pathlib.Path(__file__).parents[3]
FIXTURES = ROOT / "fixtures"
SCHEMAS = ROOT / "docs/schemas"
TRAINER = os.environ.get("FRIKAN_TRAINER", str(ROOT / "target/debug/trainer"))


def trainer(folder, line):
    """Standard output of `trainer` with a line of words in a folder."""
    done = subprocess.run([TRAINER, *line.split()], cwd=folder, capture_output=True, text=True)
    assert done.returncode <= 1, done.stderr
    for path in folder.rglob("*.json"):
        conforms(json.loads(path.read_text()))
    return done.stdout


def conforms(said):
    """Holds a result against the schema that it names, and returns that one's name."""
    name = said["schema"].removeprefix("frikan.").removesuffix("/1")
    schema = json.loads((SCHEMAS / f"{name}.json").read_text())
    jsonschema.validate(said, schema, cls=jsonschema.Draft202012Validator)
    return name
