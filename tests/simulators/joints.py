"""Joints in MuJoCo: the real one, its simulation, and the same simulation with the true parameters."""

import math
from dataclasses import dataclass, field

import mujoco
import numpy as np

# Time step of every model, s.
STEP = 0.001
# Steps of the real joint within one of the simulator's: its friction is stiff.
SUBSTEPS = 5
# A row is logged every so many steps of the simulator.
LOG_EVERY = 4


@dataclass(frozen=True)
class Pair:
    """A joint and the simulation of it, both under one position controller."""

    name: str
    model: str  # MJCF of the simulation, as a user has it
    joint: str
    truth: dict  # attributes that the simulator has for the real joint
    friction: object  # torque of friction and ripple of the real joint, of position, velocity and time step
    gains: tuple  # of the controller, N m/rad and N m s/rad; None under a `position` actuator, which has its own
    amplitudes: tuple  # of the motion, rad or m
    noise: float  # of the recorded torque, N m or N
    linear: bool = False
    columns: tuple = field(default=("qpos", "qvel", "torque"))
    # What an actuator of the simulator can have of the truth beside, and the attributes of the joint that it replaces.
    actuator: str = ""
    beside_actuator: dict = field(default_factory=dict)


def reference(pair, seed, t):
    """Position and velocity of the commanded motion: a sum of sines that do not repeat."""
    rng = np.random.default_rng(seed)
    position = velocity = 0.0
    for amplitude, frequency in zip(pair.amplitudes, rng.uniform(0.8, 1.2, len(pair.amplitudes)) * (0.21, 0.63, 1.7)):
        phase, omega = rng.uniform(0, 2 * np.pi), 2 * np.pi * frequency
        position = position + amplitude * np.sin(omega * t + phase)
        velocity = velocity + amplitude * omega * np.cos(omega * t + phase)
    return position, velocity


def simulate(pair, model, seed, seconds, friction=None):
    """Rows of time, position, velocity and actuator torque under the command of `seed`, one a step of the controller."""
    substeps = SUBSTEPS if friction else 1
    model.opt.timestep = STEP / substeps
    data = mujoco.MjData(model)
    dof = model.joint(pair.joint).dofadr[0]
    steps = int(seconds / STEP)
    position, velocity = reference(pair, seed, np.arange(steps) * STEP)
    data.qpos[dof], data.qvel[dof] = position[0], velocity[0]
    rows = np.empty((steps, 4))
    for step in range(steps):
        q, v = data.qpos[dof], data.qvel[dof]
        if pair.gains:
            data.ctrl[0] = pair.gains[0] * (position[step] - q) + pair.gains[1] * (velocity[step] - v)
        else:
            data.ctrl[0] = position[step]
        for substep in range(substeps):
            if friction:
                data.qfrc_applied[dof] = -friction(data.qpos[dof], data.qvel[dof], STEP / substeps)
            mujoco.mj_step(model, data)
            if substep == 0:
                rows[step] = step * STEP, q, v, data.actuator_force[0]
    return rows


def real(pair, seed, seconds):
    """The real joint: the inertia of the truth, friction of its own."""
    bare = with_attributes(pair, {**pair.truth, "frictionloss": 0.0, "damping": 0.0})
    return simulate(pair, bare, seed, seconds, pair.friction())


def best(pair):
    """The simulation with all of the truth that the simulator can have."""
    return with_attributes(pair, {**pair.truth, **pair.beside_actuator}, pair.actuator)


def with_attributes(pair, attributes, actuator=""):
    """The simulation with other attributes of its joint, and one more actuator."""
    spec = mujoco.MjSpec.from_string(pair.model.replace("</actuator>", actuator + "</actuator>"))
    for name, value in attributes.items():
        joint = spec.joint(pair.joint)
        setattr(joint, name, value if np.isscalar(getattr(joint, name)) else np.resize([value, 0.0, 0.0], len(getattr(joint, name))))
    return spec.compile()


def write(pair, rows, path, noise, seed):
    """A recording every few steps, its torque with noise."""
    rows = rows[::LOG_EVERY].copy()
    rows[:, 3] += noise * np.random.default_rng(seed).standard_normal(len(rows))
    header = ",".join(("time_s",) + pair.columns)
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.9g")


def errors(recording, rows):
    """Root mean squares of torque and position errors."""
    difference = rows - recording
    return {"torque": float(np.sqrt(np.mean(difference[:, 3] ** 2))), "position": float(np.sqrt(np.mean(difference[:, 1] ** 2)))}


def elbow_model():
    return f"""<mujoco model="elbow">
  <option timestep="{STEP}"/>
  <worldbody>
    <!-- one link, hanging -->
    <body name="arm">
      <inertial pos="0 0 -0.2" mass="1.5" diaginertia="0.24 0.24 0.01"/>
      <joint name="elbow" axis="0 1 0" frictionloss="1" damping="0.5"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="elbow"/>
  </actuator>
</mujoco>
"""


def axis_model():
    return f"""<mujoco model="axis">
  <option timestep="{STEP}"/>
  <worldbody>
    <body name="carriage">
      <inertial pos="0 0 0" mass="12" diaginertia="0.1 0.1 0.1"/>
      <joint name="slide" type="slide" axis="1 0 0" frictionloss="20" damping="60"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="slide"/>
  </actuator>
</mujoco>
"""


def servo_model():
    return f"""<mujoco model="servo">
  <option timestep="{STEP}"/>
  <worldbody>
    <body name="horn">
      <inertial pos="0 0 0" mass="0.4" diaginertia="0.02 0.02 0.02"/>
      <joint name="servo" axis="0 0 1" frictionloss="0.6" damping="0.2"/>
    </body>
  </worldbody>
  <actuator>
    <position name="drive" joint="servo" kp="60" kv="2"/>
  </actuator>
</mujoco>
"""


def dahl(coulomb, stiffness, viscous):
    """Friction with presliding (Dahl 1968) and viscous friction, at rest at first."""
    bristles = 0.0

    def friction(q, v, dt):
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


ELBOW_FRICTION = law(2.0, 1.0, 0.1, 1.2, 0.002)
AXIS_FRICTION = law(35.0, 0.0, 1.0, 90.0, 0.001)

ELBOW = Pair(
    name="elbow",
    model=elbow_model(),
    joint="elbow",
    truth={"armature": 0.2, "frictionloss": 2.0, "damping": 1.2},
    friction=lambda: lambda q, v, dt: ELBOW_FRICTION(v),
    gains=(200.0, 15.0),
    amplitudes=(0.8, 0.3, 0.08),
    noise=0.05,
    # LuGre bristles of 0.2 rad a time step on 0.5 kg m2, half critically damped; Coulomb, static friction, Stribeck velocity.
    actuator='<dcmotor joint="elbow" input="none" motorconst="0" resistance="1" lugre="20000 100 2 3 0.1"/>',
    beside_actuator={"frictionloss": 0.0},
)

# Ripple every 20 mm, the pitch of a screw.
RIPPLE, ORDER, PHASE = 4.0, 2 * math.pi * 50.0, 0.7

AXIS = Pair(
    name="axis",
    model=axis_model(),
    joint="slide",
    truth={"armature": 5.0, "frictionloss": 35.0, "damping": 90.0},
    friction=lambda: lambda q, v, dt: AXIS_FRICTION(v) + RIPPLE * math.sin(ORDER * q + PHASE),
    gains=(40000.0, 1500.0),
    amplitudes=(0.15, 0.06, 0.012),
    noise=0.5,
    # What the joint resists the motor gives, half a period later; a gear turns a period into a radian.
    actuator=f'<dcmotor joint="slide" input="none" motorconst="0" resistance="1" gear="{ORDER}" cogging="{RIPPLE / ORDER} 1 {PHASE + math.pi}"/>',
    linear=True,
)

SERVO = Pair(
    name="servo",
    model=servo_model(),
    joint="servo",
    truth={"armature": 0.03, "frictionloss": 1.0, "damping": 0.35},
    friction=lambda: dahl(1.0, 250.0, 0.35),
    gains=None,
    amplitudes=(0.6, 0.2, 0.05),
    noise=0.01,
    # The stiffness of the truth, half critically damped on 0.05 kg m2.
    actuator='<dcmotor joint="servo" input="none" motorconst="0" resistance="1" lugre="250 3.5 1 1 1"/>',
    beside_actuator={"frictionloss": 0.0},
)

PAIRS = {pair.name: pair for pair in (ELBOW, AXIS, SERVO)}
