"""Results of verbs that set a study, or a law, against measurements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._frozen import FrozenDict, Records
from .._result import Result

if TYPE_CHECKING:
    from .._quell import NativeAnswer
    from .._study import Study

__all__ = ["Comparison", "Decay", "LawFit", "RecordFit"]


class _Estimates(Result):
    """What every fit says."""

    parameters: FrozenDict[FrozenDict[float | bool | None]]
    """``value``, ``standard_error`` and ``fixed`` by name, or by path of a study."""
    covariance: FrozenDict[list[Any]]
    """``order``, the names or paths, and ``matrix``, row by row."""
    condition: float | None
    """Condition of the information matrix."""
    residual: float
    """Residual standard deviation; where the file gives standard deviations, in units of them."""
    rss: float
    """Sum of squares of the residuals."""
    p: int
    """Number of estimated numbers."""
    n: int
    """Number of points or samples."""
    aic: float | None
    """Akaike's information criterion."""
    file: str
    """The file."""
    columns: list[str]
    """Its columns."""
    read: FrozenDict[Any]
    """How the file was read: ``separator``, ``decimal``, ``units`` of the columns, counts of ``comment_lines`` and ``header_lines``, and the
    lines that were left out."""


class _OfRecord(_Estimates):
    """What a fit to a record says."""

    explained: float | None
    """Share of the variance of the record that the model explains, 1 − RSS/Σ(y − ȳ)²; below 0.5 the model does not explain the record,
    and standard errors are ``None``. ``None`` of a record that does not vary."""


class _ComparedLaws(_Estimates):
    """What fits of several laws say; they have no study."""

    law: str
    """The law with the least AIC."""
    comparison: Records
    """Every law by ascending AIC."""


class Decay(_ComparedLaws, _OfRecord):
    """Natural frequency, damping and friction from a free decay; arrays over the samples (n,). It has no study."""

    verb = "fit_decay"
    law: str
    """The law with the least AIC: "viscous", "coulomb" or "viscous-coulomb"."""
    converged: bool
    """Whether the search has converged."""
    recorded_quantity: str
    """What the record shows."""
    not_determinable: list[str]
    """What no free decay determines."""
    tables: FrozenDict[str]
    """Tables to paste into a study: ``belt`` and ``uncertainty``."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    measured: npt.NDArray[np.float64]
    """Measured record (n,)."""
    fitted: npt.NDArray[np.float64]
    """Computed record (n,)."""
    fitted_deviation: npt.NDArray[np.float64]
    """Standard deviation of the computed record (n,)."""
    point_residual: npt.NDArray[np.float64]
    """Measured less computed (n,)."""


class LawFit(_ComparedLaws):
    """Friction laws from measured friction; arrays over the points and over a grid of slip speeds. It has no study."""

    verb = "fit_laws"
    confidence: float
    """Confidence of the band about the curve."""
    quantile: float
    """Student's quantile of that confidence."""
    weighted: bool
    """Whether the points have standard deviations."""
    sign: str
    """How the signs of slip and friction were read."""
    friction_is: str
    """What friction is: "coefficient", or without a load "force" or "torque"."""
    at_rest: list[int]
    """Lines of the file without slip, which are left out."""
    not_determinable: list[str]
    """What steady sliding does not determine."""
    left_out: Records
    """Laws that could not be fitted, and why."""
    slip_velocity: npt.NDArray[np.float64]
    """Grid of slip speeds (n,)."""
    coefficient: npt.NDArray[np.float64]
    """Coefficient of the law (n,) on the grid."""
    coefficient_low: npt.NDArray[np.float64]
    """Lower end of its band (n,)."""
    coefficient_high: npt.NDArray[np.float64]
    """Upper end of its band (n,)."""
    line: npt.NDArray[np.float64]
    """Line of the file of each measured point (m,)."""
    points_point_velocity: npt.NDArray[np.float64]
    """Measured slip speed (m,)."""
    points_point_coefficient: npt.NDArray[np.float64]
    """Measured coefficient (m,)."""
    points_point_deviation: npt.NDArray[np.float64]
    """Its standard deviation (m,)."""
    points_point_residual: npt.NDArray[np.float64]
    """Measured less computed coefficient (m,)."""

    @property
    def tables(self) -> FrozenDict[str]:
        """Tables to paste into a study: ``friction`` and ``uncertainty``, the fact ``study``."""
        found: FrozenDict[str] = self.facts["study"]
        return found


class RecordFit(_OfRecord):
    """Numbers of a study from a measured record; arrays over the samples (n,)."""

    verb = "fit_record"
    converged: bool
    """Whether the search has converged."""
    derivatives: str
    """How derivatives are computed."""
    starts: int
    """Number of starts of the search."""
    recorded_quantity: str
    """What the record shows."""
    shift_from: str | None
    """Where a free shift counts from."""
    other_minima: Records
    """Other minima of the sum of squares."""
    not_determinable: Records
    """Combinations of numbers that the record hardly determines."""
    tables: FrozenDict[str]
    """Tables to paste into the study: ``numbers`` and ``uncertainty``."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    measured: npt.NDArray[np.float64]
    """Measured record (n,)."""
    fitted: npt.NDArray[np.float64]
    """Computed record (n,)."""
    point_residual: npt.NDArray[np.float64]
    """Measured less computed (n,)."""


class Comparison(Result):
    """Measured and computed spectra; arrays over frequencies (n,), those of a second file with the ending of its dataset."""

    verb = "compare"
    before: FrozenDict[Any]
    """The first file: ``lines``, ``measured_rms``, ``computed_rms``, ``resolution``, ``not_comparable``."""
    after: FrozenDict[Any] | None
    """The same of the second file."""
    reduction: FrozenDict[float] | None
    """Decibels by which the dither reduces the vibration: ``measured``, ``predicted``, ``difference``."""
    slow_reduction: FrozenDict[float] | None
    """The same of the vibration below the dither."""
    frequency: npt.NDArray[np.float64]
    """Frequency (n,) in Hz of the first file."""
    measured: npt.NDArray[np.float64]
    """Measured amplitude (n,)."""
    computed: npt.NDArray[np.float64]
    """Computed amplitude (n,)."""
    frequency_after: npt.NDArray[np.float64]
    """Frequency (m,) in Hz of the second file."""
    after_measured_after: npt.NDArray[np.float64]
    """Measured amplitude (m,) under dither."""
    after_computed_after: npt.NDArray[np.float64]
    """Computed amplitude (m,) under dither."""
