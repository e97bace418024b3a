"""How often a diagnosis raises an alarm where a simulation in MuJoCo is right: joints of random size whose armature, Coulomb and viscous
friction the simulation has, recorded with five kinds of noise.

    alarms.py TRAINER [--pairs N] [--seed S] [--keep FOLDER]

Without --seed every run draws joints that no run has seen.
"""

import argparse
import json
import random
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from joints import LOG_EVERY, PAIRS, STEP, law, real, simulate, with_attributes
from mujoco_pair import joint_toml

SECONDS = 30
NOISES = ("white", "coloured", "coarse encoder", "heavy tails", "grows with torque")


def drawn(rng):
    """A joint whose friction is Coulomb and viscous alone, and its true attributes."""
    pair = PAIRS[rng.choice(sorted(PAIRS))]
    truth = {name: value * rng.uniform(0.5, 2.0) for name, value in pair.truth.items()}
    smoothing = 0.001 if pair.linear else 0.002
    friction = law(truth["frictionloss"], 0.0, 1.0, truth["damping"], smoothing)
    return replace(pair, truth=truth, friction=lambda: lambda q, v, dt: friction(v))


def measured(rows, kind, noise, rng):
    """Rows as a drive logs them: position, velocity and torque with a kind of noise."""
    rows = rows.copy()
    draws = rng.standard_normal(len(rows))
    if kind == "coloured":
        for i in range(1, len(draws)):
            draws[i] = 0.9 * draws[i - 1] + np.sqrt(1.0 - 0.9**2) * draws[i]
    if kind == "heavy tails":
        draws = rng.standard_t(3, len(rows)) / np.sqrt(3.0)
    if kind == "grows with torque":
        draws *= 0.5 + np.abs(rows[:, 3]) / np.sqrt(np.mean(rows[:, 3] ** 2))
    if kind == "coarse encoder":
        step = np.ptp(rows[:, 1]) / 2**13
        rows[:, 1] = np.floor(rows[:, 1] / step) * step
        rows[:, 2] = np.gradient(rows[:, 1], rows[:, 0])
    rows[:, 3] += noise * draws
    return rows


def diagnosed(trainer, seed, keep):
    """The noise of a pair, the joint, and what the diagnosis says of it."""
    rng = random.Random(seed)
    pair, kind = drawn(rng), NOISES[seed % len(NOISES)]
    with tempfile.TemporaryDirectory() as temporary:
        folder = keep / str(seed) if keep else Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "joint.toml").write_text(joint_toml(pair))
        simulation = simulate(pair, with_attributes(pair, pair.truth), seed, SECONDS)[::LOG_EVERY]
        recording = real(pair, seed, SECONDS)[::LOG_EVERY]
        noise = rng.uniform(0.005, 0.05) * np.sqrt(np.mean(recording[:, 3] ** 2))
        header = ",".join(("time_s",) + pair.columns)
        for name, rows in (("real", measured(recording, kind, noise, np.random.default_rng(seed))), ("simulated", simulation)):
            np.savetxt(folder / f"{name}.csv", rows, delimiter=",", header=header, comments="", fmt="%.9g")
        files = "real.csv --simulation simulated.csv --joint joint.toml --json told.json --quiet".split()
        done = subprocess.run([trainer, "diagnose", *files], cwd=folder, capture_output=True, text=True, check=False)
        told = json.loads((folder / "told.json").read_text()) if (folder / "told.json").exists() else {}
    names = [finding["effect"] for finding in told.get("findings", [])]
    held_out = (told.get("fit") or {}).get("held_out") or {}
    return {"seed": seed, "noise": kind, "joint": pair.name, "exit": done.returncode, "names": names, "ratio": held_out.get("ratio")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trainer", type=lambda path: str(Path(path).resolve()))
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6))
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    print(f"seeds {arguments.seed} to {arguments.seed + arguments.pairs - 1}, {SECONDS} s at {1 / (STEP * LOG_EVERY):.0f} Hz")
    seeds = range(arguments.seed, arguments.seed + arguments.pairs)
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda seed: diagnosed(arguments.trainer, seed, arguments.keep), seeds))
    for noise in NOISES:
        of_noise = [result for result in results if result["noise"] == noise]
        alarms = [result for result in of_noise if result["exit"] != 0]
        print(f"{noise:20} {len(alarms)} of {len(of_noise)}")
        for result in alarms:
            print(f"    {result}")
    print(f"alarms: {sum(result['exit'] != 0 for result in results)} of {len(results)}")


if __name__ == "__main__":
    main()
