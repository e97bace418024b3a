"""MuJoCo reads a URDF and writes it out as MJCF."""

import sys

import mujoco

model = mujoco.MjModel.from_xml_path(sys.argv[1])
mujoco.mj_saveLastXML(sys.argv[2], model)
