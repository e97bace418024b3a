"""A joint under a position controller, and its log, whatever simulates the joint."""

import math
from dataclasses import dataclass, field

import numpy as np

from .motion import CONTROL_PERIOD_S

# Steps of the real joint in a period of the controller.
REAL_SUBSTEPS = 4
# Width of each of the two windows behind which an effect is measured, s.
SMOOTHING_S = 0.02


@dataclass
class Log:
    """Rows of a motion: time, position, velocity, torque of the actuator (of a servo the one that joint.toml has for it), and what of it the
    simulation's joint would not have needed."""

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray
    effect: np.ndarray
    friction: np.ndarray  # of the simulation's joint at these states
    commands: dict = field(default_factory=dict)  # columns in place of the torque

    @property
    def period_s(self):
        return float(self.time[1])

    def columns(self):
        """By the names of their quantities, as they are without noise."""
        motion = {"time_s": self.time, "position_rad": self.position, "velocity_rad_s": self.velocity}
        return motion | (self.commands or {"torque_Nm": self.torque})


class Control:
    """A PD controller of about 6 Hz with the feed-forward of the joint's rigid body, whose torque is logged and put out by a motor."""

    def __init__(self, joint, plant, motion):
        self.joint, self.plant, self.motion = joint, plant, motion
        omega = 2 * math.pi * 6.0
        self.kp, self.kd = joint.inertia_kgm2 * omega**2, 1.6 * joint.inertia_kgm2 * omega
        self.commands = np.zeros(len(motion[0]) + 1)

    def begin(self, step, q, v):
        """A period of the controller."""
        positions, velocities, accelerations = self.motion
        forward = self.joint.inertia_kgm2 * accelerations[step] + self.joint.gravity_Nm(positions[step])
        self.command = self.commands[step] = self.kp * (positions[step] - q) + self.kd * (velocities[step] - v) + forward
        motor = self.commands[max(step - self.plant.command_delay_steps, 0)]
        self.motor = min(max(motor, -self.plant.command_limit_Nm), self.plant.command_limit_Nm)

    def act(self, q, v):
        """What the motor is told at this state, and the torque that the log has for it."""
        return self.motor, self.command

    def columns(self, every, rows):
        """What the log has in place of the torque."""
        return {}


def run(mechanism, control, plant, motion, every):
    """Drives a mechanism of one of the simulators by a controller along a motion; a row at every so many of its periods."""
    mechanism.place(motion[0][0], motion[1][0])
    rows = np.zeros((len(motion[0]) // every, 6))
    parts = mechanism.substeps * every
    for step in range(len(rows) * every):
        state = mechanism.state()
        row = rows[step // every]
        control.begin(step, *state)
        if step % every == 0:
            row[:4] = step * CONTROL_PERIOD_S, *state, control.act(*state)[1]
        for substep in range(mechanism.substeps):
            told, known = control.act(*mechanism.state())
            needed, friction = mechanism.advance(told, (step + substep / mechanism.substeps) * CONTROL_PERIOD_S)
            row[4] += (known - needed) / parts
            row[5] += friction / parts
    time, position, velocity, torque, effect, friction = rows.T.copy()
    logged = plant.torque_scale * np.concatenate((np.repeat(torque[:1], plant.torque_delay_steps // every), torque))[: len(torque)]
    log = Log(time, position, velocity, logged, effect + logged - torque, friction, control.columns(every, len(rows)))
    log.effect = smooth(log.effect, log.period_s)
    return log


def smooth(values, period_s):
    """Without what is faster than about 20 Hz: an impact is of no length, and no encoder sees it."""
    rows = round(SMOOTHING_S / period_s)
    weights = np.convolve(np.ones(rows), np.ones(rows)) / rows**2
    return np.convolve(np.pad(values, rows - 1, mode="edge"), weights, mode="valid")
