"""The verbs of a study, which have the names of the command line: one method for each, which checks its arguments.

Those about the structure are in ``_linear.py``; what a study is apart from its verbs is in ``_checked.py``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import numpy.typing as npt

from . import results
from ._arguments import Arguments, flags, keywords
from ._axes import Axes
from ._errors import complaint
from ._laws import StudyFriction
from ._linear import LinearVerbs, State
from ._record import names_of, record_of
from ._tables import Number
from ._values import plain

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["Study"]

A_TIME = 'a finite number, or a time with its unit such as "0.5s"'
A_NUMBER_OF_A_SYSTEM = "path of a number, such as contact.pad.friction.coefficient"


class Study(LinearVerbs):
    """A checked study: of a belt, of a disc or of a system.

    Made by :class:`quell.Belt`, :class:`quell.Disc`, :class:`quell.System`, :meth:`from_toml` or :meth:`from_text`. A study is
    valid and immutable (:meth:`set` and :meth:`replace` return a new one). Its numbers and tables are attributes
    (``belt.belt_velocity``, ``belt.dither.amplitude``). Studies compare by their settings, pickle, and have a method for every
    verb of the command line. A verb for another kind of study raises :class:`quell.StudyError`.
    """

    # Verbs, in the order of the command line.

    @keywords
    def check(self) -> results.Check:
        """The study in numbers; for a study in SI also in SI."""
        return results.Check._of(self, self._native.check())

    @keywords
    def sketch(self, path: str | os.PathLike[str] | None = None, *, width: str | None = None) -> str:
        """Draws the mechanism that the study describes, with the values of its parts.

        Parameters
        ----------
        path : path, optional
            File for the drawing: SVG, PDF or PNG by the end of its name. A file there is replaced.
        width : str, optional
            Width with its unit, such as ``"85mm"`` for the column of a journal; 120 mm by default.

        Returns
        -------
        str
            The drawing as SVG.

        Raises
        ------
        quell.StudyError
            A width out of range, or a path at which no such file can be written.

        Examples
        --------
        >>> belt = quell.Belt(
        ...     damping_ratio=0.005, normal_load=1.0, belt_velocity=0.05, friction=quell.Coulomb(coefficient=0.4)
        ... )
        >>> belt.sketch(width="85mm").startswith("<svg")
        True
        """
        arguments = Arguments()
        place = arguments.optional(arguments.path, "path", path)
        wide = arguments.optional(arguments.text, "width", width, "a length with its unit, such as 85mm")
        arguments.done()
        return self._native.sketch(place, wide)

    @keywords
    def report(self, path: str | os.PathLike[str] | None = None, *, without: Sequence[str] = ()) -> str:
        """One page about the study: its sketch, values, verdicts, cost and pictures, what was not examined, and sources.

        The page is made of the answers of the verbs, and needs no other file. It takes seconds.

        Parameters
        ----------
        path : path, optional
            File for the page, whose name ends in ``.html``. A file there is replaced.
        without : sequence of str, optional
            Verbs to leave out, such as ``["thresholds"]``.

        Returns
        -------
        str
            The page as HTML.

        Raises
        ------
        quell.StudyError
            A verb that the report does not have, or a path at which no such file can be written.

        Examples
        --------
        >>> belt = quell.Belt(
        ...     damping_ratio=0.005, normal_load=1.0, belt_velocity=0.05, friction=quell.Coulomb(coefficient=0.4)
        ... )
        >>> "What was not examined" in belt.report()
        True
        """
        arguments = Arguments()
        place = arguments.optional(arguments.path, "path", path)
        names = [without] if isinstance(without, str) else list(without)
        verbs = [arguments.text("without", name, "names of verbs") for name in names]
        arguments.done()
        return self._native.report(place, verbs)

    @keywords
    def cite(self) -> results.Citations:
        """Equations and papers that the computations use, with BibTeX, and corrections of the printed equations."""
        return results.Citations._of(self, self._native.cite())

    @property
    def friction(self) -> StudyFriction:
        """The friction law of the study, and the verb: ``belt.friction.static_coefficient``, ``belt.friction(at=[0.1])``.

        See :meth:`quell.StudyFriction.__call__`. Contacts of a system have laws of their own: ``system.contacts["pad"].friction``.
        """
        return StudyFriction(self, self._document().get("friction", {}))

    @overload
    def stability(self) -> results.Stability: ...

    @overload
    def stability(
        self, parameter: str, from_: Number, to: Number, *, along: str | None = None, between: State | None = None
    ) -> results.TrackedStability: ...

    @overload
    def stability(self, *, exact: Literal[True]) -> results.ExactStability: ...

    @keywords
    def stability(
        self,
        parameter: str | None = None,
        from_: Number | None = None,
        to: Number | None = None,
        *,
        along: str | None = None,
        between: State | None = None,
        exact: bool = False,
    ) -> results.Stability | results.TrackedStability | results.ExactStability:
        """The stability of steady sliding, and of a belt or a system its eigenvalues over a parameter.

        Belt: averaged stability, equation (2.26), and every critical amplitude. Disc: the largest growth rate by eigenvalues
        or Floquet exponents, with its error. System: every eigenvalue, averaged over the dither.

        Parameters
        ----------
        parameter, from_, to :
            System: a number such as ``contact.pad.friction.coefficient`` over which eigenvalues are followed, and its range, in
            the unit of the key or as texts with units.
        along, between :
            System: a second number and its range, along which each threshold is followed as a curve.
        exact :
            Belt or system: whether to decide by Floquet exponents of the dithered motion, if that is pure slip.

        Returns
        -------
        quell.results.Stability
            With a parameter :class:`quell.results.TrackedStability`, with ``exact`` :class:`quell.results.ExactStability`.
        """
        arguments = Arguments()
        tracked = arguments.optional(arguments.text, "parameter", parameter, A_NUMBER_OF_A_SYSTEM)
        begin = arguments.optional(arguments.quantity, "from_", from_)
        end = arguments.optional(arguments.quantity, "to", to)
        second = arguments.optional(arguments.text, "along", along, A_NUMBER_OF_A_SYSTEM)
        window = arguments.optional(arguments.quantities, "between", between, "two numbers, the second above the first")
        in_part = len({it is None for it in (parameter, from_, to)}) > 1
        arguments.conflict(in_part, "given together with from_ and to", parameter=parameter)
        in_part = (along is None) != (between is None) or (along is not None and parameter is None)
        arguments.conflict(in_part, "given together with between, parameter, from_ and to", along=along)
        arguments.conflict(exact and parameter is not None, "given without parameter", exact=exact)
        arguments.done()
        if tracked is not None and begin is not None and end is not None:
            pair = None if second is None or window is None else (second, window)
            return results.TrackedStability._of(self, self._native.tracked_stability(tracked, (begin, end), pair))
        if exact:
            return results.ExactStability._of(self, self._native.stability(True))
        return results.Stability._of(self, self._native.stability(False))

    @keywords
    def simulate(
        self,
        until: Number | None = None,
        *,
        events: bool = True,
        samples: bool = True,
        start: Mapping[str, Any] | State | None = None,
        t_eval: npt.ArrayLike | None = None,
        sound: bool = False,
        transpose: Number | None = None,
        gain: Number | None = None,
    ) -> results.Simulation:
        """Simulates one trajectory with the exact time of every event at the contacts.

        Parameters
        ----------
        until :
            Time at the end: τ of a belt, 1/ω_ref of a disc; in a study in SI seconds, or a time with its unit such as ``"50ms"``
            [default: the last of ``t_eval``; else 100 periods of the slowest oscillation; of a disc, until a small motion has grown].
        events :
            Whether ``print`` lists every event. ``events`` has them in any case.
        samples :
            Whether to sample the trajectory over ``time`` (n,): observed displacement and velocity, every number of the state, and
            slip velocity, friction, load and phase of every contact. Sampling does not change the run.
        start :
            ``final`` of an earlier run, which this one continues at its time; numbers that replace those of the study's start, such as
            ``{"x": 0.1, "velocity.x": -2}``; of one coordinate (x, x′), of a belt also a dict with ``displacement``, ``velocity`` and, if
            the run does not begin at 0, ``time``; of a disc numbers that replace those of rest, such as ``{"A2": 0.1}`` [default: the
            start of the study; of a disc the leading small motion].
        t_eval :
            Times (n,) of the samples in ascending order, in the unit of ``until`` or with units, instead of equal steps. The values there are
            those of the Taylor polynomials of the steps, not interpolated. ``time`` of a disc is in 1/ω_ref, in SI too.
        sound :
            Whether to describe in ``sound`` the file that ``save("run.wav")`` writes: the velocity as sound.
        transpose :
            Factor of every frequency of that sound, which is then computed [default: 1, in SI real time, otherwise the angular
            frequency 1 at 110 Hz].
        gain :
            Fraction of full scale per unit of velocity, in a study in SI per m/s; the sound is then computed [default: the
            largest sample is 3 dB below full scale].
        """
        arguments = Arguments()
        given = plain(t_eval)
        of_texts = isinstance(given, list) and bool(given) and all(isinstance(it, str) for it in given)
        written = [arguments.text("t_eval", it, "times") for it in given] if of_texts else []
        times = None if given is None or of_texts else arguments.numbers("t_eval", given, "times: finite numbers")
        arguments.conflict(t_eval is not None and not samples, "given with samples=True", t_eval=None)
        if until is None and t_eval is not None:
            until = written[-1] if written else float(times[-1]) if times is not None and times.size else 0.0
        moments: list[float] | list[str] | None = written or (None if times is None else times.tolist())
        end = arguments.optional(arguments.quantity, "until", until, A_TIME)
        begin = arguments.optional(arguments.begin, "start", start, self._native.kind)
        factor = arguments.optional(arguments.quantity, "transpose", transpose, "a factor above 0, such as 0.5")
        level = arguments.optional(arguments.quantity, "gain", gain)
        arguments.done()
        texts = (factor, level) if sound or factor is not None or level is not None else None
        return results.Simulation._of(self, self._native.simulate(end, (bool(events), bool(samples)), begin, moments, texts))

    @overload
    def response(self, *, settle: Number | None = None, record: Number | None = None, window: None = None) -> results.Response: ...

    @overload
    def response(self, *, window: tuple[Number, Number]) -> results.Window: ...

    @overload
    def response(
        self, *, seeds: int, settle: Number | None = None, record: Number | None = None
    ) -> results.NoiseResponse: ...

    @keywords
    def response(
        self,
        *,
        settle: Number | None = None,
        record: Number | None = None,
        window: tuple[Number, Number] | None = None,
        seeds: int | None = None,
    ) -> results.Response | results.Window | results.NoiseResponse:
        """The steady response, the effect of the dither (``effect``; residual vibration E, equation (2.27)), and its cost.

        It is the response of ``observe`` in the band of slow vibration: of one mass up to 1.9 ω₀, of several below the lowest dither
        frequency.

        Parameters
        ----------
        settle, record :
            Time before the record and length of the record; in a study with units also a text such as ``"50ms"``
            [default: those of the ``solver``; of a system 200 and 60 periods of the slowest oscillation].
        window :
            Beginning and end of a part of the run from its start, which is measured instead of a steady response: also where drive,
            load or dither varies in time.
        seeds :
            Under noise: number of runs, each with another seed, of which the share that ends quiet is counted
            [default: 16].
        """
        arguments = Arguments()
        if window is not None:
            arguments.left_out("left out: window gives both times", settle=settle, record=record, seeds=seeds)
        count = arguments.optional(arguments.whole, "seeds", seeds, 1, 10_000)
        before = arguments.optional(arguments.quantity, "settle", settle, A_TIME)
        length = arguments.optional(arguments.quantity, "record", record, A_TIME)
        ends = arguments.optional(arguments.quantities, "window", window, "two finite times, the beginning and the end")
        arguments.done()
        answer = self._native.response(before, length, ends, count)
        if ends is not None:
            return results.Window._of(self, answer)
        if seeds is not None or self._native.is_noise():
            return results.NoiseResponse._of(self, answer)
        return results.Response._of(self, answer)

    @keywords
    def orbit(
        self,
        *,
        near: State | Mapping[str, Number] | None = None,
        periods: int = 1,
        from_rest: bool = False,
        from_sliding: bool = False,
        from_squeal: bool = False,
        start: State | Mapping[str, Number] | None = None,
    ) -> results.Orbit:
        """The periodic response to dither and its Floquet multipliers, through stick and slip; limit cycles without it.

        Parameters
        ----------
        near :
            State near which to search: (x, x′) of one mass, or numbers that replace those of the study's start, such as
            ``{"x": 0.1, "velocity.x": -2}``, in the units of the study or as texts with units [default: the base response,
            continued from steady sliding; where it does not exist the response that a run from the study's start reaches].
        periods :
            Number of common periods of the dithers in one period of the response.
        from_rest, from_sliding, from_squeal, start :
            At most one of them: finds the response, of any number of periods, on which a run from this start ends.
        """
        arguments = Arguments()
        state, begin = arguments.state("near", near), arguments.state("start", start)
        count = arguments.whole("periods", periods, 1, 1000)
        asked = flags(from_rest=from_rest, from_sliding=from_sliding, from_squeal=from_squeal)
        arguments.conflict(len(asked) + (start is not None) > 1, "one start alone", start=start)
        if asked or start is not None:
            arguments.left_out("given without a start: a run determines its response", near=near, periods=None if count == 1 else periods)
        arguments.done()
        return results.Orbit._of(self, self._native.orbit(state, count, asked[0] if asked else None, begin))

    @keywords
    def attractor(
        self,
        *,
        start: State | Mapping[str, Number] | None = None,
        lyapunov: bool = False,
        settle: Number | None = None,
        record: Number | None = None,
    ) -> results.Attractor:
        """The motion on which a run ends and, on request, its Lyapunov exponents.

        Parameters
        ----------
        start :
            (x, x′) of one mass, or numbers that replace those of the study's start, such as ``{"x": 0.1, "velocity.x": -2}``, in
            the units of the study or as texts with units [default: the start of the study].
        lyapunov :
            Whether to measure the exponents: mean rates at which small changes of the motion grow.
        settle, record :
            Time before the record of the exponents and its length; in a study with units also a text such as ``"50ms"``
            [default: 50 and 1000 periods of the slowest oscillation].
        """
        arguments = Arguments()
        before = arguments.optional(arguments.quantity, "settle", settle, A_TIME)
        length = arguments.optional(arguments.quantity, "record", record, A_TIME)
        if not lyapunov:
            arguments.left_out("given with lyapunov=True", settle=settle, record=record)
        begin = arguments.state("start", start)
        arguments.done()
        return results.Attractor._of(self, self._native.attractor(begin, (before, length) if lyapunov else None))

    @overload
    def thresholds(
        self,
        parameter: str = "dither.amplitude",
        from_: Number | None = None,
        to: Number | None = None,
        *,
        from_rest: bool = False,
        from_sliding: bool = False,
        from_squeal: bool = False,
        start: State | Mapping[str, Number] | None = None,
        ramp: Number = 0.0,
        near: State | Mapping[str, Number] | None = None,
        periods: int = 1,
    ) -> results.Thresholds: ...

    @overload
    def thresholds(
        self,
        parameter: str = "dither.amplitude",
        from_: Number | None = None,
        to: Number | None = None,
        *,
        along: str,
        between: State,
    ) -> results.ThresholdCurves: ...

    @keywords
    def thresholds(
        self,
        parameter: str = "dither.amplitude",
        from_: Number | None = None,
        to: Number | None = None,
        *,
        from_rest: bool = False,
        from_sliding: bool = False,
        from_squeal: bool = False,
        start: State | Mapping[str, Number] | None = None,
        ramp: Number = 0.0,
        along: str | None = None,
        between: State | None = None,
        near: State | Mapping[str, Number] | None = None,
        periods: int = 1,
    ) -> results.Thresholds | results.ThresholdCurves:
        """Exact values of a parameter at which dither starts or stops quenching, or their curves in two parameters.

        Without dither and without runs: the values at which steady sliding becomes stable or unstable, those of :meth:`stability`.

        Parameters
        ----------
        parameter :
            Path of a number of the equations, such as ``dither.amplitude``; in a study in SI also its key in SI,
            such as ``dither.amplitude_n``.
        from_, to :
            The range to search, in the unit of that key or as texts with units such as ``"5kN"`` (``--from``
            and ``--to`` on the command line) [default: of the amplitude of a dither from 0 to the limit of ``quench-amplitude``
            in maps, along a second parameter the largest].
        from_rest, from_sliding, from_squeal, start :
            Also find thresholds of runs from rest, from steady sliding, from full squeal, or from a state: (x, x′) of one mass, or
            numbers such as ``{"x": 0.1, "velocity.x": -2}`` that replace those of the study's start.
        ramp :
            Time over which the dither of these runs grows [default: it is switched on]: τ, in a study with units seconds.
        along, between :
            A second parameter, given like the first, and its range: each local threshold is continued as a curve.
        near, periods :
            A state near which the periodic motion to follow is searched at the first value, given like ``start``, and its
            number of dither periods [default: the base response].
        """
        arguments = Arguments()
        path = arguments.text("parameter", parameter, "path of a number, such as dither.amplitude")
        ends = (arguments.optional(arguments.quantity, "from_", from_), arguments.optional(arguments.quantity, "to", to))
        count = arguments.whole("periods", periods, 1, 1000)
        begin, motion = arguments.state("start", start), arguments.state("near", near)
        time = arguments.quantity("ramp", ramp, "a time ≥ 0")
        second = arguments.optional(arguments.text, "along", along, "path of a number, such as belt.belt_velocity")
        window = arguments.optional(arguments.quantities, "between", between, "two numbers, the second above the first")
        asked = flags(from_rest=from_rest, from_sliding=from_sliding, from_squeal=from_squeal)
        arguments.conflict((along is None) != (between is None), "given together with between", along=along)
        has_runs = bool(asked) or start is not None or time != repr(0.0)
        followed_twice = along is not None and (has_runs or near is not None)
        arguments.conflict(followed_twice, "given without near, starts and ramp", along=along)
        arguments.conflict(near is not None and has_runs, "given without starts and ramp", near=near)
        arguments.done()
        if second is not None and window is not None:
            return results.ThresholdCurves._of(self, self._native.threshold_curves(path, ends, second, window))
        followed = None if motion is None else (motion, count)
        return results.Thresholds._of(self, self._native.thresholds(path, ends, (asked, begin, time), followed))

    @overload
    def map(
        self,
        quantity: str | Iterable[str],
        axes: Axes | None = None,
        *,
        store: str | os.PathLike[str] | None = None,
        resume: bool = False,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        client: Client | None = None,
        shard: None = None,
    ) -> results.Map: ...

    @overload
    def map(
        self,
        quantity: str | Iterable[str],
        axes: Axes | None = None,
        *,
        store: str | os.PathLike[str],
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        shard: str,
    ) -> results.Shard: ...

    @keywords
    def map(
        self,
        quantity: str | Iterable[str],
        axes: Axes | None = None,
        *,
        store: str | os.PathLike[str] | None = None,
        resume: bool = False,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        client: Client | None = None,
        shard: str | None = None,
    ) -> results.Map | results.Shard:
        """Quantities over the axes of the study, on all cores, or on a cluster.

        Parameters
        ----------
        quantity :
            One or several names of :func:`quell.quantities`.
        axes :
            Axes that replace those of the study: :class:`Axis` objects, or a dict of paths and values.
        store :
            A Zarr store (a path that ends in .zarr) that keeps the map chunk by chunk.
        resume :
            Whether to continue an existing store.
        threads :
            Number of threads [default: all cores].
        progress :
            Called from time to time with (finished points, all points).
        client :
            A ``dask.distributed`` client: its workers compute the chunks into ``store``, which all of them must reach.
            A chunk of a lost worker is computed again; the result has the same bits as a local run.
        shard :
            One of several parts, such as "3/16", of a map that as many processes compute into ``store``, in any
            order; the result then reports what is left. ``resume=True`` without ``shard`` reads the whole map.

        Returns
        -------
        quell.results.Map
            Arrays over the axes, in their order. Unknown values are NaN, with the reason in ``NAME_status``.
        """
        arguments = Arguments()
        names = [quantity] if isinstance(quantity, str) else quantity
        if not isinstance(names, Iterable) or not (names := list(names)):
            arguments.wrong.append(complaint("quantity", quantity, "a name of quell.quantities(), or several"))
            names = []
        asked = [arguments.text("quantity", name, "a name of quell.quantities()") for name in names]
        place = arguments.optional(arguments.path, "store", store)
        if place is not None and not place.endswith(".zarr"):
            arguments.wrong.append(complaint("store", place, "a path that ends in .zarr"))
        arguments.conflict(resume and place is None, "given together with store", resume=resume)
        needs_store = "given together with store: every process keeps its chunks there"
        arguments.conflict(client is not None and place is None, needs_store, client="…")
        arguments.conflict(shard is not None and place is None, needs_store, shard="…")
        arguments.conflict(shard is not None and (resume or client is not None), "given without resume and client", shard=shard)
        part = arguments.optional(arguments.text, "shard", shard, "k/n, such as 3/16")
        count = arguments.optional(arguments.whole, "threads", threads, 1, 1024)
        arguments.done()
        study = self if axes is None else self.sweeping(axes)
        if part is not None and place is not None:
            from .cluster import compute_shard

            return compute_shard(study, asked, place, part, threads=count, progress=progress)
        if client is not None and place is not None:
            from .cluster import compute

            return compute(study, asked, place, client, resume=resume, progress=progress)
        return results.Map._of(study, study._native.map(asked, place, bool(resume), count, progress))

    @overload
    def bifurcation(
        self,
        parameter: str,
        from_: Number,
        to: Number,
        *,
        points: int = 101,
        up: bool = False,
        down: bool = False,
        ramp: Literal[False] = False,
        progress: Callable[[int, int], object] | None = None,
    ) -> results.Bifurcation: ...

    @overload
    def bifurcation(self, *, ramp: Literal[True]) -> results.Ramp: ...

    @keywords
    def bifurcation(
        self,
        parameter: str | None = None,
        from_: Number | None = None,
        to: Number | None = None,
        *,
        points: int = 101,
        up: bool = False,
        down: bool = False,
        ramp: bool = False,
        progress: Callable[[int, int], object] | None = None,
    ) -> results.Bifurcation | results.Ramp:
        """The response over a parameter, swept up and down with the state carried over.

        Without dither it is a limit cycle, steady sliding or rest.

        Parameters
        ----------
        parameter :
            Path of a number of the study, such as ``dither.amplitude``.
        from_, to, points :
            Smallest and largest value, in the unit of the key or as texts with units, and the number of values.
        up, down :
            Directions of the sweep [default: both]. A sweep down alone begins with the initial state of the study.
        ramp :
            Instead of a sweep, one run of the study as it varies in time, from its first knot to its last, compared with the
            exact thresholds.
        progress :
            Called from time to time with (finished values, all values).
        """
        arguments = Arguments()
        if ramp:
            arguments.left_out("left out: the study gives the ramp", parameter=parameter, from_=from_, to=to)
            arguments.done()
            return results.Ramp._of(self, self._native.ramp())
        path = arguments.text("parameter", parameter, "path of a number, such as dither.amplitude")
        ends = (arguments.quantity("from_", from_), arguments.quantity("to", to))
        count = arguments.whole("points", points, 0, 2**31)
        arguments.done()
        ways = (bool(up), bool(down))
        return results.Bifurcation._of(self, self._native.bifurcation(path, ends, count, ways, progress))

    @keywords
    def basins(
        self,
        *,
        displacement: State | None = None,
        velocity: State | None = None,
        plane: str | None = None,
        grid: tuple[int, int] | None = None,
        sample: int | None = None,
        seed: int | None = None,
        over: str | None = None,
        from_: Number | None = None,
        to: Number | None = None,
        points: int | None = None,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> results.Basins:
        """The responses on which starts in a window end, and the fraction of each, with its error.

        Parameters
        ----------
        displacement, velocity :
            Ranges of the first displacement and its velocity, in the units of the study or as texts with units [default: around steady
            sliding].
        plane :
            The two numbers of the state that are varied, such as ``"x,velocity.x"``, or with their windows
            ``"x=-1:1,velocity.x=-2:2"`` [default: the first displacement and its velocity].
        grid :
            Number of values of both numbers, including the edges [default: (41, 31); of several masses (21, 15)].
        sample, seed :
            Number of random states instead of a grid, and the seed of the generator [default: 1].
        over, from_, to, points :
            A parameter over which to compute the fractions, its range, and the number of values [default: 41].
        threads :
            Number of threads [default: all cores].
        progress :
            Called from time to time with (finished starts, all starts).
        """
        arguments = Arguments()
        two = "two numbers, the first below the second"
        across = arguments.optional(arguments.quantities, "displacement", displacement, two)
        window = (across, arguments.optional(arguments.quantities, "velocity", velocity, two))
        cells = arguments.pair("grid", (41, 31) if grid is None else grid, "two whole numbers, at least 2")
        sides = [
            arguments.whole("grid", int(side) if side == int(side) else side, 0, 10**7)
            for side in cells
            if np.isfinite(cells).all()
        ]
        states = arguments.optional(arguments.whole, "sample", sample, 0, 10**7)
        which = arguments.whole("seed", 1 if seed is None else seed, 0, 2**63 - 1)
        both = grid is not None and sample is not None
        arguments.conflict(both, "given without sample: it is in place of a grid", grid=grid)
        arguments.conflict(seed is not None and sample is None, "given together with sample: it says which states", seed=seed)
        count = arguments.whole("points", 41 if points is None else points, 0, 2**31)
        along = None
        if over is not None:
            path = arguments.text("over", over, "path of a number, such as dither.amplitude")
            along = (path, (arguments.quantity("from_", from_), arguments.quantity("to", to)), count)
        else:
            in_part = from_ is not None or to is not None or points is not None
            arguments.conflict(in_part, "given together with from_, to and points", over=None)
        workers = arguments.optional(arguments.whole, "threads", threads, 1, 1024)
        drawn = None if states is None else (states, which)
        text = arguments.optional(arguments.text, "plane", plane, "two names, such as x,velocity.x")
        both = plane is not None and (displacement is not None or velocity is not None)
        arguments.conflict(both, "given without displacement and velocity: windows are in the plane, such as x=-1:1", plane=plane)
        arguments.done()
        size = None if grid is None else (sides[0], sides[1])
        native = self._native.basins((text, window), (size, drawn), along, workers, progress)
        return results.Basins._of(self, native)

    @keywords
    def waveforms(self) -> results.Waveforms:
        """The least dither of each waveform that quenches, exactly and by averaging, and its cost.

        Sine, triangle, square, the waveform of the study, and bursts of the study's carrier, at the direction and the frequency of
        the study's first dither. Power, stroke and velocity are those of the structure without friction under that dither. System:
        sine, triangle, square and harmonics, with the stroke and the power of the driven point of the sliding structure.

        Returns
        -------
        quell.results.Waveforms
            Least amplitude, rms force, power, stroke, velocity and exact amplitude over the waveforms (n,).
        """
        return results.Waveforms._of(self, self._native.waveforms())

    @keywords
    def design(self) -> results.Design:
        """The least dither that is quiet over a range of operating points, as the table ``[design]`` asks.

        Returns
        -------
        quell.results.Design
            The exact least dither, that of averaging, what decides it, and its verification.
        """
        return results.Design._of(self, self._native.design())

    @keywords
    def actuator(self, *, frequency: State | None = None) -> results.Actuator:
        """Where over frequency the actuator of the study can give the dither that quenches; of a belt or a system.

        Parameters
        ----------
        frequency :
            Range of dither frequencies: angular frequencies in the units of the study, of a belt without units R, or as
            texts with units such as ``("5kHz", "40kHz")`` [default: that of a measured actuator, or from a tenth, but
            above the vibration, to 10 times the frequency of the dither].

        Returns
        -------
        quell.results.Actuator
            The largest amplitude that the actuator can give and the least that quenches, over the frequency (n,).
        """
        arguments = Arguments()
        two = "two frequencies, the first below the second"
        given = arguments.optional(arguments.quantities, "frequency", frequency, two)
        arguments.done()
        return results.Actuator._of(self, self._native.actuator(given))

    @keywords
    def probability(
        self,
        *,
        start: Literal["averaged", "local", "rest", "squeal"] = "averaged",
        samples: int | None = None,
        seed: int = 1,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> results.Probability:
        """How probable it is that a study with uncertain numbers vibrates, from random samples of its table ``[uncertainty]``.

        Parameters
        ----------
        start :
            What decides whether a sample vibrates: averaging, "local" (the multipliers of the base response), or the end of the run
            from "rest" or from the undithered limit cycle ("squeal").
        samples :
            Number of samples [default: 100000, of exact motions 1000].
        seed :
            Seed of the random numbers.
        threads :
            Number of threads [default: all cores].
        progress :
            Called from time to time with (finished samples, all samples).

        Returns
        -------
        quell.results.Probability
            The probability with its 95 % interval, quantiles of the growth rate and Sobol indices.
        """
        arguments = Arguments()
        count = arguments.optional(arguments.whole, "samples", samples, 1, 10**7)
        chosen = arguments.whole("seed", seed, 0, 2**63 - 1)
        workers = arguments.optional(arguments.whole, "threads", threads, 1, 1024)
        if not isinstance(start, str):
            arguments.wrong.append(complaint("start", start, "one of averaged, local, rest, squeal"))
        arguments.done()
        native = self._native.probability(start, count, chosen, workers, progress)
        return results.Probability._of(self, native)

    @keywords
    def compare(
        self,
        measured: str | os.PathLike[str],
        *,
        after: str | os.PathLike[str] | None = None,
        column: str | None = None,
        quantity: str | None = None,
        gain: float | None = None,
        window: tuple[float, float] | None = None,
        columns: Mapping[str, str] | None = None,
        settle: float | str | None = None,
    ) -> results.Comparison:
        """Compares a measured record or spectrum with the response of the study, before and after its dither.

        Parameters
        ----------
        measured :
            CSV, LabVIEW or MATLAB file with ``time`` (or ``time_s``) and ``displacement``, ``velocity`` or ``acceleration``, or with ``frequency_hz`` and
            ``level``; with ``after`` it is without dither.
        after :
            File measured under dither.
        column, quantity, gain, window, columns :
            How the files are read, as in :func:`quell.fit_decay`.
        settle :
            Time before the computed record, in the units of the study or with a unit [default: 200 periods].

        Returns
        -------
        quell.results.Comparison
            Lines and levels of both spectra, and the reduction by the dither in decibels.
        """
        arguments = Arguments()
        first = arguments.path("measured", measured)
        second = arguments.optional(arguments.path, "after", after)
        time = arguments.optional(arguments.quantity, "settle", settle)
        texts = record_of(arguments, column, quantity, gain, window, columns)
        arguments.done()
        return results.Comparison._of(self, self._native.compare((first, second), time, texts))

    @keywords
    def fit_record(
        self,
        data: str | os.PathLike[str],
        *,
        free: str | list[str],
        fix: str | list[str] | None = None,
        settle: float | str | None = None,
        column: str | None = None,
        quantity: str | None = None,
        gain: float | None = None,
        window: tuple[float, float] | None = None,
        columns: Mapping[str, str] | None = None,
    ) -> results.RecordFit:
        """Fits numbers of the study to a measured record, by its exact motion.

        Parameters
        ----------
        data :
            CSV, LabVIEW or MATLAB file with ``time`` (or ``time_s``) and ``displacement``, ``velocity`` or ``acceleration``.
        free :
            Paths of the numbers to estimate, such as "belt.damping_ratio", or with a start "belt.damping_ratio=0.01"; also
            "record.shift", "record.offset" and "record.gain".
        fix :
            Other numbers of the study, such as "belt.belt_velocity=0.1".
        settle :
            Time from the start of the run to the record [default: 0, with a free "record.shift" 30 periods].
        column, quantity, gain, window, columns :
            How the file is read, as in :func:`quell.fit_decay`.

        Returns
        -------
        quell.results.RecordFit
            Estimates with standard errors and covariance, combinations that the record does not determine, and arrays over the samples.
        """
        arguments = Arguments()
        place = arguments.path("data", data)
        freed, fixed = names_of(arguments, "free", free), names_of(arguments, "fix", fix)
        time = arguments.optional(arguments.quantity, "settle", settle)
        texts = record_of(arguments, column, quantity, gain, window, columns)
        arguments.done()
        return results.RecordFit._of(self, self._native.fit_record((place, freed, fixed), time, texts))
