"""Five joints and the simulations of them, each with something missing."""

import math

from joints import STEP, Drive, Pair, dahl, law, lugre


def one_joint(name, body, inertial, joint, actuator):
    """MJCF of one joint."""
    return f"""<mujoco model="{name}">
  <option timestep="{STEP}"/>
  <worldbody>
    <body name="{body}">
      {inertial}
      {joint}
    </body>
  </worldbody>
  <actuator>
    {actuator}
  </actuator>
</mujoco>
"""


ELBOW_MODEL = one_joint(
    "elbow",
    "arm",
    '<!-- hanging -->\n      <inertial pos="0 0 -0.2" mass="1.5" diaginertia="0.24 0.24 0.01"/>',
    '<joint name="elbow" axis="0 1 0" frictionloss="1" damping="0.5"/>',
    '<motor name="drive" joint="elbow"/>',
)

AXIS_MODEL = one_joint(
    "axis",
    "carriage",
    '<inertial pos="0 0 0" mass="12" diaginertia="0.1 0.1 0.1"/>',
    '<joint name="slide" type="slide" axis="1 0 0" frictionloss="20" damping="60"/>',
    '<motor name="drive" joint="slide"/>',
)

SERVO_MODEL = one_joint(
    "servo",
    "horn",
    '<inertial pos="0 0 0" mass="0.4" diaginertia="0.02 0.02 0.02"/>',
    '<joint name="servo" axis="0 0 1" frictionloss="0.6" damping="0.2"/>',
    '<position name="drive" joint="servo" kp="60" kv="2"/>',
)

GEAR_MODEL = one_joint(
    "gear",
    "upper_arm",
    '<inertial pos="0 0 -0.3" mass="4" diaginertia="0.04 0.04 0.01"/>',
    '<joint name="shoulder" axis="0 1 0" armature="0.3" frictionloss="1" damping="0.6"/>',
    '<motor name="drive" joint="shoulder"/>',
)

ARM_MODEL = f"""<mujoco model="arm">
  <option timestep="{STEP}"/>
  <worldbody>
    <body name="upper_arm">
      <inertial pos="0 0 -0.15" mass="2.5" diaginertia="0.02 0.02 0.005"/>
      <joint name="shoulder" axis="0 1 0" armature="0.4" frictionloss="2" damping="1"/>
      <body name="forearm" pos="0 0 -0.3">
        <inertial pos="0 0 -0.15" mass="1.5" diaginertia="0.012 0.012 0.003"/>
        <joint name="elbow" axis="0 1 0" frictionloss="1" damping="0.4"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="elbow"/>
    <motor name="shoulder_drive" joint="shoulder"/>
  </actuator>
</mujoco>
"""

ELBOW_FRICTION = law(2.0, 1.0, 0.1, 1.2, 0.002)
AXIS_FRICTION = law(35.0, 0.0, 1.0, 90.0, 0.001)
ARM_FRICTION = law(1.5, 0.7, 0.1, 0.8, 0.002)

ELBOW = Pair(
    name="elbow",
    model=ELBOW_MODEL,
    joint="elbow",
    truth={"armature": 0.2, "frictionloss": 2.0, "damping": 1.2},
    friction=lambda: lambda q, v, transmitted, dt: ELBOW_FRICTION(v),
    gains=(200.0, 15.0),
    amplitudes=(0.8, 0.3, 0.08),
    noise=0.05,
    # Bristles of 0.2 rad a time step on 0.5 kg m2, half critically damped; Coulomb, static friction, Stribeck velocity.
    actuator=lugre("elbow", 20000, 100, 2, 3, 0.1),
    beside_actuator={"frictionloss": 0.0},
)

# Ripple every 20 mm, the pitch of a screw.
RIPPLE, ORDER, PHASE = 4.0, 2 * math.pi * 50.0, 0.7

AXIS = Pair(
    name="axis",
    model=AXIS_MODEL,
    joint="slide",
    truth={"armature": 5.0, "frictionloss": 35.0, "damping": 90.0},
    friction=lambda: lambda q, v, transmitted, dt: AXIS_FRICTION(v) + RIPPLE * math.sin(ORDER * q + PHASE),
    gains=(40000.0, 1500.0),
    amplitudes=(0.15, 0.06, 0.012),
    noise=0.5,
    # What the joint resists the motor gives, half a period later; a gear turns a period into a radian.
    actuator=f'<dcmotor joint="slide" input="none" motorconst="0" resistance="1" gear="{ORDER}" cogging="{RIPPLE / ORDER} 1 {PHASE + math.pi}"/>',
    linear=True,
)

SERVO = Pair(
    name="servo",
    model=SERVO_MODEL,
    joint="servo",
    truth={"armature": 0.03, "frictionloss": 1.0, "damping": 0.35},
    friction=lambda: dahl(1.0, 250.0, 0.35),
    gains=None,
    amplitudes=(0.6, 0.2, 0.05),
    noise=0.01,
    # The stiffness of the truth, half critically damped on 0.05 kg m2.
    actuator=lugre("servo", 250, 3.5, 1, 1, 1),
    beside_actuator={"frictionloss": 0.0},
)

# A gear that loses a tenth of the torque that it transmits, as strain wave and planetary gears do.
LOST_SHARE = 0.1
GEAR_FRICTION = law(1.5, 0.0, 1.0, 1.0, 0.002)
LOAD_FRICTION = law(LOST_SHARE, 0.0, 1.0, 0.0, 0.002)

GEAR = Pair(
    name="gear",
    model=GEAR_MODEL,
    joint="shoulder",
    truth={"frictionloss": 1.5, "damping": 1.0},
    friction=lambda: lambda q, v, transmitted, dt: GEAR_FRICTION(v) + abs(transmitted) * LOAD_FRICTION(v),
    gains=(300.0, 25.0),
    amplitudes=(0.8, 0.3, 0.08),
    noise=0.05,
    torque_sensor=True,
    more_columns=("load_torque_Nm",),
    of_load=True,
)

ARM = Pair(
    name="arm",
    model=ARM_MODEL,
    joint="elbow",
    truth={"armature": 0.12, "frictionloss": 1.5, "damping": 0.8},
    friction=lambda: lambda q, v, transmitted, dt: ARM_FRICTION(v),
    gains=(120.0, 9.0),
    amplitudes=(0.8, 0.3, 0.08),
    noise=0.03,
    columns=("q2", "dq2", "tau2"),
    others=(Drive("shoulder", "shoulder_drive", (300.0, 25.0), (0.5, 0.2, 0.05)),),
    more_columns=("q1", "dq1"),
    # Bristles of 0.2 rad a time step on 0.166 kg m2, half critically damped.
    actuator=lugre("elbow", 6640, 33.2, 1.5, 2.2, 0.1),
    beside_actuator={"frictionloss": 0.0},
)

PAIRS = {pair.name: pair for pair in (ELBOW, AXIS, SERVO, GEAR, ARM)}
