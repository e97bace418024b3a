"""Runs a fleet on HyperQueue (the package `hyperqueue` of PyPI) or on a Slurm array (Debian's `slurm-wlm` and `munge`, as root), kills a worker or a
task in the middle, has a task fail, and checks that nothing is lost, nothing double, the failure named and the faulty joints found. `--write`
puts the row of the engine into docs/fleet.md. Not one of the tests: a thousand joints take a quarter of an hour of processor time.

    python tests/fleet TRAINER hyperqueue|slurm [--joints N] [--write]
"""

import argparse
import json
import pathlib
import resource
import subprocess
import tempfile
import time

import recordings
from bare import BareFits
from engines import ENGINES

PAGE = pathlib.Path(__file__).parents[2] / "docs/fleet.md"


def processor_time():
    """Of this process and all that it has waited for, s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("trainer", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("engine", choices=sorted(ENGINES))
    parser.add_argument("--joints", type=int, default=1000)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        print(row := run(given.trainer, given.engine, given.joints, pathlib.Path(name).resolve()))
    if given.write:
        lines = [line for line in PAGE.read_text().splitlines() if not line.startswith(f"| {given.engine} |")]
        head = next(number for number, line in enumerate(lines) if line.startswith("| engine |"))
        PAGE.write_text("\n".join([*lines[: head + 2], row, *lines[head + 2 :]]) + "\n")


def run(trainer, engine, joints, folder):
    """Runs a fleet and returns its row of the table."""
    recordings.write(folder / "recordings", joints)
    tasks, table = folder / "tasks.jsonl", folder / "table"
    bare = BareFits(trainer, folder)
    begin, used = time.time(), processor_time()
    subprocess.run([trainer, "plan", folder / "recordings", "-o", tasks, "--quiet"], check=True)
    bare.start()
    killed = ENGINES[engine]([trainer, "run", "--tasks", str(tasks), "--threads", "1"], joints + 1, folder)
    ran = time.time()
    gathered = subprocess.run([trainer, "gather", "--tasks", tasks, "-o", table, "--quiet"], stdout=subprocess.DEVNULL, check=False)
    gathering = time.time() - ran
    bare.join()
    used = processor_time() - used - sum(bare.seconds)
    assert gathered.returncode == 1, gathered

    fleet = json.loads((table / "fleet.json").read_text())
    names = {joint["joint"] for joint in fleet["joints"]}
    assert len(names) == len(fleet["joints"]) == joints, f"{len(fleet['joints'])} joints, {len(names)} names"
    assert [task["error"]["code"] for task in fleet["unfitted"]] == ["FRK-D002"], fleet["unfitted"]
    faulty = recordings.faulty(joints)
    found = {joint["joint"] for joint in fleet["joints"] if joint["outlier"]}
    each = sum(bare.seconds) / len(bare.seconds)
    # Slurm's tasks are no children of ours, so that their time is not ours to see.
    overhead = f"{100 * (used / (joints * each) - 1):+.1f} %" if engine == "hyperqueue" else "not seen"
    return (
        f"| {engine} | {joints} | {killed} | {joints - len(names)} lost, 1 failure named | {ran - begin:.0f} s + {gathering:.1f} s "
        f"| {each:.2f} s | {overhead} | {len(found & faulty)} of {len(faulty)} | {len(found - faulty)} of {joints - len(faulty)} |"
    )


if __name__ == "__main__":
    main()
