"""`Results`: what every comparison measures; each adds its own."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, ClassVar, Protocol

from .contact import Contact
from .speed import Speed

__all__ = ["Profile", "Results"]


class Profile(Protocol):
    """Settings of a peer's contact."""

    name: str

    @property
    def words(self) -> str:
        """The settings in the peer's words."""


@dataclass(frozen=True, kw_only=True)
class Results:
    """Figures of both engines.

    Attributes
    ----------
    conditions
        Machine, load and versions.
    profiles
        The peer's settings that were run.
    speeds, contacts
        What was timed, and how well each engine keeps its contact.
    max_residual, unconverged_steps
        Of all our runs.
    """

    peer: ClassVar[str]
    conditions: dict[str, Any]
    profiles: tuple[Profile, ...]
    speeds: list[Speed]
    contacts: list[Contact]
    max_residual: float
    unconverged_steps: int

    @property
    def settings(self) -> dict[str, str]:
        """The peer's settings in words, by their names."""
        return {profile.name: profile.words for profile in self.profiles}

    @property
    def settings_list(self) -> str:
        """The same in Markdown."""
        return "\n".join(f"- *{name}*: {words}" for name, words in self.settings.items())

    def to_json(self) -> dict[str, Any]:
        """Return what ``--json`` writes of these."""
        return {
            "max_residual": self.max_residual,
            "unconverged_steps": self.unconverged_steps,
            "conditions": self.conditions,
            f"{self.peer.lower()}_settings": self.settings,
            "speeds": [asdict(row) for row in self.speeds],
            "contacts": [asdict(contact) for contact in self.contacts],
        }
