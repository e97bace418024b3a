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
from ._calls import diagnose, fit, predict, simulate
from ._results import Diagnosed, Fitted, Parameters, Prediction

__all__ = [
    "Diagnosed",
    "Error",
    "Fitted",
    "Image",
    "Parameters",
    "Prediction",
    "__version__",
    "diagnose",
    "fit",
    "predict",
    "simulate",
]
