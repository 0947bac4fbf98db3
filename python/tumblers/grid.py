"""The paper's grid of manufacturing errors."""

__all__ = ["PAPER_DRAFTS_DEG", "PAPER_MAGNETIZATION_DEG"]

PAPER_DRAFTS_DEG: tuple[float, ...] = tuple(float(draft) for draft in range(16))
PAPER_MAGNETIZATION_DEG: tuple[tuple[float, float], ...] = (
    (0.0, 0.0),
    *((10.0, 10.0 * n) for n in range(1, 37)),
)
