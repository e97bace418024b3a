"""The same joint in other files: time steps, integrators and controllers; see tests/tests/simulators.

    mujoco_settings.py write PAIR FOLDER COUNT      writes setting-0.xml and so on, and prints how many
    mujoco_settings.py compare PAIR FOLDER COUNT    torque errors of true attributes, patched-I.xml and attributes-I.xml, and what patched-I.xml
                                                    says that it leaves of the identified joint beside what MuJoCo shows along the same
                                                    motion, with the friction of image.py (`trainer export --to python`)
"""

import importlib.util
import json
import math
import re
import sys
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from joints import errors, real, simulate, with_attributes
from pairs import PAIRS

SECONDS = 20
SEED = 2

# Time step (s), integrator, and bandwidth of the controller (rad/s): 55 is 1500 N m/rad on the elbow.
SETTINGS = (
    (0.0005, "implicitfast", 55.0),
    (0.002, "implicitfast", 20.0),
    (0.0002, "implicitfast", 55.0),
    (0.0005, "Euler", 20.0),
    (0.0005, "implicit", 20.0),
    (0.001, "RK4", 20.0),
    (0.001, "implicitfast", 55.0),
    (0.002, "Euler", 55.0),
    (0.005, "implicitfast", 20.0),
    (0.005, "Euler", 55.0),
)

DAMPING_RATIO = 0.7

# Frequency (Hz) and amplitude of the motions along which the exporter tries its forms, before they are scaled; factor of the frequency and
# phases of each; their length, s.
SINES = ((0.21, 0.8), (0.63, 0.3), (1.7, 0.08))
MOTIONS = ((1.0, (0.0, 0.0, 0.0)), (0.85, (1.9, 4.2, 0.7)), (1.15, (3.6, 1.1, 5.3)))
TRIAL_SECONDS = 10


def placed(pair, setting):
    """A pair in one of the settings."""
    step, integrator, bandwidth = setting
    true = with_attributes(pair, pair.truth)
    inertia = 1.0 / true.dof_invweight0[true.joint(pair.joint).dofadr[0]]
    gains = (inertia * bandwidth**2, 2 * DAMPING_RATIO * inertia * bandwidth)
    text = with_option(pair.model, step, integrator)
    if pair.gains is None:
        text = re.sub(r'kp="[^"]*" kv="[^"]*"', f'kp="{gains[0]}" kv="{gains[1]}"', text)
        return replace(pair, model=text, step=step)
    return replace(pair, model=text, step=step, gains=gains)


def with_option(model, step, integrator):
    return re.sub(r"<option [^>]*/>", f'<option timestep="{step}" integrator="{integrator}"/>', model)


def stated(text):
    """Gains of the controllers, and torques that are left, as a file says them."""
    number = r"([-+.e\d]+)"
    lines = re.findall(rf"of kp {number} and kv {number} gives {number} N", text)
    top = re.search(rf"along sines up to {number}", text)
    return float(top[1]), [tuple(map(float, line)) for line in lines]


def identified(folder):
    """Friction of the exported image."""
    spec = importlib.util.spec_from_file_location("image", folder / "image.py")
    image = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(image)
    step = image.Friction.step.__code__
    names = step.co_varnames[2 : step.co_argcount]

    def friction():
        own = image.Friction()
        return lambda q, v, transmitted, dt: own.step(dt, *({"velocity": v, "position": q}.get(name, 0.0) for name in names))

    return friction


def commanded(pair, top, motion):
    """Positions and velocities of one of the motions, other joints at rest."""
    factor, phases = motion
    time = np.arange(round(TRIAL_SECONDS / pair.step)) * pair.step
    omegas = [2 * math.pi * factor * frequency for frequency, _ in SINES]
    scale = top / sum(omega * amplitude for omega, (_, amplitude) in zip(omegas, SINES))
    position, velocity = np.zeros_like(time), np.zeros_like(time)
    for omega, (_, amplitude), phase in zip(omegas, SINES, phases):
        position += scale * amplitude * np.sin(omega * time + phase)
        velocity += scale * amplitude * omega * np.cos(omega * time + phase)
    rest = np.zeros_like(time)
    return [(position, velocity), *((rest, rest) for _ in pair.others)]


def trial(pair, model, text, folder):
    """What a file says that it leaves, and what MuJoCo shows of it, for each controller of the file."""
    top, lines = stated(text)
    truth = {"armature": float(model.dof_armature[model.joint(pair.joint).dofadr[0]])}
    shown = []
    for kp, kv, left in lines:
        driven = replace(pair, gains=(kp, kv)) if pair.gains else pair
        joint = replace(driven, truth=truth, friction=identified(folder))
        squares = []
        for motion in MOTIONS:
            commands = commanded(pair, top, motion)
            wanted = real(joint, SEED, TRIAL_SECONDS, commands)
            found = simulate(driven, model, SEED, TRIAL_SECONDS, commands=commands)
            squares.append(errors(wanted, found)["torque"] ** 2)
        shown.append([left, float(np.sqrt(np.mean(squares)))])
    return shown


def compare(pair, setting, folder, index):
    pair = placed(pair, setting)
    fresh = real(pair, SEED, SECONDS)
    torque = lambda model: errors(fresh, simulate(pair, model, SEED, SECONDS))["torque"]
    files = [folder / f"{name}-{index}.xml" for name in ("patched", "attributes")]
    models = [mujoco.MjModel.from_xml_path(str(file)) for file in files]
    return {
        "setting": setting,
        "true_attributes": torque(with_attributes(pair, pair.truth)),
        "patched": torque(models[0]),
        "attributes": torque(models[1]),
        "stated": trial(pair, models[0], files[0].read_text(), folder),
    }


def main():
    command, name, folder, count = sys.argv[1:]
    pair, folder, settings = PAIRS[name], Path(folder), SETTINGS[: int(count)]
    if command == "compare":
        print(json.dumps([compare(pair, setting, folder, index) for index, setting in enumerate(settings)]))
        return
    for index, setting in enumerate(settings):
        (folder / f"setting-{index}.xml").write_text(placed(pair, setting).model)
    print(len(settings))


if __name__ == "__main__":
    main()
