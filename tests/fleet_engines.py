"""Runs a fleet on HyperQueue (the package `hyperqueue` of PyPI, which brings server and workers) or on a Slurm array (`sbatch`), kills a task
in the middle, has one fail, and checks that nothing is lost, nothing double and the failure named. Not one of the tests: it takes minutes.

    python tests/fleet_engines.py TRAINER hyperqueue|slurm [JOINTS]
"""

import json
import math
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

# One joint in so many rubs half as much again; siblings scatter by 5 %.
FAULT_EVERY = 50


def recordings(folder, joints):
    """Separated friction of siblings, and a recording that cannot be read."""
    folder.mkdir()
    for joint in range(joints):
        draw = random.Random(joint)
        scale = math.exp(0.05 * draw.gauss(0, 1)) * (1.5 if joint % FAULT_EVERY == 7 else 1.0)
        rows = ["velocity_rad_s,friction_torque_Nm"]
        for row in range(300):
            v = (row - 149.5) / 150
            rows.append(f"{v:.4f},{scale * (math.copysign(2, v) + 0.6 * v) + 0.03 * draw.gauss(0, 1):.4f}")
        (folder / f"joint{joint:05}.csv").write_text("\n".join(rows) + "\n")
    (folder / "torn.csv").write_text("velocity_rad_s,friction_torque_Nm\n0.1,oops\n")


def kill_one_task(folder):
    """Ends one running task as a machine that fails would; says whether there was one."""
    found = subprocess.run(["pgrep", "-f", f"run --tasks {folder}/tasks.jsonl"], capture_output=True, text=True)
    for pid in found.stdout.split():
        if pid != str(os.getpid()):
            os.kill(int(pid), signal.SIGKILL)
            return True
    return False


def on_hyperqueue(command, tasks, folder):
    from hyperqueue import Job, LocalCluster
    from hyperqueue.cluster import WorkerConfig

    with LocalCluster() as cluster:
        for _ in range(2):
            cluster.start_worker(WorkerConfig(cores=1))
        client = cluster.client()
        # The second round finds nearly everything done.
        for attempt in range(2):
            job = Job(max_fails=None)
            for index in range(tasks):
                job.program([*command, "--index", str(index)], stdout=None, stderr=None)
            submitted = client.submit(job)
            if attempt == 0:
                while not kill_one_task(folder):
                    time.sleep(0.05)
            client.wait_for_jobs([submitted], raise_on_error=False)


def on_slurm(command, tasks, folder):
    line = " ".join([*command, "--index", "$SLURM_ARRAY_TASK_ID"])
    submit = ["sbatch", "--quiet", "--wait", f"--array=0-{tasks - 1}", "--output=/dev/null", "--wrap", line]
    for attempt in range(2):
        with subprocess.Popen(submit) as array:
            while attempt == 0 and array.poll() is None and not kill_one_task(folder):
                time.sleep(0.05)


def main():
    trainer, engine = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    joints = int(sys.argv[3]) if len(sys.argv) > 3 else 40
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        recordings(folder / "recordings", joints)
        tasks = folder / "tasks.jsonl"
        subprocess.run([trainer, "plan", folder / "recordings", "-o", tasks, "--quiet"], check=True)
        begin = time.time()
        command = [trainer, "run", "--tasks", str(tasks), "--threads", "1"]
        {"hyperqueue": on_hyperqueue, "slurm": on_slurm}[engine](command, joints + 1, folder)
        print(f"{engine}: {joints + 1} tasks in {time.time() - begin:.0f} s")
        begin = time.time()
        gathered = subprocess.run([trainer, "gather", "--tasks", tasks, "-o", folder / "table"], check=False)
        print(f"gathered in {time.time() - begin:.1f} s")
        assert gathered.returncode == 1, gathered
        fleet = json.loads((folder / "table/fleet.json").read_text())
    assert len({joint["joint"] for joint in fleet["joints"]}) == len(fleet["joints"]) == joints, len(fleet["joints"])
    assert [task["error"]["code"] for task in fleet["unfitted"]] == ["FRK-D002"], fleet["unfitted"]
    faults = {f"joint{joint:05}" for joint in range(7, joints, FAULT_EVERY)}
    found = {joint["joint"] for joint in fleet["joints"] if joint["outlier"]}
    print(f"faults found: {len(found & faults)} of {len(faults)}; healthy joints flagged: {len(found - faults)} of {joints - len(faults)}")


if __name__ == "__main__":
    main()
