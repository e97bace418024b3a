"""Motions of a joint under a position controller, and their log, whatever simulates the joint."""

import math
from dataclasses import dataclass

import numpy as np

# Period of the controller and time step of the simulation, s; the real joint is integrated with a quarter of it.
CONTROL_PERIOD_S = 0.001
REAL_SUBSTEPS = 4
# Steps of the controller a row: 250 Hz.
LOG_EVERY = 4
ROW_PERIOD_S = CONTROL_PERIOD_S * LOG_EVERY


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


def run(mechanism, joint, plant, motion):
    """Drives a mechanism of one of the simulators with a PD controller of about 6 Hz and the feed-forward of the simulation's rigid body."""
    omega = 2 * math.pi * 6.0
    kp, kd = joint.inertia_kgm2 * omega**2, 1.6 * joint.inertia_kgm2 * omega
    positions, velocities, accelerations = motion
    mechanism.place(positions[0], velocities[0])
    commands = np.zeros(len(positions) + 1)
    rows = np.empty((len(positions) // LOG_EVERY, 6))
    parts = mechanism.substeps * LOG_EVERY
    for step in range(len(rows) * LOG_EVERY):
        q, v = mechanism.state()
        row = rows[step // LOG_EVERY]
        forward = joint.inertia_kgm2 * accelerations[step] + joint.gravity_Nm(positions[step])
        command = commands[step] = kp * (positions[step] - q) + kd * (velocities[step] - v) + forward
        if step % LOG_EVERY == 0:
            row[:] = step * CONTROL_PERIOD_S, q, v, command, 0.0, 0.0
        motor = commands[max(step - plant.command_delay_steps, 0)]
        motor = min(max(motor, -plant.command_limit_Nm), plant.command_limit_Nm)
        for substep in range(mechanism.substeps):
            needed, friction = mechanism.advance(motor, (step + substep / mechanism.substeps) * CONTROL_PERIOD_S)
            row[4] += (command - needed) / parts
            row[5] += friction / parts
    time, position, velocity, torque, effect, friction = rows.T.copy()
    logged = plant.torque_scale * np.concatenate((np.repeat(torque[:1], plant.torque_delay_rows), torque))[: len(torque)]
    return Log(time, position, velocity, logged, smooth(effect + logged - torque), friction)


def smooth(values):
    """Without what is faster than about 20 Hz: an impact is of no length, and no encoder sees it."""
    weights = np.convolve(np.ones(5), np.ones(5)) / 25
    return np.convolve(np.pad(values, 4, mode="edge"), weights, mode="valid")
