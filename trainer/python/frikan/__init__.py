"""Learns, explains and diagnoses the friction of a robot joint or linear axis from recordings.

A recording is a path (CSV, NumPy, MATLAB, JSON, Parquet, MCAP), a frame of pandas or polars, a table of Arrow, or a mapping of names to
arrays; columns are called ``<quantity>_<unit>``, such as ``time_s``, ``position_rad``, ``torque_Nm``. Several recordings are a list.
What is known of the joint is a path of a ``joint.toml``, or a mapping with its keys. Results are those of the command line, to the byte.

>>> import frikan
>>> fitted = frikan.fit("train.csv", test="test.csv", joint="joint.toml")   # doctest: +SKIP
>>> fitted.law                                                               # doctest: +SKIP
>>> fitted.report("report.html")                                             # doctest: +SKIP
"""

from ._frikan import Error, __version__
from ._image import Image
from ._calls import arm, check, diagnose, fit, predict, rollout, simulate
from ._regressor import FrictionRegressor
from ._results import Checked, Diagnosed, Fitted, FittedArm, Parameters
from ._tables import Prediction, RolledOut

__all__ = [
    "Checked",
    "Diagnosed",
    "Error",
    "Fitted",
    "FittedArm",
    "FrictionRegressor",
    "Image",
    "Parameters",
    "Prediction",
    "RolledOut",
    "__version__",
    "arm",
    "check",
    "diagnose",
    "fit",
    "predict",
    "rollout",
    "simulate",
]
