"""The schemas of docs/schemas are those of what the program writes; the commands that no other test calls are called here."""

import json
import re

import jsonschema
import pytest
from command_line import FIXTURES, ROOT, SCHEMAS, conforms, trainer


def test_every_result_of_the_source_has_a_schema_and_every_schema_a_result():
    sources = "".join(path.read_text() for path in (ROOT / "trainer/src").rglob("*.rs"))
    named = set(re.findall(r'"frikan\.(\w+)/1"', sources))
    assert named == {path.stem for path in SCHEMAS.glob("*.json")}


@pytest.mark.parametrize("path", sorted(SCHEMAS.glob("*.json")), ids=lambda path: path.stem)
def test_a_schema_is_one_and_refuses_another_result(path):
    schema = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"schema": "frikan.other/1"}, schema)


@pytest.mark.parametrize(
    "line, name",
    [
        (f"show {FIXTURES}/elbow.frk --json -", "image"),
        (f"show {FIXTURES}/stribeck.frk --json -", "image"),
        (f"verify {FIXTURES}/elbow.frk --json", "verify"),
        (f"loop {FIXTURES}/elbow.toml --image {FIXTURES}/elbow.frk --duration 2 --quiet --json", "loop"),
        (f"simulate {FIXTURES}/elbow.toml --effect presliding=1 --duration 2 -o r.csv --quiet --json -", "simulate"),
        (f"diagnose {FIXTURES}/elbow.csv --simulation {FIXTURES}/elbow-test.csv --quiet --json -", "diagnose"),
        (f"fit {FIXTURES}/stribeck.csv --target cortex-m0plus -o m.frk --quiet --json -", "fit"),
    ],
)
def test_a_result_is_as_its_schema_says(tmp_path, line, name):
    assert conforms(json.loads(trainer(tmp_path, line))) == name


def test_a_fleet_is_as_its_schemas_say(tmp_path):
    (tmp_path / "recordings").mkdir()
    rows = [f"{v / 50},{(1 if v > 0 else -1) * 2 + 0.6 * v / 50 + 0.01 * (v % 7)}" for v in range(-50, 50)]
    for name in ("a", "b", "torn"):
        body = rows[:1] if name == "torn" else rows
        text = "\n".join(["velocity_rad_s,friction_torque_Nm", *body])
        (tmp_path / f"recordings/{name}.csv").write_text(text + "\n")
    trainer(tmp_path, "plan recordings -o tasks.jsonl --quiet")
    trainer(tmp_path, "run --tasks tasks.jsonl --index 0")
    trainer(tmp_path, "run --tasks tasks.jsonl --index 1")
    with pytest.raises(AssertionError, match="FRK-D002"):
        trainer(tmp_path, "run --tasks tasks.jsonl --index 2")
    trainer(tmp_path, "gather --tasks tasks.jsonl -o table --quiet")
    written = {conforms(json.loads(path.read_text())) for path in tmp_path.rglob("*.json")}
    assert written == {"result", "fleet"}
