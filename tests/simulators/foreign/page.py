"""The page of results."""

import math
from collections import Counter

from .effects import EFFECTS
from .noise import KINDS
from .pair import LARGEST_SHARE, LEAST_SHARE

FRICTIONS = ("`frictionloss`", "tanh of the velocity")
# Lower ends of the classes of stated probability.
CLASSES = (0.0, 0.5, 0.7, 0.85, 0.95)


def share(hits, of):
    """Hits, percentage and 95 % interval (Wilson 1927)."""
    if not of:
        return "-"
    z, p = 1.96, hits / of
    middle, half = (p + z * z / (2 * of)) / (1 + z * z / of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return f"{hits}/{of} = {100 * p:.1f} % ({100 * max(middle - half, 0.0):.1f}-{100 * (middle + half):.1f})"


def count(results, key):
    return share(sum(bool(result[key]) for result in results), len(results))


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def mean_size(results):
    sizes = [result["size"] for result in results if result["size"]]
    return f"{sum(sizes) / len(sizes):.2f}" if sizes else "-"


def interval(of):
    return f"{of[0]:.3f}" + (f" ({of[1]:.3f} to {of[2]:.3f})" if len(of) > 2 else "") if of else "none"


def told(result):
    """What was answered to a pair, in one line."""
    parts = []
    for finding in result.get("findings", []):
        rivals = "".join(f" or {name} {100 * p:.0f} %" for name, p in finding["alternatives"].items())
        parts.append(f"{finding['effect']} {100 * finding['probability']:.0f} %{rivals}")
    parts += [f"{note['effect']} (measurement)" for note in result.get("health", [])]
    if result.get("in_simulation"):
        parts.append("in the simulation itself: " + ", ".join(result["in_simulation"]))
    said = "; ".join(parts) or result.get("error", "nothing").splitlines()[0]
    of = f" at {result['ratio']:g} (beside friction {result['beside_friction_Nm'] / result['noise_Nm']:.2f})" if result["ratio"] else ""
    friction = "tanh" if result["joint"]["sign_width_rad_s"] else "frictionloss"
    where = f"{result['effect']}{of}, {friction}, {result['noise']}, seed {result['seed']}"
    return f"* {where}: {said}; held-out ratio {interval(result.get('held_out'))}, sealed {interval(result.get('sealed'))}"


def calibration(results):
    """Stated probability of names and rivals against their frequency."""
    rows, pairs = [], []
    for result in results:
        truth, beside = set(result.get("names", ())), set(result.get("beside", ()))
        for finding in result.get("findings", []):
            stated = {finding["effect"]: finding["probability"], **finding["alternatives"]}
            pairs += [(p, name in truth, name == finding["effect"]) for name, p in stated.items() if name in truth or name not in beside]
    for low, high in zip(CLASSES, (*CLASSES[1:], 1.01)):
        for first in (True, False):
            found = [(p, hit) for p, hit, leads in pairs if low <= p < high and leads == first]
            if found:
                stated = f"{100 * sum(p for p, _ in found) / len(found):.0f} %"
                rows.append([f"{100 * low:.0f} to {100 * min(high, 1):.0f} %", "name" if first else "rival", stated, share(sum(hit for _, hit in found), len(found))])
    return table(["class", "of a", "stated, mean", "true"], rows)


def by_friction(results):
    """Pairs whose Coulomb friction is the soft constraint of `frictionloss`, and those with a tanh of the velocity."""
    return [[r for r in results if bool(r["joint"]["sign_width_rad_s"]) == smooth] for smooth in (False, True)]


def of_healthy(results, title):
    rows = []
    for kind in (*KINDS, "all"):
        found = [r for r in results if kind in (r["noise"], "all")]
        rows.append([kind, *(count(part, "alarm") for part in by_friction(found))])
    alarms = "\n".join(told(result) for result in results if result["alarm"])
    sealed = share(sum(bool(result.get("sealed")) for result in results), len(results))
    text = f"\nA sealed ratio is told in {sealed} of them. Every alarm:\n\n{alarms}\n\n"
    return f"## {title}\n\nPairs with an exit status other than 0.\n\n" + table(["noise", *FRICTIONS], rows) + text


def wrong_names(results):
    """How often every wrong name is given, over friction and noise."""
    parts = [*by_friction(results), *([r for r in results if r["noise"] == kind] for kind in KINDS)]
    counts = [Counter(names[0] for r in part for names in r["wrong"]) for part in parts]
    order = (counts[0] + counts[1]).most_common()
    rows = [[name, number, *(found[name] for found in counts)] for name, number in order]
    return table(["named", "all", *FRICTIONS, *KINDS], [*rows, ["pairs", len(results), *(len(part) for part in parts)]])


def of_effects(results):
    columns = ["right: first name or its set", "first name", "named anywhere", "a name whose set misses the truth", "the right name alone", "nothing named", "mean set"]
    for result in results:
        result["nothing"] = not result["size"]
        result["alone"] = result["right"] and not result["wrong"]

    def row(found):
        return [count(found, key) for key in ("right", "first", "anywhere", "wrong", "alone", "nothing")] + [mean_size(found)]

    ratios = sorted({result["ratio"] for result in results}, reverse=True)
    overall = [
        [f"{ratio:g}", friction, *row(found)]
        for ratio in ratios
        for friction, found in zip(FRICTIONS, by_friction([r for r in results if r["ratio"] == ratio]))
    ]
    kinds = []
    for kind, effect in EFFECTS.items():
        found = [[r for r in results if r["effect"] == kind and r["ratio"] == ratio] for ratio in ratios]
        rights = [f"{sum(r['right'] for r in one)}/{len(one)}" for one in found]
        both = [r for one in found for r in one]
        kinds.append([kind, effect.why, ", ".join(effect.names), ", ".join(effect.beside) or "-", *rights, sum(bool(r["wrong"]) for r in both), mean_size(both)])
    absent = [kind for kind in EFFECTS if not any(result["effect"] == kind for result in results)]
    mistakes = Counter((r["effect"], r["wrong"][0][0] if r["wrong"] else "nothing") for r in results if r["wrong"] or not r["right"])
    head = ["concealed", "in the plant", "names that are right", "not counted", *(f"right at {ratio:g}" for ratio in ratios), "wrong names", "mean set"]
    misses = "\n".join(told(result) for result in sorted(results, key=lambda r: (r["effect"], -r["ratio"])) if result["wrong"] or not result["right"])
    return (
        "## One concealed effect\n\n"
        + table(["effect over noise", "Coulomb friction", *columns], overall)
        + "\n"
        + table(head, kinds)
        + (f"\nNot measured in these runs: {', '.join(absent)}.\n" if absent else "")
        + "\nStated probability against frequency; names that are not counted are left out.\n\n"
        + calibration(results)
        + "\nWhat was taken for what, the first wrong name of a pair:\n\n"
        + table(["concealed", "named", "pairs"], [[*pair, number] for pair, number in mistakes.most_common()])
        + "\nWrong names by Coulomb friction and by noise; a pair may have several.\n\n"
        + wrong_names(results)
        + f"\nEvery pair with a wrong name or without the right one:\n\n{misses}\n\n"
    )


def page(results):
    """The page in Markdown."""
    groups = {group: [r for r in results if r["group"] == group] for group in ("healthy", "effects", "model")}
    runs = Counter((result["group"], result["run"]) for result in results)
    seeds = ", ".join(f"`--only {group} --seed {run}` ({number} pairs)" for (group, run), number in runs.items())
    text = f"""# Plants that are not ours: joints of MuJoCo

Made by `python tests/simulators/foreign_pairs.py --trainer target/release/trainer --keep FOLDER` (packages of `tests/simulators/requirements.txt`)
and, from what it kept, by `foreign_pairs.py --results FOLDER/results.jsonl ... --page docs/foreign-plants.md`. Seeds are fresh at every run, here
{seeds}; every figure below is counted by that command, and no threshold was chosen on these pairs.
Brackets are 95 % intervals (Wilson).

A pair is a simulation and a recording of one joint (servo, elbow or shoulder under gravity, with `frictionloss`, `damping` and `armature`) for
20 to 30 s at 250 Hz, under one controller and one motion of four frequencies, half of the motions with stops. The rigid body is given in
`joint.toml`. Coulomb friction is the soft constraint that MuJoCo makes of `frictionloss` in half of the pairs, in the others a tanh of the
velocity, 0.01 to 0.1 rad/s wide, as other simulators have it; the same on both sides. The recorded joint is integrated at 0.25 ms, the simulation
too where it has a tanh, else at 1 ms. The recording has one of five kinds of noise: white; autoregressive;
an encoder of 12 to 18 bits with its velocity differenced, beside white torque noise; Student's with three degrees of freedom; growing with the
torque. An effect is the torque that the simulation's joint would not have needed for the recorded motion, below 20 Hz. Its root mean square is
{100 * LEAST_SHARE:.0f} to {100 * LARGEST_SHARE:.0f} % of the friction (three times as much for presliding and backlash, whatever it is for delays); the noise has the same root mean square, or five times
that. "Beside friction" is that ratio without what another Coulomb level, viscosity and offset make up for: where it is below about 0.1 there is
little to be found.

"""
    if groups["effects"]:
        text += of_effects(groups["effects"])
    if groups["healthy"]:
        text += of_healthy(groups["healthy"], "Nothing is missing: recording against simulation")
    if groups["model"]:
        text += of_healthy(groups["model"], "Nothing is missing: recording against a model fitted to another recording of 12 to 120 s")
    else:
        text += "Recordings against a model fitted to another one (`--only model`) are not measured in these runs.\n"
    return text.rstrip() + "\n"
