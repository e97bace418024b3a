"""Inverse dynamics of an arm and its regressor by Pinocchio: reads a URDF and states, prints torques and regressor as JSON."""

import json
import sys

import numpy as np
import pinocchio


def main(urdf, states):
    model = pinocchio.buildModelFromUrdf(urdf)
    # The gravity of Frikan's chains.
    model.gravity.linear = np.array([0.0, 0.0, -9.80665])
    data = model.createData()
    answers = []
    for q, v, a in json.load(open(states)):
        q, v, a = (np.array(x) for x in (q, v, a))
        torques = pinocchio.rnea(model, data, q, v, a).tolist()
        regressor = pinocchio.computeJointTorqueRegressor(model, data, q, v, a).tolist()
        answers.append({"torques": torques, "regressor": regressor})
    print(json.dumps({"joints": list(model.names)[1:], "answers": answers}))


main(*sys.argv[1:])
