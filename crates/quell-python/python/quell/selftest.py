"""``python -m quell.selftest``: compares an installation with reference numbers, in a few seconds.

The numbers were computed by programs written independently of Quell and confirmed by a second method. The tolerances are
those of the project's tests. Only NumPy is needed.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import quell
from quell import _quell

__all__ = ["Outcome", "main", "run"]


class Outcome(NamedTuple):
    """The outcome of a check."""

    name: str
    """Name of the check."""
    compared: int
    """Number of compared values."""
    worst: float
    """Largest deviation, as a fraction of the allowed one."""
    failures: list[str]
    """Descriptions of the deviations."""
    seconds: float
    """Duration in seconds."""


class Sheet:
    """Compares numbers."""

    def __init__(self) -> None:
        self.compared, self.worst = 0, 0.0
        self.failures: list[str] = []

    def number(self, what: str, found: float, wanted: float, allowed: float) -> None:
        """Requires ``found`` to be within ``allowed`` of ``wanted``."""
        share = abs(found - wanted) / allowed
        self.compared += 1
        self.worst = max(self.worst, share)
        if not share <= 1.0:
            self.failures.append(f"{what}: {found!r}, reference {wanted!r}, allowed ±{allowed:g}")

    def same(self, what: str, found: object, wanted: object) -> None:
        """Requires the same word or count."""
        self.compared += 1
        if found != wanted:
            self.failures.append(f"{what}: {found!r}, reference {wanted!r}")


def reference(name: str) -> Any:
    """A file of reference numbers."""
    text = _quell.reference(name)
    if text is None:
        raise LookupError(name)
    return json.loads(text)


def trajectories(sheet: Sheet) -> None:
    """Event times, kinds and states: within 1e-9, no event missing, no event added."""
    kinds = {"stick_start": "stick", "stick_end": "release"}
    for case in reference("trajectories")["cases"]:
        p = {name: float(value) for name, value in case["params"].items()}
        belt = quell.Belt(
            damping_ratio=p["zeta"],
            normal_load=p["F"],
            belt_velocity=p["v0"],
            friction=quell.Friction(
                case["law"],
                static_coefficient=p["mu_s"],
                minimum_coefficient=p["mu_m"],
                reference_velocity=p["v_m"],
            ),
            dither=[
                quell.Dither("tangential", case["wave_T"], amplitude=p["D_T"], frequency_ratio=p["R_T"]),
                quell.Dither("normal", case["wave_N"], amplitude=p["D_N"], frequency_ratio=p["R_N"]),
            ],
            initial=(float(case["x0"]), float(case["xdot0"])),
        )
        run = belt.simulate(50.0, samples=False)
        name = case["name"]
        sheet.same(f"{name}, events", run.event_count, case["n_events_to_50"])
        sheet.same(f"{name}, sticking", run.final["contacts"][0]["sticking"], case["sticking_at_50"])
        for event, wanted in zip(run.events, case["first_events"]):  # noqa: B905  the reference has only the first events
            sheet.same(f"{name}, kind", event["kind"], kinds.get(wanted["type"], "reversal"))
            sheet.number(f"{name}, time", event["time"], float(wanted["t"]), 1e-9)
            sheet.number(f"{name}, place", event["displacement"], float(wanted["x"]), 1e-9)
        end = case["state_at_50"]
        sheet.number(f"{name}, x(50)", run.final["displacement"], float(end["x"]), 1e-9)
        sheet.number(f"{name}, x′(50)", run.final["velocity"], float(end["xdot"]), 1e-9)


def averages(sheet: Sheet) -> None:
    """Effective friction to 1e-11 and its slope to 1e-9, relative; 1e-14 where they are zero."""
    for it in reference("averaging")["tangential"]:
        if it.get("at_corner"):
            continue  # a product of two rounded numbers need not equal the corner
        alpha, v = it["alpha_over_vm"] * 0.2, it["vr_over_vm"] * 0.2
        curve = belt_of(it["law"], it["wave"], alpha).friction([v]).arrays
        wanted, slope = float(it["mubar"]), float(it["dmubar"])
        name = f"{it['law']}, {it['wave']}, α = {alpha:g}, v = {v:g}"
        found = float(curve["limit_effective_coefficient"].values[0])
        sheet.number(f"{name}, μ̄", found, wanted, max(1e-11 * abs(wanted), 1e-14))
        found = float(curve["limit_effective_slope"].values[0])
        sheet.number(f"{name}, μ̄′", found, slope, max(1e-9 * abs(slope), 1e-14))


def belt_of(law: str, wave: str, alpha: float) -> quell.Belt:
    """A belt under dither of this α; R is a power of two, so that D/R equals α exactly."""
    return quell.Belt(
        damping_ratio=0.0,
        normal_load=1.0,
        belt_velocity=0.2,
        friction=quell.Friction(
            law, static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2
        ),
        dither=quell.Dither("tangential", wave, amplitude=16.0 * alpha, frequency_ratio=16.0),  # type: ignore[arg-type]
    )


def disc_of(model: Any, point: Any, strengths: tuple[float, float, float], dither: quell.Dither | None) -> quell.Disc:
    """The disc of a reference point, with listed modes."""
    modes = zip(model["beta"], model["q"], model["phi_r0"], strict=True)
    mass, damping, stiffness = strengths
    parts = ["circulatory-damping"] if point.get("damp") == "diag" else None
    return quell.Disc(
        mode=[
            quell.Mode(diameters=int(q), ratio=float(beta), shape_at_load=float(shape), damping=float(point["xi"]))
            for beta, q, shape in modes
        ],
        load=quell.Load(
            mass=mass,
            damping=damping,
            stiffness=stiffness,
            friction=float(point["f"]),
            speed=float(point["Omega"]),
        ),
        dither=dither,
        without=parts,
    )


def discs(sheet: Sheet) -> None:
    """Growth rates of discs: 1e-12 without dither, 1e-9 with it, and within the reported bound."""
    eigenvalues = reference("disc_eigenvalues")
    for point in eigenvalues["points"]:
        strengths = tuple(float(point[name]) for name in ("m", "c", "k"))
        found = disc_of(eigenvalues["models"][point["model"]], point, strengths, None).stability()  # type: ignore[arg-type]
        wanted = float(point["max_re"])
        sheet.number(f"disc {point['model']}, Ω = {point['Omega']}", found.facts["growth_rate"], wanted, 1e-12)
    for point in reference("disc_floquet")["points"]:
        dither = quell.Dither(
            point["dither"], "sine", amplitude=float(point["alpha"]), frequency_ratio=float(point["R"])
        )
        strength = float(point["m=c=k"])
        model = eigenvalues["models"][point["model"]]
        disc = disc_of(model, point, (strength, strength, strength), dither)
        # A map of one point computes only the growth rate, without the frictions at which its sign changes.
        growth = disc.map("growth", {"disc.load.speed": [float(point["Omega"])]}, threads=1)
        name = f"disc {point['model']}, {point['dither']} dither, Ω = {point['Omega']}"
        sheet.number(name, float(growth.arrays["growth"].values[0]), float(point["max_re_exponent"]), 1e-9)


def plates(sheet: Sheet) -> None:
    """Frequency parameters of annular plates, to 1e-12."""
    for ratio, modes in reference("disc_modes")["plates"].items():
        disc = quell.Disc(inner_radius_ratio=float(ratio), poisson_ratio=0.3, radial_modes=4, nodal_diameters=5)
        found = {(row["radial"], row["diameters"]): row["frequency_parameter"] for row in disc.modes().modes}
        for mode in modes:
            key = (mode["m"] + 1, mode["n"])
            if key in found:
                wanted = float(mode["k2"])
                sheet.number(f"plate b/a = {ratio}, mode {key}", found[key], wanted, 1e-12 * wanted)


def thresholds(sheet: Sheet) -> None:
    """The amplitude from which the response to dither is stable, to 1e-6."""
    for case in reference("quench_thresholds")["cases"][:1]:
        minimum = 0.2857
        belt = quell.Belt(
            damping_ratio=0.005,
            normal_load=1.0,
            belt_velocity=case["belt_velocity"],
            friction=quell.Friction(
                case["law"], static_coefficient=0.4, minimum_coefficient=minimum, reference_velocity=0.2
            ),
            dither=quell.Dither(
                "tangential", case["waveform"], amplitude=0.1, frequency_ratio=case["frequency_ratio"]
            ),
        )
        wanted = case["D_period1_stable_from"]
        local = belt.thresholds("dither.amplitude", 0.9 * wanted, 1.1 * wanted).local
        nearest = min((abs(it["value"] - wanted), it["value"]) for it in local)[1] if local else float("nan")
        sheet.number(f"threshold at v₀ = {case['belt_velocity']}", nearest, wanted, 1e-6)


CHECKS: dict[str, Callable[[Sheet], None]] = {
    "trajectories with their events": trajectories,
    "effective friction": averages,
    "growth rates of discs": discs,
    "modes of annular plates": plates,
    "exact thresholds": thresholds,
}


def run() -> Iterator[Outcome]:
    """Runs every check."""
    for name, check in CHECKS.items():
        begun, sheet = time.perf_counter(), Sheet()
        try:
            check(sheet)
        except quell.QuellError as why:
            sheet.failures.append(str(why))
        yield Outcome(name, sheet.compared, sheet.worst, sheet.failures, time.perf_counter() - begun)


def main() -> int:
    """Runs every check and prints the outcomes; returns 0 if all passed."""
    print(f"quell {quell.__version__}, Python {sys.version.split()[0]}, {sys.platform}")
    outcomes = []
    for outcome in run():
        outcomes.append(outcome)
        word = "FAILED" if outcome.failures else "ok"
        print(
            f"  {outcome.name:<32} {outcome.compared:>5} numbers, worst {outcome.worst:.2f} of what is allowed, "
            f"{outcome.seconds:5.2f} s  {word}"
        )
        for failure in outcome.failures[:5]:
            print(f"      {failure}")
    failed = sum(bool(outcome.failures) for outcome in outcomes)
    seconds = sum(outcome.seconds for outcome in outcomes)
    print(f"{'FAILED' if failed else 'passed'} in {seconds:.1f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
