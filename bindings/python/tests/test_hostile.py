"""Robustness: fields of record arrays, states modified in place, files that change, Ctrl-C."""

import inspect
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import hamel
from known import PENDULUM, XI


def test_numbers_that_stand_at_odd_places(top):
    """Packed records have unaligned numbers, with strides that are not multiples of their size."""
    x = top.start().x
    many = np.array([XI, 2 * XI, -XI])
    expected = top.accel(x, many)
    packed = np.zeros(3, dtype=[("flag", "i1"), ("xi", "f8", (3,))])
    packed["xi"] = many
    shifted = np.zeros(3, dtype=[("xi", "f8", (3,)), ("number", "i4")])
    shifted["xi"] = many
    bytes_between = np.frombuffer(b"\0" + many.tobytes(), dtype="f8", offset=1).reshape(3, 3)
    for array in (packed["xi"], shifted["xi"], bytes_between, packed["xi"][::-1][::-1]):
        assert np.array_equal(top.accel(x, array), expected)
        ends = top.step(np.tile(x, (3, 1)), array, h=0.1)
        assert np.array_equal(ends[1], top.step(np.tile(x, (3, 1)), many, h=0.1)[1])
    # A column with a stride of 12 bytes.
    column = np.zeros(3, dtype=[("xi", "f8"), ("number", "i4")])
    column["xi"] = XI
    assert np.array_equal(top.accel(x, column["xi"]), expected[0])
    state = hamel.State(x, column["xi"], [], top.parameter_values)
    assert np.array_equal(top.evaluate(state)["xi"], XI)
    assert top.accel(x, packed["xi"][:0]).shape == (0, 3)


def test_a_state_that_is_written_into_is_the_users_own(top):
    x, height = top.start().x, top.energy(top.start().x, XI)
    start = top.start()
    start.x[:], start.xi[:], start.parameters[:] = 7.0, 8.0, 9.0
    top.parameter_values[:] = 3.0
    assert np.array_equal(top.start().x, x) and np.array_equal(top.start().xi, hamel.System.from_text(top.text).start().xi)
    assert list(top.parameter_values) == list(top.with_parameters().parameter_values)
    assert top.energy(x, XI) == height and top.potential_energy(x) == top.with_parameters().potential_energy(x)


def test_a_state_has_finite_numbers(top):
    start = top.start()
    x = start.x.copy()
    x[4] = np.nan
    broken = hamel.State(x, XI, start.u, start.parameters)
    asked = (top.simulate, top.linearize, top.evaluate, top.step_slopes)
    for ask, options in zip(asked, ({"until": 1.0}, {}, {}, {"h": 0.1})):
        with pytest.raises(hamel.HamelError, match="`x` of a state needs finite numbers, the entry at the index 4 is NaN"):
            ask(at=broken, **options)
    with pytest.raises(ValueError, match=r"`xi` of a state needs 3 entries and no other axes.*\[1, 3\]"):
        top.linearize(hamel.State(start.x, [XI], start.u, start.parameters))
    with pytest.raises(TypeError, match="`xi` of a state needs real numbers, None was given"):
        top.linearize(hamel.State(start.x, None, start.u, start.parameters))
    with pytest.raises(hamel.HamelError, match="state.param.m: a finite number is needed, 1000"):
        top.with_parameters(m=10**400)


def test_numbers_by_name_are_said_to_be_none(top):
    x = top.start().x
    for h in ("0.1", None, [0.1], 1j):
        for call in (lambda: top.step(x, XI, h=h), lambda: top.step_slopes(h=h)):
            with pytest.raises(hamel.HamelError, match="`h` is a number"):
                call()
    with pytest.raises(hamel.HamelError, match="`method` is the name"):
        top.step(x, XI, h=0.1, method=None)


def test_a_system_that_is_pickled_is_the_one_that_was_read(tmp_path):
    """Pickles contain the text, so later changes of the file have no effect."""
    file = tmp_path / "a pendulum, größer ξ.eom"
    file.write_text(PENDULUM)
    system = hamel.System.from_file(file)
    kept = pickle.dumps(system.with_parameters(l=2.0))
    expected = system.with_parameters(l=2.0).accel([0.3], [0.0], [1.0])
    file.write_text(PENDULUM.replace("l * sin(q)", "2 * l * sin(q)"))
    for _ in range(2):
        again = pickle.loads(kept)
        assert np.array_equal(again.accel([0.3], [0.0], [1.0]), expected) and again.text == system.text
        file.unlink(missing_ok=True)


def test_joints_are_locked_at_numbers_of_numpy(robots):
    path = robots / "double_pendulum_description" / "urdf" / "double_pendulum.urdf"
    expected = hamel.System.from_urdf(path, lock={"joint2": 0.25}).mass_matrix([0.3])
    for value in (np.float64(0.25), np.float32(0.25), np.array(0.25)):
        assert np.array_equal(hamel.System.from_urdf(path, lock={"joint2": value}).mass_matrix([0.3]), expected)
    for value in ("0.25", None, np.zeros(2)):
        with pytest.raises(hamel.HamelError, match=r"`lock\['joint2'\]` is a number"):
            hamel.System.from_urdf(path, lock={"joint2": value})
    for rounding in (-1.0, np.nan, 1.0):
        with pytest.raises(hamel.HamelError, match="`rounding` is a number from 0 to 0.1"):
            hamel.System.from_urdf(path, rounding=rounding)


def test_robots_in_files_of_other_programs(robots, tmp_path):
    text = (robots / "double_pendulum_description" / "urdf" / "double_pendulum.urdf").read_text()
    file = tmp_path / "robot.urdf"
    file.write_text("\ufeff" + text, encoding="utf-8")
    assert len(hamel.System.from_urdf(file).joints) == 2
    file.write_bytes(text.replace("<robot", "<!-- \xe9 --><robot", 1).encode("latin-1"))
    with pytest.raises(hamel.HamelError, match=r"cannot read .*robot.urdf: byte \d+ is not UTF-8"):
        hamel.System.from_urdf(file)
    file.write_bytes(b"\xff\xfe" + text.encode("utf-16-le"))
    assert len(hamel.System.from_urdf(file).joints) == 2
    with pytest.raises(TypeError, match="a description is a string, None was given"):
        hamel.System.from_text(None)


def test_words_of_robots_that_are_not_understood_are_warned_of(robots, tmp_path):
    text = (robots / "double_pendulum_description" / "urdf" / "double_pendulum.urdf").read_text()
    file = tmp_path / "robot.urdf"
    file.write_text(text.replace("</robot>", "<tendon name='t'/></robot>"))
    with pytest.warns(UserWarning, match="`<tendon>` is not an element of `<robot>` in URDF and is left out"):
        hamel.System.from_urdf(file)


def test_functions_that_there_are_not_are_no_attributes(models):
    """`hasattr`, `getattr` with a default, and `inspect` treat them as missing."""
    disk = hamel.System.from_file(models / "rolling_disk.eom")
    assert not hasattr(disk, "regressor") and hasattr(disk, "accel")
    assert getattr(disk, "regressor", None) is None
    assert dict(inspect.getmembers(disk))["accel"].name == "accel"
    with pytest.raises(hamel.HamelError, match="has no regressor"):
        disk.regressor


def interrupted(work):
    """The time that work continues after Ctrl-C (s)."""
    # Background processes of a shell ignore SIGINT.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    begin = time.perf_counter()
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)
    return time.perf_counter() - begin - 0.3


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise")
def test_long_work_is_interrupted(top, models, tmp_path):
    x = np.tile(top.start().x, (10**6, 1))
    sleigh = hamel.System.from_file(models / "sleigh.eom")
    for work in (
        lambda: top.simulate(1e6, step=1e-3, every=10**9, method="rkmk4"),
        lambda: top.simulate(1e6, step=1e-3, times=[1e6], method="gauss6"),
        lambda: top.simulate(1e6, tol=1e-12, method="rkmk8"),
        lambda: top.simulate(1e6, step=1e-3, times=[1e6], events={"up": "w[1]"}),
        lambda: sleigh.simulate(1e6, times=np.linspace(0.0, 1e6, 10**5), method="rkmk4", step=1e-3),
        lambda: top.step(x, XI, h=0.1, method="gauss6"),
    ):
        assert interrupted(work) < 3.0
    options = {"vary": "m = normal(1, 0.01)", "until": 3.0, "members": 10**5, "keep": "max(w[1])", "out": tmp_path / "runs"}
    # A sweep first compiles machine code and proves it, which takes longer.
    assert interrupted(lambda: hamel.sweep(models / "heavy_top.eom", **options)) < 10.0
    # A later sweep works: no incomplete file remains.
    hamel.sweep(models / "heavy_top.eom", **{**options, "members": 20, "out": tmp_path / "others"})


def test_stubs_agree_with_what_is_there(tmp_path):
    """mypy's stubtest compares every public name of the package with its type stubs."""
    pytest.importorskip("mypy")
    words = [sys.executable, "-m", "mypy.stubtest", "hamel"]
    said = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    assert said.returncode == 0, said.stdout
