"""A pair of simulation and recording, made from its seed alone."""

import math
from dataclasses import dataclass

import numpy as np

from . import in_drake, in_mujoco
from .drive import Log, random_motion, run
from .effects import EFFECTS
from .joint import Plant, random_joint
from .noise import KINDS, recorded

# Each has the name of its page, whether its Coulomb friction can be a soft constraint, and the mechanism that `run` drives.
SIMULATORS = {"mujoco": in_mujoco, "drake": in_drake}

# Root mean square of the effect as a share of the friction: above the default of `--least-effect`.
LEAST_SHARE, LARGEST_SHARE = 0.04, 0.10
# Runs in which the size of the effect is sought, and the factor from the share that is accepted.
SIZE_RUNS, SIZE_FACTOR = 12, 1.25
HEADER = "time_s,position_rad,velocity_rad_s,torque_Nm"


@dataclass
class Case:
    """What a pair was made of."""

    seed: int
    effect: str  # of `EFFECTS`, or "none"
    ratio: float  # effect over noise, root mean square; 0 without an effect
    noise: str
    simulator: str = "mujoco"  # of `SIMULATORS`


class Bench:
    """Random joint of a case and its runs in the simulator of the case."""

    def __init__(self, case, rng):
        self.simulator = SIMULATORS[case.simulator]
        self.joint = random_joint(rng, self.simulator.HAS_SOFT_CONSTRAINT)

    def simulated(self, motion):
        return run(self.simulator.Mechanism(self.joint, Plant(), real=False), self.joint, Plant(), motion)

    def recorded(self, motion, plant=Plant()):
        return run(self.simulator.Mechanism(self.joint, plant, real=True), self.joint, plant, motion)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def beside_friction(log):
    """Root mean square of the effect that no other Coulomb level, viscosity and offset makes up for."""
    columns = np.column_stack((np.tanh(log.velocity / (0.01 * np.abs(log.velocity).max())), log.velocity, np.ones_like(log.velocity)))
    return rms(log.effect - columns @ np.linalg.lstsq(columns, log.effect, rcond=None)[0])


def sized(bench, motion, shape, share):
    """The log of the plant whose effect has about that share of the friction, and the size: bisection of its logarithm once it is bracketed."""
    size, low, high = 1.0, 0.0, math.inf
    for _ in range(SIZE_RUNS):
        log = bench.recorded(motion, shape(size))
        found = rms(log.effect) / rms(log.friction)
        if share / SIZE_FACTOR < found < share * SIZE_FACTOR:
            break
        low, high = (size, high) if found < share else (low, size)
        bracketed = low > 0 and high < math.inf
        size = math.sqrt(low * high) if bracketed else size * min(max((share / max(found, 1e-9)) ** 0.8, 0.1), 5.0)
    return log, size


def make(case):
    """Simulation, recording (rows of `HEADER`), text of joint.toml and what describes the pair."""
    rng = np.random.default_rng(case.seed)
    bench, seconds = Bench(case, rng), rng.uniform(20.0, 30.0)
    joint, motion = bench.joint, random_motion(rng, seconds)
    simulation = bench.simulated(motion)
    told = {**vars(case), "seconds": seconds, "joint": vars(joint)}
    if case.effect == "none":
        log = bench.recorded(motion)
        level = float(np.exp(rng.uniform(np.log(0.02), np.log(0.3)))) * rms(log.friction)
    else:
        effect = EFFECTS[case.effect]
        shape, share = effect.plant(joint, motion, rng), effect.share * rng.uniform(LEAST_SHARE, LARGEST_SHARE)
        if effect.sized:
            log, told["size"] = sized(bench, motion, shape, share)
        else:
            log = bench.recorded(motion, shape(1.0))
        level = rms(log.effect) / case.ratio
        told |= {"names": list(effect.names), "beside": list(effect.beside), "effect_Nm": rms(log.effect), "beside_friction_Nm": beside_friction(log)}
    rows, noise = recorded(log, case.noise, level, rng)
    told |= {"noise_Nm": level, "friction_Nm": rms(log.friction), "torque_Nm": rms(log.torque), **noise}
    return as_rows(simulation), rows, joint_toml(joint), told


def model_case(case):
    """A simulated recording to fit a model to, a healthy recording of another motion, text of joint.toml and what describes the pair. Every other two pairs
    have no rigid body in joint.toml: it is fitted too."""
    rng = np.random.default_rng(case.seed)
    bench, seconds = Bench(case, rng), float(np.exp(rng.uniform(np.log(12.0), np.log(120.0))))
    fitted, other = (bench.recorded(random_motion(rng, length)) for length in (seconds, rng.uniform(20.0, 30.0)))
    level = float(np.exp(rng.uniform(np.log(0.02), np.log(0.3)))) * rms(fitted.friction)
    training, _ = recorded(fitted, KINDS[rng.integers(len(KINDS))], level, rng)
    rows, noise = recorded(other, case.noise, level, rng)
    # Two by two, since simulators alternate one by one.
    given = case.seed // 6 % 2 == 0
    told = {**vars(case), "rigid_body": "given" if given else "fitted", "fitted_s": seconds, "joint": vars(bench.joint), "noise_Nm": level, "friction_Nm": rms(other.friction), **noise}
    return training, rows, joint_toml(bench.joint, given), told


def as_rows(log: Log):
    return np.column_stack((log.time, log.position, log.velocity, log.torque))


def joint_toml(joint, given=True):
    body = f"""
[rigid_body]
inertia_kgm2 = {joint.inertia_kgm2}
gravity_torque_Nm = {joint.gravity_torque_Nm}
gravity_phase_rad = {joint.phase_rad}
"""
    return f"""name = "joint"
{body if given else ""}
[drive]
rate_Hz = 250.0
"""
