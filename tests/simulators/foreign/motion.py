"""Commanded motions of a joint: several sines, moves with rests between them, or sweeps."""

import numpy as np

# Period of the controller, s.
CONTROL_PERIOD_S = 0.001


def smoothed(values, seconds):
    """Twice the mean over a window: accelerations are continuous."""
    window = np.full(int(seconds / CONTROL_PERIOD_S), CONTROL_PERIOD_S / seconds)
    for _ in range(2):
        values = np.convolve(np.pad(values, (len(window), len(window)), mode="edge"), window, mode="same")[len(window) : -len(window)]
    return values


def sines(rng, pace):
    """Four sines without a common period, each at that pace."""
    phase = np.cumsum(pace) * CONTROL_PERIOD_S
    position = np.full(len(pace), rng.uniform(-0.5, 0.5))
    for amplitude, frequency in zip((0.9, 0.45, 0.2, 0.06), (0.11, 0.37, 0.83, 1.9)):
        omega = 2 * np.pi * frequency * rng.uniform(0.8, 1.25)
        position += amplitude * rng.uniform(0.7, 1.2) * np.sin(omega * phase + rng.uniform(0, 2 * np.pi))
    return position


def multisine(rng, clock):
    return sines(rng, np.tanh(clock / 0.15))


def stops(rng, clock):
    """Sines that stop on their way, once in 3 to 8 s, for 0.3 to 2 s."""
    pace, start = np.tanh(clock / 0.15), rng.uniform(1.0, 4.0)
    while start < clock[-1]:
        dwell = rng.uniform(0.3, 2.0)
        pace *= 1 - 0.5 * (np.tanh((clock - start) / 0.08) - np.tanh((clock - start - dwell) / 0.08))
        start += dwell + rng.uniform(3.0, 8.0)
    return sines(rng, pace)


def moves(rng, clock):
    """From point to point within 2.4 rad at 0.1 to 2 rad/s, with rests of 0.3 to 3 s."""
    knots, points = [0.0], [rng.uniform(-1.2, 1.2)]
    while knots[-1] < clock[-1]:
        target, speed = rng.uniform(-1.2, 1.2), np.exp(rng.uniform(np.log(0.1), np.log(2.0)))
        way = min(abs(target - points[-1]), 4.0 * speed)
        rest = knots[-1] + rng.uniform(0.3, 3.0)
        knots += [rest, rest + way / speed + 1e-3]
        points += [points[-1], points[-1] + np.copysign(way, target - points[-1])]
    return smoothed(np.interp(clock, knots, points), rng.uniform(0.05, 0.2)) + rng.uniform(-0.5, 0.5)


def chirp(rng, clock):
    """A sine whose frequency grows from about 0.06 to 2 Hz, or falls; its speed grows to about 2 rad/s."""
    low, high = rng.uniform(0.04, 0.08), rng.uniform(1.5, 2.5)
    frequency = low * (high / low) ** (clock / clock[-1])
    if rng.random() < 0.5:
        frequency = frequency[::-1]
    amplitude = rng.uniform(0.8, 1.2) / (1 + frequency / 0.3)
    phase = 2 * np.pi * np.cumsum(frequency * np.tanh(clock / 0.15)) * CONTROL_PERIOD_S
    return amplitude * np.sin(phase + rng.uniform(0, 2 * np.pi)) + rng.uniform(-0.5, 0.5)


def ramps(rng, clock):
    """Strokes back and forth, each at one speed of 0.05 to 2 rad/s."""
    knots, points, side = [0.0], [rng.uniform(-0.5, 0.5)], rng.choice((-1, 1))
    while knots[-1] < clock[-1]:
        target, speed = side * rng.uniform(0.4, 1.2), np.exp(rng.uniform(np.log(0.05), np.log(2.0)))
        way, side = min(abs(target - points[-1]), 5.0 * speed), -side
        knots.append(knots[-1] + way / speed + 1e-3)
        points.append(points[-1] + np.copysign(way, target - points[-1]))
    return smoothed(np.interp(clock, knots, points), rng.uniform(0.05, 0.2)) + rng.uniform(-0.5, 0.5)


# Each has one shape or two.
KINDS = {"multisine": (multisine,), "dwell": (stops, moves), "sweep": (chirp, ramps)}


def random_motion(kind, rng, seconds):
    """Name of the shape, and position, velocity and acceleration of the command."""
    clock = np.arange(int(seconds / CONTROL_PERIOD_S)) * CONTROL_PERIOD_S
    shape = KINDS[kind][rng.integers(len(KINDS[kind]))]
    position = shape(rng, clock)
    velocity = np.gradient(position, CONTROL_PERIOD_S)
    return shape.__name__, (position, velocity, np.gradient(velocity, CONTROL_PERIOD_S))
