"""Recordings with columns of the trainer beside their own."""

from __future__ import annotations

import csv
import io
import json
import os
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

Path = Union[str, "os.PathLike[str]"]


class Table:
    """A recording with columns of the trainer beside its own, by name."""

    def __init__(self, content: bytes, warnings: list[str]) -> None:
        self.content = content
        self.warnings = warnings
        rows = csv.reader(io.StringIO(content.decode()))
        self._names = next(rows)
        self._columns = list(zip(*rows))

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self._names:
            raise KeyError(name)
        return np.array(self._columns[self._names.index(name)], dtype=np.float64)

    @property
    def names(self) -> list[str]:
        """Names of the columns."""
        return list(self._names)

    def frame(self) -> Any:
        """The same as a frame of pandas."""
        import pandas

        return pandas.read_csv(io.BytesIO(self.content))

    def save(self, path: Path) -> None:
        """Writes the table as CSV."""
        with open(path, "wb") as file:
            file.write(self.content)


class Prediction(Table):
    """A recording with a model's prediction beside it: columns by name."""

    @property
    def predicted(self) -> npt.NDArray[np.float64]:
        """The predicted torque, force or current, in the unit of the recording."""
        return self[next(name for name in self._names if name.startswith("predicted_"))]

    @property
    def residual(self) -> Optional[npt.NDArray[np.float64]]:
        """Recorded less predicted; ``None`` where the actuator is not recorded."""
        names = [name for name in self._names if name.startswith("residual_")]
        return self[names[-1]] if names else None


class RolledOut(Table):
    """A recording with the motion of the joint beside it as an image simulates it under the recorded commands."""

    def __init__(self, content: bytes, said: str, text: str, warnings: list[str]) -> None:
        super().__init__(content, warnings)
        self.json: dict[str, Any] = json.loads(said)
        self._text = text

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """The simulated position, in rad or m."""
        return self[f"simulated_position_{self.json['unit']}"]

    @property
    def error(self) -> npt.NDArray[np.float64]:
        """Recorded less simulated position, in rad or m."""
        return self[f"position_error_{self.json['unit']}"]

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        position = self.json["position"]
        return f"<frikan.RolledOut: position off by {position['rmse']:.5g} {self.json['unit']} (RMS)>"
