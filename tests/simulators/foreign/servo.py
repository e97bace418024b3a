"""An actuator that follows a position reference by itself and reports no torque, as joint.toml describes it, and how it is told its commands."""

from dataclasses import dataclass, replace

import numpy as np

from .joint import Joint, Plant

# Of a controller with gains on position and velocity, and of a servo whose firmware makes a duty of the position error.
KINDS = ("pd", "position_servo")


@dataclass(frozen=True)
class Servo:
    """Constants behind the gear, and what the log has."""

    kind: str  # of `KINDS`
    kp_Nm_rad: float
    kd_Nms_rad: float  # of a motor what it loses by back-EMF
    reports_velocity: bool
    forward_share: float = 0.0  # of the torque of the rigid body that the controller adds
    stall_Nm: float = 0.0  # of a motor at rest under the whole supply
    supply_V: float = 0.0
    firmware_kp: float = 0.0  # as the firmware counts it

    @property
    def is_motor(self):
        return self.kind == "position_servo"

    @property
    def torque_constant_Nm_A(self):
        return self.supply_V * self.kd_Nms_rad / self.stall_Nm

    @property
    def resistance_ohm(self):
        return self.supply_V * self.torque_constant_Nm_A / self.stall_Nm

    def duty(self, error):
        return min(max(self.kp_Nm_rad * error / self.stall_Nm, -1.0), 1.0)

    def torque_Nm(self, position, velocity, reference, reference_velocity, forward):
        """What joint.toml says that it puts out."""
        error = reference - position
        if self.is_motor:
            return self.stall_Nm * self.duty(error) - self.kd_Nms_rad * velocity
        return self.kp_Nm_rad * error + self.kd_Nms_rad * (reference_velocity - velocity) + forward

    def real(self, plant):
        """With the constants of the recorded joint: another gain of a controller, another magnet of a motor."""
        scale = plant.actuator_scale
        if self.is_motor:
            return replace(self, kp_Nm_rad=self.kp_Nm_rad * scale, kd_Nms_rad=self.kd_Nms_rad * scale**2, stall_Nm=self.stall_Nm * scale)
        return replace(self, kp_Nm_rad=self.kp_Nm_rad * scale)

    def toml(self):
        """`[actuator]` of joint.toml."""
        told = {"kp_Nm_rad": self.kp_Nm_rad, "kd_Nms_rad": self.kd_Nms_rad}
        if self.is_motor:
            told = {
                "torque_constant_Nm_A": self.torque_constant_Nm_A,
                "resistance_ohm": self.resistance_ohm,
                "supply_V": self.supply_V,
                "firmware_kp": self.firmware_kp,
                "firmware_error_gain": self.kp_Nm_rad / self.stall_Nm / self.firmware_kp,
            }
        return "\n".join([f'\n[actuator]\nkind = "{self.kind}"', *(f"{key} = {value}" for key, value in told.items()), ""])


class Control:
    """A servo that is told a motion: what reaches it, and what joint.toml says of its torque."""

    def __init__(self, servo: Servo, joint: Joint, plant: Plant, motion):
        self.servo, self.plant = servo, plant
        positions, velocities, accelerations = motion
        forward = servo.forward_share * (joint.inertia_kgm2 * accelerations + joint.gravity_torque_Nm * np.sin(positions + joint.phase_rad))
        self.told = np.column_stack((positions, velocities, forward)).tolist()
        self.band = plant.dead_band_Nm / servo.kp_Nm_rad

    def begin(self, step, position, velocity):
        """A period of the bus: commands are held until the next."""
        self.known, self.acting = self.told[step], self.told[max(step - self.plant.command_delay_steps, 0)]

    def act(self, position, velocity):
        """What the real actuator is told at this state, by a dead band too, and the torque that joint.toml has for it."""
        reference, reference_velocity, forward = self.acting
        error = reference - position
        error -= min(max(error, -self.band), self.band)
        inputs = (position + error, reference_velocity, forward)
        if self.servo.is_motor:
            inputs = self.servo.supply_V * self.servo.duty(error)
        return inputs, self.servo.torque_Nm(position, velocity, *self.known)

    def columns(self, every, rows):
        """What the log has of the commands."""
        told = np.array(self.told[: every * rows : every]).T
        names = ("reference_position_rad", "reference_velocity_rad_s", "feed_forward_Nm")[: 1 if self.servo.is_motor else 3]
        return dict(zip(names, told))


def random_servo(kind, joint, rng):
    """A servo of about 3 to 8 Hz. Half of the controllers add a part of the rigid body's torque; motors stall at 2 to 4 times what the joint
    needs to hold itself."""
    omega = 2 * np.pi * rng.uniform(3.0, 8.0)
    kp, reports_velocity = joint.inertia_kgm2 * omega**2, bool(rng.integers(2))
    if kind == "pd":
        share = float(rng.integers(2) * rng.uniform(0.3, 0.8))
        return Servo(kind, kp, 2 * rng.uniform(0.4, 1.0) * joint.inertia_kgm2 * omega, reports_velocity, share)
    stall = rng.uniform(2.0, 4.0) * (joint.gravity_torque_Nm + joint.frictionloss_Nm)
    idle_rad_s = rng.uniform(6.0, 15.0)
    return Servo(kind, kp, stall / idle_rad_s, reports_velocity, 0.0, stall, float(rng.choice((12.0, 24.0))), float(rng.integers(1, 9) * 100))
