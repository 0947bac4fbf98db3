"""What all commands do alike: options, refusals, files. Imports nothing that may be missing before it has looked."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn

__all__ = ["REFUSED", "Measurement", "Options", "run"]

REFUSED = 2
_REPETITIONS = 5


@dataclass(frozen=True)
class Measurement:
    """What is measured.

    Attributes
    ----------
    summary
        In a sentence.
    module, distribution
        The module that it needs beside this package, and what installs it; None where it needs none.
    section
        Its section of the page.
    comparison, page
        Modules that measure and that write; imported only once all that they need is known to be there.
    """

    summary: str
    module: str | None
    distribution: str | None
    section: str
    comparison: str
    page: str


@dataclass(frozen=True)
class Options:
    """What a command was asked for."""

    json: Path | None
    page: Path | None
    repetitions: int


def run(arguments: Sequence[str], measurement: Measurement) -> int:
    """Run a comparison, write what was asked for, and return the exit code.

    Parameters
    ----------
    arguments
        Of the command line.
    measurement
        What is measured.
    """
    options = _options(arguments, measurement.summary)
    needed = [("tumblers", "make .venv/installed")]
    if measurement.module is not None:
        needed.append((measurement.module, f"pip install {measurement.distribution}"))
    for module, install in needed:
        if find_spec(module) is None:
            return _refuse(f"found no module {module}, expected it to be installed: {install}")
    from tumblers.atomic import write_files
    from tumblers.errors import InputError, unreadable
    from tumblers.options import output_file
    from tumblers.progress import phases

    from .page import written_page

    try:
        if options.json is not None:
            output_file("--json", options.json, (".json",), [])
        if options.page is not None:
            output_file("--page", options.page, (".md",), [])
            # A page that cannot be read is refused now, and not after minutes.
            written_page(options.page, measurement.section, "")
    except InputError as error:
        return _refuse(str(error))
    except (OSError, ValueError) as error:
        return _refuse(f"--page: found {unreadable(error)}, expected a page that can be read")
    comparison, page = import_module(measurement.comparison), import_module(measurement.page)
    with phases(True) as tell:
        results = comparison.compare(options.repetitions, tell)
    contents: dict[Path, bytes | memoryview] = {}
    if options.json is not None:
        contents[options.json] = (json.dumps(results.to_json(), indent=2, ensure_ascii=False) + "\n").encode()
    if options.page is not None:
        contents[options.page] = written_page(options.page, measurement.section, page.section(results))
    sys.stdout.write("".join(f"{line}\n" for line in page.lines(results)))
    try:
        write_files(contents)
    except OSError as error:
        return _refuse(f"found files that cannot be written ({error.strerror}), expected ones that can")
    return 0


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Refuse in one line, without the usage."""
        raise SystemExit(_refuse(message))


def _options(arguments: Sequence[str], summary: str) -> Options:
    parser = _Parser(description=summary)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure to this file")
    parser.add_argument("--page", type=Path, metavar="FILE.md", help="replace this command's section of the page")
    parser.add_argument(
        "--repetitions",
        type=int,
        default=_REPETITIONS,
        metavar="N",
        help="alternating repetitions (default: %(default)s)",
    )
    found = parser.parse_args(arguments)
    if found.repetitions < 1:
        parser.error(f"--repetitions: found {found.repetitions}, expected at least 1")
    return Options(found.json, found.page, found.repetitions)


def _refuse(line: str) -> int:
    sys.stderr.write(f"{Path(sys.argv[0]).name}: {line}\n")
    return REFUSED
