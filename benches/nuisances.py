"""The native fit of a sensor's nuisances beside the plain one, in turns: ``python benches/nuisances.py``."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from statistics import median
from time import process_time

# Of one thread is asked here; NumPy's own are counted when it is imported.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.diagnosis.lab import measure, plan
from tests.parity.nuisances import PlainFit

from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator

TURNS = 15


def main() -> int:
    """Print the processor time of either, of one thread, and the median of the turns' ratios."""
    dataset = measure(plan())
    comparison = Comparison(dataset, Simulator(dataset, 1))
    paths, trials = comparison.nominal_paths, range(len(comparison.readers))
    times = []
    for _ in range(TURNS):
        start = process_time()
        PlainFit(comparison, paths, comparison._stretches(1.0)).residual(trials, None)
        between = process_time()
        comparison.residual(paths)
        times.append((between - start, process_time() - between))
    plain, native = (1e3 * median(each) for each in zip(*times, strict=True))
    ratio = median(a / b for a, b in times)
    what = f"{len(trials)} trials, {comparison.count} numbers"
    sys.stdout.write(f"{what}: plain {plain:.2f} ms, native {native:.2f} ms, ratio {ratio:.1f}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
