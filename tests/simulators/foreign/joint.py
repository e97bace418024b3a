"""A driven joint as a simulation knows it, and how the real one departs from it, in no simulator's words."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

GRAVITY_M_S2 = 9.81


@dataclass(frozen=True)
class Joint:
    """What the simulation knows; inertia of the link about the axis, without the armature."""

    link_inertia_kgm2: float
    armature_kgm2: float
    mass_kg: float
    lever_m: float
    phase_rad: float
    frictionloss_Nm: float
    damping_Nms_rad: float
    sign_width_rad_s: float  # of the tanh of Coulomb friction; 0 for a soft constraint

    @property
    def inertia_kgm2(self):
        return self.link_inertia_kgm2 + self.armature_kgm2

    @property
    def gravity_torque_Nm(self):
        return self.mass_kg * GRAVITY_M_S2 * self.lever_m

    def gravity_Nm(self, position):
        return self.gravity_torque_Nm * math.sin(position + self.phase_rad)


@dataclass(frozen=True)
class Bristles:
    """LuGre friction without a Stribeck effect."""

    stiffness_Nm_rad: float
    damping_Nms_rad: float
    coulomb_Nm: float


@dataclass(frozen=True)
class Ripple:
    """Torque of a sine of the angle."""

    torque_Nm: float
    order: int  # periods a turn
    phase_rad: float


@dataclass(frozen=True)
class Spring:
    stiffness_Nm_rad: float
    rest_rad: float


@dataclass(frozen=True)
class Stop:
    """A soft stop, about critically damped."""

    position_rad: float
    upper: bool
    time_constant_s: float = 0.01


@dataclass(frozen=True)
class PointMass:
    """A small mass fixed to the link."""

    mass_kg: float
    lever_m: float
    phase_rad: float

    @property
    def own_inertia_kgm2(self):
        return self.mass_kg * self.lever_m**2 * 1e-4


@dataclass(frozen=True)
class Play:
    """A second joint between drive and link: a spring, or a gap of that half width where there is one."""

    damping_Nms_rad: float
    stiffness_Nm_rad: float = 0.0
    half_gap_rad: float | None = None

    @staticmethod
    def hull_kgm2(joint):
        """Inertia of the body between the two joints, beside the armature."""
        return joint.link_inertia_kgm2 * 1e-6


@dataclass
class Plant:
    """How the real joint departs from the simulation. Callables see the state of every substep."""

    changes: dict = field(default_factory=dict)  # fields of `Joint` in place of the simulation's
    cubic_damping_Nms3_rad3: float = 0.0
    bristles: Bristles | None = None
    ripple: Ripple | None = None
    spring: Spring | None = None
    stop: Stop | None = None
    payload: PointMass | None = None
    play: Play | None = None
    level: object = None  # Coulomb friction over position, velocity, time and transmitted torque, N m
    applied: object = None  # torque on the joint over position, velocity and time, N m
    command_limit_Nm: float = math.inf  # of motor or servo; the log has the command
    command_delay_steps: int = 0  # of motor or servo; the log has the command
    torque_delay_steps: int = 0  # of the logged torque
    torque_scale: float = 1.0  # of the logged torque
    actuator_scale: float = 1.0  # of the gain of a controller, or the torque constant of a motor
    dead_band_Nm: float = 0.0  # torque of the position error about which a servo does nothing

    def joint(self, simulated):
        """The real joint."""
        return replace(simulated, **self.changes)

    def coulomb_Nm(self, real, position, velocity, now, acceleration):
        """Level of Coulomb friction of the real joint."""
        if not self.level:
            return real.frictionloss_Nm
        return self.level(position, velocity, now, real.link_inertia_kgm2 * acceleration + real.gravity_Nm(position))

    def applied_Nm(self, position, velocity, now):
        return self.applied(position, velocity, now) if self.applied else 0.0


def random_joint(rng, soft_constraint):
    """A servo, an elbow or a shoulder, each with its own friction; half of them with a soft constraint, where the simulator has one."""
    mass, lever, fraction = [(0.3, 0.08, 0.04), (1.5, 0.2, 0.05), (8.0, 0.4, 0.06)][rng.integers(3)]
    mass, lever = mass * rng.uniform(0.7, 1.4), lever * rng.uniform(0.7, 1.4)
    link = mass * lever**2 * rng.uniform(1.2, 1.6)
    weight = mass * GRAVITY_M_S2 * lever
    return Joint(
        link_inertia_kgm2=link,
        armature_kgm2=link * rng.uniform(0.2, 1.0),
        mass_kg=mass,
        lever_m=lever,
        phase_rad=rng.uniform(-0.6, 0.6),
        frictionloss_Nm=weight * rng.uniform(0.1, 0.5),
        damping_Nms_rad=weight * fraction * rng.uniform(0.5, 2.0),
        sign_width_rad_s=max(rng.choice((0, 1)), not soft_constraint) * float(np.exp(rng.uniform(np.log(0.01), np.log(0.1)))),
    )
