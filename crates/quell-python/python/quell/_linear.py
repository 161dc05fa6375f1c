"""The verbs of a study about its structure: natural motions, and what forces and dithers do to it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from . import results
from ._arguments import Arguments, keywords
from ._checked import CheckedStudy
from ._record import names_of
from ._tables import Number
from ._values import plain

__all__ = ["LinearVerbs", "State"]

State = tuple[Number, Number]
"""Two numbers: displacement and velocity, or the ends of a range."""


class LinearVerbs(CheckedStudy):
    """The verbs about the structure of a study."""

    def modes(self) -> results.Modes:
        """Natural frequencies and shapes of a belt, a disc or a system, and critical speeds of a disc."""
        return results.Modes._of(self, self._native.modes())

    @keywords
    def receptance(
        self,
        *,
        outputs: str | Iterable[str] = (),
        inputs: str | Iterable[str] = (),
        contacts: Literal["sliding", "springs", "none"] = "sliding",
        frequency: State | None = None,
        points: int | None = None,
        at: Iterable[Number] | None = None,
    ) -> results.Receptance:
        """Receptances of a belt or a system, displacement over force between rows, over frequency.

        Parameters
        ----------
        outputs, inputs :
            Names of the rows whose displacements are asked, and along which forces act: coordinates, points of modes,
            ``"CONTACT.tangent"``, ``"CONTACT.normal"`` [default: those of the contacts].
        contacts :
            "sliding": with friction carried along, under dither averaged; "springs": without friction; "none": the structure alone.
        frequency :
            Range of angular frequencies, or of texts with units such as ``"2kHz"`` [default: from rest beyond the fastest motion].
        points :
            Number of frequencies at equal distances [default: 401, and more around each resonance].
        at :
            Frequencies that are asked alone, ascending, in place of a range.

        Returns
        -------
        quell.results.Receptance
            Complex receptances over output, input and frequency; :meth:`~quell.results.Receptance.to_universal_file` writes them.

        Examples
        --------
        >>> belt = quell.Belt(
        ...     damping_ratio=0.05, normal_load=1.0, belt_velocity=0.05, friction=quell.Coulomb(coefficient=0.4)
        ... )
        >>> found = belt.receptance(frequency=(0.0, 2.0), points=3)
        >>> print(abs(found.receptance[0, 0]).round(3))
        [ 1.    10.     0.333]
        """
        arguments = Arguments()
        rows = (names_of(arguments, "outputs", outputs), names_of(arguments, "inputs", inputs))
        what = arguments.text("contacts", contacts, '"sliding", "springs" or "none"')
        within = arguments.optional(arguments.quantities, "frequency", frequency, "two finite numbers")
        count = None if points is None else arguments.whole("points", points, 2, 5_000_000)
        listed = [arguments.quantity("at", one) for one in ([] if at is None else plain(at))]
        arguments.done()
        return results.Receptance._of(self, self._native.receptance(rows, what, (within, count, listed)))

    @keywords
    def resonances(
        self,
        *,
        speeds: State | None = None,
        order: Literal["first", "second"] = "first",
        clear: State | None = None,
        frequency: State | None = None,
    ) -> results.Resonances:
        """Speeds at which waves of a disc meet, the meetings that can be unstable, and clear dither frequencies.

        Belt or system: the slip at each contact per unit of each dither, over the dither frequency.

        Parameters
        ----------
        speeds :
            Disc: range of speeds in which meetings are listed, in ω_ref, or as texts with units such as ``"900rpm"`` [default: 0
            to 1 ω_ref]. If a load is given in SI, plain numbers are in Hz.
        order :
            Disc: order of the theory in the friction, "first" or "second".
        clear :
            Disc: a range of speeds that the dither should keep clear.
        frequency :
            Disc: the range of dither frequencies R to search, with ``clear``. System: the range of angular frequencies, or of
            texts with units such as ``"2kHz"`` [default: 0.1 to 10 times that of the dither].
        """
        arguments = Arguments()
        two = "two finite numbers"
        ranges = arguments.optional(arguments.quantities, "speeds", speeds, two)
        wanted = arguments.optional(arguments.quantities, "clear", clear, two)
        within = arguments.optional(arguments.quantities, "frequency", frequency, two)
        how_far = arguments.text("order", order, '"first" or "second"')
        arguments.done()
        return results.Resonances._of(self, self._native.resonances(ranges, how_far, wanted, within))
