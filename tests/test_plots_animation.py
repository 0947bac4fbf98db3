from __future__ import annotations

import shutil
import signal
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from tumblers import InputError, StaticField, drive, preset_scenario, simulate
from tumblers.plots import animation_bytes
from tumblers.plots.animation import _Stage
from tumblers.plots.film import Film
from tumblers.plots.scene import Scene


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return simulate(preset_scenario("cuboid_on_paper", duration_s=0.2))


def film(frequency_Hz: float, duration_s: float) -> Film:
    scenario = preset_scenario("cuboid_on_paper", drive=drive(0.01, frequency_Hz), duration_s=duration_s, step_s=2e-3)
    return Film.of(Scene.of(simulate(scenario)))


def test_a_gif_shows_the_run(run: xr.Dataset) -> None:
    done: list[int] = []
    # 0.2 s at 0.25 times is 0.8 s of film: at 20 frames a second 17 of them, the first and the last row among them.
    image = Image.open(BytesIO(animation_bytes(run, "gif", speed=0.25, progress=done.append)))
    assert done == list(range(1, 18))
    assert (image.format, image.n_frames, image.info["duration"], image.info["loop"]) == ("GIF", 17, 50, 0)
    frames = []
    for k in (0, 8, 16):
        image.seek(k)
        frames.append(np.asarray(image.convert("RGB"), dtype=float) / 255.0)
    # Something moves: some per cent of the picture is the robot.
    for a, b in ((0, 1), (1, 2)):
        assert (np.abs(frames[a] - frames[b]).max(axis=2) > 0.2).mean() > 0.005


def test_a_turn_of_the_field_takes_two_seconds() -> None:
    slow = film(5.0, 1.0)
    assert slow.speed == pytest.approx(0.1)
    assert (slow.rows[0], slow.rows[-1], slow.rows.size) == (0, 500, 201)


def test_a_long_film_is_faster_but_never_skips_a_turn() -> None:
    fast = film(10.0, 10.0)
    # 16 frames a turn would be 0.125 times.
    assert fast.speed == pytest.approx(0.1)
    # It ends after 600 frames, each 5 ms of the run later than the one before; rows are 2 ms apart.
    assert fast.rows.size == 600
    assert fast.rows[-1] == pytest.approx(599 * 2.5, abs=1.0)


def test_a_field_that_rests_gives_a_short_film() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.05)
    static = replace(scenario, field=StaticField(strength_T=0.01, direction=(0.0, 0.0, 1.0)))
    made = Film.of(Scene.of(simulate(static)))
    assert 5.0 <= 0.05 / made.speed <= 12.0


def test_what_cannot_be_written_is_refused(run: xr.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="gif or mp4"):
        animation_bytes(run, "webm")
    with pytest.raises(InputError, match="speed: found 0"):
        animation_bytes(run, "gif", speed=0.0)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(InputError, match="found mp4 but no ffmpeg on this machine"):
        animation_bytes(run, "mp4")


def test_ctrl_c_waits_for_the_end_of_a_frame(run: xr.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[int] = []
    draw = _Stage.show

    def show(stage: _Stage, row: int) -> None:
        if len(shown) == 2:
            signal.raise_signal(signal.SIGINT)
        draw(stage, row)
        shown.append(row)

    monkeypatch.setattr(_Stage, "show", show)
    # A shell starts what runs in the background with Ctrl-C ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            animation_bytes(run, "gif", speed=0.25)
        assert len(shown) == 3
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg on this machine")
def test_an_mp4_is_written(run: xr.Dataset) -> None:
    assert animation_bytes(run, "mp4", speed=0.5)[4:8] == b"ftyp"
