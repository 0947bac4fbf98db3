"""netCDF files of results."""

from __future__ import annotations

from io import BytesIO
from os import PathLike
from pathlib import Path

import xarray as xr

from .atomic import write_files

__all__ = ["netcdf_bytes", "save_netcdf"]


def netcdf_bytes(dataset: xr.Dataset) -> memoryview:
    """Return a Dataset as the bytes of a netCDF-4 file.

    Parameters
    ----------
    dataset
        What `simulate` or `sweep` returned.
    """
    # HDF5 does not survive a full disk: it writes to memory.
    buffer = BytesIO()
    dataset.to_netcdf(buffer, engine="h5netcdf")
    return buffer.getbuffer()


def save_netcdf(dataset: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a Dataset to a netCDF-4 file, whole or not at all.

    Parameters
    ----------
    dataset
        What `simulate` or `sweep` returned.
    path
        The file; one that exists is replaced.

    Raises
    ------
    OSError
        The folder is missing or cannot be written to, or the disk is full.
    """
    write_files({Path(path): netcdf_bytes(dataset)})
