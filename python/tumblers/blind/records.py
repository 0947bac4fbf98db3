"""`Record`: one dataset's truth beside its diagnosis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from ..errors import InputError, show
from .answer import Answer, seal
from .forms import law_of
from .make import ANSWERS_FORMAT, SEAL, SEAL_FORMAT
from .repeated import Repeated
from .ties import effect_of
from .written import read_diagnosis, read_repeat, read_run, read_table

__all__ = ["Record", "read_records"]

# How many causes each kind of dataset has.
_CAUSES = {"none": 0, "one": 1, "two": 2, "outside": 1}


@dataclass(frozen=True, kw_only=True, slots=True)
class Record:
    """One dataset's truth beside its diagnosis.

    Attributes
    ----------
    dataset
        The folder's name.
    answer
        The truth, whose seal was whole.
    diagnosis
        The table of ``diagnosis.json``; None where the dataset has none.
    seconds, threads, version
        How long the diagnosis took, on how many threads, and by which version it is.
    repeated
        The same once more with nothing beside it; None where that was not done.
    """

    dataset: str
    answer: Answer
    diagnosis: Mapping[str, Any] | None
    seconds: float | None = None
    threads: int = 1
    version: str | None = None
    repeated: Repeated | None = None

    @property
    def truth(self) -> tuple[str, ...]:
        """Names of the causes that were at work."""
        return tuple(effect.name for effect in self.answer.effects)

    @property
    def verdict(self) -> str:
        """The diagnosis's verdict, or ``failed``."""
        return "failed" if self.diagnosis is None else str(self.diagnosis["verdict"])

    @property
    def named(self) -> tuple[str, ...]:
        """Names of the effects that the diagnosis chose, in its order."""
        return () if self.diagnosis is None else tuple(effect["name"] for effect in self.diagnosis["effects"])

    @property
    def same_form(self) -> bool:
        """Whether every cause has the catalogue's form."""
        return all(effect.form == "catalogue" for effect in self.answer.effects)


def read_records(directory: str | PathLike[str], answers: str | PathLike[str]) -> tuple[int, list[Record]]:
    """Return the seed and the records of a folder, after every seal was checked.

    Parameters
    ----------
    directory
        The folder of datasets.
    answers
        The file with the answers.

    Raises
    ------
    InputError
        A file that is no such file or not as it was written, a dataset without an answer or a seal or with two answers,
        an answer that is not the sealed one, causes that are not as many as the kind says, or one that cannot be at
        work again.
    """
    directory, answers = Path(directory), Path(answers)
    table = read_table(answers, ANSWERS_FORMAT)
    try:
        entries = [(entry["dataset"], entry["salt"], entry["answer"]) for entry in table["answers"]]
        seed = int(table["seed"])
    except (KeyError, OverflowError, TypeError, ValueError):
        raise InputError(
            "answers", "no list of datasets, salts and answers", f"a {ANSWERS_FORMAT} file", answers
        ) from None
    names = [name for name, _, _ in entries]
    for name in names:
        if names.count(name) > 1:
            raise InputError("answers", f"{show(name)} again", "one answer for every dataset", answers)
        # A path could lead out of the folder.
        if not isinstance(name, str) or name in ("", ".", "..") or Path(name).name != name:
            raise InputError("answers", f"the dataset {show(name)}", "the name of a folder of datasets", answers)
    for path in sorted(directory.glob("dataset-*")):
        if path.name not in names:
            raise InputError("answers", f"no answer for {path.name}", "one for every dataset", answers)
    if not names:
        raise InputError("answers", "no answers", "at least one", answers)
    return seed, [_record(directory / name, salt, answer, answers) for name, salt, answer in entries]


def _record(folder: Path, salt: object, answer: object, answers: Path) -> Record:
    sealed = read_table(folder / SEAL, SEAL_FORMAT)
    if not isinstance(salt, str) or not isinstance(answer, dict) or not _is_sealed(sealed, salt, answer):
        raise InputError(folder.name, "an answer that is not the sealed one", f"that of {folder / SEAL}", answers)
    try:
        truth = Answer.from_table(answer)
        _check(truth)
    except InputError as error:
        raise InputError(f"{folder.name}.{error.key}", error.found, error.expected, answers) from None
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError):
        raise InputError(folder.name, show(answer), "an answer of this version", answers) from None
    run = read_run(folder) or {}
    return Record(
        dataset=folder.name,
        answer=truth,
        diagnosis=read_diagnosis(folder),
        seconds=run.get("seconds"),
        threads=run.get("threads", 1),
        version=run.get("version"),
        repeated=_repeated(read_repeat(folder), trials=len(truth.strength_by_trial)),
    )


def _repeated(table: Mapping[str, Any] | None, trials: int) -> Repeated | None:
    if table is None:
        return None
    return Repeated(
        seconds=table["seconds"],
        processor_s=table.get("processor_s"),
        threads=table["threads"],
        cores=table["cores"],
        same=table["same"],
        trials=trials,
    )


def _check(truth: Answer) -> None:
    """Refuse what would count as nothing: causes not as the kind says, an effect that cannot be at work again."""
    if truth.kind not in _CAUSES:
        raise InputError("kind", show(truth.kind), " or ".join(_CAUSES))
    found, count = len({cause.name for cause in truth.effects}), _CAUSES[truth.kind]
    if not found == len(truth.effects) == count:
        said = f"{len(truth.effects)} causes with {found} names"
        raise InputError("effects", said, f"{count} different ones for kind {truth.kind}")
    if truth.kind == "outside":
        return
    for i, cause in enumerate(truth.effects):
        try:
            effect = effect_of(cause.name, cause.parameters)
            if effect.is_neutral():
                raise InputError(cause.name, "what changes nothing", "a parameter that is not neutral")
            law_of(effect, cause.form, 0)
        except InputError as error:
            raise InputError(f"effects[{i}].{error.key}", error.found, error.expected) from None
        if cause.form != "catalogue" and not (type(cause.form_seed) is int and cause.form_seed >= 0):
            raise InputError(f"effects[{i}].form_seed", show(cause.form_seed), "a whole number of at least 0")


def _is_sealed(sealed: Mapping[str, Any], salt: str, answer: Mapping[str, Any]) -> bool:
    try:
        return bool(sealed.get("sha256") == seal(salt, answer))
    except (RecursionError, ValueError):
        # What JSON cannot hold has no seal: NaN, half a character, tables nested too deeply.
        return False
