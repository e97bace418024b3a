import math
import struct


def bits_of(x):
    return struct.unpack("<I", struct.pack("<f", x))[0]


def held(x, low, high):
    return min(max(x, low), high)


def limited(value, limit):
    return 0.0 if math.isnan(value) else held(value, -limit, limit)


def is_finite(x):
    return math.isfinite(x) and abs(x) <= 3.4028235e38


def is_period(dt):
    return 0.0 < dt <= 1.0


def magnitude_of(x):
    return abs(x)


def f_exp(x):
    return math.exp(held(x, -87.0, 88.37))


def f_decay(x):
    return math.exp(max(-abs(x), -87.0))


def lag_share(ratio):
    x = held(ratio, 0.0, 1.0e6)
    n = x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x / 24.0)))
    return n / (1.0 + n)


def f_log(x):
    return math.log(held(abs(x), 1.1754944e-38, 3.4028235e38))


f_tanh = math.tanh
f_atan = math.atan


def f_sin(x):
    return math.sin(held(x, -32768.0, 32768.0))


def f_cos(x):
    return math.cos(held(x, -32768.0, 32768.0))


def f_power(x, p):
    return 0.0 if x == 0.0 and p > 0.0 else f_exp(p * f_log(x))


def f_square_root(x):
    return math.sqrt(abs(x))


def f_sign(x):
    return (x > 0.0) - (x < 0.0) + 0.0


least, most = min, max


def squared(x):
    return x * x


def divided(x, y):
    if y != 0.0:
        return x / y
    return math.nan if x == 0.0 or math.isnan(x) else math.copysign(math.inf, x) * math.copysign(1.0, y)


def cubic(cell, t):
    return ((cell[3] * t + cell[2]) * t + cell[1]) * t + cell[0]


def geometric(table, x, offset, sides):
    """A table whose cells grow with |x| + offset; a side has origin, last position, cells per 2^32 and the bits that turn the sign."""
    origin, last, cells_per_turn, sign = sides[math.copysign(1.0, x) < 0.0]
    product = min((bits_of(min(abs(x) + offset, 3.4e38)) - origin) % 2**32, last) * cells_per_turn
    value = cubic(table[product >> 32], 1.0 + (product % 2**32) / 2**32)
    return -value if sign else value


def uniform(table, x, low, scale, place):
    """A table of equal cells."""
    product = int(held((x - low) * scale, 0.0, 2**32 - 1)) * place[1]
    return cubic(table[place[0] + (product >> 32)], 1.0 + (product % 2**32) / 2**32)


def single(x):
    """The number in single precision that is nearest; what no such number is as large as, as the largest."""
    return struct.unpack("<f", struct.pack("<f", held(x, -3.4028235e38, 3.4028235e38)))[0]


def spot_of(position, rows):
    """Where a value lies among the rows of its edges, and the way through the row, 2^32 for the whole of it."""
    return divmod(position * rows, 2**32)


def spot_geometric(x, offset, sides):
    origin, last, rows, _ = sides[math.copysign(1.0, x) < 0.0]
    return spot_of(min((bits_of(single(abs(single(x)) + offset)) - origin) % 2**32, last), rows)


def spot_uniform(x, low, scale, rows):
    return spot_of(int(held(single(single(single(x) - low) * scale), 0.0, 2**32 - 1)), rows)


def signed(word):
    return (word + 2**31) % 2**32 - 2**31


def high(a, b):
    """The high word of a product."""
    return a * b >> 32


def add_edges(sums, spot, first, edges):
    """Edges from a spot on, each a cubic of the way, onto the sums in which they end."""
    row, way = spot
    x = way >> 1
    for target in range(len(sums)):
        a = edges[first + row * len(sums) + target]
        sums[target] = (sums[target] + a[0] + high(a[1] + high(a[2] + high(a[3], x), x), x)) % 2**32


class Motion:
    """A sample within the trained ranges; `angle` is the position as measured."""

    velocity = position = load = temperature = angle = law = dt = travel = 0.0


def smooth_sign(m, width):
    return math.tanh(m.velocity / width)


def travelled(memory, position):
    distance = position - (memory[0] if memory[1] else position)
    memory[:2] = position, 1.0
    return distance


def lagged(m, memory, time_constant):
    """Hess & Soom 1990."""
    before = memory[0] if memory[1] else m.velocity
    memory[:2] = before + lag_share(m.dt / time_constant) * (m.velocity - before), 1.0
    return memory[0]


def coulomb(m, dry, viscous, width):
    return dry * smooth_sign(m, width) + viscous * m.velocity


def stribeck(m, amplitude, velocity, exponent, width):
    return amplitude * f_exp(-f_power(m.velocity / velocity, exponent)) * smooth_sign(m, width)


def power_viscous(m, coefficient, exponent, width):
    return coefficient * f_power(m.velocity, exponent) * smooth_sign(m, width)


def asymmetry(m, dry, viscous, width):
    return dry * abs(smooth_sign(m, width)) + viscous * abs(m.velocity)


def temperature_friction(m, reference, dry, viscous, decay, width):
    warmth = m.temperature - reference
    thinned = (1.0 - f_exp(-(decay * warmth))) / decay if decay > 0.0 else warmth
    return dry * smooth_sign(m, width) * warmth + viscous * m.velocity * thinned


def load_friction(m, c, peak, velocity, width):
    sign = smooth_sign(m, width)
    coefficient = c[0] + peak * f_exp(-((m.velocity / velocity) ** 2))
    return coefficient * abs(m.load) * sign + c[1] * m.load * abs(sign) + c[2] * m.load**2 * sign


def warm_up(m, memory, c, dry, viscous, width):
    power = min(abs(m.law * m.velocity), c[1])
    memory[0] = held(memory[0] + lag_share(m.dt / c[0]) * (power - memory[0]), 0.0, c[1])
    return (dry * smooth_sign(m, width) + viscous * m.velocity) * memory[0]


def turned_over(share, travel, left):
    return share * left + math.copysign(1.0 - left, travel)


def presliding(m, memory, elements, width):
    """Maxwell slip elements of torque and distance (Dahl 1968; Al-Bender, Lampaert & Swevers 2005)."""
    torque = 0.0
    for i, (most_torque, distance) in enumerate(elements):
        memory[i] = turned_over(memory[i], m.travel, f_decay(m.travel / distance))
        torque += most_torque * (memory[i] - smooth_sign(m, width))
    return torque


def dwell_breakaway(m, memory, c, width):
    gain, time, distance, rest_velocity, limit = c
    longer = min(memory[0] + m.dt, limit)
    if abs(m.velocity) < rest_velocity:
        memory[:3] = longer, 0.0, gain * f_log(1.0 + longer / time)
    else:
        memory[:2] = 0.0, min(memory[1] + abs(m.travel) / distance, 20.0)
    return memory[2] * f_decay(memory[1]) * smooth_sign(m, width)


def ripple(m, lines):
    return sum(cosine * f_cos(order * m.angle) + sine * f_sin(order * m.angle) for order, cosine, sine in lines)


def play(m, memory, half_width):
    link = memory[0] if memory[1] else m.position
    memory[:2] = held(link, m.position - half_width, m.position + half_width), 1.0
    return m.position - memory[0]


def windup(m, memory, torque, distance):
    memory[0] = turned_over(memory[0], m.travel, f_decay(m.travel / distance))
    return torque * memory[0]


def spring(m, stiffness, rest):
    return stiffness * (m.position - rest)
