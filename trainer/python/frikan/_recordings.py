"""Recordings and joint files as the trainer takes them."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np

Recording = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]
Joint = Union[None, str, "os.PathLike[str]", Mapping[str, Any]]
Handed = tuple[str, Optional[bytes]]


def handed(recording: Recording, label: str = "recording") -> Handed:
    """A path as it is; a frame or mapping of columns as an archive of NumPy, which keeps every bit."""
    if isinstance(recording, (str, os.PathLike)):
        return os.fspath(recording), None
    columns = {str(name): _column(values) for name, values in columns_of(recording).items()}
    archive = io.BytesIO()
    np.savez(archive, **columns)  # type: ignore[arg-type]
    return label, archive.getvalue()


def all_handed(recordings: Union[Recording, Sequence[Recording], None], label: str) -> list[Handed]:
    """One recording or several."""
    if recordings is None:
        return []
    if isinstance(recordings, (list, tuple)):
        return [handed(one, f"{label} {number}") for number, one in enumerate(recordings, 1)]
    return [handed(recordings, label)]


def joint_file(joint: Joint) -> Optional[tuple[bool, str]]:
    """A path, or the keys of such a file."""
    if joint is None:
        return None
    if isinstance(joint, Mapping):
        return True, json.dumps(joint)
    return False, os.fspath(joint)


def columns_of(recording: Any) -> Mapping[str, Any]:
    """The columns of a frame or mapping by name."""
    if isinstance(recording, Mapping):
        return recording
    names = getattr(recording, "column_names", None)  # Arrow
    if names is None:
        names = getattr(recording, "columns", None)  # pandas, polars
    if names is None:
        raise TypeError(f"a path, frame or mapping of columns is expected, not {type(recording).__name__}")
    return {name: recording[name] for name in names}


def _column(values: Any) -> np.ndarray[Any, Any]:
    column = np.asarray(values)
    if column.dtype.kind == "M":  # dates: nanoseconds since 1970
        return column.astype("datetime64[ns]").astype(np.int64)
    if column.dtype.kind in "fiu":
        return column
    return column.astype(np.float64)
