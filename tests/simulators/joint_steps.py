"""Steps of one joint of MuJoCo, one line a case: integrator, form, drive, time step, then position, velocity and bristle deflection.

The table is kept in `trainer/src/export/simulator/trial/mujoco_steps.txt`, with which the exporter's own steps are compared; a test
compares the table with the MuJoCo that is installed.
"""

import itertools

import mujoco
import numpy as np

STEPS = 400

INTEGRATORS = ("Euler", "implicit", "implicitfast", "RK4", "discrete")

# Attributes of the joint, and a passive motor.
FORMS = {
    "attributes": ('frictionloss="2" damping="1.2"', ""),
    "polynomial": ('damping="1.2 0.1 -0.01"', ""),
    "softness": ('frictionloss="2" damping="1.2" solreffriction="0.005 1" solimpfriction="0.98 0.99"', ""),
    "bristles": ('damping="1.2"', "20000 100 2 3 0.1"),
    "peak": ('frictionloss="2" damping="1.2"', "5000 0 0 1 0.1"),
}

DRIVES = {
    "motor": ("<motor joint='j'/>", 6.0),
    "position": ("<position joint='j' kp='200' kv='15'/>", 0.1),
}

# s; at the longer ones `solreffriction` is limited by the step.
TIME_STEPS = (0.0005, 0.002)


def model(integrator, form, drive, step):
    attributes, lugre = FORMS[form]
    motor = f"<dcmotor joint='j' input='none' motorconst='0' resistance='1' lugre='{lugre}'/>" if lugre else ""
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
  <option timestep="{step}" integrator="{integrator}"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="1" diaginertia="0.3 0.3 0.3"/>
      <joint name="j" axis="0 1 0" armature="0.2" {attributes}/>
    </body>
  </worldbody>
  <actuator>{DRIVES[drive][0]}{motor}</actuator>
</mujoco>""")


def main():
    for integrator, form, drive, step in itertools.product(INTEGRATORS, FORMS, DRIVES, TIME_STEPS):
        simulation = model(integrator, form, drive, step)
        data = mujoco.MjData(simulation)
        for index in range(STEPS):
            data.ctrl[0] = DRIVES[drive][1] * np.sin(20 * index * step)
            mujoco.mj_step(simulation, data)
        if any(warning.number for warning in data.warning):
            print(integrator, form, drive, step, "diverges")
            continue
        deflection = data.act[0] if len(data.act) else 0.0
        print(integrator, form, drive, step, *(f"{value:.12g}" for value in (data.qpos[0], data.qvel[0], deflection)))


if __name__ == "__main__":
    main()
