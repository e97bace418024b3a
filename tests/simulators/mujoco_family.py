"""Runs MJCF that was written for one simulator of the MuJoCo family in that one; needs the packages of mujoco3.txt.

    mujoco_family.py model FILE                          writes the elbow as its user has it
    mujoco_family.py run MUJOCO3.xml MJX.xml NEWTON.xml  prints in its last line, of each, the attributes of the joint that are in force there
                                                         and, of MJX and Newton, by how much their motion differs from that of MuJoCo 3, rad
"""

import json
import sys
from pathlib import Path

import jax
import mujoco
import newton
import numpy as np
from mujoco import mjx

from pairs import ELBOW

# Steps of the motion, torque and frequency that drive it: three quarters of a turn there and back.
STEPS, TORQUE, FREQUENCY = 1000, 8.0, 1.0


def torques(step):
    return TORQUE * np.sin(2 * np.pi * FREQUENCY * step * np.arange(STEPS))


def in_force(model):
    return {name: float(np.asarray(getattr(model, f"dof_{name}"))[0]) for name in ("armature", "damping", "frictionloss")}


def of_mujoco(path):
    """The model, and positions under the torques."""
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    positions = []
    for torque in torques(model.opt.timestep):
        data.ctrl[0] = torque
        mujoco.mj_step(model, data)
        positions.append(data.qpos[0])
    return model, np.array(positions)


def in_jax(path):
    model, expected = of_mujoco(path)
    jax.config.update("jax_enable_x64", True)
    there = mjx.put_model(model)
    step = jax.jit(lambda data, torque: (lambda next: (next, next.qpos[0]))(mjx.step(there, data.replace(ctrl=torque[None]))))
    _, positions = jax.lax.scan(step, mjx.put_data(model, mujoco.MjData(model)), jax.numpy.array(torques(model.opt.timestep)))
    return {**in_force(there), "differs": float(np.abs(np.asarray(positions) - expected).max())}


def in_newton(path):
    _, expected = of_mujoco(path)
    builder = newton.ModelBuilder()
    newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
    builder.add_mjcf(path)
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True)
    step = mujoco.MjModel.from_xml_path(path).opt.timestep
    state, after, control = model.state(), model.state(), model.control()
    positions = []
    for torque in torques(step):
        control.joint_f.assign(np.array([torque], dtype=np.float32))
        solver.step(state, after, control, None, step)
        state, after = after, state
        positions.append(state.joint_q.numpy()[0])
    return {**in_force(solver.mj_model), "differs": float(np.abs(np.array(positions) - expected).max())}


def main():
    command, *paths = sys.argv[1:]
    if command == "model":
        Path(paths[0]).write_text(ELBOW.model)
        return
    model, positions = of_mujoco(paths[0])
    print(
        json.dumps(
            {
                "mujoco3": {**in_force(model), "travel": float(np.ptp(positions))},
                "mjx": in_jax(paths[1]),
                "newton": in_newton(paths[2]),
            }
        )
    )


if __name__ == "__main__":
    main()
