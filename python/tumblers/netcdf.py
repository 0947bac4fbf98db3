"""netCDF files of results."""

from __future__ import annotations

from os import PathLike

import xarray as xr

from .atomic import atomic_file

__all__ = ["save_netcdf"]


def save_netcdf(dataset: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a Dataset to a netCDF-4 file, whole or not at all.

    Raises
    ------
    OSError
        The folder is missing or cannot be written to.
    """
    with atomic_file(path) as temporary:
        dataset.to_netcdf(temporary, engine="h5netcdf")
