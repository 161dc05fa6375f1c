//! Errors of the printed text: the list behind `quell cite`, the report of `quell reproduce` and the errata of the book.
//!
//! Here |v_r| ≤ αG_max is "inside"; γ = πα/(4v_m), w = |v_r|/v_m, κ = 4v_mζ/(3FΔμ), Δμ = μ_s − μ_m.
//!
//! Each entry that enters a computation names the test that computes the printed and the correct form and compares both with the
//! definition.

use quell_model::{Direction, LawKind};

use super::citation::Task;
use super::correction::{Bears, Correction, DiscKind, Proof};

const STABILITY: &[Task] = &[Task::Stability];
const AVERAGING: &[Task] = &[Task::Friction, Task::Stability];
const RESPONSE: &[Task] = &[Task::Response];
const MODES: &[Task] = &[Task::Modes];
const RESONANCES: &[Task] = &[Task::Resonances];
const MOTION: &[Task] = &[Task::Stability, Task::Resonances];

/// Belts with tangential dither.
const TANGENTIAL: Bears =
    Bears::Belt { law: None, direction: Some(Direction::Tangential), waveform: None };
/// Belts with normal dither.
const NORMAL: Bears = Bears::Belt { law: None, direction: Some(Direction::Normal), waveform: None };
/// Every belt.
const BELT: Bears = Bears::Belt { law: None, direction: None, waveform: None };

/// Belts with this law under tangential dither of this waveform.
const fn under(law: LawKind, waveform: &'static str) -> Bears {
    Bears::Belt { law: Some(law), direction: Some(Direction::Tangential), waveform: Some(waveform) }
}

/// Belts with this law.
const fn with(law: LawKind) -> Bears {
    Bears::Belt { law: Some(law), direction: None, waveform: None }
}

/// A test of the belt's averages.
const fn belt(name: &'static str) -> Proof {
    Proof::Test { file: "crates/quell-dynamics/tests/averaging_errata.rs", name }
}

/// A test of the motion of the belt.
const fn motion(name: &'static str) -> Proof {
    Proof::Test { file: "crates/quell-dynamics/tests/motion_errata.rs", name }
}

/// A test of the disc.
const fn disc(name: &'static str) -> Proof {
    Proof::Test { file: "crates/quell-disc/tests/errata.rs", name }
}

/// Every correction, in the order of the dissertation.
pub const CORRECTIONS: &[Correction] = &[
    Correction {
        equations: "text of figures 2.2, 4.2",
        printed: "μ_m = 0.2587",
        right: "μ_m = 0.2857: with the printed number the undithered belt would oscillate at 0.5925 ω₀ instead of 0.6544 ω₀",
        tasks: &[],
        bears: with(LawKind::Stribeck),
        proof: motion("minimum_coefficient"),
    },
    Correction {
        equations: "text before figure 2.3",
        printed: "a lower frequency ratio reduces the steady amplitude further",
        right: "true of E at constant D, figure 2.8; the forced part alone is D/(R² − 1), which grows as R falls",
        tasks: &[],
        bears: TANGENTIAL,
        proof: motion("forced_amplitude_grows_as_the_ratio_falls"),
    },
    Correction {
        equations: "(2.22), (3.19)",
        printed: "μ̄(v_r) = ⟨μ(v_r + αG)⟩, v_r the slip velocity",
        right: "as (2.21), (3.18) use it the argument is Ż − v₀, and it is exact; of the slip v₀ − Ż it is ⟨μ(v_r − αG)⟩, which \
                antiperiodic waveforms alone forgive",
        tasks: AVERAGING,
        bears: TANGENTIAL,
        proof: belt("sign_of_the_fast_motion"),
    },
    Correction {
        equations: "(2.27)",
        printed: "E = M₁/M₀, no record stated",
        right: "a settling time is discarded, the mean removed, a Hann window applied; with the mean left in, E is the ratio of the mean \
                displacements, above 1 in every case tried; E is undefined where the undithered run settles to steady sliding",
        tasks: RESPONSE,
        bears: BELT,
        proof: motion("efficiency_needs_the_mean_removed"),
    },
    Correction {
        equations: "text of figures 2.7, 2.10, and after (3.60)",
        printed: "decreasing law, v₀ > v₂: the undithered system is stable",
        right: "only locally: a stick-slip cycle coexists with stable sliding far above v₂",
        tasks: STABILITY,
        bears: with(LawKind::Decreasing),
        proof: motion("a_cycle_coexists_with_stable_sliding"),
    },
    Correction {
        equations: "text of figure 2.10",
        printed: "stable again from α = 0.98 at v₀ = 1",
        right: "α = v₀ exactly, by a jump of the criterion; 0.98 is a central difference with the step v_m/10 across the corner",
        tasks: STABILITY,
        bears: under(LawKind::Decreasing, "sine"),
        proof: belt("quench_amplitude_is_a_jump"),
    },
    Correction {
        equations: "caption of figure 2.11",
        printed: "v₀ = 1.0",
        right: "v₀ = 1.5, as its text says: from rest D = 6.5 settles and 14 does not, at v₀ = 1.0 it is the reverse",
        tasks: &[],
        bears: Bears::Nothing,
        proof: motion("figure_2_11_is_at_one_and_a_half"),
    },
    Correction {
        equations: "(3.9), (3.10), (3.15), (4.18)",
        printed: "brackets and factors in the wrong place",
        right: "(3.9) goes into (3.1); the brace of (3.10) closes behind F; (3.15) lacks α_T in its 2ζ term and a + before O(); in (4.18) \
                α_N(μ − (εφ₁′ + ε²φ₂′)μ′)",
        tasks: &[],
        bears: Bears::Nothing,
        proof: Proof::Reading,
    },
    Correction {
        equations: "text after (3.25)",
        printed: "G is odd",
        right: "G is even: τ₂ = 2π − τ₁ needs it; the second interval of (3.25) is [Rτ₂, 2π]",
        tasks: AVERAGING,
        bears: TANGENTIAL,
        proof: belt("integral_of_a_waveform_is_even"),
    },
    Correction {
        equations: "(3.36a)",
        printed: "sgn(v_r)[… v_r …] for v_r < 0",
        right: "|v_r| inside the bracket: the print counts the sign twice",
        tasks: AVERAGING,
        bears: under(LawKind::Decreasing, "square"),
        proof: belt("sign_for_negative_slip"),
    },
    Correction {
        equations: "(3.38a), (B.10a)",
        printed: "e^{−w−γ}[erf √γ − erf √(γ−w)]",
        right: "e^{γ−w}[erf √γ − erf √(γ−w)]; the printed curve does not even meet (3.38b) at v_r = πα/4",
        tasks: AVERAGING,
        bears: under(LawKind::Decreasing, "triangle"),
        proof: belt("effective_decreasing_triangle"),
    },
    Correction {
        equations: "text after (3.41)",
        printed: "μ̄′ ≥ 0 inside |v_r| ≤ αG_max (of triangle and square it is said for the chosen values only)",
        right: "for Stribeck only up to (μ_s − μ_m)/μ_s = √6/π (sine), √0.4 (triangle), 1 (square)",
        tasks: STABILITY,
        bears: with(LawKind::Stribeck),
        proof: belt("slope_inside_can_be_negative"),
    },
    Correction {
        equations: "(3.44), (4.34)",
        printed: "α^L = v_m √((2/3)√(1 − κ))",
        right: "α^L = v_m √(2/3) √(1 − κ): the second root is not inside the first (probably a brace lost in the optical reading)",
        tasks: STABILITY,
        bears: under(LawKind::Stribeck, "sine"),
        proof: belt("everywhere_stable_amplitudes"),
    },
    Correction {
        equations: "(3.45a), (3.45b)",
        printed: "π²/16",
        right: "3⟨G²⟩ = π²/10",
        tasks: AVERAGING,
        bears: under(LawKind::Stribeck, "triangle"),
        proof: belt("slope_stribeck_triangle"),
    },
    Correction {
        equations: "(3.46), (3.47), (4.35)",
        printed: "π²/48",
        right: "⟨G²⟩ = π²/30",
        tasks: STABILITY,
        bears: under(LawKind::Stribeck, "triangle"),
        proof: belt("upper_edge_stribeck_triangle"),
    },
    Correction {
        equations: "(3.48), (4.36)",
        printed: "(2/π) v_m √(3 − 4v_mζ/(FΔμ))",
        right: "(v_m/π) √((240/23)(1 − κ))",
        tasks: STABILITY,
        bears: under(LawKind::Stribeck, "triangle"),
        proof: belt("everywhere_stable_amplitudes"),
    },
    Correction {
        equations: "(3.53a)",
        printed: "first exponent +1/2; second term without 1/(2√(γ−w)); erf terms of (3.38a)",
        right: "first exponent −1/2; second term with 1/(2√(γ−w)), twice; erf terms with e^{γ−w}",
        tasks: AVERAGING,
        bears: under(LawKind::Decreasing, "triangle"),
        proof: belt("slope_decreasing_triangle"),
    },
    Correction {
        equations: "before (3.50), C.7; (3.58), (3.63), chapter 4",
        printed: "“triangular” for the square; equation numbers used twice or shifted by some",
        right: "“square”; chapter 4 cites (3.43), (3.47), (3.51), (3.55), (3.59) under other numbers",
        tasks: &[],
        bears: Bears::Nothing,
        proof: Proof::Reading,
    },
    Correction {
        equations: "text after (4.15)",
        printed: "(4.15) cannot be solved exactly",
        right: "it separates, dw/μ(V − w) = α_N g dθ: for the decreasing law in closed form",
        tasks: AVERAGING,
        bears: NORMAL,
        proof: belt("fast_motion_under_normal_dither_separates"),
    },
    Correction {
        equations: "(4.24), (4.28), (4.32)",
        printed: "2ζ + F dμ̄/dv_r, φ′ varying with v_r",
        right: "2ζ + F⟨μ′(v₀ − φ′)⟩ with φ′ frozen, right up to α_N²; the limit R → ∞ is 2ζ + ⟨(μ′/μ)(2ζφ′ + Z)⟩; the total \
                derivative is 16 % off, because (4.24) drops the large load on the next order of the velocity",
        tasks: STABILITY,
        bears: NORMAL,
        proof: belt("fast_motion_stays_frozen_in_the_slope"),
    },
    Correction {
        equations: "(4.24)",
        printed: "the load α_N R g meets the fast velocity φ′ alone",
        right: "it meets the next order of the velocity too, −α_N⟨gμ′p⟩, a term of order one: the criterion for R → ∞ is \
                2ζ + ⟨(μ′/μ)(2ζφ′ + Z)⟩",
        tasks: STABILITY,
        bears: NORMAL,
        proof: belt("limit_of_high_frequency_under_normal_dither"),
    },
    Correction {
        equations: "(4.34), (4.36), (4.38), (4.40), (4.42)",
        printed: "stable at any belt velocity",
        right: "they hold μ(v₀): not so until μ is taken at the tip v₀ = α^L G_max",
        tasks: STABILITY,
        bears: NORMAL,
        proof: belt("stable_everywhere_needs_the_tip"),
    },
    Correction {
        equations: "(4.38)",
        printed: "(v_m/μ)(2/π) √(3 − 4v_mζ/(FΔμ))",
        right: "1/π instead of 2/π: the print is twice too large",
        tasks: STABILITY,
        bears: Bears::Belt {
            law: Some(LawKind::Stribeck),
            direction: Some(Direction::Normal),
            waveform: Some("square"),
        },
        proof: belt("everywhere_stable_amplitudes"),
    },
    Correction {
        equations: "figure 4.11",
        printed: "square normal dither: stable at D_N = 0.6, unstable from 0.7, stable at 0.9",
        right: "most likely the sine, whose pattern it is: the square is unstable for 0.5538 < D_N < 0.6147 only, the sine for \
                0.7103 < D_N < 0.9654",
        tasks: STABILITY,
        bears: NORMAL,
        proof: motion("figure_4_11_shows_the_sine"),
    },
    Correction {
        equations: "(B.3), (B.5)",
        printed: "prefactors exp((v_r − πα/v_m)/v_m), exp(v_r/v_m − πα/4)",
        right: "exp(v_r/v_m − πα/(4v_m)) in both",
        tasks: AVERAGING,
        bears: under(LawKind::Decreasing, "triangle"),
        proof: belt("integrals_of_appendix_b"),
    },
    Correction {
        equations: "(B.4)",
        printed: "e^{−w−γ}[erf √γ − erf √(γ−w) + erfi √γ]",
        right: "e^{γ−w}[erf √γ − erf √(γ−w)] + e^{−w−γ} erfi √γ: the fault behind (3.38a)",
        tasks: AVERAGING,
        bears: under(LawKind::Decreasing, "triangle"),
        proof: belt("integrals_of_appendix_b"),
    },
    Correction {
        equations: "(5.2), (5.5)",
        printed: "(∂ᵣᵣw + …)², ∂/∂θ²",
        right: "(∂ᵣᵣ + ∂ᵣ/r + ∂_θθ/r²)² is an operator, without w inside; ∂²/∂θ²",
        tasks: MODES,
        bears: Bears::Disc(DiscKind::ComputedModes),
        proof: disc("modes_solve_the_plate_equation"),
    },
    Correction {
        equations: "(5.7b)",
        printed: "∫ sin² jθ … = 1 for every j",
        right: "there is no sin 0: for j = 0 the condition does not hold",
        tasks: MODES,
        bears: Bears::Disc(DiscKind::ComputedModes),
        proof: disc("normalisation_of_real_and_complex_modes"),
    },
    Correction {
        equations: "captions of tables 5.1, 5.2 and figures 5.3–5.15",
        printed: "b/a = 0.05, r₀/a = 0.5",
        right: "b/a = 0.5: all thirteen printed speeds come out; the load cannot then sit at r₀/a = 0.5, which is the clamp",
        tasks: MODES,
        bears: Bears::Disc(DiscKind::ComputedModes),
        proof: disc("geometry_of_the_tables"),
    },
    Correction {
        equations: "(5.14), text of figures 5.8–5.15",
        printed: "a modal damping ξ that is never defined; D* of (5.1) is dropped",
        right: "ξ of a disc at rest is 2ξβ(A′ − qΩB), 2ξβ(B′ + qΩA); without the circulatory pair the free disc would be unstable \
                beyond Ω = β/q",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("damping_turns_with_the_disc"),
    },
    Correction {
        equations: "(5.17)",
        printed: "the same bands return with more modes (figures 5.3 to 5.5)",
        right: "ω_cr depends on the set of modes: from N_θ = 2 to 5 every speed, c, k and f changes by 1.188",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::ComputedModes),
        proof: disc("reference_frequency_depends_on_the_modes"),
    },
    Correction {
        equations: "(5.18), (5.25), (5.32)",
        printed: "A_pq″ and A_pq′ inside the double sum",
        right: "A_ij″ and A_ij′, as (5.15) has them; taken literally the verdict flips",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("indices_of_the_double_sum"),
    },
    Correction {
        equations: "text before (5.30), (5.30), (5.32)",
        printed: "F_θ cos Rτ as the fundamental of a friction that alternates between ±F_θ",
        right: "an assumption; the fundamental of that square wave is (4/π)F_θ cos Rτ: every threshold under tangential dither is printed 4/π too \
                high; α = 4/π corrects it",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::Tangential),
        proof: disc("first_harmonic_of_a_reversed_friction"),
    },
    Correction {
        equations: "(5.23), (5.32), captions of chapter 5",
        printed: "0 < α < 1 although the figures use α = 1; no α in (5.32) although captions give one; N_t for N_r",
        right: "0 ≤ α ≤ 1 and f α cos Rτ; N_r",
        tasks: &[],
        bears: Bears::Disc(DiscKind::Any),
        proof: Proof::Reading,
    },
    Correction {
        equations: "captions of figures 5.3–5.15",
        printed: "m, c/ω_cr, k/ω_cr², F_θ/(r₀ω_cr²) as pure numbers",
        right: "each has the unit of a mass: the number that decides is its ratio to M_p, the mass of the plate over its modes' norm",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("loads_are_ratios_to_the_mass_of_the_plate"),
    },
    Correction {
        equations: "(5.39)–(5.66)",
        printed: "R of (5.7) in the complex form",
        right: "complex modes need half of R² for l ≠ 0: with (5.7) put in literally every coupling is doubled",
        tasks: RESONANCES,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("normalisation_of_real_and_complex_modes"),
    },
    Correction {
        equations: "(5.40)–(5.51), (5.53)",
        printed: "α e^{iRτ} + α* e^{−iRτ} for α cos Rτ",
        right: "α cos Rτ is α/2 in the complex form",
        tasks: RESONANCES,
        bears: Bears::Disc(DiscKind::Dithered),
        proof: disc("dither_is_halved_in_the_complex_form"),
    },
    Correction {
        equations: "(5.55), table 5.1",
        printed: "five speeds",
        right: "Ω = 0 is a meeting too; places alone say nothing of instability",
        tasks: RESONANCES,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("standstill_is_a_meeting"),
    },
    Correction {
        equations: "(5.56), table 5.2",
        printed: "eight dither-induced instabilities",
        right: "places only. At first order only the first three of the eight have a tongue: waves that meet head-on share their \
                damping, and a wave with l = 0 is coupled one way only. Exactly, strong friction adds the fourth, as figure 5.9 and its \
                text have it: at m = c = k = 0.1, Ω = 0.553, f = 1.7·10⁻⁴ three waves grow together",
        tasks: RESONANCES,
        bears: Bears::Disc(DiscKind::Dithered),
        proof: disc("at_first_order_three_of_eight_grow_and_exactly_the_fourth_too"),
    },
    Correction {
        equations: "text after (5.56)",
        printed: "neither normal nor tangential dither suppresses the undithered instabilities",
        right: "tangential dither does, at first order: they are driven by the mean friction, which it takes away (its own (5.66) \
                and conclusion say so)",
        tasks: RESONANCES,
        bears: Bears::Disc(DiscKind::Tangential),
        proof: disc("tangential_dither_takes_the_first_tongues_away"),
    },
    Correction {
        equations: "text of figures 5.9–5.12",
        printed: "without modal damping the tongues of Ω₁ and Ω₄ begin at f = 10⁻⁴ and 3·10⁻⁵",
        right: "they have no threshold: of second order in f, there for every f > 0, their growth goes with f⁴; at \
                the printed values it exceeds 10⁻⁷",
        tasks: MOTION,
        bears: Bears::Disc(DiscKind::Tangential),
        proof: disc("revived_tongues_have_no_threshold"),
    },
    Correction {
        equations: "axes of figures 5.3–5.15",
        printed: "f of order 10⁻⁵",
        right: "10⁻⁴ of the f that (5.18) uses together with m, c, k: the threshold c(1 + Ω) to 2c depends on nothing else",
        tasks: STABILITY,
        bears: Bears::Disc(DiscKind::Any),
        proof: disc("unit_of_the_friction_axis"),
    },
];
