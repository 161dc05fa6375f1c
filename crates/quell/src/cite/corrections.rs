//! Where the print is wrong, and for which belts that matters.

use quell_model::{Belt, Direction, LawKind, Waveform};

use super::{Task, has};

/// A place where the print was corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Correction {
    /// Equations of the dissertation.
    pub equations: &'static str,
    /// What it should be.
    pub right: &'static str,
    /// The computations concerned.
    pub tasks: &'static [Task],
}

/// Corrections that bear on a belt.
pub(super) fn corrections(belt: &Belt) -> Vec<Correction> {
    use Direction::{Normal, Tangential};
    use Waveform::{Sine, Square, Triangle};
    const BOTH: &[Task] = &[Task::Friction, Task::Stability];
    const STABILITY: &[Task] = &[Task::Stability];
    let stribeck = belt.friction().kind() == LawKind::Stribeck;
    let decreasing = belt.friction().kind() == LawKind::Decreasing;
    let with = |direction, waveform| has(belt, direction, Some(waveform));
    let (tangential, normal) = (has(belt, Tangential, None), has(belt, Normal, None));
    let entries: [(bool, &'static str, &'static str, &'static [Task]); 13] = [
        (
            tangential,
            "(2.21), (3.19)",
            "the effective friction is ⟨μ(v_r − αG)⟩: x′ = Z′ + αG; the printed + is forgiven by \
             antiperiodic waveforms only",
            BOTH,
        ),
        (tangential, "text after (3.25)", "G is even, not odd: τ₂ = 2π − τ₁ needs it", BOTH),
        (
            decreasing && with(Tangential, Triangle),
            "(3.38a), (B.4), (B.10a)",
            "the erf terms inside carry e^{γ−w}, not e^{−w−γ}",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Triangle),
            "(B.3), (B.5)",
            "the prefactor is exp(v_r/v_m − πα/(4v_m))",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Triangle),
            "(3.53a)",
            "first exponent −1/2; second term with 1/(2√(γ−w)), twice; erf terms with e^{γ−w}",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Square),
            "(3.36a)",
            "|v_r| inside the bracket: for v_r < 0 the print counts the sign twice",
            BOTH,
        ),
        (
            stribeck && with(Tangential, Sine),
            "(3.44), (4.34)",
            "stable at every belt speed from v_m √((2/3)(1 − κ)) on, without the nested root",
            STABILITY,
        ),
        (
            stribeck && with(Tangential, Triangle),
            "(3.45)–(3.47), (4.35)",
            "3⟨G²⟩ = π²/10 and ⟨G²⟩ = π²/30 instead of π²/16 and π²/48",
            BOTH,
        ),
        (
            stribeck && with(Tangential, Triangle),
            "(3.48), (4.36)",
            "(v_m/π) √((240/23)(1 − κ)) instead of (2/π) v_m √(3 − 4v_mζ/(FΔμ))",
            STABILITY,
        ),
        (
            stribeck && with(Normal, Square),
            "(4.38)",
            "1/π instead of 2/π: the print is twice too large",
            STABILITY,
        ),
        (
            normal,
            "(4.32)",
            "φ′ stays frozen in the derivative: 2ζ + F⟨μ′(v₀ − φ′)⟩; the total derivative that the \
             text describes is wrong",
            STABILITY,
        ),
        (
            normal,
            "(4.34), (4.36), (4.38), (4.40), (4.42)",
            "they hold μ(v₀) and so are not valid at any belt speed until μ is taken at v₀ = α^L G_max",
            STABILITY,
        ),
        (
            true,
            "(2.27)",
            "the record is not stated: here a settling time is discarded, the mean removed, a Hann \
             window applied; E is undefined where the undithered run settles to steady sliding",
            &[Task::Response],
        ),
    ];
    entries
        .into_iter()
        .filter(|(applies, ..)| *applies)
        .map(|(_, equations, right, tasks)| Correction { equations, right, tasks })
        .collect()
}
