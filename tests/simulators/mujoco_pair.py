"""Logs a joint of MuJoCo and its simulation, or simulates a patched model; see tests/tests/simulators.rs.

    mujoco_pair.py log PAIR FOLDER              writes model.xml, joint.toml, real.csv and simulated.csv
    mujoco_pair.py compare PAIR FOLDER MODEL... torque and position errors on a fresh motion, as JSON
"""

import json
import sys
from pathlib import Path

import mujoco

from joints import best, errors, real, simulate, with_attributes, write
from pairs import PAIRS

SECONDS = 60
FRESH_SECONDS = 20


def joint_toml(pair):
    position, velocity, torque = ("m", "m/s", "N") if pair.linear else ("rad", "rad/s", "Nm")
    actuator = "force" if pair.linear else "torque"
    columns = "".join(
        f'{quantity} = {{ name = "{name}", unit = "{unit}" }}\n'
        for quantity, name, unit in zip(("position", "velocity", actuator), pair.columns, (position, velocity, torque))
    )
    return f'name = "{pair.joint}"\n[columns]\n{columns}'


def log(pair, folder):
    (folder / "model.xml").write_text(pair.model)
    (folder / "joint.toml").write_text(joint_toml(pair))
    write(pair, real(pair, 1, SECONDS), folder / "real.csv", pair.noise, 1)
    simulation = simulate(pair, mujoco.MjModel.from_xml_string(pair.model), 1, SECONDS)
    write(pair, simulation, folder / "simulated.csv", 0.0, 1)


def compare(pair, models):
    fresh = real(pair, 2, FRESH_SECONDS)
    references = {"true_attributes": with_attributes(pair, pair.truth), "true_model": best(pair)}
    result = {name: errors(fresh, simulate(pair, model, 2, FRESH_SECONDS)) for name, model in references.items()}
    for path in models:
        model = mujoco.MjModel.from_xml_path(str(path))
        result[path.name] = errors(fresh, simulate(pair, model, 2, FRESH_SECONDS))
        result[path.name]["controls"] = int(model.nu)
    print(json.dumps(result))


if __name__ == "__main__":
    command, pair, folder, *models = sys.argv[1:]
    if command == "log":
        log(PAIRS[pair], Path(folder))
    else:
        compare(PAIRS[pair], [Path(folder) / model for model in models])
