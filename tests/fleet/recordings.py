"""Short recordings of joints of one construction, some with a fault, and one that cannot be read."""

import math
import random

# One joint in so many has a fault.
FAULT_EVERY = 50
ROWS = 300
# Siblings rub alike but for so much (standard deviation of the logarithm), and their noise differs as much.
SPREAD = 0.05
NOISE_NM = 0.03
# What is the matter with the faulty ones, in turn: friction over that of a sibling, amplitude of a ripple over position in N m, noise over
# that of a sibling.
FAULTS = [(1.3, 0.0, 1.0), (1.0, 0.08, 1.0), (1.0, 0.0, 1.6)]
# Periods of the ripple a radian.
RIPPLE = 12
FIRST_FAULT = 7


def faulty(joints):
    """Names of the joints with a fault."""
    return {name(joint) for joint in range(FIRST_FAULT, joints, FAULT_EVERY)}


def name(joint):
    return f"joint{joint:05}"


def write(folder, joints):
    """Recordings of so many joints with their separated friction, and one that is torn."""
    folder.mkdir()
    for joint in range(joints):
        (folder / f"{name(joint)}.csv").write_text(recording(joint))
    (folder / "torn.csv").write_text("velocity_rad_s,friction_torque_Nm\n0.1,oops\n")


def recording(joint):
    draw = random.Random(joint)
    is_faulty = joint % FAULT_EVERY == FIRST_FAULT
    rubs, ripple, noise = FAULTS[joint // FAULT_EVERY % len(FAULTS)] if is_faulty else (1.0, 0.0, 1.0)
    rubs *= math.exp(SPREAD * draw.gauss(0, 1))
    noise *= NOISE_NM * math.exp(SPREAD * draw.gauss(0, 1))
    rows = ["position_rad,velocity_rad_s,friction_torque_Nm"]
    for row in range(ROWS):
        v = (2 * row + 1) / ROWS - 1
        position = draw.uniform(-0.5, 0.5)
        friction = rubs * (math.copysign(2, v) + 0.6 * v) + ripple * math.sin(2 * math.pi * RIPPLE * position)
        rows.append(f"{position:.5f},{v:.5f},{friction + noise * draw.gauss(0, 1):.4f}")
    return "\n".join(rows) + "\n"
