"""The friction of a joint from a LeRobot dataset: what it was told (`action`) and where it went (`observation.state`), episode by episode.

    python trainer/python/examples/lerobot_joint.py DATASET elbow_flex.pos joint.toml

Versions 2 and 3 of the format are read by pyarrow, which LeRobot brings; LeRobot itself need not be installed. `joint.toml` says what the
actuator makes of an action (docs/servos.md), for a dataset holds no torque. Its columns are `state` and `action`, in the unit of the dataset.
"""

import json
import pathlib
import sys

import numpy as np
import pyarrow.parquet

import frikan


def episodes(dataset, motor):
    """The recordings of a motor by its name in `meta/info.json`: a mapping of columns for each episode."""
    dataset = pathlib.Path(dataset)
    features = json.loads((dataset / "meta/info.json").read_text())["features"]
    place = {feature: _names(features[feature]).index(motor) for feature in ("observation.state", "action")}
    wanted = ["timestamp", "episode_index", *place]
    # A file holds an episode in version 2, and several in version 3.
    files = sorted(dataset.glob("data/chunk-*/*.parquet"))
    tables = [pyarrow.parquet.read_table(file, columns=wanted) for file in files]
    rows = {name: np.concatenate([_array(table[name]) for table in tables]) for name in wanted}
    recordings = []
    for episode in np.unique(rows["episode_index"]):
        of_episode = rows["episode_index"] == episode
        recordings.append(
            {
                "time_s": rows["timestamp"][of_episode].astype(float),
                "state": rows["observation.state"][of_episode, place["observation.state"]],
                "action": rows["action"][of_episode, place["action"]],
            }
        )
    return recordings


def _names(feature):
    """Names of the elements of a feature: a list, or a list under a heading."""
    names = feature["names"]
    return next(iter(names.values())) if isinstance(names, dict) else names


def _array(column):
    """A column of numbers, or of vectors of one length, as an array."""
    return np.array(column.to_pylist())


def fitted(dataset, motor, joint):
    """The fit of all episodes but the last one, which is only scored."""
    recordings = episodes(dataset, motor)
    return frikan.fit(recordings[:-1], test=recordings[-1:], joint=joint)


if __name__ == "__main__":
    print(fitted(*sys.argv[1:]))
