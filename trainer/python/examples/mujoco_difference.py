"""A recording beside a MuJoCo model of the same joint: what does the model leave out?

    python trainer/python/examples/mujoco_difference.py fixtures/elbow.toml

The recording is simulated here, of an elbow with Stribeck friction whose contact bends before it slides; the model knows body, gravity, Coulomb
and viscous friction.
"""

import sys

import mujoco
import numpy as np

import frikan

MODEL = """
<mujoco>
  <compiler angle="radian"/>
  <option gravity="0 0 -9.81" integrator="implicitfast"/>
  <worldbody>
    <body>
      <inertial pos="0 0 -0.6" mass="1.0194" diaginertia="0.13302 0.13302 0.01"/>
      <joint name="elbow" type="hinge" axis="0 1 0" damping="1.2" frictionloss="2"/>
    </body>
  </worldbody>
</mujoco>
"""


def torque_of(model, recorded):
    """Torque that the model asks for on the recorded motion, N m (inverse dynamics)."""
    data = mujoco.MjData(model)
    position, time_s = recorded["position_rad"], recorded["time_s"]
    velocity = np.gradient(position, time_s)
    acceleration = np.gradient(velocity, time_s)
    torque = np.empty_like(position)
    for row, state in enumerate(zip(position, velocity, acceleration)):
        data.qpos[0], data.qvel[0], data.qacc[0] = state
        mujoco.mj_inverse(model, data)
        torque[row] = data.qfrc_inverse[0]
    return torque


def compared(joint):
    """The diagnosis of the recording beside the model."""
    real = frikan.simulate(joint, effects={"presliding": 1}, duration=60, seed=7)
    simulated = {**real, "torque_Nm": torque_of(mujoco.MjModel.from_xml_string(MODEL), real)}
    return frikan.diagnose(real, simulation=simulated)


if __name__ == "__main__":
    print(compared(sys.argv[1]))
