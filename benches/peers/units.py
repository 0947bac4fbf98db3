"""Millimetres, milligrams and seconds, in which a robot of 38 µg is not below a peer's floors."""

from __future__ import annotations

__all__ = ["FORCE", "INERTIA", "LENGTH", "MASS", "TORQUE"]

# Multiply SI by these.
MASS = 1e6
LENGTH = 1e3
# kg m s⁻² = 10⁶ mg · 10³ mm s⁻²
FORCE = MASS * LENGTH
# kg m² s⁻² = 10⁶ mg · 10⁶ mm² s⁻²
TORQUE = MASS * LENGTH**2
INERTIA = MASS * LENGTH**2
