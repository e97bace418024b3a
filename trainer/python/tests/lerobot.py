"""A data set in the format of LeRobot, of an arm with two position-controlled motors of which one swings a pendulum."""

import json

import numpy as np
import pyarrow
import pyarrow.parquet

MOTORS = ["shoulder_lift.pos", "elbow_flex.pos"]
FPS = 50
SECONDS = 20
# Of the elbow: stiffness and damping of its controller, N m/rad and N m s/rad; Coulomb and viscous friction, N m and N m s/rad.
KP, KD = 20.0, 0.6
COULOMB, VISCOUS = 0.3, 0.15
INERTIA, GRAVITY = 0.02, 0.5
JOINT = {
    "columns": {"position": {"name": "state", "unit": "deg"}, "reference_position": {"name": "action", "unit": "deg"}},
    "actuator": {"kind": "pd", "kp_Nm_rad": KP, "kd_Nms_rad": KD},
}


def elbow(phase):
    """Where the elbow was and what it was told, frame by frame, degrees. An action holds until the next one."""
    waves = [(0.7, 0.5), (0.4, 1.3), (0.2, 2.9), (0.06, 5.3)]
    steps = 20
    step_s = 1 / (FPS * steps)
    count = 2 * np.pi / 4096
    times = np.arange(SECONDS * FPS) / FPS
    told = sum(size * np.sin(rate * times + phase * (1 + rate)) for size, rate in waves)
    position, velocity, seen = told[0], 0.0, []
    for action in told:
        seen.append(round(position / count) * count)
        for _ in range(steps):
            torque = KP * (action - position) - KD * velocity
            free = velocity + step_s * (torque - GRAVITY * np.sin(position)) / INERTIA
            slowed = free - step_s * (COULOMB * np.sign(free) + VISCOUS * free) / INERTIA
            velocity = slowed if slowed * free > 0 else 0.0
            position += step_s * velocity
    return np.degrees(seen), np.degrees(told)


def write(folder, version, phases=(0.3, 0.9, 1.7)):
    """Writes an episode for each phase: a file each in version 2, one for all in version 3."""
    tables = []
    for episode, phase in enumerate(phases):
        seen, told = elbow(phase)
        still = np.zeros_like(seen)
        frames = np.arange(len(seen))
        vectors = {"observation.state": [still, seen], "action": [still, told]}
        columns = {name: list(np.column_stack(parts).astype(np.float32)) for name, parts in vectors.items()}
        columns["timestamp"] = (frames / FPS).astype(np.float32)
        columns["frame_index"] = frames
        columns["episode_index"] = np.full(len(frames), episode)
        tables.append(pyarrow.table(columns))
    chunk = folder / "data/chunk-000"
    chunk.mkdir(parents=True)
    if version == 2:
        for episode, table in enumerate(tables):
            pyarrow.parquet.write_table(table, chunk / f"episode_{episode:06}.parquet")
    else:
        pyarrow.parquet.write_table(pyarrow.concat_tables(tables), chunk / "file-000.parquet")
    # Version 2 knows lists of names with and without a heading.
    names = {"motors": MOTORS} if version == 2 else MOTORS
    feature = {"dtype": "float32", "shape": [len(MOTORS)], "names": names}
    info = {"codebase_version": f"v{version}.0", "fps": FPS, "features": {"observation.state": feature, "action": feature}}
    (folder / "meta").mkdir()
    (folder / "meta/info.json").write_text(json.dumps(info))
