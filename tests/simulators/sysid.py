"""MuJoCo's own identification of a joint: what its sysid makes of a simulation and a recording of the real joint."""

import mujoco
import numpy as np
from mujoco import sysid

from joints import ACTUATOR, STEP, references, set_attributes

SENSORS = ("position", "velocity", "torque")


def controlled(pair):
    """The simulation with the controllers in it, as `position` actuators, and sensors for what is recorded."""
    spec = mujoco.MjSpec.from_string(pair.model)
    for drive in pair.drives:
        if drive.gains:
            spec.actuator(drive.actuator).set_to_position(kp=drive.gains[0], kv=drive.gains[1])
    kinds = (mujoco.mjtSensor.mjSENS_JOINTPOS, mujoco.mjtSensor.mjSENS_JOINTVEL, mujoco.mjtSensor.mjSENS_ACTUATORFRC)
    of = ((mujoco.mjtObj.mjOBJ_JOINT, pair.joint),) * 2 + ((mujoco.mjtObj.mjOBJ_ACTUATOR, ACTUATOR),)
    for name, kind, (objtype, objname) in zip(SENSORS, kinds, of):
        spec.add_sensor(name=name, type=kind, objtype=objtype, objname=objname)
    return spec


def commands(pair, seed, t):
    """Control of the `position` actuators; the velocity has its share as an angle."""
    pairs = zip(pair.drives, references(pair, seed, t))
    return np.stack([position + (drive.gains[1] / drive.gains[0] * velocity if drive.gains else 0.0) for drive, (position, velocity) in pairs], axis=1)


def parameters(pair, spec):
    """Attributes of the joint to fit, from the simulation's on, and their bounds."""
    joint, model = spec.joint(pair.joint), spec.compile()
    inertia = model.dof_M0[model.joint(pair.joint).dofadr[0]]
    known = {"armature": (joint.armature, inertia), "frictionloss": (joint.frictionloss, joint.frictionloss), "damping": (joint.damping[0], joint.damping[0])}
    params = sysid.ParameterDict()
    for name, (value, scale) in known.items():
        modifier = lambda spec, parameter, name=name: set_attributes(spec.joint(pair.joint), {name: parameter.value[0]})
        params.add(sysid.Parameter(name, nominal=value, min_value=0.0, max_value=5.0 * scale, modifier=modifier))
    return params.move_off_bounds()


def fitted(pair, recording, seed):
    """Attributes of the joint that sysid fits to a recording: to position, velocity and torque, under the recorded command."""
    spec = controlled(pair)
    model = spec.compile()
    rows = np.loadtxt(recording, delimiter=",", skiprows=1)
    clock = np.arange(round(rows[-1, 0] / STEP) + 2) * STEP
    control = sysid.TimeSeries(clock, commands(pair, seed, clock))
    # Sensors of a rollout are those of the state before the step, at the time after it.
    measured = sysid.TimeSeries.from_names(rows[:, 0] + STEP, rows[:, 1:4], model)
    starts = [(position[0], velocity[0]) for position, velocity in references(pair, seed, clock[:1])]
    q, v = np.zeros(model.nq), np.zeros(model.nv)
    for drive, (position, velocity) in zip(pair.drives, starts):
        dof = model.joint(drive.joint).dofadr[0]
        q[dof], v[dof] = position, velocity
    sequence = sysid.ModelSequences(pair.name, spec, "recording", sysid.create_initial_state(model, q, v), control, measured)
    residual = sysid.build_residual_fn(models_sequences=[sequence])
    found, _ = sysid.optimize(parameters(pair, spec), residual, verbose=False)
    return {name: float(found[name].value[0]) for name in found.keys()}
