"""What pages show of Python runs as it stands there, in a folder with the files that it names."""

import shutil

import pytest
from command_line import FIXTURES, ROOT
from test_frikan import URDF, sliding, table_of, turntable

PAGE = ROOT / "docs/python.md"


def blocks():
    """The parts of the page that are Python: indented, from an import on."""
    text, block = PAGE.read_text(encoding="utf-8"), []
    for line in [*text.splitlines(), "end"]:
        if line.startswith("    ") or (block and not line):
            block.append(line[4:])
            continue
        code = "\n".join(block).strip()
        if code.startswith(("import ", "from ")):
            yield code
        block = []


def test_every_block_of_the_page_runs(tmp_path, monkeypatch):
    for module in ("matplotlib", "sklearn", "tqdm"):
        pytest.importorskip(module)
    import matplotlib

    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fixtures").symlink_to(FIXTURES)
    table_of(turntable(), tmp_path / "recordings.csv")
    (tmp_path / "arm.urdf").write_text(URDF)
    shutil.copy(FIXTURES / "stribeck.csv", tmp_path / "recording.csv")
    velocity, friction = sliding(300)
    names = {"velocity": velocity, "friction": friction}
    shown = list(blocks())
    assert len(shown) == 3
    for code in shown:
        exec(compile(code, str(PAGE), "exec"), names)
    fitted = names["fitted"]
    assert (tmp_path / "elbow.frk").read_bytes() == fitted.image.content and "uPlot" in (tmp_path / "elbow.html").read_text()
    assert [line.get_label() for line in fitted.plot().get_lines()] == [fitted.law, fitted.law]


MODEL = """<mujoco><worldbody><body><joint name="elbow" axis="0 1 0" armature="0.02"/>
<geom type="sphere" pos="0 0 -0.5" size="0.1" mass="2"/></body></worldbody></mujoco>"""


def test_the_inertia_of_a_model_is_what_the_page_of_exports_lets_mujoco_work_out(tmp_path, monkeypatch, capsys):
    pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.xml").write_text(MODEL)
    page = (ROOT / "docs/exports.md").read_text(encoding="utf-8")
    (code,) = (part.partition("```")[0] for part in page.split("```python\n")[1:])
    exec(compile(code, "docs/exports.md", "exec"), {})
    # A ball of 2 kg and a radius of 0.1 m half a metre off the axis, without the rotor.
    assert float(capsys.readouterr().out) == pytest.approx(2 * 0.5**2 + 0.4 * 2 * 0.1**2)
