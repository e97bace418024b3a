"""The elbow of pairs.py in Drake; see tests/tests/simulators.

    drake_pair.py write FOLDER   writes elbow.urdf and elbow.sdf
    drake_pair.py run FOLDER     loads patched.urdf, patched.sdf and friction.py, and prints what Drake has of them, as JSON
"""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Adder, Demultiplexer

from joints import STEP, errors, real, reference
from pairs import ELBOW

FRESH_SECONDS = 5
# Time step of the plant, s: the table of friction is evaluated once a step and steep through zero.
PLANT_STEP = STEP / 5
INERTIA_OF_BODIES = 0.3

INERTIAL = '<mass value="1.5"/><inertia ixx="0.24" iyy="0.24" izz="0.01" ixy="0" ixz="0" iyz="0"/>'

URDF = f"""<robot name="elbow">
  <link name="arm">
    <inertial><origin xyz="0 0 -0.2"/>{INERTIAL}</inertial>
  </link>
  <!-- hanging -->
  <joint name="elbow" type="continuous">
    <parent link="world"/>
    <child link="arm"/>
    <axis xyz="0 1 0"/>
    <dynamics damping="0"/>
  </joint>
  <transmission type="transmission_interface/SimpleTransmission">
    <joint name="elbow"/>
    <actuator name="drive"/>
  </transmission>
</robot>
"""

SDF = """<sdf version="1.9">
  <model name="elbow">
    <link name="arm">
      <inertial>
        <pose>0 0 -0.2 0 0 0</pose>
        <mass>1.5</mass>
        <inertia><ixx>0.24</ixx><iyy>0.24</iyy><izz>0.01</izz></inertia>
      </inertial>
    </link>
    <joint name="elbow" type="revolute">
      <parent>world</parent>
      <child>arm</child>
      <axis><xyz>0 1 0</xyz></axis>
    </joint>
  </model>
</sdf>
"""


def loaded(path):
    """A plant with the model, not yet finalized."""
    plant = MultibodyPlant(PLANT_STEP)
    Parser(plant).AddModels(str(path))
    return plant


def after_a_second(path):
    """Damping of the joint as Drake read it, and its position a second after it was let go at 1 rad."""
    plant = loaded(path)
    plant.Finalize()
    simulator = Simulator(plant)
    plant.get_actuation_input_port().FixValue(simulator.get_mutable_context(), np.zeros(plant.num_actuators()))
    joint = plant.GetJointByName("elbow")
    joint.set_angle(simulator.get_mutable_context(), 1.0)
    simulator.AdvanceTo(1.0)
    return {"damping": joint.default_damping(), "position": joint.get_angle(simulator.get_context())}


def simulate(urdf, friction, seed, seconds):
    """Rows as those of joints.simulate, of the model with the exported rotor inertia and friction."""
    builder = DiagramBuilder()
    plant = builder.AddSystem(loaded(urdf))
    friction.set_rotor_inertia(plant, plant.GetJointActuatorByName("drive"), INERTIA_OF_BODIES)
    plant.Finalize()
    law, sum_, split = builder.AddSystem(friction.JointFriction()), builder.AddSystem(Adder(2, 1)), builder.AddSystem(Demultiplexer(2, 1))
    builder.Connect(plant.get_state_output_port(), split.get_input_port())
    builder.Connect(split.get_output_port(1), law.get_input_port())
    builder.Connect(law.get_output_port(), sum_.get_input_port(1))
    builder.Connect(sum_.get_output_port(), plant.get_actuation_input_port())
    builder.ExportInput(sum_.get_input_port(0), "command")
    simulator = Simulator(builder.Build())
    context = simulator.get_mutable_context()
    state = plant.GetMyMutableContextFromRoot(context)
    steps = int(seconds / STEP)
    position, velocity = reference(ELBOW, seed, np.arange(steps) * STEP)
    plant.SetPositionsAndVelocities(state, [position[0], velocity[0]])
    rows = np.empty((steps, 4))
    for step in range(steps):
        q, v = plant.GetPositionsAndVelocities(state)
        torque = ELBOW.gains[0] * (position[step] - q) + ELBOW.gains[1] * (velocity[step] - v)
        simulator.get_system().get_input_port().FixValue(context, [torque])
        rows[step] = step * STEP, q, v, torque
        simulator.AdvanceTo((step + 1) * STEP)
    return rows


def python_of(path):
    spec = importlib.util.spec_from_file_location("friction", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    command, folder = sys.argv[1], Path(sys.argv[2])
    if command == "write":
        (folder / "elbow.urdf").write_text(URDF)
        (folder / "elbow.sdf").write_text(SDF)
    else:
        rows = simulate(folder / "elbow.urdf", python_of(folder / "friction.py"), 2, FRESH_SECONDS)
        result = {name: after_a_second(folder / f"patched.{name}") for name in ("urdf", "sdf")}
        result["python"] = errors(real(ELBOW, 2, FRESH_SECONDS), rows)
        print(json.dumps(result))
