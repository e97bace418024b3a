"""Noise of a recording: five kinds."""

import numpy as np

KINDS = ("white", "autoregressive", "coarse_encoder", "heavy_tails", "grows_with_torque")
# Degrees of freedom of Student's distribution: the variance is finite, the kurtosis is not.
STUDENT_FREEDOM = 3


def unit_noise(kind, torque, rng):
    """Noise of root mean square 1, and what describes it."""
    n = len(torque)
    told = {}
    if kind == "autoregressive":
        pole = told["pole"] = rng.uniform(0.5, 0.95)
        noise, innovations = np.empty(n), rng.standard_normal(n)
        noise[0] = innovations[0] / np.sqrt(1 - pole**2)
        for row in range(1, n):
            noise[row] = pole * noise[row - 1] + innovations[row]
    elif kind == "heavy_tails":
        noise = rng.standard_t(STUDENT_FREEDOM, n)
    elif kind == "grows_with_torque":
        noise = rng.standard_normal(n) * (0.3 + np.abs(torque) / np.sqrt(np.mean(torque**2)))
    else:
        noise = rng.standard_normal(n)
    return noise / np.sqrt(np.mean(noise**2)), told


def recorded(log, kind, rms, rng):
    """Columns of time, position, velocity and torque as recorded, and what describes the noise: an encoder of 12 to 18 bits a turn, or else an
    exact one."""
    noise, told = unit_noise(kind, log.torque, rng)
    position, velocity = log.position, log.velocity
    if kind == "coarse_encoder":
        bits = told["bits"] = int(rng.integers(12, 19))
        position = counted(position, bits)
        velocity = np.diff(position, prepend=2 * position[0] - position[1]) / log.period_s
    return log.columns() | {"position_rad": position, "velocity_rad_s": velocity, "torque_Nm": log.torque + rms * noise}, told


def recorded_by_servo(log, kind, rms_rad, rms_rad_s, reports_velocity, rng):
    """The same of a joint that reports no torque: the noise is that of its position and, where it has one, of its velocity. Here the coarse
    encoder is the noise, and comes without velocity."""
    noise, told = unit_noise(kind, log.torque, rng)
    velocity_noise, _ = unit_noise(kind, log.torque, rng)
    columns = log.columns() | {"position_rad": log.position + rms_rad * noise, "velocity_rad_s": log.velocity + rms_rad_s * velocity_noise}
    if kind == "coarse_encoder":
        bits = told["bits"] = round(np.log2(2 * np.pi / (rms_rad * np.sqrt(12))))
        columns["position_rad"] = counted(log.position, bits)
    if kind == "coarse_encoder" or not reports_velocity:
        del columns["velocity_rad_s"]
    return columns, told


def counted(position, bits):
    """By an encoder of so many bits a turn."""
    step = 2 * np.pi / 2**bits
    return np.round(position / step) * step
