"""Asks `trainer diagnose` about plants that are not ours: joints of MuJoCo and Drake, healthy or with one concealed effect.

    foreign_pairs.py --trainer PATH [--simulator mujoco|drake|both] [--pairs N] [--only healthy|effects] [--model] [--seed N] [--jobs N]
                     [--keep FOLDER] [--page FILE.md]
    foreign_pairs.py --again SEED ...            the pairs of these seeds of their own, kept whatever the answer
    foreign_pairs.py --results FILE.jsonl ... --page FILE.md     the page of runs that are done

Seeds are fresh at every run and printed. `--keep` has `results.jsonl` with every pair and a folder for each that is answered wrongly.
"""

import argparse
import itertools
import json
import shutil
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from foreign.answer import ask, judge, write
from foreign.effects import EFFECTS
from foreign.noise import KINDS
from foreign.page import page
from foreign.pair import SIMULATORS, Case, make, model_case

# Root mean square of the effect over that of the noise.
RATIOS = (1.0, 0.2)
# Pairs a seed of a run has room for.
PAIRS_A_SEED = 100_000


def cases(arguments):
    """Groups and cases in the order in which they run: a run that is cut short has all kinds in their shares."""
    rng = np.random.default_rng(arguments.seed)
    kinds = list(itertools.product(EFFECTS, RATIOS))
    rng.shuffle(kinds)
    first = arguments.seed * PAIRS_A_SEED
    simulators = list(SIMULATORS) if arguments.simulator == "both" else [arguments.simulator]
    for number in range(arguments.pairs):
        seed = first + 3 * number
        noise = KINDS[number % len(KINDS)]
        # They alternate, the other way around from one round of all kinds to the next.
        simulator = simulators[(number + number // len(kinds)) % len(simulators)]
        if arguments.only in (None, "effects"):
            effect, ratio = kinds[number % len(kinds)]
            yield "effects", Case(seed, str(effect), float(ratio), str(rng.choice(KINDS)), simulator)
        if arguments.only in (None, "healthy"):
            yield "healthy", Case(seed + 1, "none", 0.0, noise, simulator)
        if arguments.model:
            yield "model", Case(seed + 2, "none", 0.0, noise, simulator)


def solve(job):
    """One pair made, asked and judged; its folder stays where the answer is wrong. None where the simulator cannot compute the joint."""
    group, case, binary, keep, always = job
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "pair"
        try:
            pair = model_case(case) if group == "model" else make(case)
        except RuntimeError as error:
            print(f"{group} {case.seed} ({case.effect}): {error}", file=sys.stderr)
            return None
        write(folder, pair)
        answer = ask(binary, folder, group == "model")
        told = pair[3]
        judged = judge(told, answer)
        wrong = judged["alarm"] if group != "effects" else judged["wrong"] or not judged["right"]
        if keep and (wrong or always):
            shutil.copytree(folder, Path(keep) / f"{group}-{case.seed}", dirs_exist_ok=True)
        return {"group": group, **told, **answer, **judged}


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trainer", type=Path)
    parser.add_argument("--pairs", type=int, default=48, help="of each group")
    parser.add_argument("--simulator", choices=(*SIMULATORS, "both"), default="mujoco", help="both: pairs alternate")
    parser.add_argument("--only", choices=("healthy", "effects", "model"))
    parser.add_argument("--model", action="store_true", help="also models of one recording against healthy recordings of other motions")
    parser.add_argument("--seed", type=int, default=int(time.time()) % PAIRS_A_SEED)
    parser.add_argument("--jobs", type=int, choices=(1, 2), default=1)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--page", type=Path)
    parser.add_argument("--again", type=int, nargs="+", help="seeds of pairs of the run of --seed and --pairs")
    parser.add_argument("--results", type=Path, nargs="+")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="no pair is begun later")
    arguments = parser.parse_args()
    arguments.model = arguments.model or arguments.only == "model"
    if not (arguments.trainer or arguments.results):
        parser.error("--trainer or --results is needed")
    return arguments


def measure(arguments):
    """Results in the order of the cases, each written as it comes."""
    print(f"seed {arguments.seed}", file=sys.stderr)
    again = arguments.again or ()
    binary, start = str(arguments.trainer.resolve()), time.monotonic()
    jobs = [(group, case, binary, arguments.keep, bool(again)) for group, case in cases(arguments) if not again or case.seed in again]
    results, lines = [], sys.stdout
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
        lines = (arguments.keep / "results.jsonl").open("a")
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for begin in range(0, len(jobs), 2 * arguments.jobs):
            if time.monotonic() - start > 60 * arguments.minutes:
                break
            for result in filter(None, pool.map(solve, jobs[begin : begin + 2 * arguments.jobs])):
                result["run"] = arguments.seed
                results.append(result)
                print(json.dumps(result), file=lines, flush=True)
    return results


def main():
    arguments = read_arguments()
    if arguments.results:
        results = [json.loads(line) for path in arguments.results for line in path.read_text().splitlines()]
    else:
        results = measure(arguments)
    text = page(results)
    if arguments.page:
        arguments.page.write_text(text)
    else:
        print(text, file=sys.stderr)


if __name__ == "__main__":
    main()
