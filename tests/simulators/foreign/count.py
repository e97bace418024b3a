"""Results counted: shares, sizes of sets, stated probability against frequency, costs."""

from statistics import mean, median

# Lower ends of the classes of stated probability.
CLASSES = (0.0, 0.5, 0.7, 0.85, 0.95)


def stated(results):
    """Every stated probability: that, whether it is of a right name, whether that name leads its set. Names that do not count are left out."""
    pairs = []
    for result in results:
        truth, beside = set(result.get("names", ())), set(result.get("beside", ()))
        for finding in result.get("findings", []):
            told = {finding["effect"]: finding["probability"], **finding["alternatives"]}
            pairs += [(p, name in truth, name == finding["effect"]) for name, p in told.items() if name in truth or name not in beside]
    return pairs


def classes(pairs):
    """Bounds of each class that is not empty, the mean probability in it, right ones and all."""
    for low, high in zip(CLASSES, (*CLASSES[1:], 1.01)):
        found = [(p, hit) for p, hit, _ in pairs if low <= p < high]
        if found:
            yield low, min(high, 1.0), mean(p for p, _ in found), sum(hit for _, hit in found), len(found)


def calibration_error(pairs):
    """Mean distance of frequency from probability over the classes, by their size."""
    return sum(abs(hits / of - p) * of for _, _, p, hits, of in classes(pairs)) / len(pairs) if pairs else None


def of_effects(results):
    sizes = [result["size"] for result in results if result["size"]]
    counts = {key: sum(bool(result[key]) for result in results) for key in ("right", "first", "wrong")}
    return {"pairs": len(results), **counts, "mean_set": mean(sizes) if sizes else None}


def count(results):
    """Of each kind of reference, and of all together stated probability and costs."""
    counted = {}
    for reference in dict.fromkeys(result["reference"] for result in results):
        part = [result for result in results if result["reference"] == reference]
        healthy, effects = ([r for r in part if r["healthy"] == of] for of in (True, False))
        ratios = sorted({result["ratio"] for result in effects}, reverse=True)
        servos = sorted({result["actuator"] for result in effects if result.get("actuator", "torque") != "torque"})
        counted[reference] = {
            "healthy": {"pairs": len(healthy), "alarms": sum(r["alarm"] for r in healthy)},
            "effects": of_effects(effects),
            **{f"effect over noise {ratio:g}": of_effects([r for r in effects if r["ratio"] == ratio]) for ratio in ratios},
            **{servo: of_effects([r for r in effects if r["actuator"] == servo]) for servo in servos},
        }
    pairs = stated(results)
    costs = [result["processor_s"] for result in results if "processor_s" in result]
    counted["stated"] = {
        "calibration_error": calibration_error(pairs),
        "calibration_error_of_first_names": calibration_error([pair for pair in pairs if pair[2]]),
        "classes": [{"from": low, "to": high, "stated": p, "right": hits, "of": of} for low, high, p, hits, of in classes(pairs)],
    }
    if costs:
        counted["processor_s"] = {"mean": mean(costs), "median": median(costs), "most": max(costs)}
    return counted
