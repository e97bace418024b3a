"""Fits without a fleet, beside it and at the same time, so that both meet the same machine."""

import os
import subprocess
import threading

# One joint in so many is fitted without the fleet too.
SAMPLE = 10


class BareFits(threading.Thread):
    """Fits every tenth recording by `trainer fit`, one after the other; `seconds` is the processor time of each."""

    def __init__(self, trainer, folder):
        super().__init__()
        self.recordings = sorted((folder / "recordings").glob("joint*.csv"))[::SAMPLE]
        self.command = [trainer, "fit", "--threads", "1", "--quiet", "--json", folder / "bare.json", "-o", folder / "bare.frk"]
        self.seconds = []

    def run(self):
        for recording in self.recordings:
            fit = subprocess.Popen([*self.command, recording], stdout=subprocess.DEVNULL)
            _, _, used = os.wait4(fit.pid, 0)
            fit.returncode = 0
            self.seconds.append(used.ru_utime + used.ru_stime)
