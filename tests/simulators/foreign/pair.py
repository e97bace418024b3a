"""A pair of reference and recording, made from its seed alone."""

import math
from dataclasses import asdict, dataclass, replace

import numpy as np

from . import drive, in_drake, in_mujoco, motion, servo
from .drive import run, smooth
from .effects import EFFECTS, of_reference
from .joint import Plant, random_joint
from .motion import CONTROL_PERIOD_S, random_motion
from .noise import KINDS, recorded, recorded_by_servo

# Each has the name of its page, whether its Coulomb friction can be a soft constraint, and the mechanism that `run` drives.
SIMULATORS = {"mujoco": in_mujoco, "drake": in_drake}
# What a recording is compared with: a simulation that was refitted to it, a model fitted to another recording, nothing; of a servo, which reports
# no torque, such a simulation.
REFERENCES = {"simulation": "simulation.csv", "model": "model.csv", "alone": None, "servo": "simulation.csv"}
RATES_HZ, SERVO_RATES_HZ = (250, 1000), (200, 250, 500)
# Root mean square of the effect over that of the noise.
RATIOS = (1.0, 0.2)
# By how much less an encoder is off, in torque by the gain of the position error, than what measures a torque.
SERVO_FINER = 5.0
SHORTEST_S, LONGEST_S = 20.0, 90.0

# Root mean square of what the reference cannot have of the effect, as a share of the friction: above the default of `--least-effect`.
LEAST_SHARE, LARGEST_SHARE = 0.04, 0.10
# Runs in which the size of the effect is sought.
SIZE_RUNS = 12
# Of the noise of healthy recordings, as a share of the friction.
LEAST_NOISE, LARGEST_NOISE = 0.02, 0.3
# What is left at least of a parameter that is refitted.
LEAST_LEFT = 0.02


@dataclass
class Case:
    """What a pair is made of."""

    seed: tuple  # of the set, index of the reference, number of the pair
    reference: str  # of `REFERENCES`
    effect: str  # of `EFFECTS`, or "none"
    ratio: float  # effect over noise, root mean square; 0 without an effect
    noise: str
    simulator: str
    motion: str
    rate_Hz: int
    body: str  # "given" in joint.toml, or "free"
    actuator: str = "torque"  # that is logged, or a kind of servo


def case(seed, reference, number):
    """The case of a number, whatever else is asked for. Every choice is balanced by itself, in blocks in which each of its values comes once."""
    seed, is_servo = (seed, list(REFERENCES).index(reference), number), reference == "servo"

    def choose(which, values, index=number):
        block, place = divmod(index, len(values))
        values = list(values)
        return values[np.random.default_rng((*seed[:2], which, block)).permutation(len(values))[place]]

    # A third is healthy, and half behind a model.
    period = 2 if reference == "model" else 3
    effect, ratio, body = "none", 0.0, choose(0, ("given", "free"))
    if number % period:
        kinds = of_reference(reference)
        index = number - number // period - 1
        place = choose(1, range(len(kinds)), index)
        effect = kinds[place]
        # Each effect has one ratio and then the other.
        ratio = RATIOS[(index // len(kinds) + place) % 2] * (SERVO_FINER if is_servo else 1.0)
        if EFFECTS[effect].given and reference != "model":
            body = "given"
    # Without a reference a body that is not given is missing.
    body = "given" if reference == "alone" else body
    # Drake takes five times as long, and has neither controllers nor motors of its own.
    simulator = "mujoco" if is_servo else choose(2, ("mujoco", "mujoco", "mujoco", "drake"))
    rate, actuator = choose(5, SERVO_RATES_HZ if is_servo else RATES_HZ), choose(6, servo.KINDS) if is_servo else "torque"
    return Case(seed, reference, effect, ratio, choose(3, KINDS), simulator, choose(4, motion.KINDS), rate, body, actuator)


class Bench:
    """Random joint of a case and its runs."""

    def __init__(self, case, rng):
        self.simulator = SIMULATORS[case.simulator]
        self.joint = random_joint(rng, self.simulator.HAS_SOFT_CONSTRAINT)
        self.every = round(1 / case.rate_Hz / CONTROL_PERIOD_S)
        self.servo = servo.random_servo(case.actuator, self.joint, rng) if case.actuator != "torque" else None

    def simulated(self, joint, motion):
        """The joint as a simulation knows it, under the controller of the real one."""
        return self.driven(self.simulator, joint, Plant(), False, motion)

    def recorded(self, motion, plant=Plant(), simulator=None):
        return self.driven(simulator or self.simulator, self.joint, plant, True, motion)

    def driven(self, simulator, joint, plant, real, motion):
        if self.servo:
            mechanism, control = simulator.Mechanism(joint, plant, real, self.servo), servo.Control(self.servo, self.joint, plant, motion)
        else:
            mechanism, control = simulator.Mechanism(joint, plant, real), drive.Control(self.joint, plant, motion)
        return run(mechanism, control, plant, motion, self.every)

    def logged(self, log, noise, level, rng):
        """Columns as recorded under noise of a root mean square, N m, and what describes it. A servo's is that of position and velocity, each of
        which its gains would make that torque of."""
        if not self.servo:
            return recorded(log, noise, level, rng)
        of = self.servo
        return recorded_by_servo(log, noise, level / of.kp_Nm_rad, level / of.kd_Nms_rad, of.reports_velocity, rng)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def refit(log, joint, body):
    """Least squares of Coulomb and viscous friction, and with `body` of inertia and gravity, on a recording: the joint with these, and what they
    leave of the effect."""
    ahead = np.append(log.velocity[1:], log.velocity[-1])
    speed = (log.velocity + ahead) / 2
    sign = (log.friction - joint.damping_Nms_rad * speed) / joint.frictionloss_Nm
    columns = [sign, speed]
    if body:
        columns += [(ahead - log.velocity) / log.period_s, np.sin(log.position), np.cos(log.position)]
    columns = np.column_stack([smooth(column, log.period_s) for column in columns])
    coulomb, viscous, inertia, sine, cosine = found = np.zeros(5)
    found[: columns.shape[1]] = np.linalg.lstsq(columns, log.effect, rcond=None)[0]
    coulomb, viscous, inertia, sine, cosine = map(float, found)

    def moved(value, change):
        return max(value + change, LEAST_LEFT * value)

    weight = joint.gravity_torque_Nm * np.exp(1j * joint.phase_rad) + complex(sine, cosine)
    # The moment of the mass alone: its own share of the inertia stays as it is.
    ratio = abs(weight) / joint.gravity_torque_Nm
    tuned = replace(
        joint,
        frictionloss_Nm=moved(joint.frictionloss_Nm, coulomb),
        damping_Nms_rad=moved(joint.damping_Nms_rad, viscous),
        armature_kgm2=moved(joint.armature_kgm2, inertia),
        mass_kg=joint.mass_kg * ratio**2,
        lever_m=joint.lever_m / ratio,
        phase_rad=float(np.angle(weight)),
    )
    return tuned, log.effect - columns @ found[: columns.shape[1]]


class Reference:
    """What is compared with: what it can have of an effect, and how the simulation comes by it."""

    def __init__(self, case, bench):
        self.bench = bench
        given = EFFECTS[case.effect].given if case.effect in EFFECTS else ""
        # A model was fitted to another recording, and a level that is refitted is no effect.
        self.fixed, self.body = case.reference == "model" or given == "level", case.body == "free"

    def refitted(self, log):
        """The joint as the reference has it, and the effect beside it."""
        return (self.bench.joint, log.effect) if self.fixed else refit(log, self.bench.joint, self.body)

    def beside(self):
        """Names of what was refitted: with an effect it takes other values than those of the joint, and saying so is neither right nor wrong."""
        return () if self.fixed else ("friction_level",) + ("inertia_error", "gravity_error") * self.body


def sized(bench, reference, motion, shape, share):
    """The size with which the effect has about that share of the friction, and its recording: bisection of its logarithm once it is bracketed. The size is
    sought in MuJoCo, whose runs are short."""
    size, low, high = 1.0, 0.0, math.inf
    for _ in range(SIZE_RUNS):
        log = bench.recorded(motion, shape(size), in_mujoco)
        found = rms(reference.refitted(log)[1]) / rms(log.friction)
        if share * LEAST_SHARE < found < share * LARGEST_SHARE:
            break
        aim = share * math.sqrt(LEAST_SHARE * LARGEST_SHARE)
        low, high = (size, high) if found < aim else (low, size)
        bracketed = low > 0 and high < math.inf
        size = math.sqrt(low * high) if bracketed else size * min(max((aim / max(found, 1e-9)) ** 0.9, 0.1), 5.0)
    else:
        log = bench.recorded(motion, shape(size), in_mujoco)
    return size, log if bench.simulator is in_mujoco else bench.recorded(motion, shape(size))


def make(case):
    """Columns of the reference (none where there is none) and of the recording, text of joint.toml and the truth about the pair."""
    rng = np.random.default_rng(case.seed)
    bench = Bench(case, rng)
    reference = Reference(case, bench)

    def duration():
        # Half of them below 30 s.
        return SHORTEST_S * (LONGEST_S / SHORTEST_S) ** float(rng.random() ** 2)

    seconds = duration()
    shape_of_motion, motion = random_motion(case.motion, rng, seconds)
    truth = {"healthy": case.effect == "none", "class": "healthy", **asdict(case), "seconds": seconds, "shape_of_motion": shape_of_motion}
    level = float(np.exp(rng.uniform(np.log(LEAST_NOISE), np.log(LARGEST_NOISE))))
    if case.effect == "none":
        log = bench.recorded(motion)
        tuned, left = reference.refitted(log)
        level *= rms(log.friction) / (SERVO_FINER if bench.servo else 1.0)
    else:
        effect = EFFECTS[case.effect]
        shape = effect.plant(bench.joint, motion, rng)
        size, log = sized(bench, reference, motion, shape, effect.share) if effect.sized else (1.0, bench.recorded(motion, shape(1.0)))
        tuned, left = reference.refitted(log)
        level = rms(left)
        if effect.only == "servo":
            # A position is not the worse for an actuator that is far off: the noise is that beside the largest of the others.
            level = min(level, LARGEST_SHARE * rms(log.friction))
        level /= case.ratio
        truth |= {
            "class": effect.names[0],
            "names": list(effect.names),
            "beside": [name for name in dict.fromkeys((*effect.beside, *reference.beside())) if name not in effect.names],
            "parameters": {"size": size, **numbers(shape)},
        }
    # Behind the refit: what the reference lacks. Before it: the torque that the healthy joint would not have needed.
    truth |= {"effect_Nm": rms(left), "effect_before_refit_Nm": rms(log.effect), "joint": asdict(bench.joint), "reference_joint": asdict(tuned)}
    columns, noise = bench.logged(log, case.noise, level, rng)
    truth |= {"noise_Nm": level, "friction_Nm": rms(log.friction), "torque_Nm": rms(log.torque), **noise}
    compared = None
    if bench.servo:
        truth["servo"] = asdict(bench.servo)
    if REFERENCES[case.reference] == "simulation.csv":
        simulated = bench.simulated(tuned, motion).columns()
        compared = {name: simulated[name] for name in columns}
    elif case.reference == "model":
        truth["fitted_s"] = duration()
        other = bench.recorded(random_motion(case.motion, rng, truth["fitted_s"])[1])
        compared, _ = bench.logged(other, KINDS[rng.integers(len(KINDS))], level, rng)
    return compared, columns, joint_toml(bench, case), truth


def numbers(shape):
    """What an effect's shape was drawn with; a complex number as its two parts."""
    drawn = {name: cell.cell_contents for name, cell in zip(shape.__code__.co_freevars, shape.__closure__ or ()) if np.isscalar(cell.cell_contents)}
    return {name: [value.real, value.imag] if isinstance(value, complex) else float(value) for name, value in drawn.items()}


def joint_toml(bench, case):
    joint = bench.joint
    body = f"""
[rigid_body]
inertia_kgm2 = {joint.inertia_kgm2}
gravity_torque_Nm = {joint.gravity_torque_Nm}
gravity_phase_rad = {joint.phase_rad}
"""
    return f"""name = "joint"
{body if case.body == "given" else ""}{bench.servo.toml() if bench.servo else ""}
[drive]
rate_Hz = {case.rate_Hz}.0
"""
