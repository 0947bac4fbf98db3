"""How long a diagnosis takes on more cores than it had."""

from __future__ import annotations

import pytest

from tumblers.blind.repeated import Repeated


@pytest.mark.parametrize(
    ("threads", "cores", "processor_s", "expected"),
    [
        # 20 s on one core and 260 s on all.
        (2, 2, 280.0, 85.0),
        (8, 2, 280.0, 85.0),
        # 40 s on one core and 880 s on all.
        (8, 8, 920.0, 260.0),
        # As it was.
        (4, 4, 500.0, 150.0),
        (4, 8, None, 150.0),
        # All on one core: what ran beside it took the rest.
        (4, 2, 140.0, 150.0),
        # No more than all on all.
        (2, 2, 310.0, 75.0),
        # Nobody can say.
        (8, None, 500.0, None),
        (2, 2, None, None),
        (1, 4, 140.0, None),
    ],
)
def test_a_time_on_four_cores_is_that_of_what_runs_on_one_and_of_what_runs_on_all(
    threads: int, cores: int | None, processor_s: float | None, expected: float | None
) -> None:
    again = Repeated(seconds=150.0, processor_s=processor_s, threads=threads, cores=cores, same=True, trials=6)
    assert again.seconds_on(4) == (None if expected is None else pytest.approx(expected))
