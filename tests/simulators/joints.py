"""A joint in MuJoCo: the real one, its simulation, and the same simulation with the true parameters."""

import math
from dataclasses import dataclass, field

import mujoco
import numpy as np

# Time step of every model, s.
STEP = 0.001
# Fewest steps of the real joint within one of the simulator's, and the longest of them, s: its friction is stiff.
SUBSTEPS, FINE_STEP = 5, 2e-4
# A row is logged every so many steps of the simulator.
LOG_EVERY = 4
# Actuator of the joint that is recorded.
ACTUATOR = "drive"


@dataclass(frozen=True)
class Drive:
    """A joint under a position controller."""

    joint: str
    actuator: str
    gains: tuple  # of the controller, N m/rad and N m s/rad; None under a `position` actuator, which has its own
    amplitudes: tuple  # of the motion, rad or m


@dataclass(frozen=True)
class Pair:
    """A joint and the simulation of it, both under one position controller."""

    name: str
    model: str  # MJCF of the simulation, as a user has it
    joint: str
    truth: dict  # attributes that the simulator has for the real joint
    friction: object  # torque of friction and ripple of the real joint, of position, velocity, transmitted torque and time step
    gains: tuple
    amplitudes: tuple
    noise: float  # of the recorded torque, N m or N
    linear: bool = False
    columns: tuple = ("qpos", "qvel", "torque")
    # A torque sensor behind the gear, and other joints that move, with the columns that they are recorded in.
    torque_sensor: bool = False
    others: tuple = ()
    more_columns: tuple = ()
    # What an actuator of the simulator can have of the truth beside, and the attributes of the joint that it replaces.
    actuator: str = ""
    beside_actuator: dict = field(default_factory=dict)
    # Whether friction hangs on the transmitted torque, of which a simulator's friction can have the mean only.
    of_load: bool = False
    # Time step of the simulation, s.
    step: float = STEP

    @property
    def drives(self):
        return (Drive(self.joint, ACTUATOR, self.gains, self.amplitudes), *self.others)


def reference(drive, seed, t):
    """Position and velocity of the commanded motion: a sum of sines that do not repeat."""
    rng = np.random.default_rng(seed)
    position = velocity = 0.0
    for amplitude, frequency in zip(drive.amplitudes, rng.uniform(0.8, 1.2, len(drive.amplitudes)) * (0.21, 0.63, 1.7)):
        phase, omega = rng.uniform(0, 2 * np.pi), 2 * np.pi * frequency
        position = position + amplitude * np.sin(omega * t + phase)
        velocity = velocity + amplitude * omega * np.cos(omega * t + phase)
    return position, velocity


def references(pair, seed, t):
    """The commanded motion of every joint, each its own."""
    return [reference(drive, seed + 100 * place, t) for place, drive in enumerate(pair.drives)]


def simulate(pair, model, seed, seconds, friction=None, commands=None):
    """Rows of time, position, velocity, actuator torque, torque transmitted to the link and friction under the command of `seed`, one a
    step of the controller; then position and velocity of the other joints. A `friction` acts beside that of the model. `commands` are
    positions and velocities at each step of every joint, in place of those of `seed`.
    """
    substeps = max(SUBSTEPS, math.ceil(pair.step / FINE_STEP)) if friction else 1
    model.opt.timestep = pair.step / substeps
    if friction:
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    data = mujoco.MjData(model)
    dofs = [model.joint(drive.joint).dofadr[0] for drive in pair.drives]
    controls = [model.actuator(drive.actuator).id for drive in pair.drives]
    dof, armature = dofs[0], model.dof_armature[dofs[0]]
    steps = round(seconds / pair.step)
    commands = commands or references(pair, seed, np.arange(steps) * pair.step)
    for place, (position, velocity) in zip(dofs, commands):
        data.qpos[place], data.qvel[place] = position[0], velocity[0]
    rows = np.empty((steps, 4 + 2 * len(dofs)))
    transmitted = 0.0
    for step in range(steps):
        state = [(data.qpos[place], data.qvel[place]) for place in dofs]
        for drive, control, (q, v), (position, velocity) in zip(pair.drives, controls, state, commands):
            if drive.gains:
                data.ctrl[control] = drive.gains[0] * (position[step] - q) + drive.gains[1] * (velocity[step] - v)
            else:
                data.ctrl[control] = position[step]
        for substep in range(substeps):
            if friction:
                data.qfrc_applied[dof] = -friction(data.qpos[dof], data.qvel[dof], transmitted, pair.step / substeps)
            mujoco.mj_step(model, data)
            lost = -(data.qfrc_applied[dof] + data.qfrc_passive[dof] + data.qfrc_constraint[dof])
            transmitted = data.qfrc_actuator[dof] - lost - armature * data.qacc[dof]
            if substep == 0:
                own, *others = state
                torque = data.actuator_force[controls[0]]
                rows[step] = [step * pair.step, *own, torque, transmitted, lost, *(value for other in others for value in other)]
    return rows


def real(pair, seed, seconds, commands=None):
    """The real joint: the inertia of the truth, friction of its own."""
    bare = with_attributes(pair, {**pair.truth, "frictionloss": 0.0, "damping": 0.0})
    return simulate(pair, bare, seed, seconds, pair.friction(), commands)


def best(pair, seed, seconds):
    """The simulation with all of the truth that the simulator can have on the motion of `seed`."""
    beside = nearest_friction(real(pair, seed, seconds)) if pair.of_load else pair.beside_actuator
    return with_attributes(pair, {**pair.truth, **beside}, pair.actuator)


def nearest_friction(rows):
    """Coulomb and viscous friction nearest to the real one."""
    velocity, friction = rows[:, 2], rows[:, 5]
    (coulomb, viscous), *_ = np.linalg.lstsq(np.stack((np.sign(velocity), velocity), axis=1), friction)
    return {"frictionloss": float(coulomb), "damping": float(viscous)}


def with_attributes(pair, attributes, actuator=""):
    """The simulation with other attributes of its joint, and one more actuator."""
    spec = mujoco.MjSpec.from_string(pair.model.replace("</actuator>", actuator + "</actuator>"))
    set_attributes(spec.joint(pair.joint), attributes)
    return spec.compile()


def set_attributes(joint, attributes):
    """Sets attributes of a joint; of those in powers of the velocity the first ones."""
    for name, value in attributes.items():
        powers = np.size(getattr(joint, name))
        padded = np.append(value, np.zeros(powers))[:powers]
        setattr(joint, name, padded if powers > 1 else float(padded[0]))


def write(pair, rows, path, noise, seed):
    """A recording every few steps, with noise of the torques."""
    header = ("time_s",) + pair.columns + pair.more_columns
    torques = [3, 4] if pair.torque_sensor else [3]
    rows = rows[::LOG_EVERY, [0, 1, 2, *torques, *range(6, rows.shape[1])]]
    rng = np.random.default_rng(seed)
    for column in torques:
        rows[:, column] += noise * rng.standard_normal(len(rows))
    np.savetxt(path, rows, delimiter=",", header=",".join(header), comments="", fmt="%.9g")


def errors(recording, rows):
    """Root mean squares of torque and position errors."""
    torque, position = recording[:, 3] - rows[:, 3], recording[:, 1] - rows[:, 1]
    return {"torque": float(np.sqrt(np.mean(torque**2))), "position": float(np.sqrt(np.mean(position**2)))}


def dahl(coulomb, stiffness, viscous):
    """Friction with presliding (Dahl 1968) and viscous friction, at rest at first."""
    bristles = 0.0

    def friction(q, v, transmitted, dt):
        nonlocal bristles
        bristles += stiffness * v * dt * (1.0 - math.copysign(bristles / coulomb, bristles * v))
        bristles = min(max(bristles, -coulomb), coulomb)
        return bristles + viscous * v

    return friction


def law(coulomb, excess, stribeck_velocity, viscous, smoothing):
    """Coulomb, Stribeck and viscous friction of a velocity."""

    def friction(v):
        dry = coulomb + excess * math.exp(-((v / stribeck_velocity) ** 2))
        return dry * math.tanh(v / smoothing) + viscous * v

    return friction


def lugre(joint, stiffness, damping, coulomb, at_rest, stribeck_velocity):
    """A motor without input that has LuGre friction."""
    values = f"{stiffness} {damping} {coulomb} {at_rest} {stribeck_velocity}"
    return f'<dcmotor joint="{joint}" input="none" motorconst="0" resistance="1" lugre="{values}"/>'
