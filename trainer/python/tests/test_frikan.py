"""The package does what the command line does, to the byte, and behaves as Python does."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import frikan

ROOT = pathlib.Path(__file__).parents[3]
FIXTURES = ROOT / "fixtures"
TRAINER = os.environ.get("FRIKAN_TRAINER", str(ROOT / "target/debug/trainer"))


def trainer(folder, line):
    done = subprocess.run([TRAINER, *line.split()], cwd=folder, capture_output=True, text=True)
    assert done.returncode <= 1, done.stderr
    return done.stdout


def without_time(said):
    return {key: value for key, value in said.items() if key != "seconds"}


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
    shown = fitted._repr_html_()
    assert "coulomb_torque" in shown and "R²" in shown
    assert fitted.curve.shape[1] == 2 and fitted.band.shape[1] == 3


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
    assert found.json["headline"] in str(found) and "<li>" in found._repr_html_()
    assert stages


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
    code = f"import frikan\nprint('ready', flush=True)\nfrikan.fit({str(FIXTURES / 'elbow.csv')!r})"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as work:
        assert work.stdout.readline() == "ready\n"
        time.sleep(0.3)
        work.send_signal(signal.SIGINT)
        _, messages = work.communicate(timeout=20)
    assert "KeyboardInterrupt" in messages and work.returncode != 0
