"""What a recording has and its simulation leaves out, and the names of it that are right.

A name is right where it is that of the equation in the plant. Beside it only names of other terms that the same change of the plant brings
along count. What one recording cannot tell apart has to be stated as a set: a lone rival is wrong.
"""

import math
from dataclasses import dataclass

import numpy as np

from .joint import GRAVITY_M_S2, Bristles, Plant, Play, PointMass, Ripple, Spring, Stop


@dataclass(frozen=True)
class Effect:
    """`plant` of joint, motion, a random generator of its shape, and the size (about 1; the torque grows with it)."""

    names: tuple  # that are right
    why: str
    plant: object
    beside: tuple = ()  # neither right nor wrong: part of the change as the catalogue splits it up
    share: float = 1.0  # of the friction, as a multiple of the usual one
    sized: bool = True
    given: str = ""  # what would take the effect away if it were refitted: "level" (friction and body), or "body"
    only: str = ""  # with a "torque" column, or with a "servo" that reports none


def coulomb(joint, motion, rng):
    sign = rng.choice((-1, 1))
    return lambda size: Plant(changes={"frictionloss_Nm": joint.frictionloss_Nm * max(1 + 0.1 * sign * size, 0.02)})


def viscous(joint, motion, rng):
    sign = rng.choice((-1, 1))
    return lambda size: Plant(changes={"damping_Nms_rad": joint.damping_Nms_rad * max(1 + 0.2 * sign * size, 0.02)})


def stribeck(joint, motion, rng):
    speed = rng.uniform(0.05, 0.15) * np.abs(motion[1]).max()
    loss = joint.frictionloss_Nm
    return lambda size: Plant(level=lambda q, v, t, load: loss * (1 + 0.2 * size * math.exp(-((v / speed) ** 2))))


def load(joint, motion, rng):
    loss = joint.frictionloss_Nm
    return lambda size: Plant(level=lambda q, v, t, load: loss + 0.05 * size * abs(load))


def driving_loss(joint, motion, rng):
    loss = joint.frictionloss_Nm
    return lambda size: Plant(level=lambda q, v, t, load: loss + (0.1 * size * abs(load) if load * v > 0 else 0.0))


def presliding(joint, motion, rng):
    loss, inertia = joint.frictionloss_Nm, joint.inertia_kgm2

    def plant(size):
        stiffness = loss / (0.03 * size)
        return Plant(changes={"frictionloss_Nm": 0.0}, bristles=Bristles(stiffness, math.sqrt(stiffness * inertia), loss))

    return plant


def spring(joint, motion, rng):
    middle, stiffness = rng.uniform(-0.5, 0.5), 0.1 * joint.frictionloss_Nm
    return lambda size: Plant(spring=Spring(stiffness * size, middle))


def gravity(joint, motion, rng):
    angle = rng.uniform(0, 2 * math.pi)
    change = 0.05 * joint.frictionloss_Nm / joint.gravity_torque_Nm * np.exp(1j * angle)

    def plant(size):
        moment = np.exp(1j * joint.phase_rad) + change * size
        return Plant(changes={"mass_kg": joint.mass_kg * abs(moment), "phase_rad": float(np.angle(moment))})

    return plant


def payload(joint, motion, rng):
    # Beside the line to the mass of the link: on it, a payload is a scale of the torque and an inertia.
    at, angle = joint.lever_m * rng.uniform(1.0, 2.0), joint.phase_rad + rng.choice((-1, 1)) * rng.uniform(0.4, 1.0)
    mass = 0.1 * joint.frictionloss_Nm / GRAVITY_M_S2 / at
    return lambda size: Plant(payload=PointMass(mass * size, at, angle))


def armature(joint, motion, rng):
    added = 0.1 * joint.frictionloss_Nm / np.sqrt(np.mean(motion[2] ** 2))
    return lambda size: Plant(changes={"armature_kgm2": joint.armature_kgm2 + added * size})


def inside(motion, rng, low=0.25, high=0.75):
    return float(np.quantile(motion[0], rng.uniform(low, high)))


def position_friction(joint, motion, rng):
    middle, width, loss = inside(motion, rng), rng.uniform(0.1, 0.25) * np.ptp(motion[0]), joint.frictionloss_Nm
    return lambda size: Plant(level=lambda q, v, t, load: loss * (1 + 0.2 * size * math.exp(-0.5 * ((q - middle) / width) ** 2)))


def ripple(joint, motion, rng):
    order, phase, torque = int(rng.integers(4, 31)), rng.uniform(0, 2 * math.pi), 0.1 * joint.frictionloss_Nm
    return lambda size: Plant(ripple=Ripple(torque * size, order, phase))


def contact(joint, motion, rng):
    upper, travel = rng.random() < 0.5, np.ptp(motion[0])

    def plant(size):
        depth = 0.02 * travel * size
        return Plant(stop=Stop(motion[0].max() - depth if upper else motion[0].min() + depth, upper))

    return plant


def backlash(joint, motion, rng):
    return lambda size: Plant(play=Play(1e-3 * joint.damping_Nms_rad, half_gap_rad=0.003 * size))


def elasticity(joint, motion, rng):
    def plant(size):
        stiffness = joint.link_inertia_kgm2 * (2 * math.pi * 8.0) ** 2 / size
        return Plant(play=Play(0.1 * math.sqrt(stiffness * joint.link_inertia_kgm2), stiffness))

    return plant


def drift(joint, motion, rng):
    loss, sign, end = joint.frictionloss_Nm, rng.choice((-1, 1)), 0.001 * len(motion[0])
    return lambda size: Plant(level=lambda q, v, t, load: loss * max(1 + 0.2 * sign * size * t / end, 0.02))


def offset(joint, motion, rng):
    torque = 0.1 * joint.frictionloss_Nm * rng.choice((-1, 1))
    return lambda size: Plant(applied=lambda q, v, t: torque * size)


def asymmetry(joint, motion, rng):
    loss, sign = joint.frictionloss_Nm, rng.choice((-1, 1))
    return lambda size: Plant(level=lambda q, v, t, load: loss * max(1 + 0.1 * size * math.copysign(sign, v), 0.02))


def measured_late(joint, motion, rng):
    steps = 4 * int(rng.integers(2, 4))
    return lambda size: Plant(torque_delay_steps=steps)


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
    return lambda size: Plant(cubic_damping_Nms3_rad3=cubic * size)


def event(joint, motion, rng):
    end = 0.001 * len(motion[0])
    start, length = rng.uniform(0.2, 0.7) * end, rng.uniform(0.5, 1.5)
    torque = 0.5 * joint.frictionloss_Nm * rng.choice((-1, 1))
    return lambda size: Plant(applied=lambda q, v, t: torque * size if start <= t <= start + length else 0.0)


def torque_scale(joint, motion, rng):
    return lambda size: Plant(torque_scale=1 + 0.02 * size)


def actuator_gain(joint, motion, rng):
    scale = 1 + rng.choice((-1, 1)) * rng.uniform(0.1, 0.2)
    return lambda size: Plant(actuator_scale=scale)


def servo_late(joint, motion, rng):
    steps = int(rng.integers(8, 21))
    return lambda size: Plant(command_delay_steps=steps)


def dead_band(joint, motion, rng):
    torque = 0.3 * joint.frictionloss_Nm
    return lambda size: Plant(dead_band_Nm=torque * size)


EFFECTS = {
    "coulomb_level": Effect(("friction_level",), "level of Coulomb friction", coulomb, given="level"),
    "viscous_level": Effect(("friction_level",), "damping of the joint", viscous, given="level"),
    "stribeck": Effect(("stribeck",), "Coulomb friction over speed", stribeck),
    "load": Effect(("load_friction",), "Coulomb friction over the transmitted torque", load, beside=("friction_level",)),
    "driving_loss": Effect(("drive_backdrive", "load_friction"), "loss while the gear drives: half of it is load friction", driving_loss, beside=("friction_level",)),
    "presliding": Effect(("presliding",), "LuGre bristles, static friction as Coulomb's", presliding, share=3.0),
    "spring": Effect(("spring",), "a linear spring", spring),
    "gravity": Effect(("gravity_error",), "another mass at another angle, inertia kept", gravity, given="body"),
    "payload": Effect(("gravity_error", "inertia_error"), "a mass has weight and inertia", payload, given="body"),
    "armature": Effect(("inertia_error",), "rotor inertia", armature, given="body"),
    "position_friction": Effect(("position_friction",), "Coulomb friction over the angle, a smooth bump", position_friction, beside=("friction_level",)),
    "ripple": Effect(("position_ripple",), "cogging, a sine of the angle", ripple),
    "contact": Effect(("contact",), "a stop at one end of the motion", contact),
    "backlash": Effect(("backlash",), "two bodies and a gap, drive side recorded", backlash, share=3.0),
    "elasticity": Effect(("elasticity",), "two bodies and a spring, drive side recorded", elasticity),
    "drift": Effect(("slow_drift",), "Coulomb friction over time", drift, beside=("friction_level",)),
    "offset": Effect(("torque_offset",), "constant applied torque", offset),
    "asymmetry": Effect(("direction_asymmetry",), "Coulomb friction over the direction", asymmetry),
    "measured_late": Effect(("time_misalignment",), "torque column 8 or 12 ms late", measured_late, sized=False, only="torque"),
    "command_early": Effect(("time_misalignment", "command_delay"), "the log has the command, the motor follows 8 or 12 ms later", command_early, sized=False, only="torque"),
    "saturation": Effect(("saturation",), "the log has the command, the motor its limit", saturation, only="torque"),
    "viscous_nonlinearity": Effect(("viscous_nonlinearity",), "cubic damping", viscous_nonlinearity, beside=("friction_level",)),
    "event": Effect(("transient_event",), "a constant torque for about a second", event),
    "torque_scale": Effect(("torque_scale", "drive_backdrive"), "scaled torque column; equal to a loss in one direction of power", torque_scale, beside=("friction_level",), given="body", only="torque"),
    "actuator_gain": Effect(("actuator_gain",), "gain of a controller, torque constant of a motor: 10 to 20 % off", actuator_gain, sized=False, given="body", only="servo"),
    "torque_limit": Effect(("supply_or_duty_limit",), "the actuator's torque has a limit that it meets again and again", saturation, share=10.0, only="servo"),
    "command_delay": Effect(("command_delay",), "a command acts 8 to 20 ms later", servo_late, sized=False, given="level", only="servo"),
    "dead_band": Effect(("dead_band",), "nothing is done about a small position error", dead_band, only="servo"),
}


def of_reference(reference):
    """Names of the effects that pairs with such a reference can have. Of a servo the actuator's come twice as often as the joint's."""
    if reference == "servo":
        actuator = [name for name, of in EFFECTS.items() if of.only == "servo"]
        return [name for name, of in EFFECTS.items() if of.only != "torque"] + actuator[::-1]
    return [name for name, of in EFFECTS.items() if of.only != "servo" and (reference != "alone" or of.given != "level")]
