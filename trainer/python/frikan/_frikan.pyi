from collections.abc import Callable, Sequence
from typing import Any, Optional

__version__: str

Handed = tuple[str, Optional[bytes]]
Joint = Optional[tuple[bool, str]]
Progress = Optional[Callable[[str, int, Optional[float]], Any]]

class Error(Exception):
    code: str
    exit_status: int
    file: Optional[str]
    row: Optional[int]
    column: Optional[str]
    value: Optional[str]

class Fitted:
    def json(self) -> str: ...
    def report(self, command: str) -> str: ...
    def text(self, image: str) -> str: ...
    def image(self) -> bytes: ...
    def doubt(self) -> Optional[tuple[str, str]]: ...
    def curves(self) -> tuple[list[list[float]], list[list[float]]]: ...

class Diagnosed:
    def json(self) -> str: ...
    def report(self, compared_with: str, command: str) -> str: ...
    def text(self) -> str: ...
    def image(self) -> Optional[bytes]: ...
    def trajectory(self) -> Optional[str]: ...

class Image:
    def __init__(self, content: bytes) -> None: ...
    def content(self) -> bytes: ...
    def json(self) -> str: ...
    def crc32(self) -> Optional[int]: ...
    def inputs(self) -> list[tuple[str, str, float, float]]: ...
    def evaluate(self, columns: Sequence[bytes]) -> bytes: ...

def fit(
    recordings: list[Handed],
    tests: list[Handed],
    joint_file: Joint,
    inputs: Optional[list[str]],
    representation: Optional[str],
    rate: Optional[float],
    max_bytes: Optional[int],
    max_instructions: Optional[int],
    target: Optional[str],
    seed: int,
    progress: Progress,
) -> Fitted: ...
def diagnose(
    recordings: list[Handed],
    simulation: Optional[Handed],
    model: Optional[bytes],
    spline: bool,
    joint_file: Joint,
    target: Optional[str],
    least_effect: Optional[float],
    seed: int,
    progress: Progress,
) -> Diagnosed: ...
def predict(image: Image, recording: Handed, joint_file: Joint) -> tuple[bytes, list[str]]: ...
def simulate(
    joint_file: Joint,
    effects: list[tuple[str, float]],
    duration: Optional[float],
    noise: Optional[str],
    seed: int,
    motion_seed: int,
) -> str: ...
