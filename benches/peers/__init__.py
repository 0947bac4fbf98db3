"""What the comparisons with other simulators share: cases, units, clocks and the page."""
