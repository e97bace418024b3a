"""Engines that run the tasks of a list, twice: in the first round something is killed, the second does what it left."""

import os
import signal
import subprocess
import time

from slurm import TwoWorkers


def kill_one_task(folder):
    """Ends one running task as a machine that fails would; says whether there was one."""
    found = subprocess.run(["pgrep", "-f", f"run --tasks {folder}/tasks.jsonl"], capture_output=True, text=True)
    for pid in found.stdout.split():
        try:
            os.kill(int(pid), signal.SIGKILL)
            return True
        except ProcessLookupError:
            pass
    return False


def hyperqueue(command, tasks, folder):
    """The package of PyPI, which brings server and workers."""
    from hyperqueue import Job, LocalCluster
    from hyperqueue.cluster import WorkerConfig

    with LocalCluster() as cluster:
        for _ in range(2):
            cluster.start_worker(WorkerConfig(cores=1))
        client = cluster.client()
        for attempt in range(2):
            job = Job(max_fails=None)
            for index in range(tasks):
                job.program([*command, "--index", str(index)], stdout=None, stderr=None)
            submitted = client.submit(job)
            while attempt == 0 and not kill_one_task(folder):
                time.sleep(0.05)
            client.wait_for_jobs([submitted], raise_on_error=False)
    return "a task"


def slurm(command, tasks, folder):
    """An array on two workers of this machine, of which one dies with what it was doing."""
    line = " ".join([*command, "--index", "$SLURM_ARRAY_TASK_ID"])
    submit = ["sbatch", "--quiet", "--wait", "--no-requeue", f"--array=0-{tasks - 1}", "--output=/dev/null", "--wrap", line]
    with TwoWorkers(folder / "slurm") as cluster:
        for attempt in range(2):
            with subprocess.Popen(submit, env=cluster.environment) as array:
                while attempt == 0 and not (folder / "tasks.results").exists():
                    time.sleep(0.05)
                if attempt == 0:
                    cluster.kill_a_worker()
                    while not kill_one_task(folder):
                        time.sleep(0.05)
                array.wait()
    return "a worker and a task"


ENGINES = {"hyperqueue": hyperqueue, "slurm": slurm}
