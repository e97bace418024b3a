"""A driven joint in MuJoCo under a position controller, and the log of its motion."""

import math
from dataclasses import dataclass, field

import mujoco
import numpy as np

GRAVITY_M_S2 = 9.81
# Period of the controller and time step of the simulation, s; the real joint is integrated with a quarter of it.
CONTROL_PERIOD_S = 0.001
REAL_SUBSTEPS = 4
# Steps of the controller a row: 250 Hz.
LOG_EVERY = 4
ROW_PERIOD_S = CONTROL_PERIOD_S * LOG_EVERY


@dataclass(frozen=True)
class Joint:
    """What the simulation knows; inertia of the link about the axis, without the armature."""

    link_inertia_kgm2: float
    armature_kgm2: float
    mass_kg: float
    lever_m: float
    phase_rad: float
    frictionloss_Nm: float
    damping_Nms_rad: float
    sign_width_rad_s: float  # of the tanh of Coulomb friction; 0 for the soft constraint of `frictionloss`

    @property
    def inertia_kgm2(self):
        return self.link_inertia_kgm2 + self.armature_kgm2

    @property
    def gravity_torque_Nm(self):
        return self.mass_kg * GRAVITY_M_S2 * self.lever_m

    def gravity_Nm(self, position):
        return self.gravity_torque_Nm * math.sin(position + self.phase_rad)


@dataclass
class Plant:
    """How the real joint departs from the simulation. Callables see the state of every substep."""

    attributes: dict = field(default_factory=dict)  # of the joint, in place of the simulation's
    inertial: dict = field(default_factory=dict)  # fields of `Joint` that the link has in truth
    actuators: str = ""  # more actuators, in MJCF
    bodies: str = ""  # fixed to the link, in MJCF
    play: str = ""  # attributes of a second joint between drive and link, in MJCF
    frictionloss: object = None  # of position, velocity, time and transmitted torque, N m
    applied: object = None  # torque on the joint of position, velocity and time, N m
    command_limit_Nm: float = math.inf  # of the motor; the log has the command
    command_delay_steps: int = 0  # of the motor; the log has the command
    torque_delay_rows: int = 0  # of the logged torque
    torque_scale: float = 1.0  # of the logged torque


def random_joint(rng):
    """A servo, an elbow or a shoulder, each with its own friction."""
    mass, lever, fraction = [(0.3, 0.08, 0.04), (1.5, 0.2, 0.05), (8.0, 0.4, 0.06)][rng.integers(3)]
    mass, lever = mass * rng.uniform(0.7, 1.4), lever * rng.uniform(0.7, 1.4)
    link = mass * lever**2 * rng.uniform(1.2, 1.6)
    weight = mass * GRAVITY_M_S2 * lever
    return Joint(
        link_inertia_kgm2=link,
        armature_kgm2=link * rng.uniform(0.2, 1.0),
        mass_kg=mass,
        lever_m=lever,
        phase_rad=rng.uniform(-0.6, 0.6),
        frictionloss_Nm=weight * rng.uniform(0.1, 0.5),
        damping_Nms_rad=weight * fraction * rng.uniform(0.5, 2.0),
        sign_width_rad_s=rng.choice((0, 1)) * float(np.exp(rng.uniform(np.log(0.01), np.log(0.1)))),
    )


def model(joint, plant, timestep):
    """The compiled model of the joint as `plant` alters it."""
    link = Joint(**{**vars(joint), **plant.inertial})
    lever = (-link.lever_m * math.sin(link.phase_rad), 0.0, -link.lever_m * math.cos(link.phase_rad))
    own = link.link_inertia_kgm2 - link.mass_kg * link.lever_m**2
    attributes = {
        "armature": joint.armature_kgm2,
        "damping": joint.damping_Nms_rad,
        "frictionloss": joint.frictionloss_Nm,
        **plant.attributes,
    }
    if joint.sign_width_rad_s:
        attributes["frictionloss"] = 0.0
    words = " ".join(f'{name}="{value}"' for name, value in attributes.items())
    body = f"""<inertial pos="{lever[0]} 0 {lever[2]}" mass="{link.mass_kg}" diaginertia="{own} {own} {own}"/>{{}}{plant.bodies}"""
    driven = f'<joint name="joint" axis="0 1 0" {words}/>'
    if plant.play:
        hull = link.link_inertia_kgm2 * 1e-6
        inside = body.format(f'<joint name="play" axis="0 1 0" {plant.play}/>')
        body = f'<inertial pos="0 0 0" mass="1e-6" diaginertia="{hull} {hull} {hull}"/>{driven}<body name="link">{inside}</body>'
    else:
        body = body.format(driven)
    return mujoco.MjModel.from_xml_string(f"""<mujoco model="foreign">
  <option timestep="{timestep}" gravity="0 0 -{GRAVITY_M_S2}"/>
  <worldbody><body name="arm">{body}</body></worldbody>
  <actuator><motor name="drive" joint="joint"/>{plant.actuators}</actuator>
</mujoco>""")


def random_motion(rng, seconds):
    """Position, velocity and acceleration of the command: four sines without a common period; from rest on, and in half of the motions with three stops."""
    clock = np.arange(int(seconds / CONTROL_PERIOD_S)) * CONTROL_PERIOD_S
    pace = np.tanh(clock / 0.15)
    if rng.random() < 0.5:
        for start in (np.arange(3) + rng.uniform(0.1, 0.5, 3)) * seconds / 3:
            dwell = rng.uniform(0.5, 1.5)
            pace *= 1 - 0.5 * (np.tanh((clock - start) / 0.08) - np.tanh((clock - start - dwell) / 0.08))
    phase = np.cumsum(pace) * CONTROL_PERIOD_S
    lines = zip((0.9, 0.45, 0.2, 0.06), (0.11, 0.37, 0.83, 1.9))
    position, centre = np.zeros_like(clock), rng.uniform(-0.5, 0.5)
    for amplitude, frequency in lines:
        omega = 2 * np.pi * frequency * rng.uniform(0.8, 1.25)
        position = position + amplitude * rng.uniform(0.7, 1.2) * np.sin(omega * phase + rng.uniform(0, 2 * np.pi))
    velocity = np.gradient(position, CONTROL_PERIOD_S)
    return position + centre, velocity, np.gradient(velocity, CONTROL_PERIOD_S)


@dataclass
class Log:
    """Rows of a motion: time, position, velocity, torque of the actuator, and what of it the simulation's joint would not have needed."""

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray
    effect: np.ndarray
    friction: np.ndarray  # of the simulation's joint at these states


def run(joint, plant, motion, substeps):
    """Drives the joint with a PD controller of about 6 Hz and the feed-forward of its rigid body."""
    omega = 2 * math.pi * 6.0
    kp, kd = joint.inertia_kgm2 * omega**2, 1.6 * joint.inertia_kgm2 * omega
    compiled = model(joint, plant, CONTROL_PERIOD_S / substeps)
    data = mujoco.MjData(compiled)
    expected = model(joint, Plant(), CONTROL_PERIOD_S)
    inverse = mujoco.MjData(expected)
    positions, velocities, accelerations = motion
    data.qpos[0], data.qvel[0] = positions[0], velocities[0]
    width, coulomb = joint.sign_width_rad_s, float(plant.attributes.get("frictionloss", joint.frictionloss_Nm))
    commands = np.zeros(len(positions) + 1)
    rows = np.empty((len(positions) // LOG_EVERY, 6))
    for step in range(len(rows) * LOG_EVERY):
        q, v = float(data.qpos[0]), float(data.qvel[0])
        row = rows[step // LOG_EVERY]
        forward = joint.inertia_kgm2 * accelerations[step] + joint.gravity_Nm(positions[step])
        command = commands[step] = kp * (positions[step] - q) + kd * (velocities[step] - v) + forward
        if step % LOG_EVERY == 0:
            row[:] = step * CONTROL_PERIOD_S, q, v, command, 0.0, 0.0
        motor = commands[max(step - plant.command_delay_steps, 0)]
        data.ctrl[0] = min(max(motor, -plant.command_limit_Nm), plant.command_limit_Nm)
        for substep in range(substeps):
            now = (step + substep / substeps) * CONTROL_PERIOD_S
            q, v = float(data.qpos[0]), float(data.qvel[0])
            if plant.frictionloss:
                transmitted = joint.link_inertia_kgm2 * float(data.qacc[0]) + joint.gravity_Nm(q)
                coulomb = plant.frictionloss(q, v, now, transmitted)
            applied = plant.applied(q, v, now) if plant.applied else 0.0
            sign = math.tanh(v / width) if width else 0.0
            data.qfrc_applied[0] = applied - coulomb * sign
            if not width:
                compiled.dof_frictionloss[0] = coulomb
            mujoco.mj_step(compiled, data)
            inverse.qpos[0], inverse.qvel[0], inverse.qacc[0] = q, v, data.qacc[0]
            mujoco.mj_inverse(expected, inverse)
            smoothed = joint.frictionloss_Nm * sign
            row[4] += (command - float(inverse.qfrc_inverse[0]) - smoothed) / (substeps * LOG_EVERY)
            row[5] += (smoothed - float(inverse.qfrc_constraint[0] + inverse.qfrc_passive[0])) / (substeps * LOG_EVERY)
    time, position, velocity, torque, effect, friction = rows.T.copy()
    logged = plant.torque_scale * np.concatenate((np.repeat(torque[:1], plant.torque_delay_rows), torque))[: len(torque)]
    return Log(time, position, velocity, logged, smooth(effect + logged - torque), friction)


def smooth(values):
    """Without what is faster than about 20 Hz: an impact is of no length, and no encoder sees it."""
    weights = np.convolve(np.ones(5), np.ones(5)) / 25
    return np.convolve(np.pad(values, 4, mode="edge"), weights, mode="valid")
