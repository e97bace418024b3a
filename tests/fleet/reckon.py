"""Measures what a task of a fleet takes, and what `plan`, `run` and `gather` take of a long list, and reckons a hundred thousand joints. `--write` puts
the rows into docs/large-fleet.md. Not one of the tests: it takes some minutes.

    python tests/fleet/reckon.py TRAINER [--write]
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile
from collections import namedtuple

import recordings

PAGE = pathlib.Path(__file__).parents[2] / "docs/large-fleet.md"
FIXTURES = PAGE.parents[1] / "fixtures"
JOINTS = 100_000
# Joints that are fitted, of short recordings of separated friction and of a minute of a joint with gravity.
SHORT, LONG = 40, 8
# Lengths of the lists that are planned and gathered, with results copied from those that were fitted.
LISTS = [2000, 8000]
# Starts of which the mean is taken.
STARTS = 20

Used = namedtuple("Used", "processor memory")


def used(command, folder):
    """Processor time (s) and largest memory (bytes) of a command."""
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    # A fleet with a joint that is flagged ends with 1.
    assert process.returncode in (0, 1), command
    return Used(usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024)


class Fitted:
    """Tasks that were run one by one; all figures are means of a task."""

    def __init__(self, trainer, folder, joints, joint_file=()):
        subprocess.run([trainer, "plan", "recordings", "-o", "tasks.jsonl", "--quiet", *joint_file], cwd=folder, check=True)
        run = [trainer, "run", "--tasks", "tasks.jsonl", "--threads", "1", "--index"]
        tasks = [used([*run, str(index)], folder) for index in range(joints)]
        self.processor = sum(task.processor for task in tasks) / joints
        self.memory = max(task.memory for task in tasks)
        self.recording = size(folder / "recordings") / joints
        self.result = size(folder / "tasks.results") / joints


def size(folder):
    return sum(path.stat().st_size for path in folder.iterdir())


def short(trainer, folder):
    recordings.write(folder / "recordings", SHORT)
    (folder / "recordings/torn.csv").unlink()
    return Fitted(trainer, folder, SHORT)


def long(trainer, folder):
    (folder / "recordings").mkdir()
    joint = FIXTURES / "elbow.toml"
    for seed in range(LONG):
        words = ["simulate", joint, "--seed", str(seed), "-o", f"recordings/joint{seed}.csv", "--duration", "60", "--quiet"]
        subprocess.run([trainer, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return Fitted(trainer, folder, LONG, ["--joint", str(joint)])


class Listed:
    """What a list of so many joints takes, whose results are copies of those in `fitted`."""

    def __init__(self, trainer, folder, joints, fitted):
        (folder / "recordings").mkdir(parents=True)
        for joint in range(joints):
            (folder / f"recordings/{recordings.name(joint)}.csv").touch()
        self.plan = used([trainer, "plan", "recordings", "-o", "tasks.jsonl", "--quiet"], folder)
        results = folder / "tasks.results"
        results.mkdir()
        done = [json.loads(path.read_text()) for path in sorted((fitted / "tasks.results").glob("*.json"))]
        for index, line in enumerate((folder / "tasks.jsonl").read_text().splitlines()):
            result = {**done[index % len(done)], "task": json.loads(line)}
            (results / f"{index:06}.json").write_text(json.dumps(result) + "\n")
        # A task that is done already: what starting and finding its line takes.
        last = [trainer, "run", "--tasks", "tasks.jsonl", "--index", str(joints - 1)]
        self.start_s = sum(used(last, folder).processor for _ in range(STARTS)) / STARTS
        self.gather = used([trainer, "gather", "--tasks", "tasks.jsonl", "-o", "fleet", "--quiet"], folder)
        self.tables = size(folder / "fleet")
        self.page = (folder / "fleet/fleet.html").stat().st_size


def reckoned(of_list, joints=LISTS):
    """A straight line through two lengths of a list, at a hundred thousand."""
    few, many = of_list
    slope = (many - few) / (joints[1] - joints[0])
    return many + slope * (JOINTS - joints[1])


def duration(seconds):
    for unit, length in [("d", 86400), ("h", 3600), ("min", 60), ("s", 0.5)]:
        if seconds >= 2 * length:
            return f"{seconds / max(length, 1):.3g} {unit}"
    return f"{1000 * seconds:.3g} ms"


def space(size_bytes):
    for unit, length in [("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)]:
        if size_bytes >= length:
            return f"{size_bytes / length:.3g} {unit}"
    return f"{size_bytes:.0f} B"


def rows(trainer, folder):
    """The rows of the table."""
    told = []
    for name, make in [("short", short), ("long", long)]:
        (folder / name).mkdir()
        fitted = make(trainer, folder / name)
        all_s = JOINTS * fitted.processor
        told += [
            f"| {name}: processor time of a task | {duration(fitted.processor)} | {duration(all_s)}; on 64 cores {duration(all_s / 64)} |",
            f"| {name}: memory of a task, at most | {space(fitted.memory)} | {space(64 * fitted.memory)} on 64 cores |",
            f"| {name}: recording, result with image | {space(fitted.recording)}, {space(fitted.result)} "
            f"| {space(JOINTS * fitted.recording)}, {space(JOINTS * fitted.result)} |",
        ]
    lists = [Listed(trainer, folder / str(joints), joints, folder / "short") for joints in LISTS]

    def row(name, say, pick):
        measured = [pick(one) for one in lists]
        return f"| {name} | {', '.join(map(say, measured))} | {say(reckoned(measured))} |"

    told += [
        row("`plan`, processor time", duration, lambda one: one.plan.processor),
        row("starting a task and finding its line, processor time", duration, lambda one: one.start_s),
        row("`gather`, processor time", duration, lambda one: one.gather.processor),
        row("`gather`, memory", space, lambda one: one.gather.memory),
        row("its tables and page", space, lambda one: one.tables),
        row("its page alone", space, lambda one: one.page),
    ]
    return told


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("trainer", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        told = rows(given.trainer, pathlib.Path(name).resolve())
    print("\n".join(told))
    if given.write:
        lines = PAGE.read_text().splitlines()
        head = next(number for number, line in enumerate(lines) if line.startswith("|---"))
        after = next(number for number in range(head, len(lines)) if not lines[number].startswith("|"))
        PAGE.write_text("\n".join([*lines[: head + 1], *told, *lines[after:]]) + "\n")


if __name__ == "__main__":
    main()
