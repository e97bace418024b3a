"""The joint in MuJoCo."""

import math

import mujoco

from .drive import REAL_SUBSTEPS
from .joint import GRAVITY_M_S2, Plant
from .motion import CONTROL_PERIOD_S

TITLE = "MuJoCo"
HAS_SOFT_CONSTRAINT = True
# Under a torque.
MOTOR = '<motor name="drive" joint="joint"/>'


class Mechanism:
    """A joint under way, driven by a motor or by a servo. Coulomb friction is the soft constraint of `frictionloss`, or a tanh of the velocity."""

    def __init__(self, joint, plant, real, servo=None):
        """The recorded joint with `real`, else the simulation; a tanh needs the short steps in both, and so does a servo, which closes its loop
        at each of them."""
        self.substeps = REAL_SUBSTEPS if real or joint.sign_width_rad_s or servo else 1
        self.simulated, self.plant, self.real = joint, plant, plant.joint(joint)
        self.model = model(joint, plant, CONTROL_PERIOD_S / self.substeps, following(servo, plant) if servo else MOTOR)
        self.data = mujoco.MjData(self.model)
        self.expected = model(joint, Plant(), CONTROL_PERIOD_S)
        self.inverse = mujoco.MjData(self.expected)
        # The soft constraint gives way by the inertia that it holds: behind a play MuJoCo takes the drive's alone, and the friction would be another.
        self.model.dof_invweight0[0] = self.expected.dof_invweight0[0]

    def place(self, position, velocity):
        self.data.qpos[0], self.data.qvel[0] = position, velocity

    def state(self):
        return float(self.data.qpos[0]), float(self.data.qvel[0])

    def advance(self, motor, now):
        """A substep on; the torque that the simulation's joint would have needed for it, and what of it is friction."""
        data, width = self.data, self.simulated.sign_width_rad_s
        data.ctrl[:] = motor
        q, v = self.state()
        coulomb = self.plant.coulomb_Nm(self.real, q, v, now, float(data.qacc[0]))
        sign = math.tanh(v / width) if width else 0.0
        data.qfrc_applied[0] = self.plant.applied_Nm(q, v, now) - coulomb * sign
        if not width:
            self.model.dof_frictionloss[0] = coulomb
        mujoco.mj_step(self.model, data)
        acceleration, known = float(data.qacc[0]), self.simulated
        if width:
            friction = known.frictionloss_Nm * sign + known.damping_Nms_rad * v
            return known.inertia_kgm2 * acceleration + known.gravity_Nm(q) + friction, friction
        inverse = self.inverse
        inverse.qpos[0], inverse.qvel[0], inverse.qacc[0] = q, v, acceleration
        mujoco.mj_inverse(self.expected, inverse)
        return float(inverse.qfrc_inverse[0]), -float(inverse.qfrc_constraint[0] + inverse.qfrc_passive[0])


def model(joint, plant, timestep, actuator=MOTOR):
    """The compiled model of the joint as `plant` alters it."""
    link = plant.joint(joint)
    lever = (-link.lever_m * math.sin(link.phase_rad), 0.0, -link.lever_m * math.cos(link.phase_rad))
    own = link.link_inertia_kgm2 - link.mass_kg * link.lever_m**2
    words = " ".join(f'{name}="{value}"' for name, value in attributes(link, plant).items())
    body = f"""<inertial pos="{lever[0]} 0 {lever[2]}" mass="{link.mass_kg}" diaginertia="{own} {own} {own}"/>{{}}{payload(plant)}"""
    driven = f'<joint name="joint" axis="0 1 0" {words}/>'
    if plant.play:
        hull = plant.play.hull_kgm2(joint)
        inside = body.format(f'<joint name="play" axis="0 1 0" {play(plant.play)}/>')
        body = f'<inertial pos="0 0 0" mass="1e-6" diaginertia="{hull} {hull} {hull}"/>{driven}<body name="link">{inside}</body>'
    else:
        body = body.format(driven)
    return mujoco.MjModel.from_xml_string(f"""<mujoco model="foreign">
  <option timestep="{timestep}" gravity="0 0 -{GRAVITY_M_S2}"/>
  <worldbody><body name="arm">{body}</body></worldbody>
  <actuator>{actuator}{resistances(plant)}</actuator>
</mujoco>""")


def following(servo, plant):
    """The actuator of a servo as `plant` alters it, in MJCF: a controller, or a motor under the voltage that its firmware makes of the supply."""
    real, limit = servo.real(plant), plant.command_limit_Nm
    is_limited = math.isfinite(limit)
    if real.is_motor:
        saturation = f'saturation="{limit} 0 0"' if is_limited else ""
        return f'<dcmotor name="drive" joint="joint" motorconst="{real.torque_constant_Nm_A}" resistance="{real.resistance_ohm}" {saturation}/>'
    force = f'forcelimited="true" forcerange="{-limit} {limit}"' if is_limited else ""
    return f'<pid name="drive" joint="joint" input="pos vel ff" kp="{real.kp_Nm_rad}" kv="{real.kd_Nms_rad}" {force}/>'


def attributes(link, plant):
    """Of the driven joint, in MJCF."""
    damping = f"{link.damping_Nms_rad} 0 {plant.cubic_damping_Nms3_rad3}" if plant.cubic_damping_Nms3_rad3 else link.damping_Nms_rad
    found = {"armature": link.armature_kgm2, "damping": damping, "frictionloss": 0.0 if link.sign_width_rad_s else link.frictionloss_Nm}
    if plant.spring:
        found |= {"stiffness": plant.spring.stiffness_Nm_rad, "springref": math.degrees(plant.spring.rest_rad)}
    if plant.stop:
        at = math.degrees(plant.stop.position_rad)
        limits = f"{at - 1000} {at}" if plant.stop.upper else f"{at} {at + 1000}"
        found |= {"limited": "true", "range": limits, "solreflimit": f"{plant.stop.time_constant_s} 1"}
    return found


def resistances(plant):
    """Motors without a voltage that have bristles or cogging, in MJCF."""
    motor = '<dcmotor joint="joint" input="none" motorconst="0" resistance="1" {}/>'
    words = []
    if plant.bristles:
        of = plant.bristles
        words.append(f'lugre="{of.stiffness_Nm_rad} {of.damping_Nms_rad} {of.coulomb_Nm} {of.coulomb_Nm} 1"')
    if plant.ripple:
        of = plant.ripple
        words.append(f'gear="{of.order}" cogging="{of.torque_Nm / of.order} 1 {of.phase_rad}"')
    return "".join(motor.format(one) for one in words)


def payload(plant):
    if not plant.payload:
        return ""
    of = plant.payload
    small, place = of.own_inertia_kgm2, f"{-of.lever_m * math.sin(of.phase_rad)} 0 {-of.lever_m * math.cos(of.phase_rad)}"
    return f'<body><inertial pos="{place}" mass="{of.mass_kg}" diaginertia="{small} {small} {small}"/></body>'


def play(of):
    """Attributes of the joint between drive and link, in MJCF."""
    if of.half_gap_rad is None:
        return f'stiffness="{of.stiffness_Nm_rad}" damping="{of.damping_Nms_rad}"'
    half = math.degrees(of.half_gap_rad)
    return f'limited="true" range="{-half} {half}" solreflimit="0.004 1" damping="{of.damping_Nms_rad}"'
