"""The catalogue: every effect by its name, and a user's own beside them."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from difflib import get_close_matches
from hashlib import sha256
from importlib.util import module_from_spec, spec_from_file_location
from os import PathLike
from pathlib import Path

from ..errors import InputError, show
from ..section import require_table
from .adhesion_coefficient import AdhesionCoefficient
from .base import Effect
from .camera_calibration import CameraCalibration
from .center_of_mass_offset import CenterOfMassOffset
from .contact_compliance import ContactCompliance
from .definition import check_definition
from .draft_angle import DraftAngle
from .eddy_current_drag import EddyCurrentDrag
from .electrostatic_force import ElectrostaticForce
from .field_ellipticity import FieldEllipticity
from .field_rolloff import FieldRolloff
from .friction_anisotropy import FrictionAnisotropy
from .friction_coefficient import FrictionCoefficient
from .line_contact_adhesion import LineContactAdhesion
from .magnetization_misalignment import MagnetizationMisalignment
from .magnetization_strength import MagnetizationStrength
from .size_error import SizeError
from .stray_field_gradient import StrayFieldGradient
from .substrate_tilt import SubstrateTilt
from .surface_roughness import SurfaceRoughness
from .viscous_drag import ViscousDrag

__all__ = ["CATALOGUE", "effects_from_tables", "file_of", "get", "load_file", "register", "sources_of"]

CATALOGUE: dict[str, type[Effect]] = {
    effect.name: effect
    for effect in (
        MagnetizationMisalignment,
        MagnetizationStrength,
        DraftAngle,
        SizeError,
        CenterOfMassOffset,
        FrictionCoefficient,
        FrictionAnisotropy,
        AdhesionCoefficient,
        LineContactAdhesion,
        ElectrostaticForce,
        StrayFieldGradient,
        FieldRolloff,
        FieldEllipticity,
        SubstrateTilt,
        EddyCurrentDrag,
        ViscousDrag,
        SurfaceRoughness,
        ContactCompliance,
        CameraCalibration,
    )
}

_LOADED: dict[Path, tuple[type[Effect], ...]] = {}


def get(name: str, key: str = "effect.name") -> type[Effect]:
    """Return an effect of the catalogue.

    Parameters
    ----------
    name
        Its name.
    key
        Where the name stands, for errors.

    Raises
    ------
    InputError
        A name that is not in the catalogue.
    """
    if not isinstance(name, str):
        raise InputError(key, show(name), "a name")
    if name not in CATALOGUE:
        near = get_close_matches(name, CATALOGUE, 1)
        found = f"{show(name)} (did you mean {near[0]}?)" if near else show(name)
        raise InputError(key, found, f"one of {', '.join(CATALOGUE)}, or an effect registered before")
    return CATALOGUE[name]


def register(effect: type[Effect]) -> type[Effect]:
    """Add an effect to the catalogue, and return it, so that it can stand as a decorator.

    Parameters
    ----------
    effect
        The class; one that is registered already is left as it is.

    Raises
    ------
    InputError
        An incomplete definition, or the name of another effect.
    """
    checked = _free(effect, {})
    CATALOGUE[checked.name] = checked
    return effect


def _free(effect: object, also: dict[str, type[Effect]]) -> type[Effect]:
    checked = check_definition(effect)
    if {**CATALOGUE, **also}.get(checked.name, checked) is not checked:
        raise InputError(f"{checked.__name__}.name", show(checked.name), "a name that no other effect has")
    return checked


def load_file(path: str | PathLike[str]) -> tuple[type[Effect], ...]:
    """Run a Python file and register the effects that it defines: all of them, or none.

    Parameters
    ----------
    path
        The file, which runs with all rights of Python; one that has been loaded is not run again.

    Raises
    ------
    InputError
        A file that cannot be read or run, that defines no effect, or an effect that is refused.
    """
    path = Path(path)
    if path.resolve() in _LOADED:
        return _LOADED[path.resolve()]
    if not path.is_file():
        found = "a directory" if path.is_dir() else "no such file"
        raise InputError(None, found, "a Python file with effects", path)
    before = dict(CATALOGUE)
    name = f"tumblers_effects_{sha256(str(path.resolve()).encode()).hexdigest()[:16]}"
    try:
        effects = _effects_of(path, name)
        added: dict[str, type[Effect]] = {}
        for effect in effects:
            added[effect.name] = _free(effect, added)
    except BaseException as error:
        sys.modules.pop(name, None)
        CATALOGUE.clear()
        CATALOGUE.update(before)
        if isinstance(error, InputError):
            raise error.in_file(path) from None
        raise
    CATALOGUE.update(added)
    _LOADED[path.resolve()] = effects
    return effects


def file_of(effect: type[Effect]) -> Path | None:
    """Return the file that `load_file` has an effect from; None for one that it did not load.

    Parameters
    ----------
    effect
        The class.
    """
    return next((path for path, effects in _LOADED.items() if effect in effects), None)


def sources_of(effects: Iterable[Effect]) -> dict[str, str]:
    """Return the SHA-256 of the file of every effect that `load_file` has, by name: a result depends on it.

    Parameters
    ----------
    effects
        Of a scenario.
    """
    files = {effect.name: file_of(type(effect)) for effect in effects}
    return {name: sha256(file.read_bytes()).hexdigest() for name, file in files.items() if file is not None}


def _effects_of(path: Path, name: str) -> tuple[type[Effect], ...]:
    spec = spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise InputError(None, f"the suffix {show(path.suffix)}", "a Python file, .py")
    module = module_from_spec(spec)
    # Dataclasses and pickle look a class's module up by its name.
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except InputError:
        raise
    except (Exception, SystemExit) as error:
        raise InputError(None, f"{type(error).__name__}: {error}", "a Python file that runs") from None
    defined = [
        value
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Effect) and value.__module__ == name
    ]
    # What others are made from, and has no name, is none itself.
    effects = tuple(
        one
        for one in defined
        if hasattr(one, "name") or not any(issubclass(other, one) for other in defined if other is not one)
    )
    if not effects:
        raise InputError(None, "no effect", "a subclass of tumblers.effects.Effect")
    return effects


def effects_from_tables(tables: object) -> tuple[Effect, ...]:
    """Return the effects of a file's ``[[effect]]`` tables, in their order.

    Parameters
    ----------
    tables
        What the file holds under ``effect``.

    Raises
    ------
    InputError
        No array of tables, an unknown name or key, or a value that is refused.
    """
    if not isinstance(tables, list | tuple):
        raise InputError("effect", show(tables), "an array of tables [[effect]]")
    effects = []
    for i, entry in enumerate(tables):
        section = f"effect[{i}]"
        table = require_table(section, entry)
        name = table.get("name")
        if not isinstance(name, str):
            raise InputError(f"{section}.name", show(name) if "name" in table else "no such key", "an effect's name")
        effects.append(get(name, f"{section}.name").from_table(table, section))
    return tuple(effects)
