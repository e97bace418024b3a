"""Asks `trainer diagnose` about plants that are not ours: joints of MuJoCo and Drake, healthy or with one concealed effect.

    foreign_pairs.py --write FOLDER [--simulation N] [--model N] [--alone N] [--servo N] [--seed N] [--jobs N]
    foreign_pairs.py --score FOLDER --trainer PATH [--only NAMES] [--extra "FLAGS"] [--jobs N] [-o RESULTS.json] [--page FILE.md]
    foreign_pairs.py --results RESULTS.json ... --page FILE.md     the page of runs that are done

Pairs are written once, each from the seed, its kind of reference and its number alone, and scored as often as there are programs to measure. A
pair is a recording (real.csv) with its joint.toml, what it is compared with (simulation.csv: a simulation refitted to the recording; model.csv:
another recording of the healthy joint, to which a model is fitted first; or nothing) and truth.json. Of --servo it is a joint of MuJoCo under a
controller or a position servo, whose files have positions and commands and no torque, with a refitted simulation. A third of the motions dwell, a third sweep,
a third have four sines; 20 to 90 s at 250 Hz or 1 kHz, of servos at 200 to 500 Hz. A third is healthy, and half behind a model.
"""

import argparse
import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from foreign.answer import score, write
from foreign.count import count
from foreign.page import page
from foreign.pair import REFERENCES, case, make


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", type=Path, metavar="FOLDER")
    parser.add_argument("--simulation", type=int, default=48, help="pairs with a simulation")
    parser.add_argument("--model", type=int, default=0, help="pairs with a model of another recording")
    parser.add_argument("--alone", type=int, default=0, help="recordings without a reference")
    parser.add_argument("--servo", type=int, default=0, help="pairs with a simulation, of a joint that reports no torque")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="fresh unless given")
    parser.add_argument("--score", type=Path, metavar="FOLDER")
    parser.add_argument("--trainer", type=Path)
    parser.add_argument("--only", default="*", metavar="NAMES", help="pattern of the pairs' folders, such as 'simulation-*'")
    parser.add_argument("--extra", default="", help="flags of every diagnosis")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--results", type=Path, nargs="+", default=[])
    parser.add_argument("--page", type=Path)
    arguments = parser.parse_args()
    if not (arguments.write or arguments.score or arguments.results):
        parser.error("--write, --score or --results is needed")
    if arguments.score and not arguments.trainer:
        parser.error("--score needs --trainer")
    return arguments


def wanted(arguments):
    """Cases in an order in which a set that is cut short has all kinds in their shares."""
    numbers = {reference: getattr(arguments, reference) for reference in REFERENCES}
    places = sorted(((number + 0.5) / of, reference, number) for reference, of in numbers.items() for number in range(of))
    return [case(arguments.seed, reference, number) for _, reference, number in places]


def make_one(folder, case):
    """The folder of a pair, unless it is there."""
    there = folder / f"{case.reference}-{case.seed[-1]:03}"
    if (there / "truth.json").exists():
        return
    try:
        write(there, *make(case))
    except RuntimeError as error:
        print(f"{there.name} ({case.effect}): the simulator cannot compute it: {error}", file=sys.stderr)


def main():
    arguments = read_arguments()
    results = [result for path in arguments.results for result in json.loads(path.read_text())["pairs"]]
    with ProcessPoolExecutor(arguments.jobs) as pool:
        if arguments.write:
            print(f"seed {arguments.seed}", file=sys.stderr)
            list(pool.map(partial(make_one, arguments.write), wanted(arguments)))
        if arguments.score:
            folders = sorted(path.parent for path in arguments.score.glob(f"{arguments.only}/truth.json"))
            for result in pool.map(partial(score, binary=arguments.trainer.resolve(), extra=arguments.extra), folders):
                results.append(result)
                names = [finding["effect"] for finding in result.get("findings", [])]
                print(result["pair"], result["class"], *names, file=sys.stderr, flush=True)
    if results:
        counted = count(results)
        print(json.dumps(counted, indent=1))
        if arguments.output:
            arguments.output.write_text(json.dumps({"extra": arguments.extra, "counted": counted, "pairs": results}, indent=1))
        if arguments.page:
            arguments.page.write_text(page(results))


if __name__ == "__main__":
    main()
