from __future__ import annotations

import json
import re
from dataclasses import replace
from hashlib import sha256
from importlib.resources import files
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from tumblers import InputError, Relief, StaticField, preset_scenario, simulate
from tumblers.effects.size_error import SizeError
from tumblers.view import view_page


def content(page: str) -> dict[str, Any]:
    (text,) = re.findall(r'<script type="application/json" id="content">(.*?)</script>', page, re.DOTALL)
    read: dict[str, Any] = json.loads(text)
    return read


def test_the_page_is_complete_in_itself(run: xr.Dataset) -> None:
    page = view_page(run)
    frame = re.sub(r'(?s)<script type="importmap">.*?</script>', "", page)
    assert not re.search(r"(?:src|href)=[\"'](?!data:)", frame)
    assert not re.search(r"https?://|url\(|@import", frame)
    assert "default-src 'none'" in frame
    assert "{{" not in frame
    (imports,) = re.findall(r'(?s)<script type="importmap">(.*?)</script>', page)
    assert all(code.startswith("data:text/javascript;base64,") for code in json.loads(imports)["imports"].values())


def test_the_library_is_the_package_s() -> None:
    folder = files("tumblers.view") / "three"
    listed = dict(re.findall(r"\| `(\S+\.js)` \| `([0-9a-f]{64})` \|", (folder / "README.md").read_text("utf-8")))
    assert listed.keys() == {path.name for path in folder.iterdir() if path.name.endswith(".js")}
    assert {name: sha256((folder / name).read_bytes()).hexdigest() for name in listed} == listed
    assert "MIT License" in (folder / "LICENSE").read_text("utf-8")


def test_the_page_has_the_run(run: xr.Dataset) -> None:
    given = content(view_page(run))
    rows = [int(abs(run["time"].values - t).argmin()) for t in given["time"]]
    assert (rows[0], rows[-1]) == (0, run.sizes["time"] - 1)
    # A cycle in sixty frames at least, and no row that the run has not.
    assert len(rows) >= 60
    np.testing.assert_allclose(run["time"].values[rows], given["time"], atol=1e-7)
    # Rounded to 1e-5 mm.
    np.testing.assert_allclose(given["position"], run["position_m"].values[rows] * 1e3, atol=0.51e-5)
    turned = Rotation.from_quat(run["orientation"].values[rows], scalar_first=True)
    # Rounded to 1e-5 in each of four components.
    assert (turned.inv() * Rotation.from_quat(given["orientation"])).magnitude().max() < 4e-5
    assert given["mode"] == run["contact_mode"].values[rows].tolist()
    assert given["modes"] == ["airborne", "point", "line", "surface"]
    # At the start the field points along +y, a quarter of its turn later down: it rolls the robot towards +y.
    np.testing.assert_allclose(given["field"][0], [0.0, 1.0, 0.0], atol=1e-4)
    quarter = int(np.abs(np.array(given["time"]) - 0.25).argmin())
    assert given["field"][quarter][2] == pytest.approx(-1.0, abs=0.01)
    assert given["down"] == [0.0, 0.0, -1.0]


def test_a_slope_an_effect_and_a_relief_reach_the_page() -> None:
    scenario = preset_scenario("cuboid_up_paper", duration_s=0.01)
    scenario = replace(
        scenario,
        effects=(SizeError(length_factor=1.5),),
        relief=Relief(wavelength_m=1e-3, cosine_m=(2e-6,), sine_m=(0.0,)),
    )
    given = content(view_page(simulate(scenario)))
    half = np.sqrt(0.5)
    np.testing.assert_allclose(given["down"], [0.0, -half, -half], atol=1e-6)
    corners = np.concatenate([np.array(face) for face in given["faces"]])
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.4, 1.2, 0.1], rtol=1e-6)
    assert len(given["creases"]) == 12
    y, height = np.array(given["relief"]).T
    np.testing.assert_allclose(height, 2e-3 * (np.cos(2.0 * np.pi * y) - 1.0), atol=2e-6)


def test_a_field_may_be_nothing() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.02)
    none = StaticField(strength_T=0.0, direction=(0.0, 0.0, 1.0))
    given = content(view_page(simulate(replace(scenario, field=none))))
    assert given["field"][0] == [0.0, 0.0, 0.0]
    assert given["speed"] in given["speeds"]


@pytest.mark.parametrize("broken", ["variable", "scenario", "pose", "row"])
def test_what_is_no_run_is_refused(run: xr.Dataset, broken: str) -> None:
    other = {
        "variable": lambda: run.drop_vars("contact_mode"),
        "scenario": lambda: run.assign_attrs(scenario="format = 1"),
        "pose": lambda: run.assign(position_m=run["position_m"] * np.nan),
        "row": lambda: run.isel(time=[0]),
    }[broken]()
    with pytest.raises(InputError, match=r"found .*, expected"):
        view_page(other)
