"""The package does what the command line does, to the byte, and behaves as Python does."""

import html
import json
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from command_line import FIXTURES, conforms, trainer

import frikan


def without_time(said):
    """A result without what differs from run to run: its time, and the options of a command line."""
    return {key: value for key, value in said.items() if key not in ("seconds", "configuration")}


def without_command(page):
    """A page without what made it, which its foot tells."""
    before, made, after = page.partition("<h2>Made by</h2><pre>")
    assert made
    return before + after.partition("</pre>")[2]


def same_page(own, path):
    assert without_command(own) == without_command(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def fitted():
    return frikan.fit(FIXTURES / "stribeck.csv", test=FIXTURES / "stribeck-test.csv")


def test_a_fit_is_that_of_the_command_line(fitted, tmp_path):
    files = f"{FIXTURES}/stribeck.csv --test {FIXTURES}/stribeck-test.csv"
    trainer(tmp_path, f"fit {files} -o m.frk --json m.json --report m.html --quiet")
    assert fitted.image.content == (tmp_path / "m.frk").read_bytes()
    assert without_time(fitted.json) == without_time(json.loads((tmp_path / "m.json").read_text()))
    fitted.report(tmp_path / "own.html")
    same_page((tmp_path / "own.html").read_text(encoding="utf-8"), tmp_path / "m.html")
    assert fitted.law in str(fitted) and fitted.doubt is None
    assert fitted.parameters["coulomb_torque"]["unit"] == "N m" and len(fitted.parameters) == len(list(fitted.parameters))
    assert "coulomb_torque" in fitted.parameters._repr_html_()
    shown = html.unescape(fitted._repr_html_())
    assert shown.startswith("<iframe") and (tmp_path / "own.html").read_text(encoding="utf-8") in shown
    assert conforms(fitted.json) == "fit"
    assert fitted.curve.shape[1] == 2 and fitted.band.shape[1] == 3


def test_a_doubtful_image_is_saved_by_force_alone(tmp_path):
    # One speed each way: Coulomb and viscous friction have one shape.
    one_speed = {"velocity_rad_s": np.tile([0.5, -0.5], 200), "friction_torque_Nm": np.tile([2.0, -2.0], 200)}
    one_speed["friction_torque_Nm"] += 0.01 * np.random.default_rng(1).standard_normal(400)
    doubtful = frikan.fit(one_speed)
    code, sentence = doubtful.doubt
    assert code.startswith("FRK-N") and "not written" in str(doubtful)
    with pytest.raises(frikan.Error, match=code) as refused:
        doubtful.image.save(tmp_path / "doubtful.frk")
    assert refused.value.exit_status == 4 and sentence in str(refused.value) and not any(tmp_path.iterdir())
    doubtful.image.save(tmp_path / "doubtful.frk", force=True)
    assert frikan.Image.load(tmp_path / "doubtful.frk").content == doubtful.image.content


def test_arrays_and_frames_give_the_law_of_their_file(fitted):
    table = np.genfromtxt(FIXTURES / "stribeck.csv", delimiter=",", names=True, comments=None)
    columns = {name: table[name] for name in table.dtype.names}
    assert frikan.fit(columns, seed=1).law == fitted.law
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(columns)
    assert without_time(frikan.fit(frame).json)["parameters"] == fitted.json["parameters"]
    assert list(fitted.parameters.frame()["name"]) == list(fitted.parameters)


def test_an_image_computes_the_bits_of_the_drive():
    image = frikan.Image.load(FIXTURES / "stribeck.frk")
    lines = (FIXTURES / "stribeck.bits").read_text().split()
    bits = np.array([int(word, 16) for word in lines], dtype=np.uint32).reshape(-1, 2)
    friction = image(bits[:, 0].copy().view(np.float32))
    assert friction.dtype == np.float32 and (friction.view(np.uint32) == bits[:, 1]).all()
    assert image([[0.1, 0.2], [0.3, 0.4]]).shape == (2, 2) and image(0.1).shape == ()
    assert list(image.inputs) == ["velocity"] and "velocity" in repr(image)
    with pytest.raises(TypeError, match="velocity"):
        image(0.1, load=1.0)


def test_a_prediction_is_that_of_the_command_line(tmp_path):
    trainer(tmp_path, f"predict {FIXTURES}/stribeck.frk {FIXTURES}/stribeck-test.csv -o p.csv")
    predicted = frikan.predict(FIXTURES / "stribeck.frk", FIXTURES / "stribeck-test.csv")
    assert predicted.content == (tmp_path / "p.csv").read_bytes()
    assert predicted.predicted.shape == predicted.residual.shape == predicted["velocity_rad_s"].shape


def test_a_diagnosis_is_that_of_the_command_line(tmp_path):
    joint = FIXTURES / "elbow.toml"
    trainer(tmp_path, f"simulate {joint} --effect presliding=1 --duration 20 --seed 7 -o real.csv --quiet")
    real = frikan.simulate(joint, effects={"presliding": 1}, duration=20, seed=7)
    file = np.genfromtxt(tmp_path / "real.csv", delimiter=",", names=True)
    assert all((real[name] == file[name]).all() for name in file.dtype.names)
    trainer(tmp_path, f"diagnose real.csv --joint {joint} --json d.json --report d.html -o d.frk --quiet")
    stages = []
    found = frikan.diagnose(tmp_path / "real.csv", joint=joint, progress=lambda *line: stages.append(line[0]))
    assert without_time(found.json) == without_time(json.loads((tmp_path / "d.json").read_text()))
    assert found.image.content == (tmp_path / "d.frk").read_bytes()
    assert found.verdict == "missing_physics" and found.findings and len(found.parameters) > 0
    assert found.json["headline"] in str(found) and found.json["headline"] in html.unescape(found._repr_html_())
    assert stages


def test_a_check_is_that_of_the_command_line(tmp_path):
    said = trainer(tmp_path, f"check {FIXTURES}/elbow.csv --joint {FIXTURES}/elbow.toml --json c.json")
    checked = frikan.check(FIXTURES / "elbow.csv", joint=FIXTURES / "elbow.toml")
    assert checked.json == without_time(json.loads((tmp_path / "c.json").read_text())) and str(checked) == said
    assert checked.verdict in ("good", "usable") and "Coulomb friction" in checked.identifiable
    assert len(checked.identifiable) == len(checked.json["identifiable"]) and "gravity (sine)" in checked.identifiable
    assert checked.items[0]["code"] in checked._repr_html_() and isinstance(checked.record_next, list)


def test_a_rollout_is_that_of_the_command_line(tmp_path):
    files = f"{FIXTURES}/elbow.frk {FIXTURES}/elbow-test.csv --joint {FIXTURES}/elbow.toml"
    said = trainer(tmp_path, f"rollout {files} -o r.csv --json r.json")
    rolled = frikan.rollout(FIXTURES / "elbow.frk", FIXTURES / "elbow-test.csv", joint=FIXTURES / "elbow.toml")
    assert rolled.content == (tmp_path / "r.csv").read_bytes() and str(rolled) == said
    assert rolled.json == without_time(json.loads((tmp_path / "r.json").read_text()))
    assert np.sqrt(np.mean(rolled.error**2)) == pytest.approx(rolled.json["position"]["rmse"], rel=1e-6)
    with pytest.raises(frikan.Error, match="FRK-U001"):
        frikan.rollout(FIXTURES / "elbow.frk", FIXTURES / "elbow-test.csv", joint=FIXTURES / "elbow.toml", window=0)


URDF = """<robot name="table"><link name="base"/>
<link name="plate"><inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="plate"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="20" velocity="3"/></joint></robot>"""


def turntable():
    """A plate of 0.3 kg m2 with 0.8 N m of Coulomb and 0.4 N m s/rad of viscous friction."""
    time_s = np.arange(0, 16, 0.008)
    waves = [(0.9, 0.31), (0.35, 0.83), (0.12, 1.9)]
    position = sum(size * np.sin(2 * np.pi * rate * time_s) for size, rate in waves)
    velocity = sum(size * 2 * np.pi * rate * np.cos(2 * np.pi * rate * time_s) for size, rate in waves)
    acceleration = sum(-size * (2 * np.pi * rate) ** 2 * np.sin(2 * np.pi * rate * time_s) for size, rate in waves)
    noise = 0.01 * np.random.default_rng(5).standard_normal(len(time_s))
    torque = 0.3 * acceleration + 0.8 * np.tanh(velocity / 0.01) + 0.4 * velocity + noise
    return {"time_s": time_s, "turn_position_rad": position, "turn_torque_Nm": torque}


def table_of(columns, path):
    np.savetxt(path, np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="", fmt="%.9g")


def test_an_arm_is_that_of_the_command_line(tmp_path):
    table_of(turntable(), tmp_path / "arm.csv")
    (tmp_path / "arm.urdf").write_text(URDF)
    trainer(tmp_path, "arm arm.csv --urdf arm.urdf -o there --quiet")
    arm = frikan.arm(tmp_path / "arm.csv", urdf=tmp_path / "arm.urdf")
    arm.save(tmp_path / "here")
    names = sorted(path.name for path in (tmp_path / "there").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "here").iterdir()) == ["arm.json", "arm.urdf", "turn.frk"]
    for name in ("arm.urdf", "turn.frk"):
        assert (tmp_path / "here" / name).read_bytes() == (tmp_path / "there" / name).read_bytes()
    assert without_time(arm.json) == without_time(json.loads((tmp_path / "there/arm.json").read_text()))
    coulomb = next(row["value"] for row in arm.joints[0]["parameters"] if row["name"] == "coulomb_torque")
    assert coulomb == pytest.approx(0.8, rel=0.05) and list(arm.images()) == ["turn"]
    assert "turn" in repr(arm) and "turn" in arm._repr_html_() and arm.base_parameters


def sliding(rows=1500):
    random = np.random.default_rng(3)
    velocity = random.uniform(-2, 2, rows)
    friction = (1.5 + 0.6 * np.exp(-np.abs(velocity) / 0.1)) * np.tanh(velocity / 0.005) + 0.7 * velocity
    return velocity, friction + 0.02 * random.standard_normal(rows)


def test_a_regressor_keeps_the_manners_of_scikit_learn():
    velocity, friction = sliding()
    regressor = frikan.FrictionRegressor(seed=2)
    with pytest.raises(AttributeError, match="not fitted"):
        regressor.predict(velocity)
    assert regressor.fit(velocity[:, None], friction) is regressor
    assert regressor.score(velocity[:, None], friction) > 0.99 and regressor.n_features_in_ == 1
    recording = {"velocity_rad_s": velocity, "friction_torque_Nm": friction}
    assert regressor.law_ == frikan.fit(recording, inputs=["velocity"], seed=2).law
    assert (regressor.predict({"velocity": velocity}) == regressor.image_(velocity).astype(float)).all()
    assert regressor.get_params()["seed"] == 2 and regressor.set_params(seed=3).seed == 3
    with pytest.raises(ValueError, match="no parameter"):
        regressor.set_params(depth=3)
    with pytest.raises(ValueError, match="columns"):
        regressor.fit(np.zeros((5, 2)), np.zeros(5))
    with pytest.raises(ValueError, match="no column"):
        regressor.predict({"speed": velocity})


def test_a_regressor_goes_through_scikit_learn():
    base = pytest.importorskip("sklearn.base")
    selection = pytest.importorskip("sklearn.model_selection")
    velocity, friction = sliding(600)
    regressor = base.clone(frikan.FrictionRegressor(representation="expression"))
    assert base.is_regressor(regressor) and regressor.representation == "expression"
    scores = selection.cross_val_score(regressor, velocity[:, None], friction, cv=2)
    assert scores.min() > 0.98


def test_a_drive_without_floating_point_unit_gets_integers():
    fitted = frikan.fit(FIXTURES / "stribeck.csv", target="cortex-m0plus")
    assert fitted.integers["target"] == "cortex-m0plus" and fitted.integers["error"]["share"] < 0.01
    assert "integers    a table of" in str(fitted)
    assert frikan.fit(FIXTURES / "stribeck.csv", target="cortex-m4f").integers is None


def test_what_is_refused_is_an_exception_with_its_place(tmp_path):
    (tmp_path / "bad.csv").write_text("time_s,position_rad,torque_Nm\n" + "0.1,oops,1\n" * 30)
    with pytest.raises(frikan.Error) as refused:
        frikan.fit(tmp_path / "bad.csv")
    assert refused.value.code == "FRK-D005" and refused.value.row == 2 and refused.value.exit_status == 3
    with pytest.raises(frikan.Error, match="FRK-I002"):
        frikan.fit("nowhere.csv")
    with pytest.raises(frikan.Error, match="FRK-D015"):
        frikan.fit(FIXTURES / "stribeck.csv", joint={"drive": {"gear_ratio": 0}})
    with pytest.raises(ValueError, match="target"):
        frikan.fit(FIXTURES / "stribeck.csv", target="abacus")
    with pytest.raises(TypeError):
        frikan.fit(42)


def test_other_threads_run_on_and_a_callback_that_fails_ends_the_work():
    ticks, is_done = [], threading.Event()

    def tick():
        while not is_done.is_set():
            ticks.append(None)
            time.sleep(0.005)

    def fail(*_):
        raise RuntimeError("enough")

    ticker = threading.Thread(target=tick)
    ticker.start()
    with pytest.raises(RuntimeError, match="enough"):
        frikan.fit(FIXTURES / "elbow.csv", joint=FIXTURES / "elbow.toml", progress=fail)
    is_done.set()
    ticker.join()
    assert len(ticks) > 3


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT of one process to another")
def test_interrupting_the_work_raises_at_once():
    # One fit after the other: a single one may be over before the signal is there. A job in the background of a shell inherits that it ignores SIGINT.
    code = (
        "import frikan, signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nprint('ready', flush=True)\n"
        f"while True: frikan.fit({str(FIXTURES / 'elbow.csv')!r})"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as work:
        assert work.stdout.readline() == "ready\n"
        time.sleep(0.3)
        work.send_signal(signal.SIGINT)
        try:
            _, messages = work.communicate(timeout=20)
        finally:
            work.kill()
    assert "KeyboardInterrupt" in messages and work.returncode != 0
