"""An estimator in the manner of scikit-learn, which need not be installed."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._calls import fit
from ._image import Image
from ._recordings import columns_of
from ._results import Fitted, Parameters

# Columns of a recording by the names of inputs, joint side, SI units; any other input is a column of its own name.
COLUMNS = {
    "rotary": {
        "velocity": "velocity_rad_s",
        "position": "position_rad",
        "load": "load_torque_Nm",
        "temperature": "temperature_C",
        "friction": "friction_torque_Nm",
    },
    "linear": {
        "velocity": "velocity_m_s",
        "position": "position_m",
        "load": "load_force_N",
        "temperature": "temperature_C",
        "friction": "friction_force_N",
    },
}


class FrictionRegressor:
    """Friction over velocity, and over other inputs where there are some.

    ``X`` has a column for each of ``inputs``, or is a frame with columns of these names; ``y`` is the friction, the rigid body taken off.
    What is predicted is what the drive computes. ``axis`` is ``"rotary"`` (rad/s, N m) or ``"linear"`` (m/s, N). After ``fit`` there are
    ``law_``, ``parameters_``, ``image_`` and ``fitted_``, the result of :func:`frikan.fit`.
    """

    law_: str
    parameters_: Parameters
    image_: Image
    fitted_: Fitted
    n_features_in_: int

    def __init__(
        self,
        inputs: tuple[str, ...] = ("velocity",),
        *,
        axis: str = "rotary",
        representation: Optional[str] = None,
        target: Optional[str] = None,
        seed: int = 1,
    ) -> None:
        self.inputs = inputs
        self.axis = axis
        self.representation = representation
        self.target = target
        self.seed = seed

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters of the constructor, as they are."""
        return {name: getattr(self, name) for name in _names()}

    def set_params(self, **params: Any) -> FrictionRegressor:
        """Sets parameters of the constructor."""
        for name, value in params.items():
            if name not in _names():
                raise ValueError(f"there is no parameter of the name {name!r}; there are {', '.join(_names())}")
            setattr(self, name, value)
        return self

    def fit(self, X: Any, y: npt.ArrayLike) -> FrictionRegressor:
        """Fits the law."""
        if self.axis not in COLUMNS:
            raise ValueError(f"there is no axis of the name {self.axis!r}; there are {', '.join(COLUMNS)}")
        names = COLUMNS[self.axis]
        columns = self._split(X)
        friction = np.asarray(y, dtype=np.float64).reshape(-1)
        if any(len(column) != len(friction) for column in columns.values()):
            raise ValueError("X and y differ in their numbers of rows")
        recording = {names.get(name, name): column for name, column in columns.items()}
        recording[names["friction"]] = friction
        self.fitted_ = fit(
            recording,
            inputs=list(self.inputs),
            representation=self.representation,
            target=self.target,
            seed=self.seed,
        )
        self.law_, self.parameters_, self.image_ = self.fitted_.law, self.fitted_.parameters, self.fitted_.image
        self.n_features_in_ = len(self.inputs)
        return self

    def predict(self, X: Any) -> npt.NDArray[np.float64]:
        """The friction, in N m or N."""
        if not hasattr(self, "image_"):
            raise AttributeError("this regressor is not fitted yet")
        columns = self._split(X)
        friction = self.image_(**{name: columns[name] for name in self.image_.inputs})
        return friction.astype(np.float64)

    def score(self, X: Any, y: npt.ArrayLike) -> float:
        """The coefficient of determination."""
        friction = np.asarray(y, dtype=np.float64).reshape(-1)
        left, all_of_it = friction - self.predict(X), friction - friction.mean()
        return float(1.0 - (left @ left) / (all_of_it @ all_of_it))

    def _split(self, X: Any) -> dict[str, npt.NDArray[np.float64]]:
        """The inputs by name."""
        if isinstance(X, Mapping) or hasattr(X, "columns") or hasattr(X, "column_names"):
            given = columns_of(X)
            missing = [name for name in self.inputs if name not in given]
            if missing:
                raise ValueError(f"X has no column {missing[0]!r}; the inputs are {', '.join(self.inputs)}")
            return {name: np.asarray(given[name], dtype=np.float64) for name in self.inputs}
        table = np.asarray(X, dtype=np.float64)
        table = table.reshape(-1, 1) if table.ndim == 1 else table
        if table.ndim != 2 or table.shape[1] != len(self.inputs):
            raise ValueError(f"X has {table.shape[-1]} columns; the inputs are {', '.join(self.inputs)}")
        return {name: np.ascontiguousarray(table[:, place]) for place, name in enumerate(self.inputs)}

    def __sklearn_tags__(self) -> Any:
        from sklearn.utils import RegressorTags, Tags, TargetTags

        return Tags(estimator_type="regressor", target_tags=TargetTags(required=True), regressor_tags=RegressorTags())

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self.get_params().items())
        return f"FrictionRegressor({given})"


def _names() -> list[str]:
    return [name for name in inspect.signature(FrictionRegressor).parameters]
