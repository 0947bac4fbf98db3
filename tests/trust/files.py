"""Files that are sound, and the same with something wrong in them."""

from __future__ import annotations

import re
from typing import Any

from hypothesis import strategies as st

from ..dataset_folder import DATASET as METRES

SCENARIO = """\
format = "tumblers-scenario/1"
[robot]
shape = "hull"
vertices_m = [[1e-4, 1e-4, 1e-4], [-1e-4, -1e-4, 1e-4], [-1e-4, 1e-4, -1e-4], [1e-4, -1e-4, -1e-4]]
mass_kg = 3.78e-8
magnetization_A_per_m = 15000
magnetization_axis = [0.0, 1.0, 0.0]
[substrate]
friction_coefficient = 0.3
friction_ellipsoid = [1.0, 1.0, 0.1]
[field]
kind = "table"
csv = "field.csv"
[run]
duration_s = 0.25
step_s = 5.0e-4
incline_deg = 5
[initial]
orientation = [1, 0, 0, 0]
[relief]
cosine_m = [1e-6]
sine_m = [2e-6]
[surroundings]
wrench_time_s = [0.1, 0.2]
wrench_N_N_m = [[1e-9, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]
[[effect]]
name = "friction_coefficient"
factor = 1.1
"""
FIELD = "time_s,Bx_T,By_T,Bz_T\n0,0,0,0.01\n4,0,0.01,0\n"
# With pixels, frames and a table of the field beside it.
DATASET = (
    METRES.replace("mass_kg = 3.78e-8", "density_kg_per_m3 = 1200")
    .replace("angle_noise_deg = 1.0", "angle_noise_deg = 1.0\nmicrometres_per_pixel = 2.5\nframes_per_second = 20")
    .replace('{ kind = "static", strength_T = 0.020, direction = [0, 0, 1] }', '{ kind = "table", csv = "field.csv" }')
)
TRACK = "frame,x,y,tilt_deg\n0,10.5,20,0\n1,11,20.5,3\n2,,,\n3,12,21,\n"
ANSWER: dict[str, Any] = {
    "kind": "one",
    "effects": [
        {
            "name": "viscous_drag",
            "form": "catalogue",
            "form_seed": None,
            "parameters": {"viscosity_Pa_s": 2e-3},
            "strength_sigma": 3.0,
        }
    ],
    "strength_sigma": 3.0,
    "strength_by_trial": {"f05": 3.0},
    "affected_trials": ["f05"],
    "where": {"time": [0.0, 1.0]},
    "nuisances": {},
    "jitter": {},
    "jitter_sigma": 0.1,
}

DIAGNOSIS: dict[str, Any] = {
    "format": "tumblers-diagnosis/1",
    "verdict": "explained",
    "effects": [
        {
            "name": "viscous_drag",
            "probability": 0.9,
            "parameters": {"viscosity_Pa_s": {"estimate": 2.1e-3, "low": 1e-3, "high": None, "identified": True}},
            "confounded_with": ["eddy_current_drag"],
        }
    ],
    "ranking": [{"effects": ["viscous_drag"], "probability": 0.9, "held_out_gap": 1.0, "shrink": 0.9}],
    "gap": {
        "noise_floor": 1.0,
        "before": 3.0,
        "after_nuisance_only": 2.5,
        "after": 1.1,
        "shrink": {"estimate": 0.95, "low": 0.9, "high": 1.0},
        "held_out_trials": ["f05"],
    },
    "where": [
        {"axis": "trial", "value": "f05", "share_of_gap": 0.9},
        {"axis": "time", "low": 0.0, "high": 1.0, "share_of_gap": 0.5},
    ],
}
RUN: dict[str, Any] = {
    "format": "tumblers-blind-run/1", "version": "0.1.0", "seconds": 12.5, "threads": 1, "error": None,
}  # fmt: skip
REPEAT: dict[str, Any] = {
    "format": "tumblers-blind-repeat/1", "version": "0.1.0", "seconds": 9.5, "threads": 4, "cores": None, "same": True,
}  # fmt: skip

# Values that a file may have in the place of any other.
NASTY = [
    "", "nan", "-inf", "1e400", "-1e-400", "5e-324", "1.7976931348623157e308", "0", "-0.0", "true", "[]", "{}",
    '""', "'a'", '"\\u0000"', '"\\n"', '"../outside.csv"', '"/etc/passwd"', '"pipe.csv"', '"link.csv"', '"loop.csv"',
    '"."', '"' + "a" * 300 + '"', "9" * 400, "9" * 5000, "0x" + "f" * 5000, "0b" + "1" * 20000, "-" + "9" * 4999,
    "1979-05-27", "1979-05-27T07:32:00Z", "2000-02-30", "12:00:00", "[" * 60 + "]" * 60, "[" * 5000 + "]" * 5000,
    "{ a = " * 60 + "1" + " }" * 60, "{ " + "a." * 3000 + "a = 1 }", "[1, 'a', {}]", "[[0, 0, 0], [0, 0, 1e-300]]",
    "null", "NaN", "-Infinity", '"\\ud800"', "\ufeff", "\x00", "[nan, nan, nan]", "[1e200, 1e200, 1e200]",
    "[1e-200, 0, 0]", "\u2028", "\u0661\u0662",
]  # fmt: skip
PLACE = re.compile(r'"[^"\n]*"|[-+]?\d[\w.+-]*|\b[A-Za-z_]\w*\b|[\[\]{}=,\n]')


@st.composite
def mutated(draw: st.DrawFn, text: str) -> bytes:
    """Return a text with a few of its words replaced, doubled, left out or cut off, or with other bytes in it."""
    for _ in range(draw(st.integers(1, 4))):
        places = [match.span() for match in PLACE.finditer(text)] or [(0, 0)]
        start, end = draw(st.sampled_from(places))
        kind = draw(st.sampled_from(["nasty", "number", "text", "drop", "double", "swap", "cut"]))
        if kind == "swap":
            other = draw(st.sampled_from(places))
            put = text[other[0] : other[1]]
        else:
            put = {
                "nasty": draw(st.sampled_from(NASTY)),
                "number": repr(draw(st.floats())),
                "text": draw(st.text(max_size=20)),
                "double": text[start:end] * 2,
            }.get(kind, "")
        text = text[:start] + put + ("" if kind == "cut" else text[end:])
    found = text.encode("utf-8", "surrogatepass")
    dressed = draw(st.sampled_from(["plain", "plain", "plain", "BOM", "CRLF", "CR", "bytes", "lines twice", "UTF-16"]))
    if dressed == "bytes":
        at = draw(st.integers(0, len(found)))
        return found[:at] + draw(st.binary(max_size=50)) + found[at:]
    if dressed == "lines twice":
        lines = found.splitlines(keepends=True) or [b""]
        at = draw(st.integers(0, len(lines) - 1))
        return b"".join([*lines[: at + 1], *lines[at:]])
    return {
        "BOM": b"\xef\xbb\xbf" + found,
        "CRLF": found.replace(b"\n", b"\r\n"),
        "CR": found.replace(b"\n", b"\r"),
        "UTF-16": found.decode("utf-8", "replace").encode("utf-16"),
    }.get(dressed, found)
