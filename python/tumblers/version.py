"""The package's version, kept in `Cargo.toml`."""

from importlib.metadata import PackageNotFoundError, version

__all__ = ["__version__"]

try:
    __version__ = version("tumblers")
except PackageNotFoundError:
    __version__ = "0+not.installed"
