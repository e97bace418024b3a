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
    """Time, position, velocity and torque as recorded, and what describes the noise: an encoder of 12 to 18 bits a turn, or else an exact one."""
    noise, told = unit_noise(kind, log.torque, rng)
    position, velocity = log.position, log.velocity
    if kind == "coarse_encoder":
        bits = told["bits"] = int(rng.integers(12, 19))
        step = 2 * np.pi / 2**bits
        position = np.round(position / step) * step
        velocity = np.diff(position, prepend=2 * position[0] - position[1]) / log.period_s
    return np.column_stack((log.time, position, velocity, log.torque + rms * noise)), told
