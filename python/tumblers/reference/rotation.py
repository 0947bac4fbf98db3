"""Rotations (docs/model.md, "State and pose update").

Equations::

    Q⁺ = normalise(Q + (h/2) ω⁺ ∘ Q)
    R⁺ = C(s) R,   C(s) = I + 2/(1 + |s|²) ([s]ₓ + [s]ₓ²),   s = h ω⁺/2     (the same rotation)

`C(s)` turns by `2 atan |s|` about `s`.
"""

from __future__ import annotations

import math

import numpy as np

from .array import Array


def cross(a: Array, b: Array) -> Array:
    """`a × b`, shapes (3,); `numpy.cross` costs ten times as much for one pair."""
    a0, a1, a2 = a
    b0, b1, b2 = b
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def cayley(s: Array) -> Array:
    """Rotation matrix `C(s)`, shape (3, 3), of the half-angle vector `s`, shape (3,)."""
    x, y, z = (float(c) for c in s)
    f = 2.0 / (1.0 + x * x + y * y + z * z)
    return np.array(
        [
            [1.0 - f * (y * y + z * z), f * (x * y - z), f * (x * z + y)],
            [f * (x * y + z), 1.0 - f * (x * x + z * z), f * (y * z - x)],
            [f * (x * z - y), f * (y * z + x), 1.0 - f * (x * x + y * y)],
        ]
    )


def half_cayley(s: Array) -> Array:
    """Rotation matrix, shape (3, 3), of half the angle of `C(s)` about the same axis."""
    return cayley(s / (1.0 + math.sqrt(1.0 + float(s @ s))))


def cayley_vector(rotation: Array) -> Array:
    """`s`, shape (3,), with `C(s) = rotation`; the inverse of `cayley` for angles below π."""
    w = 1.0 + float(np.trace(rotation))
    skew = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    return np.asarray(skew / w)


def matrix(quaternion: Array) -> Array:
    """Rotation matrix, shape (3, 3), body to substrate, of a unit quaternion `w, x, y, z`."""
    w, x, y, z = (float(c) for c in quaternion)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def product(a: Array, b: Array) -> Array:
    """Quaternion product `a ∘ b`, shapes (4,), `w, x, y, z`."""
    vector = a[0] * b[1:] + b[0] * a[1:] + cross(a[1:], b[1:])
    return np.concatenate([[a[0] * b[0] - float(a[1:] @ b[1:])], vector])


def step_quaternion(quaternion: Array, omega: Array, step: float) -> Array:
    """`Q⁺ = normalise(Q + (h/2) ω⁺ ∘ Q)`, shape (4,).

    Parameters
    ----------
    quaternion : Array, shape (4,)
        `w, x, y, z`, body to substrate.
    omega : Array, shape (3,)
        `ω⁺` [rad/s], substrate frame.
    step : float
        `h` [s].
    """
    moved = quaternion + 0.5 * step * product(np.concatenate([[0.0], omega]), quaternion)
    return np.asarray(moved / np.linalg.norm(moved))


def aligning(source: Array, target: Array) -> Array:
    """Smallest rotation, shape (3, 3), that takes the unit vector `source` to `target`."""
    axis, cosine = cross(source, target), float(source @ target)
    if cosine < -1.0 + 1e-12:
        other = np.eye(3)[int(np.argmin(np.abs(source)))]
        axis = cross(source, other)
        axis /= np.linalg.norm(axis)
        return np.asarray(2.0 * np.outer(axis, axis) - np.eye(3))
    # |s| = tan(θ/2) = |a × b| / (1 + a · b).
    return cayley(axis / (1.0 + cosine))


def axis_angle(axis: Array, angle: float) -> Array:
    """Unit quaternion, shape (4,), of a turn by `angle` [rad] about `axis`, shape (3,)."""
    unit = axis / np.linalg.norm(axis)
    return np.concatenate([[math.cos(angle / 2.0)], math.sin(angle / 2.0) * unit])
