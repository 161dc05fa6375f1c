"""Results of the verbs of a study.

A result has the facts that the command line prints with ``--json`` as attributes (``response.residual_vibration``), in the
units of the study, which ``result.units`` names. Unknown facts are ``None``, with the reason in ``result.why``. A fact that is an object has
its parts as attributes (``actuator.best.amplitude``), a list of objects its columns (``thresholds.local[0].value``, ``thresholds.local.value``).
The arrays of a result and their coordinates are attributes too (``run.displacement`` over ``run.time``), as NumPy arrays in the units of
the study: in SI for a study in SI. Names that depend on the study, such as those of coordinates,
are not known to type checkers: ``run["velocity_x"]``. ``result.dataset`` has everything, with units and provenance, as one
:class:`xarray.Dataset`. pint reads the units (:meth:`Result.quantity`), and ``attrs["scaling"]`` is the scale of a dimensionless
number. If xarray is not installed, it is a :class:`quell.results.Arrays`. Results plot, save, pickle, and are shown as tables.

A fact whose name is a keyword of Python has an underscore as an attribute: ``thresholds.from_``.
"""

from __future__ import annotations

from .._dataset import Arrays, Variable
from .._frozen import FrozenDict, Records
from .._result import Result
from ._measured import Comparison, Decay, LawFit, RecordFit
from ._motion import Attractor, NoiseResponse, Orbit, Response, Simulation, Window
from ._steady import Actuator, Check, Citations, DescribingFunction, Design, ExactStability, FrictionCurve, Modes, Probability, Receptance, Resonances, Stability, TrackedStability, Waveforms
from ._sweeps import Basins, Bifurcation, Map, Ramp, Shard, ThresholdCurves, Thresholds

__all__ = [
    "Actuator",
    "Arrays",
    "Attractor",
    "Basins",
    "Bifurcation",
    "Check",
    "Citations",
    "Comparison",
    "Decay",
    "DescribingFunction",
    "Design",
    "ExactStability",
    "FrictionCurve",
    "FrozenDict",
    "LawFit",
    "Map",
    "Modes",
    "NoiseResponse",
    "Orbit",
    "Probability",
    "Ramp",
    "RecordFit",
    "Records",
    "Receptance",
    "Resonances",
    "Response",
    "Result",
    "Shard",
    "Simulation",
    "Stability",
    "ThresholdCurves",
    "Thresholds",
    "TrackedStability",
    "Variable",
    "Waveforms",
    "Window",
]
