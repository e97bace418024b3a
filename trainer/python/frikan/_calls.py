"""The calls of the package."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _frikan
from ._image import Image
from ._recordings import Joint, Recording, all_handed, handed, joint_file
from ._results import Checked, Diagnosed, Fitted, FittedArm
from ._tables import Prediction, RolledOut

Recordings = Union[Recording, Sequence[Recording]]
Model = Union[Image, Fitted, str, "os.PathLike[str]"]
Progress = Callable[[str, int, Optional[float]], Any]


def fit(
    recordings: Recordings,
    *,
    test: Optional[Recordings] = None,
    joint: Joint = None,
    inputs: Optional[Sequence[str]] = None,
    representation: Optional[str] = None,
    form: Optional[str] = None,
    rate: Optional[float] = None,
    max_bytes: Optional[int] = None,
    max_instructions: Optional[int] = None,
    target: Optional[str] = None,
    seed: int = 1,
    progress: Optional[Progress] = None,
) -> Fitted:
    """Fits the friction law of one joint.

    ``test`` is only scored; ``inputs`` of the law are chosen by relevance when absent; ``representation`` is ``"table"`` or
    ``"expression"``; ``form`` a law of the literature such as ``"stribeck"`` to fit in any case, by the names of the command line; ``rate`` of the samples in Hz; ``target`` is the drive that has to have room for the image; one without floating-point unit gets a table of integers
    (``Fitted.integers``). ``progress`` is called
    with stage, steps and error while it works. One seed, one result.
    """
    native = _frikan.fit(
        all_handed(recordings, "recording"),
        all_handed(test, "test"),
        joint_file(joint),
        None if inputs is None else list(inputs),
        representation,
        form,
        rate,
        max_bytes,
        max_instructions,
        target,
        seed,
        progress,
    )
    return Fitted(native)


def diagnose(
    recordings: Recordings,
    *,
    simulation: Optional[Recording] = None,
    model: Union[None, Image, str, "os.PathLike[str]"] = None,
    base: str = "coulomb-viscous",
    joint: Joint = None,
    target: Optional[str] = None,
    least_effect: Optional[float] = None,
    seed: int = 0,
    progress: Optional[Progress] = None,
) -> Diagnosed:
    """Names the physics that a simulation, a model, or (with neither) a static friction model of the recording leaves out.

    ``base`` of the latter is ``"coulomb-viscous"`` or ``"spline"``; ``least_effect`` is the smallest share of the torque worth acting on.
    """
    if simulation is not None and model is not None:
        raise TypeError("a recording is compared with a simulation or with a model, not with both")
    if base not in ("coulomb-viscous", "spline"):
        raise ValueError(f"there is no base of the name {base!r}")
    if isinstance(model, (str, os.PathLike)):
        compared_with = f"the model {os.path.basename(os.fspath(model))}"
        model = Image.load(model)
    elif model is not None:
        compared_with = "the model"
    elif simulation is not None:
        label = handed_label(simulation)
        compared_with = f"the simulation {label}" if label else "the simulation"
    else:
        kind = "a symmetric friction curve" if base == "spline" else "symmetric Coulomb and viscous friction"
        compared_with = f"{kind}, fitted to the same recording"
    native = _frikan.diagnose(
        all_handed(recordings, "recording"),
        None if simulation is None else handed(simulation, "simulation"),
        None if model is None else model.content,
        base == "spline",
        joint_file(joint),
        target,
        least_effect,
        seed,
        progress,
    )
    return Diagnosed(native, compared_with)


def predict(model: Model, recording: Recording, *, joint: Joint = None) -> Prediction:
    """A recording with the model's prediction beside it, rigid body included."""
    return Prediction(*_frikan.predict(_image(model)._native, handed(recording), joint_file(joint)))


def check(recordings: Recordings, *, joint: Joint = None) -> Checked:
    """The quality of recordings, what can be identified from them and what to record next, before anything is fitted."""
    return Checked(*_frikan.check(all_handed(recordings, "recording"), joint_file(joint)))


def rollout(model: Model, recording: Recording, *, joint: Joint = None, window: Optional[float] = None) -> RolledOut:
    """The joint simulated with a model under the commands of a recording, and how far it comes off.

    It is put back to the recorded state every ``window`` seconds; as is usual for its actuator when absent.
    """
    return RolledOut(*_frikan.rollout(_image(model)._native, handed(recording), joint_file(joint), window))


def arm(
    recordings: Recordings,
    *,
    urdf: Union[str, "os.PathLike[str]"],
    test: Optional[Recordings] = None,
    joint: Joint = None,
    target: Optional[str] = None,
    seed: int = 1,
    progress: Optional[Progress] = None,
) -> FittedArm:
    """Fits bodies and friction of a whole arm from recordings of all its joints.

    ``urdf`` is the path of the robot's description, ``joint`` an ``arm.toml`` or a mapping with its keys; ``test`` is only scored.
    """
    native = _frikan.arm(
        all_handed(recordings, "recording"),
        all_handed(test, "test"),
        os.fspath(urdf),
        joint_file(joint),
        target,
        seed,
        progress,
    )
    return FittedArm(native)


def simulate(
    joint: Joint,
    *,
    effects: Optional[Mapping[str, float]] = None,
    duration: Optional[float] = None,
    noise: Optional[str] = None,
    seed: int = 1,
    motion_seed: Optional[int] = None,
) -> dict[str, npt.NDArray[np.float64]]:
    """A simulated recording of a joint in closed loop, columns by name, with ``effects`` hidden in it by name and amplitude (1 is a
    plausible strength); ``duration`` in seconds."""
    hidden = [(name, float(amplitude)) for name, amplitude in (effects or {}).items()]
    text = _frikan.simulate(joint_file(joint), hidden, duration, noise, seed, seed if motion_seed is None else motion_seed)
    names, _, rows = text.partition("\n")
    table = np.loadtxt(rows.splitlines(), delimiter=",", ndmin=2)
    return {name: np.ascontiguousarray(table[:, column]) for column, name in enumerate(names.split(","))}


def _image(model: Model) -> Image:
    if isinstance(model, Fitted):
        return model.image
    return model if isinstance(model, Image) else Image.load(model)


def handed_label(recording: Any) -> Optional[str]:
    """Name of a file; ``None`` of what is none."""
    return os.path.basename(os.fspath(recording)) if isinstance(recording, (str, os.PathLike)) else None
