"""Slurm on one machine, without a trace in its configuration: munged, slurmctld and two slurmd of one processor each. Needs Debian's `slurm-wlm`
and `munge`, and to be root."""

import os
import signal
import subprocess
import time

CONFIGURATION = """\
ClusterName=here
SlurmctldHost=localhost
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MaxArraySize=100001
MaxJobCount=200000
SlurmdTimeout=10
SlurmctldPort=16817
NodeName=worker[0-1] NodeHostname=localhost NodeAddr=127.0.0.1 Port=[16818-16819] CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class TwoWorkers:
    """The cluster while it is entered; `environment` is that of its commands."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        self.daemons = []

    def __enter__(self):
        self.folder.mkdir()
        for name in ["state", "spool-worker0", "spool-worker1"]:
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(folder=self.folder))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        places = {"key-file": key, "socket": "munge.socket", "pid-file": "munge.pid", "log-file": "munge.log", "seed-file": "munge.seed"}
        self._start("munged", "--foreground", "--force", *[f"--{option}={self.folder / place}" for option, place in places.items()])
        self._wait_for(lambda: (self.folder / "munge.socket").exists())
        self._start("slurmctld", "-D")
        self.workers = [self._worker(number) for number in range(2)]
        idle = lambda: subprocess.run(["sinfo", "--noheader", "-o", "%t %D"], env=self.environment, capture_output=True, text=True).stdout
        self._wait_for(lambda: idle().strip() == "idle 2")
        return self

    def _start(self, *command):
        with open(self.folder / f"{command[0]}.out", "a") as out:
            daemon = subprocess.Popen(command, env=self.environment, stdout=out, stderr=out, start_new_session=True)
        self.daemons.append(daemon)
        return daemon

    def _worker(self, number):
        return self._start("slurmd", "-D", "-N", f"worker{number}")

    @staticmethod
    def _wait_for(is_so, seconds=60):
        end = time.time() + seconds
        while not is_so():
            assert time.time() < end, "Slurm does not come up"
            time.sleep(0.2)

    def kill_a_worker(self):
        """Ends one slurmd and the steps that it began, as the loss of its machine would; it comes back after a while."""
        self.workers[1].kill()
        steps = subprocess.run(["pgrep", "-f", "slurmstepd: .*worker1|slurmstepd -N worker1"], capture_output=True, text=True)
        for pid in steps.stdout.split():
            os.kill(int(pid), signal.SIGKILL)
        self.workers[1].wait()
        time.sleep(2)
        self.workers[1] = self._worker(1)

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()
