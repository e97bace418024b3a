"""A model image."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _frikan


class Image:
    """A model image: the law as the drive computes it, bit for bit, in 32-bit floats.

    Called with the velocity, and the other inputs by name, as numbers or arrays, it gives the friction.
    """

    def __init__(self, content: bytes, refuse_doubtful: Optional[Callable[[], None]] = None) -> None:
        self._native = _frikan.Image(content)
        self._refuse_doubtful = refuse_doubtful

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"]) -> Image:
        """Reads an image from a file."""
        with open(path, "rb") as file:
            return cls(file.read())

    def save(self, path: Union[str, "os.PathLike[str]"], force: bool = False) -> None:
        """Writes the image to a file.

        That of a fit which may not be relied upon raises ``frikan.Error`` with the code of ``Fitted.doubt``, unless ``force`` says to write it
        nevertheless.
        """
        if self._refuse_doubtful is not None and not force:
            self._refuse_doubtful()
        with open(path, "wb") as file:
            file.write(self.content)

    @property
    def content(self) -> bytes:
        """The bytes of the file."""
        return self._native.content()

    @property
    def inputs(self) -> dict[str, tuple[str, float, float]]:
        """Unit, lowest and highest trained value of each input."""
        return {name: (unit, low, high) for name, unit, low, high in self._native.inputs()}

    @property
    def json(self) -> dict[str, Any]:
        """Everything that the image says."""
        said: dict[str, Any] = json.loads(self._native.json())
        return said

    def __call__(self, velocity: npt.ArrayLike, **others: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """The friction at these values, in the unit of the actuator."""
        names = list(self.inputs)
        unknown = set(others) - set(names)
        missing = set(names) - set(others) - {"velocity"}
        if unknown or missing:
            raise TypeError(f"the inputs of this image are {', '.join(names)}")
        given = {"velocity": velocity, **others}
        arrays = np.broadcast_arrays(*(np.asarray(given[name], dtype=np.float32) for name in names))
        flat = self._native.evaluate([np.ascontiguousarray(array).tobytes() for array in arrays])
        return np.frombuffer(flat, dtype=np.float32).reshape(arrays[0].shape)

    def __repr__(self) -> str:
        return f"<frikan.Image of {', '.join(self.inputs)}, {len(self.content)} bytes>"
