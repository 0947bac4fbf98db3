"""A hypothesis and its fit: the objective, the descent and the deviations of what it found."""
