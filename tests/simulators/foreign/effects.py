"""What a recording has and its simulation leaves out, and the names of it that are right.

A name is right where it is that of the equation in the plant. Beside it only names of other terms that the same change of the plant brings
along count. What one recording cannot tell apart has to be stated as a set: a lone rival is wrong.
"""

import math
from dataclasses import dataclass

import numpy as np

from .joint import GRAVITY_M_S2, Plant


@dataclass(frozen=True)
class Effect:
    """`plant` of joint, motion, a random generator of its shape, and the size (about 1; the torque grows with it)."""

    names: tuple  # that are right
    why: str
    plant: object
    beside: tuple = ()  # neither right nor wrong: part of the change as the catalogue splits it up
    share: float = 1.0  # of the friction, as a multiple of the usual one
    sized: bool = True


def coulomb(joint, motion, rng):
    sign = rng.choice((-1, 1))
    return lambda size: Plant(attributes={"frictionloss": joint.frictionloss_Nm * max(1 + 0.1 * sign * size, 0.02)})


def viscous(joint, motion, rng):
    sign = rng.choice((-1, 1))
    return lambda size: Plant(attributes={"damping": joint.damping_Nms_rad * max(1 + 0.2 * sign * size, 0.02)})


def stribeck(joint, motion, rng):
    speed = rng.uniform(0.05, 0.15) * np.abs(motion[1]).max()
    loss = joint.frictionloss_Nm
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss * (1 + 0.2 * size * math.exp(-((v / speed) ** 2))))


def load(joint, motion, rng):
    loss = joint.frictionloss_Nm
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss + 0.05 * size * abs(load))


def driving_loss(joint, motion, rng):
    loss = joint.frictionloss_Nm
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss + (0.1 * size * abs(load) if load * v > 0 else 0.0))


def presliding(joint, motion, rng):
    loss, inertia = joint.frictionloss_Nm, joint.inertia_kgm2

    def plant(size):
        stiffness = loss / (0.03 * size)
        damping = math.sqrt(stiffness * inertia)
        lugre = f'<dcmotor joint="joint" input="none" motorconst="0" resistance="1" lugre="{stiffness} {damping} {loss} {loss} 1"/>'
        return Plant(attributes={"frictionloss": 0.0}, actuators=lugre)

    return plant


def spring(joint, motion, rng):
    middle, stiffness = rng.uniform(-0.5, 0.5), 0.1 * joint.frictionloss_Nm
    return lambda size: Plant(attributes={"stiffness": stiffness * size, "springref": math.degrees(middle)})


def gravity(joint, motion, rng):
    angle = rng.uniform(0, 2 * math.pi)
    change = 0.05 * joint.frictionloss_Nm / joint.gravity_torque_Nm * np.exp(1j * angle)

    def plant(size):
        moment = np.exp(1j * joint.phase_rad) + change * size
        return Plant(inertial={"mass_kg": joint.mass_kg * abs(moment), "phase_rad": float(np.angle(moment))})

    return plant


def payload(joint, motion, rng):
    # Beside the line to the mass of the link: on it, a payload is a scale of the torque and an inertia.
    at, angle = joint.lever_m * rng.uniform(1.0, 2.0), joint.phase_rad + rng.choice((-1, 1)) * rng.uniform(0.4, 1.0)
    mass = 0.1 * joint.frictionloss_Nm / GRAVITY_M_S2 / at
    place = f"{-at * math.sin(angle)} 0 {-at * math.cos(angle)}"

    def plant(size):
        small = mass * size * at**2 * 1e-4
        inertial = f'<inertial pos="{place}" mass="{mass * size}" diaginertia="{small} {small} {small}"/>'
        return Plant(bodies=f"<body>{inertial}</body>")

    return plant


def armature(joint, motion, rng):
    added = 0.1 * joint.frictionloss_Nm / np.sqrt(np.mean(motion[2] ** 2))
    return lambda size: Plant(attributes={"armature": joint.armature_kgm2 + added * size})


def inside(motion, rng, low=0.25, high=0.75):
    return float(np.quantile(motion[0], rng.uniform(low, high)))


def position_friction(joint, motion, rng):
    middle, width, loss = inside(motion, rng), rng.uniform(0.1, 0.25) * np.ptp(motion[0]), joint.frictionloss_Nm
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss * (1 + 0.2 * size * math.exp(-0.5 * ((q - middle) / width) ** 2)))


def ripple(joint, motion, rng):
    order, phase, torque = int(rng.integers(4, 31)), rng.uniform(0, 2 * math.pi), 0.1 * joint.frictionloss_Nm

    def plant(size):
        cogging = f'cogging="{torque * size / order} 1 {phase}"'
        return Plant(actuators=f'<dcmotor joint="joint" input="none" motorconst="0" resistance="1" gear="{order}" {cogging}/>')

    return plant


def contact(joint, motion, rng):
    upper, travel = rng.random() < 0.5, np.ptp(motion[0])

    def plant(size):
        depth = 0.02 * travel * size
        stop = math.degrees(motion[0].max() - depth if upper else motion[0].min() + depth)
        limits = f"{stop - 1000} {stop}" if upper else f"{stop} {stop + 1000}"
        return Plant(attributes={"limited": "true", "range": limits, "solreflimit": "0.01 1"})

    return plant


def backlash(joint, motion, rng):
    def plant(size):
        half = math.degrees(0.003 * size)
        return Plant(play=f'limited="true" range="{-half} {half}" solreflimit="0.004 1" damping="{1e-3 * joint.damping_Nms_rad}"')

    return plant


def elasticity(joint, motion, rng):
    def plant(size):
        stiffness = joint.link_inertia_kgm2 * (2 * math.pi * 8.0) ** 2 / size
        damping = 0.1 * math.sqrt(stiffness * joint.link_inertia_kgm2)
        return Plant(play=f'stiffness="{stiffness}" damping="{damping}"')

    return plant


def drift(joint, motion, rng):
    loss, sign, end = joint.frictionloss_Nm, rng.choice((-1, 1)), 0.001 * len(motion[0])
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss * max(1 + 0.2 * sign * size * t / end, 0.02))


def offset(joint, motion, rng):
    torque = 0.1 * joint.frictionloss_Nm * rng.choice((-1, 1))
    return lambda size: Plant(applied=lambda q, v, t: torque * size)


def asymmetry(joint, motion, rng):
    loss, sign = joint.frictionloss_Nm, rng.choice((-1, 1))
    return lambda size: Plant(frictionloss=lambda q, v, t, load: loss * max(1 + 0.1 * size * math.copysign(sign, v), 0.02))


def measured_late(joint, motion, rng):
    rows = int(rng.integers(2, 4))
    return lambda size: Plant(torque_delay_rows=rows)


def command_early(joint, motion, rng):
    steps = 4 * int(rng.integers(2, 4))
    return lambda size: Plant(command_delay_steps=steps)


def saturation(joint, motion, rng):
    torque = joint.inertia_kgm2 * motion[2] + joint.gravity_torque_Nm * np.sin(motion[0] + joint.phase_rad)
    peak = np.abs(torque).max() + joint.frictionloss_Nm
    return lambda size: Plant(command_limit_Nm=peak * math.exp(-0.3 * size))


def viscous_nonlinearity(joint, motion, rng):
    speed = np.abs(motion[1]).max()
    cubic = 0.3 * joint.frictionloss_Nm / speed**3
    return lambda size: Plant(attributes={"damping": f"{joint.damping_Nms_rad} 0 {cubic * size}"})


def event(joint, motion, rng):
    end = 0.001 * len(motion[0])
    start, length = rng.uniform(0.2, 0.7) * end, rng.uniform(0.5, 1.5)
    torque = 0.5 * joint.frictionloss_Nm * rng.choice((-1, 1))
    return lambda size: Plant(applied=lambda q, v, t: torque * size if start <= t <= start + length else 0.0)


def torque_scale(joint, motion, rng):
    return lambda size: Plant(torque_scale=1 + 0.02 * size)


EFFECTS = {
    "coulomb_level": Effect(("friction_level",), "frictionloss of the joint", coulomb),
    "viscous_level": Effect(("friction_level",), "damping of the joint", viscous),
    "stribeck": Effect(("stribeck",), "frictionloss over speed", stribeck),
    "load": Effect(("load_friction",), "frictionloss over the transmitted torque", load, beside=("friction_level",)),
    "driving_loss": Effect(("drive_backdrive", "load_friction"), "loss while the gear drives: half of it is load friction", driving_loss, beside=("friction_level",)),
    "presliding": Effect(("presliding",), "LuGre bristles of a dcmotor, static friction as Coulomb's", presliding, share=3.0),
    "spring": Effect(("spring",), "stiffness and springref", spring),
    "gravity": Effect(("gravity_error",), "another mass at another angle, inertia kept", gravity),
    "payload": Effect(("gravity_error", "inertia_error"), "a mass has weight and inertia", payload),
    "armature": Effect(("inertia_error",), "armature of the joint", armature),
    "position_friction": Effect(("position_friction",), "frictionloss over the angle, a smooth bump", position_friction, beside=("friction_level",)),
    "ripple": Effect(("position_ripple",), "cogging of a dcmotor", ripple),
    "contact": Effect(("contact",), "range of the joint", contact),
    "backlash": Effect(("backlash",), "two bodies and a gap, drive side recorded", backlash, share=3.0),
    "elasticity": Effect(("elasticity",), "two bodies and a spring, drive side recorded", elasticity),
    "drift": Effect(("slow_drift",), "frictionloss over time", drift, beside=("friction_level",)),
    "offset": Effect(("torque_offset",), "constant applied torque", offset),
    "asymmetry": Effect(("direction_asymmetry",), "frictionloss over the direction", asymmetry),
    "measured_late": Effect(("time_misalignment",), "torque column two or three rows late", measured_late, sized=False),
    "command_early": Effect(("time_misalignment", "command_delay"), "the log has the command, the motor follows 8 or 12 ms later", command_early, sized=False),
    "saturation": Effect(("saturation",), "the log has the command, the motor its limit", saturation),
    "viscous_nonlinearity": Effect(("viscous_nonlinearity",), "cubic damping", viscous_nonlinearity, beside=("friction_level",)),
    "event": Effect(("transient_event",), "a constant torque for about a second", event),
    "torque_scale": Effect(("torque_scale", "drive_backdrive"), "scaled torque column; equal to a loss in one direction of power", torque_scale, beside=("friction_level",)),
}
