"""What fits, diagnoses and predictions bring back."""

from __future__ import annotations

import html
import json
import os
from typing import Any, Iterator, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _frikan
from ._image import Image
from ._notebook import page, table

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
        return table(("parameter", "symbol", "value", "unit", "95 % interval"), cells)


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
        """The image for the drive; where the fit may not be relied upon, it is saved by ``force=True`` alone."""
        return Image(self._native.image(), self._native.refuse_doubtful)

    @property
    def integers(self) -> Optional[dict[str, Any]]:
        """The table of integers for a drive without floating-point unit: counts, error and instructions; ``None`` where it is none."""
        integers: Optional[dict[str, Any]] = self.json["integers"]
        return integers

    @property
    def doubt(self) -> Optional[tuple[str, str]]:
        """Code and sentence of why the fit may not be relied upon, where the command line ends with 4; ``None`` where it may."""
        return self._native.doubt()

    @property
    def curve(self) -> npt.NDArray[np.float64]:
        """The law over velocity: two columns."""
        return np.array(self._native.curves()[0], dtype=np.float64).reshape(-1, 2)

    @property
    def band(self) -> npt.NDArray[np.float64]:
        """Where the friction lies with 95 %: velocity, low, high; no rows for a law by trajectory."""
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
        if len(band):
            axes.fill_between(band[:, 0], band[:, 1], band[:, 2], alpha=0.25, label="95 % band")
        axes.plot(curve[:, 0], curve[:, 1], label=self.law)
        axes.set_xlabel("velocity")
        axes.set_ylabel(f"friction ({self.json['unit']})")
        axes.legend()
        return axes

    def __str__(self) -> str:
        return self._native.text(None if self.doubt else "MODEL.frk")

    def __repr__(self) -> str:
        return f"<frikan.Fitted: friction = {self.law}>"

    def _repr_html_(self) -> str:
        return page(self._native.report("frikan.fit"))


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
        return page(self._native.report(self._compared_with, "frikan.diagnose"))


class Checked:
    """What recordings are worth before anything is fitted to them."""

    def __init__(self, said: str, text: str) -> None:
        self.json: dict[str, Any] = json.loads(said)
        self._text = text

    @property
    def verdict(self) -> str:
        """``good``, ``usable`` or ``unusable``."""
        return str(self.json["verdict"])

    @property
    def items(self) -> list[dict[str, Any]]:
        """What was noticed, each with ``code``, ``severity``, ``message`` and ``when_s``."""
        return list(self.json["items"])

    @property
    def identifiable(self) -> dict[str, float]:
        """What can be identified, with the share of the friction within which."""
        return {one["name"]: one["within_share_of_friction"] for one in self.json["identifiable"]}

    @property
    def record_next(self) -> list[str]:
        """Motions that would tell what these do not."""
        return list(self.json["record_next"])

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<frikan.Checked: {self.verdict}>"

    def _repr_html_(self) -> str:
        rows = ((item["severity"], item["code"], item["message"]) for item in self.items)
        return f"<p><b>{html.escape(self.verdict)}</b></p>" + table(("severity", "code", "message"), rows)


class FittedArm:
    """A fitted arm: bodies, and a law with an image for each joint."""

    def __init__(self, native: _frikan.FittedArm) -> None:
        self._native = native
        self.json: dict[str, Any] = json.loads(native.json())
        self.warnings = native.warnings()

    @property
    def joints(self) -> list[dict[str, Any]]:
        """Law, parameters and scores of each joint."""
        return list(self.json["joints"])

    @property
    def base_parameters(self) -> list[dict[str, Any]]:
        """Inertial parameters that the motion can determine, each with ``expression``, ``value``, ``ci95`` and ``unit``."""
        return list(self.json["base_parameters"])

    def images(self, force: bool = False) -> dict[str, Image]:
        """Images by joint, where the law may be relied upon; of every joint with ``force``."""
        names = [joint["name"] for joint in self.joints]
        return {name: Image(found[1]) for name, found in zip(names, self._native.images(force)) if found is not None}

    def urdf(self, force: bool = False) -> str:
        """The URDF with the friction of these joints."""
        return self._native.patched(force)

    def save(self, folder: Path, force: bool = False) -> None:
        """Writes what ``trainer arm`` writes: an image for each joint, ``arm.json`` and ``arm.urdf``."""
        os.makedirs(folder, exist_ok=True)
        for found in self._native.images(force):
            if found is not None:
                with open(os.path.join(folder, found[0]), "wb") as file:
                    file.write(found[1])
        _write(os.path.join(folder, "arm.json"), self._native.json() + "\n")
        _write(os.path.join(folder, "arm.urdf"), self.urdf(force))

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        return f"<frikan.FittedArm of {', '.join(joint['name'] for joint in self.joints)}>"

    def _repr_html_(self) -> str:
        rows = ((joint["name"], joint["law"] or "", joint["image"] or "not to be relied upon") for joint in self.joints)
        return table(("joint", "friction", "image"), rows)


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
