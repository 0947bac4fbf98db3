"""Progress where standard error is no terminal."""

from __future__ import annotations

import pytest

from tumblers import progress
from tumblers.progress import native_call, phases


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that stands still; its only entry is the time, s."""
    for name in ("FORCE_COLOR", "TTY_INTERACTIVE", "TTY_COMPATIBLE"):
        monkeypatch.delenv(name, raising=False)
    now = [100.0]
    monkeypatch.setattr(progress, "monotonic", lambda: now[0])
    return now


def test_a_log_gets_a_plain_line_every_ten_seconds(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    with native_call("cases", 40, True) as report:
        assert report is not None
        for done in range(40):
            report(done)
            clock[0] += 1.0
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == "tumblers: cases 10/40, 10 s\ntumblers: cases 20/40, 20 s\ntumblers: cases 30/40, 30 s\n"


def test_a_log_gets_no_line_of_what_is_over_at_once(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    with native_call("cases", 2, True) as report:
        assert report is not None
        report(1)
        clock[0] += 9.9
        report(2)
    assert capsys.readouterr().err == ""


def test_phases_are_named_every_ten_seconds(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    with phases(progress=True) as tell:
        tell("fitting each effect", 0, 19)
        clock[0] += 10.0
        tell("fitting each effect", 3, 19)
        tell("fitting each effect", 4, 19)
        clock[0] += 10.0
        tell("fitting pairs", 1, 4)
    assert capsys.readouterr().err == "tumblers: fitting each effect 3/19, 10 s\ntumblers: fitting pairs 1/4, 20 s\n"


def test_phases_go_to_a_callback_or_nowhere(capsys: pytest.CaptureFixture[str]) -> None:
    told: list[tuple[str, int, int]] = []
    with phases(lambda *words: told.append(words)) as tell:
        tell("fitting pairs", 1, 4)
    with phases(progress=False) as tell:
        tell("fitting pairs", 2, 4)
    assert told == [("fitting pairs", 1, 4)]
    assert capsys.readouterr().err == ""
