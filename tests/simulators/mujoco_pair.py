"""Logs a joint of MuJoCo and its simulation, or simulates a patched model; see tests/tests/simulators.

    mujoco_pair.py log PAIR FOLDER              writes model.xml, joint.toml, real.csv and simulated.csv
    mujoco_pair.py compare PAIR FOLDER MODEL... torque and position errors on a fresh motion, as JSON
"""

import contextlib
import json
import sys
from pathlib import Path

import mujoco

import sysid
from joints import best, errors, real, simulate, with_attributes, write
from pairs import PAIRS

SECONDS = 60
FRESH_SECONDS = 20
# Of the recorded and the fresh motion.
SEED, FRESH_SEED = 1, 2


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
    write(pair, real(pair, SEED, SECONDS), folder / "real.csv", pair.noise, SEED)
    simulation = simulate(pair, mujoco.MjModel.from_xml_string(pair.model), SEED, SECONDS)
    write(pair, simulation, folder / "simulated.csv", 0.0, SEED)


def compare(pair, folder, models):
    fresh = real(pair, FRESH_SEED, FRESH_SECONDS)
    with contextlib.redirect_stdout(sys.stderr):
        fitted = sysid.fitted(pair, folder / "real.csv", SEED)
    compared = {
        "true_attributes": with_attributes(pair, pair.truth),
        "true_model": best(pair, SEED, SECONDS),
        "sysid": with_attributes(pair, fitted),
        **{model: mujoco.MjModel.from_xml_path(str(folder / model)) for model in models},
    }
    result = {name: errors(fresh, simulate(pair, model, FRESH_SEED, FRESH_SECONDS)) for name, model in compared.items()}
    for name, model in compared.items():
        result[name]["controls"] = int(model.nu)
    result["sysid"]["fitted"] = {name: value.tolist() for name, value in fitted.items()}
    print(json.dumps(result))


if __name__ == "__main__":
    command, pair, folder, *models = sys.argv[1:]
    if command == "log":
        log(PAIRS[pair], Path(folder))
    else:
        compare(PAIRS[pair], Path(folder), models)
