from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from PIL import Image

from tumblers.plots.contact import MODE_COLOURS
from tumblers.simulate import CONTACT_MODES
from tumblers.view import view_page

playwright = pytest.importorskip("playwright.sync_api", reason="no playwright: pip install playwright")

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# WebGL without a graphics card; Chromium has no sandbox for root.
_OPTIONS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", *(["--no-sandbox"] if os.getuid() == 0 else [])]


class Opened:
    """The page of a run in a browser, with all that it says and asks for."""

    def __init__(self, page: playwright.Page, file: Path) -> None:
        self.page, self.said, self.asked = page, [], []
        page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: self.said.append(f"error: {error}"))
        page.on("request", lambda request: self.asked.append(request.url))
        page.goto(file.as_uri())
        self.wait_for("#position", "x ")

    def wait_for(self, selector: str, words: str) -> None:
        """Wait until an element's text has a match of a regular expression."""
        playwright.expect(self.page.locator(selector)).to_have_text(re.compile(words), timeout=30_000)

    def position(self) -> NDArray[np.float64]:
        """Return the position that the page says, mm."""
        return np.array([float(word) for word in re.findall(r"-?\d+\.\d+", self.page.inner_text("#position"))])

    def pixels(self) -> NDArray[np.float64]:
        """Return what the canvas shows, shape (rows, columns, 3), without what lies over it."""
        shot = self.page.locator("#scene").screenshot(style="header { visibility: hidden }")
        return np.asarray(Image.open(BytesIO(shot)).convert("RGB"), dtype=float) / 255.0

    def robot(self) -> NDArray[np.float64]:
        """Return row and column of the pixels that have the colour of a contact mode, in light or shade."""
        pixels = self.pixels()
        directions = pixels / np.maximum(np.linalg.norm(pixels, axis=2, keepdims=True), 0.05)
        found = np.zeros(pixels.shape[:2], dtype=bool)
        for colour in MODE_COLOURS:
            wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], dtype=float)
            found |= directions @ (wanted / np.linalg.norm(wanted)) > 0.98
        return np.argwhere(found & (np.ptp(pixels, axis=2) > 0.2))


@pytest.fixture(scope="module")
def opened(run: xr.Dataset, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    file = tmp_path_factory.mktemp("view") / "run.html"
    file.write_text(view_page(run), encoding="utf-8")
    with playwright.sync_playwright() as driver:
        system = next(filter(None, map(shutil.which, _NAMES)), None)
        if system is None and not Path(driver.chromium.executable_path).exists():
            pytest.skip("no Chromium: install chromium, or run `playwright install chromium`")
        browser = driver.chromium.launch(executable_path=system, args=_OPTIONS)
        yield Opened(browser.new_page(viewport={"width": 800, "height": 500}), file)
        browser.close()


def test_the_page_shows_the_robot_and_play_moves_it(opened: Opened, run: xr.Dataset) -> None:
    page = opened.page
    np.testing.assert_allclose(opened.position(), run["position_m"].values[0] * 1e3, atol=1e-4)
    before = opened.robot()
    # The picture is neither blank nor one colour: the robot has a part of it, and so has the substrate.
    assert 0.005 < len(before) / (800 * 450) < 0.5
    assert page.locator("#failure").is_hidden()

    page.uncheck("#follow")
    page.click("#play")
    assert page.inner_text("#play") == "Pause"
    # The spiked robot makes 1.1 mm in the whole run, 0.3 mm is a part of it.
    opened.wait_for("#position", r"y (0\.[3-9]|1)")
    page.click("#play")
    assert page.inner_text("#play") == "Play"
    there = opened.position()
    y = run["position_m"].values[:, 1] * 1e3
    assert y.min() <= there[1] <= y.max()
    # Looked at from +x it travels to the right.
    after = opened.robot()
    assert after[:, 1].mean() - before[:, 1].mean() > 30.0
    # Paused it stays.
    page.wait_for_timeout(300)
    np.testing.assert_array_equal(opened.position(), there)

    assert opened.said == []
    assert [url for url in opened.asked if not url.startswith(("file:", "data:"))] == []


def test_the_slider_and_the_camera(opened: Opened, run: xr.Dataset) -> None:
    page = opened.page
    page.locator("#time").fill("0.5")
    opened.wait_for("#clock", r"^0\.500 ")
    row = int(np.abs(run["time"].values - 0.5).argmin())
    # The page moves the robot evenly between two frames, here rows of the run that are 8 ms apart at most.
    near = run["position_m"].values[row - 16 : row + 17] * 1e3
    assert (near.min(axis=0) - 1e-4 <= opened.position()).all()
    assert (opened.position() <= near.max(axis=0) + 1e-4).all()
    modes = {CONTACT_MODES[mode] for mode in run["contact_mode"].values[row - 16 : row + 17]}
    assert page.inner_text("#legend li.now") in modes

    page.check("#follow")
    page.click("#home")
    before = opened.pixels()
    page.mouse.move(400, 200)
    page.mouse.down()
    page.mouse.move(520, 240, steps=4)
    page.mouse.up()
    page.wait_for_timeout(200)
    assert np.abs(opened.pixels() - before).mean() > 0.01
    assert opened.said == []


def test_it_plays_to_the_end_and_starts_again(opened: Opened, run: xr.Dataset) -> None:
    page = opened.page
    page.locator("#time").fill("0.98")
    page.select_option("#speed", "5")
    page.click("#play")
    opened.wait_for("#play", "^Play$")
    np.testing.assert_allclose(opened.position(), run["position_m"].values[-1] * 1e3, atol=1e-4)
    page.select_option("#speed", "0.01")
    page.click("#play")
    opened.wait_for("#clock", r"^0\.0")
    assert opened.said == []
