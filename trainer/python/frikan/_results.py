"""What fits, diagnoses and predictions bring back."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from typing import Any, Iterator, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _frikan
from ._image import Image

Path = Union[str, "os.PathLike[str]"]


class Parameters:
    """Constants of a law by name, each with ``name``, ``symbol``, ``value``, ``unit`` and ``ci95``."""

    def __init__(self, rows: list[dict[str, Any]]) -> None:
        self.rows = rows

    def __getitem__(self, name: str) -> dict[str, Any]:
        for row in self.rows:
            if row["name"] == name:
                return row
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        return (row["name"] for row in self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def frame(self) -> Any:
        """The same as a frame of pandas."""
        import pandas

        flat = [{**row, "low": row["ci95"][0], "high": row["ci95"][1]} for row in self.rows]
        return pandas.DataFrame(flat, columns=["name", "symbol", "value", "low", "high", "unit"])

    def __repr__(self) -> str:
        return "\n".join(_line(row) for row in self.rows)

    def _repr_html_(self) -> str:
        cells = ((row["name"], row["symbol"], _number(row["value"]), row["unit"], _interval(row)) for row in self.rows)
        body = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in cells)
        head = "".join(f"<th>{name}</th>" for name in ("parameter", "symbol", "value", "unit", "95 % interval"))
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class Fitted:
    """A fitted law with its image, its scores and its report."""

    def __init__(self, native: _frikan.Fitted) -> None:
        self._native = native
        self.json: dict[str, Any] = json.loads(native.json())

    @property
    def law(self) -> str:
        """The formula that was found, as text."""
        return str(self.json["expression"])

    @property
    def parameters(self) -> Parameters:
        """Constants of the law, then of the rigid body."""
        return Parameters(self.json["parameters"])

    @property
    def image(self) -> Image:
        """The image for the drive."""
        return Image(self._native.image())

    @property
    def doubt(self) -> Optional[tuple[str, str]]:
        """Code and sentence of why the fit may not be relied upon; ``None`` where it may."""
        return self._native.doubt()

    @property
    def curve(self) -> npt.NDArray[np.float64]:
        """The law over velocity: two columns."""
        return np.array(self._native.curves()[0], dtype=np.float64).reshape(-1, 2)

    @property
    def band(self) -> npt.NDArray[np.float64]:
        """Where the friction lies with 95 %: velocity, low, high."""
        return np.array(self._native.curves()[1], dtype=np.float64).reshape(-1, 3)

    def report(self, path: Path) -> None:
        """Writes the result as one HTML page."""
        _write(path, self._native.report("frikan.fit"))

    def plot(self, axes: Any = None) -> Any:
        """Draws law and band over velocity with Matplotlib, and gives its axes."""
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.gca()
        band, curve = self.band, self.curve
        axes.fill_between(band[:, 0], band[:, 1], band[:, 2], alpha=0.25, label="95 % band")
        axes.plot(curve[:, 0], curve[:, 1], label=self.law)
        axes.set_xlabel("velocity")
        axes.set_ylabel(f"friction ({self.json['unit']})")
        axes.legend()
        return axes

    def __str__(self) -> str:
        return self._native.text("MODEL.frk")

    def __repr__(self) -> str:
        return f"<frikan.Fitted: friction = {self.law}>"

    def _repr_html_(self) -> str:
        train = self.json["train"]
        score = f"R² {train['r2']:.4f}, error {_number(train['rmse'])} {html.escape(self.json['unit'])}"
        doubt = f"<p>{html.escape(self.doubt[1])}</p>" if self.doubt else ""
        parameters = self.parameters._repr_html_()
        return f"<p>friction = <code>{html.escape(self.law)}</code>; {score}</p>{doubt}{parameters}"


class Diagnosed:
    """What a model leaves out, with the improved image."""

    def __init__(self, native: _frikan.Diagnosed, compared_with: str) -> None:
        self._native = native
        self._compared_with = compared_with
        self.json: dict[str, Any] = json.loads(native.json())

    @property
    def verdict(self) -> str:
        """``consistent``, ``missing_physics``, ``unexplained`` or ``bad_data``."""
        return str(self.json["verdict"])

    @property
    def findings(self) -> list[dict[str, Any]]:
        """What is missing, in the order in which it was found."""
        return list(self.json["findings"])

    @property
    def parameters(self) -> Parameters:
        """The constants of all findings."""
        return Parameters([row for finding in self.findings for row in finding["parameters"]])

    @property
    def image(self) -> Optional[Image]:
        """The improved image; ``None`` where there is none that is better."""
        content = self._native.image()
        return None if content is None else Image(content)

    @property
    def trajectory(self) -> Optional[str]:
        """The motion to record next, as CSV, where the answer lists alternatives."""
        return self._native.trajectory()

    def report(self, path: Path) -> None:
        """Writes the result as one HTML page."""
        _write(path, self._native.report(self._compared_with, "frikan.diagnose"))

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        return f"<frikan.Diagnosed: {self.json['headline']}>"

    def _repr_html_(self) -> str:
        items = "".join(f"<li>{html.escape(finding['sentence'])}</li>" for finding in self.findings)
        return f"<p>{html.escape(self.json['headline'])}</p><ul>{items}</ul>"


class Prediction:
    """A recording with a model's prediction beside it: columns by name."""

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

    @property
    def predicted(self) -> npt.NDArray[np.float64]:
        """The predicted torque, force or current, in the unit of the recording."""
        return self[next(name for name in self._names if name.startswith("predicted_"))]

    @property
    def residual(self) -> Optional[npt.NDArray[np.float64]]:
        """Recorded less predicted; ``None`` where the actuator is not recorded."""
        names = [name for name in self._names if name.startswith("residual_")]
        return self[names[-1]] if names else None

    def frame(self) -> Any:
        """The same as a frame of pandas."""
        import pandas

        return pandas.read_csv(io.BytesIO(self.content))

    def save(self, path: Path) -> None:
        """Writes the table as CSV."""
        with open(path, "wb") as file:
            file.write(self.content)


def _write(path: Path, text: str) -> None:
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(text)


def _number(value: float) -> str:
    return f"{value:.5g}"


def _interval(row: dict[str, Any]) -> str:
    low, high = row["ci95"]
    return "" if low is None or high is None else f"{_number(low)} to {_number(high)}"


def _line(row: dict[str, Any]) -> str:
    return f"{row['name']:<30} {row['symbol']:<6} {_number(row['value']):>12} {row['unit']:<10} {_interval(row)}"
