"""A hypothesis and its fit: the objective, the descent from a start, and how what trials pull scatters."""
