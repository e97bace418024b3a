"""The page of results."""

import math
from collections import Counter

from .count import classes, stated
from .effects import EFFECTS, of_reference
from .noise import KINDS
from .pair import LARGEST_SHARE, LEAST_SHARE, LONGEST_S, SERVO_FINER, SERVO_RATES_HZ, SHORTEST_S, SIMULATORS


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
    of = f" at {result['ratio']:g}" if result["ratio"] else ""
    where = f"{result['pair']}, {result['effect']}{of}, body {result['body']}, {plant(result)}, {result['motion']}, {result['noise']}"
    return f"* {where}: {said}; held-out ratio {interval(result.get('held_out'))}, sealed {interval(result.get('sealed'))}"


def calibration(results):
    """Stated probability of names and rivals against their frequency."""
    rows = []
    for of, leads in (("name", True), ("rival", False)):
        for low, high, p, hits, number in classes([pair for pair in stated(results) if pair[2] == leads]):
            rows.append([f"{100 * low:.0f} to {100 * high:.0f} %", of, f"{100 * p:.0f} %", share(hits, number)])
    return table(["class", "of a", "stated, mean", "true"], rows)


def simulator(result):
    return SIMULATORS[result["simulator"]].TITLE


def plant(result):
    """Simulator, kind of servo if it is one, and Coulomb friction: a soft constraint of the simulator, or a tanh of the velocity."""
    servo = f"{result['actuator']} " if result.get("actuator", "torque") != "torque" else ""
    return f"{simulator(result)} {servo}{'tanh' if result['joint']['sign_width_rad_s'] else 'frictionloss'}"


def split(results, key):
    """Results by a key: in the order of the simulators, soft constraints first."""
    order = list(SIMULATORS)
    ordered = sorted(results, key=lambda r: (order.index(r["simulator"]), r.get("actuator", ""), bool(r["joint"]["sign_width_rad_s"])))
    return {name: [r for r in results if key(r) == name] for name in dict.fromkeys(map(key, ordered))}


def of_healthy(results, title):
    parts = split(results, plant)
    rows = [[kind, *(count([r for r in part if kind in (r["noise"], "all")], "alarm") for part in parts.values())] for kind in (*KINDS, "all")]
    alarms = "\n".join(told(result) for result in results if result["alarm"])
    sealed = share(sum(bool(result.get("sealed")) for result in results), len(results))
    text = f"\nA sealed ratio is told in {sealed} of them. Every alarm:\n\n{alarms}\n\n"
    return f"## {title}\n\nPairs with an exit status other than 0.\n\n" + table(["noise", *parts], rows) + text


def wrong_names(results):
    """How often every wrong name is given, over plant and noise."""
    parts = {"all": results, **split(results, plant), **{kind: [r for r in results if r["noise"] == kind] for kind in KINDS}}
    counts = [Counter(names[0] for r in part for names in r["wrong"]) for part in parts.values()]
    rows = [[name, *(found[name] for found in counts)] for name, _ in counts[0].most_common()]
    return table(["named", *parts], [*rows, ["pairs", *map(len, parts.values())]])


def mistakes(results):
    """The first wrong name of each pair that has one, or nothing, over the simulators."""
    parts = split(results, simulator)
    counts = [
        Counter((r["effect"], r["wrong"][0][0] if r["wrong"] else "nothing") for r in part if r["wrong"] or not r["right"])
        for part in (results, *parts.values())
    ]
    return table(["concealed", "named", "pairs", *parts], [[*pair, *(found[pair] for found in counts)] for pair, _ in counts[0].most_common()])


def kinds_of(results):
    """The effects that these pairs can have, in the order of the catalogue."""
    kinds = {kind for reference in {result["reference"] for result in results} for kind in of_reference(reference)}
    return [kind for kind in EFFECTS if kind in kinds]


def of_kinds(results, ratios):
    """Every kind of effect over the simulators."""
    parts = split(results, simulator)
    rows = []
    for kind in kinds_of(results):
        cells, effect = [], EFFECTS[kind]
        for part in parts.values():
            found = [r for r in part if r["effect"] == kind]
            levels = [[r["right"] for r in found if r["ratio"] == ratio] for ratio in ratios]
            cells += [*(f"{sum(rights)}/{len(rights)}" for rights in levels), sum(bool(r["wrong"]) for r in found)]
        size = mean_size([r for r in results if r["effect"] == kind])
        rows.append([kind, effect.why, ", ".join(effect.names), ", ".join(effect.beside) or "-", *cells, size])
    heads = [head for name in parts for head in (*(f"{name}: right at {ratio:g}" for ratio in ratios), "wrong names")]
    return table(["concealed", "in the plant", "names that are right", "not counted", *heads, "mean set"], rows)


def of_effects(results, title):
    columns = ["right: first name or its set", "first name", "named anywhere", "a name whose set misses the truth", "the right name alone", "nothing named", "mean set"]
    for result in results:
        result["nothing"] = not result["size"]
        result["alone"] = result["right"] and not result["wrong"]

    def row(found):
        return [count(found, key) for key in ("right", "first", "anywhere", "wrong", "alone", "nothing")] + [mean_size(found)]

    ratios = sorted({result["ratio"] for result in results}, reverse=True)
    overall = [
        [f"{ratio:g}", name, *row([r for r in found if r["ratio"] == ratio])] for ratio in ratios for name, found in split(results, plant).items()
    ]
    absent = [kind for kind in kinds_of(results) if not any(result["effect"] == kind for result in results)]
    misses = "\n".join(told(result) for result in sorted(results, key=lambda r: (r["effect"], -r["ratio"])) if result["wrong"] or not result["right"])
    return (
        f"## {title}\n\n"
        + table(["effect over noise", "plant", *columns], overall)
        + "\n"
        + of_kinds(results, ratios)
        + (f"\nNot measured in these runs: {', '.join(absent)}.\n" if absent else "")
        + "\nStated probability against frequency; names that are not counted are left out.\n\n"
        + calibration(results)
        + "\nWhat was taken for what, the first wrong name of a pair:\n\n"
        + mistakes(results)
        + "\nWrong names by plant and by noise; a pair may have several.\n\n"
        + wrong_names(results)
        + f"\nEvery pair with a wrong name or without the right one:\n\n{misses}\n\n"
    )


# What a recording is compared with, as the page says it.
COMPARED = {
    "simulation": "recording against simulation",
    "model": "recording against a model fitted to another recording",
    "alone": "recording without a reference",
    "servo": "positions and commands of a servo against simulation",
}


def page(results):
    """The page in Markdown."""
    sets = Counter((result["seed"][0], result["reference"]) for result in results)
    seeds = ", ".join(f"`--seed {seed}` ({number} pairs of `--{of}`)" for (seed, of), number in sets.items())
    text = f"""# Plants that are not ours: joints of MuJoCo and of Drake

Made by `python tests/simulators/foreign_pairs.py --write FOLDER` and `... --score FOLDER --trainer target/release/trainer -o RESULTS.json` (packages of
`tests/simulators/requirements.txt`) and, from the results, by `foreign_pairs.py --results RESULTS.json ... --page docs/foreign-plants.md`. Seeds are
fresh at every run, here {seeds};
every figure below is counted by that command, and no threshold was chosen on these pairs. Brackets are 95 % intervals (Wilson).

A pair is a reference and a recording of one joint (servo, elbow or shoulder under gravity, with Coulomb friction, damping and rotor inertia) for
{SHORTEST_S:g} to {LONGEST_S:g} s at 250 Hz or 1 kHz, under one controller. A third of the motions dwell (sines with stops, or moves with rests), a third sweep (a
chirp, or strokes each at one speed), a third have four frequencies. The rigid body is given in `joint.toml` in half of the pairs, and where the
effect is one of the body. Friction of the joint is a tanh of the velocity, 0.01 to 0.1 rad/s wide, or ("frictionloss", half of the pairs
of MuJoCo) the soft constraint that MuJoCo makes of it. In MuJoCo the recorded joint is integrated at 0.25 ms, the simulation too where it has a
tanh, else at 1 ms. In Drake the recorded joint is a discrete plant of 0.25 ms, which has limits of joints and contact between bodies, and the
simulation is integrated continuously with steps of variable length; the tanh, which Drake's joints do not have, is a generalized force beside the
plant, and so are bristles, cogging and cubic damping.

The simulation is tuned to its recording first, as its users do: Coulomb and viscous friction, and a body that is not given, by least squares
(but where another level is what is concealed). A reference is that simulation; or a model fitted to a healthy recording of another motion of the
same kind; or nothing. Names of what was refitted are not counted beside an effect, for they differ from the joint's.

The recording has one of five kinds of noise: white; autoregressive; an encoder of 12 to 18 bits with its velocity differenced, beside white
torque noise; Student's with three degrees of freedom; growing with the torque. An effect is the torque that the reference's joint, tuned as above,
would not have needed for the recorded motion, below 20 Hz. Its root mean square is {100 * LEAST_SHARE:.0f} to {100 * LARGEST_SHARE:.0f} % of the friction (three times as much for
presliding and backlash, whatever it is for delays); the noise has the same root mean square, or five times that.

A servo is such a joint of MuJoCo that reports no torque: under MuJoCo's `pid` actuator with gains on position and velocity and in half of them
30 to 80 % of the torque of the rigid body as feed-forward ("pd"), or under its `dcmotor` whose voltage a firmware makes of the position error
("position_servo"), of 3 to 8 Hz. Loop and joint are stepped at 0.25 ms in recording and simulation; commands change at 1 kHz. The log has positions
and commands at {", ".join(map(str, SERVO_RATES_HZ))} Hz, in half of the pairs velocities, and `[actuator]` of `joint.toml` the constants of the simulation. Its noise is that
of the position, and of the velocity where there is one: what the gains would make of each is a {SERVO_FINER:g}th of the noise above, so that the effect is
{SERVO_FINER:g} times as large or as large as the noise, and an encoder that is coarse is the noise. Another gain, a limit and a delay are larger, and the
noise beside them is at most that beside the largest of the other effects. The body is given where another gain is concealed, for one body and
gain are another body and gain; nothing is refitted where a delay is, for it would be taken for damping.

"""
    for reference, compared in COMPARED.items():
        part = [result for result in results if result["reference"] == reference]
        effects, healthy = ([result for result in part if result["healthy"] == of] for of in (False, True))
        if effects:
            text += of_effects(effects, f"One concealed effect: {compared}")
        if healthy:
            text += of_healthy(healthy, f"Nothing is missing: {compared}")
    return text.rstrip() + "\n"
