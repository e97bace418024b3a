"""A joint under a position controller, and its log, whatever simulates the joint."""

import math
from dataclasses import dataclass

import numpy as np

from .motion import CONTROL_PERIOD_S

# Steps of the real joint in a period of the controller.
REAL_SUBSTEPS = 4
# Width of each of the two windows behind which an effect is measured, s.
SMOOTHING_S = 0.02


@dataclass
class Log:
    """Rows of a motion: time, position, velocity, torque of the actuator, and what of it the simulation's joint would not have needed."""

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray
    effect: np.ndarray
    friction: np.ndarray  # of the simulation's joint at these states

    @property
    def period_s(self):
        return float(self.time[1])


def run(mechanism, joint, plant, motion, every):
    """Drives a mechanism of one of the simulators with a PD controller of about 6 Hz and the feed-forward of the joint's rigid body; a row at
    every so many of its steps."""
    omega = 2 * math.pi * 6.0
    kp, kd = joint.inertia_kgm2 * omega**2, 1.6 * joint.inertia_kgm2 * omega
    positions, velocities, accelerations = motion
    mechanism.place(positions[0], velocities[0])
    commands = np.zeros(len(positions) + 1)
    rows = np.zeros((len(positions) // every, 6))
    parts = mechanism.substeps * every
    for step in range(len(rows) * every):
        q, v = mechanism.state()
        row = rows[step // every]
        forward = joint.inertia_kgm2 * accelerations[step] + joint.gravity_Nm(positions[step])
        command = commands[step] = kp * (positions[step] - q) + kd * (velocities[step] - v) + forward
        if step % every == 0:
            row[:4] = step * CONTROL_PERIOD_S, q, v, command
        motor = commands[max(step - plant.command_delay_steps, 0)]
        motor = min(max(motor, -plant.command_limit_Nm), plant.command_limit_Nm)
        for substep in range(mechanism.substeps):
            needed, friction = mechanism.advance(motor, (step + substep / mechanism.substeps) * CONTROL_PERIOD_S)
            row[4] += (command - needed) / parts
            row[5] += friction / parts
    time, position, velocity, torque, effect, friction = rows.T.copy()
    logged = plant.torque_scale * np.concatenate((np.repeat(torque[:1], plant.torque_delay_steps // every), torque))[: len(torque)]
    log = Log(time, position, velocity, logged, effect + logged - torque, friction)
    log.effect = smooth(log.effect, log.period_s)
    return log


def smooth(values, period_s):
    """Without what is faster than about 20 Hz: an impact is of no length, and no encoder sees it."""
    rows = round(SMOOTHING_S / period_s)
    weights = np.convolve(np.ones(rows), np.ones(rows)) / rows**2
    return np.convolve(np.pad(values, rows - 1, mode="edge"), weights, mode="valid")
