"""`Answer`: the truth of a dataset, and the seal that it was not changed afterwards."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from hashlib import sha256
from typing import Any, Self

__all__ = ["Answer", "TrueCause", "seal"]


@dataclass(frozen=True, kw_only=True, slots=True)
class TrueCause:
    """A cause that was at work.

    Attributes
    ----------
    name, form
        Its name, and ``catalogue``, the name of another form, or ``outside``.
    form_seed
        What the details of another form were drawn from, so that it can be run again; None for the others.
    parameters
        Its numbers; those of an effect bear the keys of ``[[effect]]``.
    strength_sigma
        Its strength alone, in standard deviations of the noise.
    beside_sigma
        Of two the strength where the other is at work; None for the others, and in answers from before it was asked.
    """

    name: str
    form: str
    form_seed: int | None
    parameters: Mapping[str, Any]
    strength_sigma: float
    beside_sigma: float | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Answer:
    """The truth of a dataset.

    Attributes
    ----------
    kind
        ``none``, ``one``, ``two`` or ``outside``.
    effects
        The causes.
    strength_sigma, strength_by_trial
        Strength of all together, in standard deviations of the noise, in the dataset and in each trial.
    affected_trials
        The trials whose strength is 1 or more.
    where
        The part of the data in which a cause acts, by axis, where it is not all of it.
    nuisances, jitter
        How far the measurement and the nominal numbers are off.
    jitter_sigma
        What the jitter and the step show without any cause, in standard deviations of the noise.
    """

    kind: str
    effects: tuple[TrueCause, ...]
    strength_sigma: float
    strength_by_trial: Mapping[str, float]
    affected_trials: tuple[str, ...]
    where: Mapping[str, tuple[float, float]]
    nuisances: Mapping[str, Any]
    jitter: Mapping[str, Any]
    jitter_sigma: float

    def table(self) -> dict[str, Any]:
        """Return the answer as JSON holds it."""
        found: dict[str, Any] = json.loads(json.dumps(asdict(self), allow_nan=False))
        return found

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Return the answer that `table` returned.

        Parameters
        ----------
        table
            What JSON held.

        Raises
        ------
        TypeError, KeyError
            A table of another form.
        """
        effects = tuple(TrueCause(**effect) for effect in table["effects"])
        where = {axis: (float(low), float(high)) for axis, (low, high) in table["where"].items()}
        rest = {"effects": effects, "where": where, "affected_trials": tuple(table["affected_trials"])}
        return cls(**{**table, **rest})


def seal(salt: str, answer: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the salt and the answer in canonical JSON.

    Parameters
    ----------
    salt
        Random letters, so that no answer can be guessed from its seal.
    answer
        What `Answer.table` returned.
    """
    text = json.dumps(answer, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return sha256((salt + text).encode()).hexdigest()
