"""Results as tables and files of other packages: pandas, NetCDF, Parquet, MATLAB, pint. They are imported only here, when needed."""

from __future__ import annotations

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import StudyError, complaint
from ._names import attributes

if TYPE_CHECKING:
    import pandas

    from ._result import Result
    from .results import Simulation

__all__ = ["events_frame", "frame", "mat", "needed", "netcdf", "parquet", "quantity"]

INSTALL = {"scipy.io": "scipy", "scipy.sparse": "scipy", "scipy.sparse.linalg": "scipy"}
"""Packages whose modules have other names than those under which pip installs them."""


def needed(module: str, what: str) -> Any:
    """An optional package.

    Raises
    ------
    ImportError
        It is not installed; the message names the command that installs it.
    """
    try:
        return import_module(module)
    except ImportError as why:
        package = INSTALL.get(module, module)
        raise ImportError(f"{what} needs {package}, which is not installed: pip install {package}") from why


def frame(result: Result) -> pandas.DataFrame:
    """The arrays over the first coordinates of a result, one row for each point, with the coordinates as index."""
    pandas = needed("pandas", "to_dataframe()")
    arrays = result.arrays
    over = next((it.dims for name, it in arrays.items() if it.dims and name not in arrays.coords and arrays.coords.issuperset(it.dims)), None)
    if over is None:
        raise StudyError([complaint("to_dataframe", None, "a result with arrays; facts are in to_dict()", "usage")])
    columns = {name: it for name, it in arrays.items() if it.dims == over and name not in arrays.coords}
    axes = [arrays[dim].values for dim in over]
    index = pandas.MultiIndex.from_product(axes, names=over) if len(over) > 1 else pandas.Index(axes[0], name=over[0])
    values = {name: (it.words() if "flag_meanings" in it.attrs else it.values).ravel() for name, it in columns.items()}
    table = pandas.DataFrame(values, index=index)
    table.attrs = {
        "verb": result.verb,
        "study": result.study.text,
        "changes": list(result.study.changes),
        "units": {name: str(arrays[name].attrs["units"]) for name in (*over, *columns) if "units" in arrays[name].attrs},
    }
    return table


def events_frame(run: Simulation) -> pandas.DataFrame:
    """The events of a run, one row for each, in the units of the study."""
    pandas = needed("pandas", "events_frame()")
    arrays = run.arrays
    columns = {name.removeprefix("event_"): it.values for name, it in arrays.items() if it.dims == ("event",)}
    names = run.facts["state_names"]
    states = np.array([event["state"] for event in run.events], dtype=float).reshape(-1, len(names))
    contacts = [contact["name"] for contact in run.contacts]
    columns["contact_name"] = np.array([contacts[event["contact"]] for event in run.events], dtype=object)
    columns.update({attributes(names)[name]: states[:, place] for place, name in enumerate(names)})
    first = ("time", "contact", "contact_name", "kind", "slip_sign", "displacement", "velocity")
    none = np.array([])
    table = pandas.DataFrame({name: columns.get(name, none) for name in (*first, *columns)})
    table.index.name = "event"
    table.attrs["units"] = {
        name: str(arrays[f"event_{name}"].attrs["units"])
        for name in table.columns
        if f"event_{name}" in arrays and "units" in arrays[f"event_{name}"].attrs
    }
    return table


def netcdf(result: Result, path: str | os.PathLike[str]) -> None:
    """Writes everything as a NetCDF file.

    A variable that is named like a dimension, but is not its coordinate, gets the suffix ``_value``.
    """
    needed("xarray", "to_netcdf()")
    dataset = result.to_xarray()
    clashing = {name: f"{name}_value" for name, it in dataset.variables.items() if name in dataset.dims and it.dims != (name,)}
    dataset = dataset.rename_vars(clashing)
    for name, variable in dataset.variables.items():
        if variable.dtype.kind == "b":
            dataset[name] = dataset[name].astype("int8")
    try:
        dataset.to_netcdf(path)
    except (ImportError, ValueError) as why:
        if any(_is_there(module) for module in ("netCDF4", "h5netcdf")):
            raise
        raise ImportError("to_netcdf() needs netCDF4 or h5netcdf: pip install h5netcdf") from why


def _is_there(module: str) -> bool:
    from importlib.util import find_spec

    return find_spec(module) is not None


def parquet(result: Result, path: str | os.PathLike[str]) -> None:
    """Writes the table of :func:`frame` as a Parquet file, with units and study in its metadata."""
    table = frame(result)
    if not any(_is_there(module) for module in ("pyarrow", "fastparquet")):
        raise ImportError("to_parquet() needs pyarrow, which is not installed: pip install pyarrow")
    table.to_parquet(path)


LONGEST_NAME = 63
"""The longest name of a field in MATLAB."""


def mat(result: Result, path: str | os.PathLike[str]) -> None:
    """Writes everything as a MAT-file: a structure with the name of the verb."""
    scipy = needed("scipy.io", "to_mat()")
    arrays = result.arrays
    fields: dict[str, Any] = {}
    units: dict[str, str] = {}
    meanings: dict[str, Any] = {}
    for name, one in arrays.items():
        field = _field(name)
        if "flag_meanings" in one.attrs:
            meanings[field] = np.array(one.attrs["flag_meanings"].split(" "), dtype=object)
        if "units" in one.attrs:
            units[field] = str(one.attrs["units"])
        fields[field] = np.array(one.values.tolist(), dtype=object) if one.values.dtype.kind == "U" and one.dims else _in_mat(one.values)
    about = {_field(name): value for name, value in arrays.attrs.items()}
    fields["about"] = {**about, "units": units, "meanings": meanings}
    scipy.savemat(path, {_field(result.verb): fields}, long_field_names=True, oned_as="column", appendmat=False)


def _in_mat(values: Any) -> Any:
    """Numbers as MATLAB has them; a text without dimension."""
    return str(values) if values.dtype.kind == "U" else values


def _field(name: str) -> str:
    """A name as that of a field."""
    plain = "".join(it if it.isascii() and it.isalnum() else "_" for it in name)
    return (plain if plain[:1].isalpha() else f"x{plain}")[:LONGEST_NAME]


def quantity(result: Result, name: str, registry: Any = None) -> Any:
    """A variable with its unit, as a quantity of pint."""
    pint = needed("pint", "quantity()")
    units = pint.get_application_registry() if registry is None else registry
    one = result.arrays[name]
    unit = one.attrs.get("units", "dimensionless")
    try:
        return units.Quantity(one.values if one.dims else one.values.item(), unit)
    except pint.UndefinedUnitError:
        allowed = f"a number with a unit; {name} is in units of {unit}, because the study has none"
        raise StudyError([complaint("quantity", name, allowed)]) from None
