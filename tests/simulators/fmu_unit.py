"""An exported co-simulation unit in FMPy; see tests/tests/simulators.

    fmu_unit.py UNIT.fmu INPUTS.csv    validates the unit, steps it through the rows in steps of a millisecond, goes back to a kept state,
                                       compiles its sources as a part of a tool, and prints what came out as JSON
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu, supported_platforms
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

STEP = 1e-3


def started(folder, description):
    unit = FMU3Slave(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="joint",
    )
    unit.instantiate()
    unit.enterInitializationMode(startTime=0.0)
    unit.exitInitializationMode()
    return unit


def stepped(unit, description, inputs, first):
    """Outputs after a step at every row of inputs."""
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output"]
    names = [references[name] for name in inputs.dtype.names]
    rows = []
    for step, row in enumerate(inputs):
        unit.setFloat64(names, list(row))
        unit.doStep(currentCommunicationPoint=STEP * (first + step), communicationStepSize=STEP)
        rows.append(list(unit.getFloat64(outputs)))
    return rows


if __name__ == "__main__":
    path, rows = sys.argv[1:]
    inputs = np.atleast_1d(np.genfromtxt(rows, delimiter=",", names=True))
    description = read_model_description(path, validate=True)
    result = {"problems": validate_fmu(path), "platforms": supported_platforms(path)}
    result["inputs"] = {v.name: v.unit for v in description.modelVariables if v.causality == "input"}
    with tempfile.TemporaryDirectory() as folder:
        extract(path, unzipdir=folder)
        unit = started(folder, description)
        half = len(inputs) // 2
        result["outputs"] = stepped(unit, description, inputs[:half], 0)
        kept = unit.getFMUState()
        result["outputs"] += stepped(unit, description, inputs[half:], half)
        unit.setFMUState(kept)
        again = stepped(unit, description, inputs[half:], half)
        result["repeats"] = again == result["outputs"][half:]
        unit.freeFMUState(kept)
        unit.reset()
        result["starts_anew"] = stepped(unit, description, inputs[:half], 0) == result["outputs"][:half]
        unit.terminate()
        unit.freeInstance()
        sources = sorted(str(source) for source in (Path(folder) / "sources").glob("*.c"))
        flags = "-std=c99 -pedantic -Wall -Wextra -Werror -c".split() + [f"-DFMI3_FUNCTION_PREFIX={description.coSimulation.modelIdentifier}_"]
        subprocess.run(["cc", *flags, *sources], cwd=folder, check=True)
    # What a tool does with a unit: inputs over time, outputs over time.
    over_time = np.zeros(11, dtype=[("time", float)] + [(name, float) for name in inputs.dtype.names])
    over_time["time"] = np.linspace(0.0, 1.0, 11)
    for name in inputs.dtype.names:
        over_time[name] = inputs[name][0]
    simulated = simulate_fmu(path, stop_time=1.0, step_size=0.1, input=over_time, output=["friction"])
    result["simulated"] = float(simulated["friction"][-1])
    print(json.dumps(result))
