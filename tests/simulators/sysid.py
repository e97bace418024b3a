"""MuJoCo's own identification of a joint: what its sysid makes of a simulation and a recording of the real joint.

It fits `armature`, `frictionloss` and `damping` to the recorded positions, velocities and torques by whole simulations. Beside the recording
it gets the controllers and their command: from the recorded torque alone, a simulation drifts away within seconds.
"""

import mujoco
import numpy as np
from mujoco import sysid

from joints import ACTUATOR, STEP, references, set_attributes


def controlled(pair):
    """The simulation with the controllers in it, as `position` actuators, and sensors for what is recorded."""
    spec = mujoco.MjSpec.from_string(pair.model)
    for drive in pair.drives:
        if drive.gains:
            spec.actuator(drive.actuator).set_to_position(kp=drive.gains[0], kv=drive.gains[1])
    joint = {"objtype": mujoco.mjtObj.mjOBJ_JOINT, "objname": pair.joint}
    actuator = {"objtype": mujoco.mjtObj.mjOBJ_ACTUATOR, "objname": ACTUATOR}
    spec.add_sensor(name="position", type=mujoco.mjtSensor.mjSENS_JOINTPOS, **joint)
    spec.add_sensor(name="velocity", type=mujoco.mjtSensor.mjSENS_JOINTVEL, **joint)
    spec.add_sensor(name="torque", type=mujoco.mjtSensor.mjSENS_ACTUATORFRC, **actuator)
    return spec


def command(drive, position, velocity):
    """Control of a `position` actuator; a commanded velocity acts as an angle."""
    return position + drive.gains[1] / drive.gains[0] * velocity if drive.gains else position


def parameters(pair, spec):
    """Attributes of the joint, at first those of the simulation, and their bounds; damping has three powers of the velocity."""
    joint, model = spec.joint(pair.joint), spec.compile()
    inertia, viscous = model.dof_M0[model.joint(pair.joint).dofadr[0]], joint.damping[0]
    bounds = {
        "armature": (joint.armature, 0.0, 5.0 * inertia),
        "frictionloss": (joint.frictionloss, 0.0, 5.0 * joint.frictionloss),
        "damping": (joint.damping, 5.0 * viscous * np.array([0.0, -1.0, -1.0]), 5.0 * viscous * np.ones(3)),
    }
    found = sysid.ParameterDict()
    for name, (value, low, high) in bounds.items():
        modifier = lambda spec, parameter: set_attributes(spec.joint(pair.joint), {parameter.name: parameter.value})
        found.add(sysid.Parameter(name, value, low, high, modifier=modifier))
    return found.move_off_bounds()


def fitted(pair, recording, seed):
    """Attributes of the joint that leave the least of a recording under the command of `seed`."""
    spec = controlled(pair)
    model = spec.compile()
    rows = np.loadtxt(recording, delimiter=",", skiprows=1)
    clock = np.arange(round(rows[-1, 0] / STEP) + 2) * STEP
    motions = references(pair, seed, clock)
    control = np.stack([command(drive, *motion) for drive, motion in zip(pair.drives, motions)], axis=1)
    q, v = np.zeros(model.nq), np.zeros(model.nv)
    for drive, (position, velocity) in zip(pair.drives, motions):
        dof = model.joint(drive.joint).dofadr[0]
        q[dof], v[dof] = position[0], velocity[0]
    # A rollout gives the sensors before a step the time after it.
    measured = sysid.TimeSeries.from_names(rows[:, 0] + STEP, rows[:, 1:4], model)
    start = sysid.create_initial_state(model, q, v)
    sequence = sysid.ModelSequences(pair.name, spec, "recording", start, sysid.TimeSeries(clock, control), measured)
    residual = sysid.build_residual_fn(models_sequences=[sequence])
    found, _ = sysid.optimize(parameters(pair, spec), residual, verbose=False)
    return {name: parameter.value for name, parameter in found.items()}
