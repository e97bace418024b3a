#!/usr/bin/env python3
"""Time and memory of `fit` and `diagnose` over the size of a CSV, beside polars reading the same file; writes a page.

usage: size.py TRAINER [--rows N,N,...] [--diagnose-up-to N] -o PAGE.md

The recording is that of fixtures/elbow.toml at 1 kHz by `trainer simulate`, with columns beside it, 120 B a row. Needs polars (`pip install polars`).
"""
import argparse, os, pathlib, subprocess, sys, tempfile, time

RATE = 1000
# Less memory than the largest recording needs.
LITTLE_MB = 400
READ = "import polars, sys; polars.read_csv(sys.argv[1], infer_schema_length=10_000)"


def measured(*command, ends=(0,)):
    """Seconds of the clock and of the processor, and MB at most, of a command that has to end with one of these."""
    start = time.time()
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    said = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) not in ends:
        sys.exit(f"{command}: {said}")
    return time.time() - start, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def recording(trainer, folder, rows):
    """A CSV of so many rows, with the joint file beside it."""
    joint, narrow, wide = folder / "elbow.toml", folder / "narrow.csv", folder / f"{rows}.csv"
    joint.write_text(pathlib.Path("fixtures/elbow.toml").read_text().replace("rate_Hz = 250.0", f"rate_Hz = {RATE}.0"))
    subprocess.run([trainer, "simulate", joint, "--duration", str(rows / RATE), "--seed", "7", "--quiet", "-o", narrow], check=True)
    with open(narrow) as source, open(wide, "w") as made:
        made.write(source.readline().rstrip() + ",drive_temperature_raw,bus_voltage_raw,supply_current_raw,status_word\n")
        for row, line in enumerate(source):
            made.write(f"{line.rstrip()},{31 + row * 1e-9:.15f},{48.1234567890123 - row * 1e-10:.15f},{1 / (1 + row % 977):.15f},4660\n")
    narrow.unlink()
    return joint, wide


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("trainer")
    arguments.add_argument("--rows", default="100000,1000000,10000000")
    arguments.add_argument("--diagnose-up-to", type=int, default=1_000_000)
    arguments.add_argument("-o", dest="page", type=pathlib.Path, required=True)
    a = arguments.parse_args()
    lines = []
    sizes = [int(rows) for rows in a.rows.split(",")]
    largest = max(sizes)
    for rows in sizes:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            joint, csv = recording(a.trainer, folder, rows)
            size = csv.stat().st_size
            polars = measured(sys.executable, "-c", READ, csv)
            runs = [("fit", ("fit", csv, "--joint", joint, "-o", folder / "law.frk", "--quiet"))]
            if rows <= a.diagnose_up_to:
                runs.append(("diagnose", ("diagnose", csv, "--joint", joint, "--quiet")))
            if rows == largest:
                runs.append((f"fit --memory {LITTLE_MB}", (*runs[0][1], "--memory", str(LITTLE_MB))))
            for name, command in runs:
                clock, processor, memory = measured(a.trainer, *command, ends=(0, 1))
                lines.append(f"| `{name}` | {rows} | {size / 1e6:.0f} | {clock:.1f} | {processor:.1f} | {processor / polars[1]:.1f} | {memory:.0f} | {memory * 2**20 / rows:.0f} |")
                print(lines[-1], flush=True)
    a.page.write_text(PAGE.replace("ARGUMENTS", " ".join(sys.argv[1:])) + "\n".join(lines) + "\n")


PAGE = """# Large recordings

Written by `target/simulators/bin/python tests/size.py ARGUMENTS`. A CSV of nine columns, 1000 rows a second, five of which
(time, position, torque, reference, trajectory) the simulator writes. Seconds are those of the machine that wrote the page, two busy cores; the
processor's seconds over those of polars reading the same file travel. Memory is the largest that was resident.

`fit` and `diagnose` keep eight bytes a number and no text, and beyond two million rows no column that nothing reads: neither a quantity, nor of
another joint, nor named in joint.toml or by `--inputs`.

`fit` filters half a million samples at most and learns from fifty thousand of those in motion. Scores, and the simulation under what was recorded, are of
every row, a stretch at a time; pictures show a million rows at most.

`diagnose` searches 30000 rows behind its filter, four minutes of a motion at 50 Hz, and half a million samples at most. Of a longer recording these are 24
stretches, one in each of as many equal parts and each at another place of its part (stratified sampling), with its first and its last rows. An effect of a
share s of the noise gains s²/2 nats a row: one of a twenty-seventh of the noise gains the twenty by which it is told from chance, and four
times as many rows would only halve that. What happens once beside the stretches is not seen, and the result says how much was searched.

`--memory MB` (1000): of a recording that needs more, at 8 B a number in use, 40 B a row and 100 MB beside, stretches of 32768 rows spread over it are read: every
other one, every fourth, and so on. `diagnose` then searches in proportion less; six tenths of its memory are the search's.

| command | rows | MB of CSV | s | s of the processor | of polars | MB | bytes a row |
|---|---|---|---|---|---|---|---|
"""

if __name__ == "__main__":
    main()
