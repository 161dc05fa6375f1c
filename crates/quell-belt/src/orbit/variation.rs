//! How a small change of state travels along a run: the variational equation with a jump at every event.
//!
//! In slip a change (ξ, η) of (x, x′) obeys
//!
//! ```text
//! ξ′ = η,   η′ = −ξ − (2ζ + μ′(v_r)N) η
//! ```
//!
//! At v_r = 0 it is multiplied by the saltation matrix I + (f₊ − f₋)nᵀ/(nᵀf₋), n = (0, 1):
//! a reversal gives diag(1, a₊/a₋) with the accelerations a on both sides, a stick diag(1, 0).
//!
//! A release happens on h = σf_s − μ_sN = 0, n = (σ, 0): with f₋ = (v₀, 0) and f₊ = (v₀, a₊), a₊ = −σ(μ_s − μ(0⁺))N, it adds
//! (a₊σ/ḣ)ξ to η, ḣ = σ(v₀ − Σ D_T g_T′) − μ_sN′ along the stick: where friction starts below its static level a
//! later release starts as much later. Where it starts at that level, or where a jump of the dither breaks the bond at a
//! time of its own, a release changes nothing.
//!
//! Scheme: Gauss–Legendre collocation with 8 nodes, of order 16 as the Taylor step whose series it reads μ′ from.

use std::sync::LazyLock;

use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_model::{Belt, Direction};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;

use crate::simulation::{Event, EventKind, Observer, Segment};

/// Collocation nodes of a segment.
const NODES: usize = 8;

/// A 2 × 2 matrix, row by row.
pub type Matrix = [[f64; 2]; 2];

/// Gauss–Legendre collocation on [0, 1].
struct Collocation {
    nodes: [f64; NODES],
    weights: [f64; NODES],
    /// `integrals[i][j]`: ∫₀^{cᵢ} of the j-th Lagrange polynomial.
    integrals: [[f64; NODES]; NODES],
    /// The square of `integrals`.
    squares: [[f64; NODES]; NODES],
    /// Sums of the rows of `integrals`.
    reaches: [f64; NODES],
}

static COLLOCATION: LazyLock<Collocation> = LazyLock::new(Collocation::new);

impl Collocation {
    fn new() -> Self {
        let mut nodes = [0.0; NODES];
        for (k, node) in nodes.iter_mut().enumerate() {
            // Newton's method on P₈ from Chebyshev's points.
            let mut x = -libm::cos(std::f64::consts::PI * (k as f64 + 0.75) / (NODES as f64 + 0.5));
            for _ in 0..50 {
                let (value, slope) = legendre(x);
                x -= value / slope;
            }
            *node = 0.5 * (1.0 + x);
        }
        // The rule itself integrates the polynomials exactly.
        let weights = nodes.map(|node| {
            let x = 2.0 * node - 1.0;
            let slope = legendre(x).1;
            1.0 / ((1.0 - x * x) * slope * slope)
        });
        let mut integrals = [[0.0; NODES]; NODES];
        for (row, &end) in integrals.iter_mut().zip(&nodes) {
            for (j, entry) in row.iter_mut().enumerate() {
                let values = nodes.map(|node| lagrange(&nodes, j, end * node));
                *entry = end * values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
            }
        }
        let mut squares = [[0.0; NODES]; NODES];
        for i in 0..NODES {
            for j in 0..NODES {
                squares[i][j] = (0..NODES).map(|k| integrals[i][k] * integrals[k][j]).sum();
            }
        }
        let reaches = integrals.map(|row| row.iter().sum());
        Self { nodes, weights, integrals, squares, reaches }
    }
}

/// P₈ and its derivative.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for n in 1..NODES {
        let n = n as f64;
        (before, value) = (value, ((2.0 * n + 1.0) * x * value - n * before) / (n + 1.0));
    }
    (value, NODES as f64 * (before - x * value) / (1.0 - x * x))
}

/// The j-th Lagrange polynomial at a place.
fn lagrange(nodes: &[f64; NODES], j: usize, place: f64) -> f64 {
    let others = nodes.iter().enumerate().filter(|(k, _)| *k != j);
    others.map(|(_, node)| (place - node) / (nodes[j] - node)).product()
}

/// Carries a matrix of changes along a run.
#[derive(Clone, Debug)]
pub(super) struct Variation<'a> {
    belt: &'a Belt,
    /// Changes of the state at the end per change at the start.
    pub(super) matrix: Matrix,
    /// ∫(2ζ + μ′N) over slip.
    pub(super) damping: f64,
    /// Events in order, with the sign of v_r afterwards.
    pub(super) events: Vec<(EventKind, i8)>,
    /// Least slip velocity in the direction of slip, and when.
    pub(super) least: Option<(f64, f64)>,
    /// Time spent in stick.
    pub(super) stuck: f64,
    sign: i8,
}

impl<'a> Variation<'a> {
    pub(super) fn new(belt: &'a Belt) -> Self {
        Self {
            belt,
            matrix: [[1.0, 0.0], [0.0, 1.0]],
            damping: 0.0,
            events: Vec::new(),
            least: None,
            stuck: 0.0,
            sign: 0,
        }
    }

    fn normal_load(&self, time: f64) -> f64 {
        self.belt.normal_load() + dithers(self.belt, Direction::Normal, time)
    }

    /// x″ at v_r = 0 on the branch of a sign.
    fn acceleration(&self, event: &Event, sign: i8) -> f64 {
        let friction = self.belt.friction().coefficient(0.0) * self.normal_load(event.time);
        f64::from(sign) * friction
            - 2.0 * self.belt.damping_ratio() * self.belt.belt_velocity()
            - event.displacement
            + dithers(self.belt, Direction::Tangential, event.time)
    }
}

/// A dither jumps at a break where its value just before differs by more than this share of its amplitude.
const JUMP: f64 = 1e-3;

impl Variation<'_> {
    /// η after a release per ξ before it.
    fn release(&self, event: &Event) -> f64 {
        let belt = self.belt;
        let law = belt.friction();
        if law.starts_at_static_level() || broken_by_jump(belt, event.time) {
            return 0.0;
        }
        let sign = f64::from(event.slip_sign);
        let growth = sign
            * (belt.belt_velocity() - dither_rates(belt, Direction::Tangential, event.time))
            - law.static_coefficient() * dither_rates(belt, Direction::Normal, event.time);
        let jump = (law.static_coefficient() - law.coefficient(0.0)) * self.normal_load(event.time);
        // a₊σ/ḣ with a₊ = −σ jump.
        -jump / growth
    }
}

/// How long before a moment its dithers are looked at, in radians of each.
const BEFORE: f64 = 1e-6;

/// Whether a dither jumps at a moment.
fn broken_by_jump(belt: &Belt, time: f64) -> bool {
    belt.dithers().iter().any(|it| {
        let phase = f64::mul_add(it.frequency_ratio, time, it.phase);
        let change = it.waveform.value(phase + BEFORE) - it.waveform.value(phase - BEFORE);
        it.amplitude > 0.0 && change.abs() > JUMP
    })
}

/// Σ D R g′ of one direction.
fn dither_rates(belt: &Belt, direction: Direction, time: f64) -> f64 {
    belt.dithers_along(direction)
        .map(|it| {
            let phase = f64::mul_add(it.frequency_ratio, time, it.phase);
            it.amplitude * it.frequency_ratio * it.waveform.slope(phase)
        })
        .sum()
}

/// Σ D g of one direction.
pub(super) fn dithers(belt: &Belt, direction: Direction, time: f64) -> f64 {
    belt.dithers_along(direction)
        .map(|it| {
            it.amplitude * it.waveform.value(f64::mul_add(it.frequency_ratio, time, it.phase))
        })
        .sum()
}

/// A segment of slip with the law that its changes obey.
struct Along<'v, 'b, 's, 'c> {
    variation: &'v mut Variation<'b>,
    segment: &'s Segment<'c>,
}

impl LawVisitor for Along<'_, '_, '_, '_> {
    type Output = ();

    fn visit<L: SlidingLaw>(self, law: &L) {
        with_fused_multiply_add(AlongBy { along: self, law });
    }
}

struct AlongBy<'v, 'b, 's, 'c, 'l, L> {
    along: Along<'v, 'b, 's, 'c>,
    law: &'l L,
}

impl<L: SlidingLaw> Work for AlongBy<'_, '_, '_, '_, '_, L> {
    type Output = ();

    #[expect(
        clippy::needless_range_loop,
        reason = "small matrices by their indices, as in the formula"
    )]
    #[inline(always)]
    fn run(self) {
        let Along { variation, segment } = self.along;
        let rule = &*COLLOCATION;
        let h = segment.duration();
        let sign = f64::from(segment.slip_sign());
        let (slip, unit) = segment.slip_series();
        let belt = variation.belt;
        let has_normal = belt.dithers().iter().any(|it| it.direction == Direction::Normal);
        let mut speeds = [0.0; NODES];
        let mut rates = [0.0; NODES];
        for k in 0..NODES {
            let since = rule.nodes[k] * h;
            speeds[k] = sign * unit * horner(slip, since);
            let load = if has_normal {
                variation.normal_load(segment.clock().time() + since)
            } else {
                belt.normal_load()
            };
            rates[k] = f64::mul_add(self.law.slope(speeds[k]), load, 2.0 * belt.damping_ratio());
        }
        variation.damping += h * weighted(rule, &rates);
        let [upper, lower] = variation.matrix;
        let force = forces(rule, &rates, h, [upper[0], upper[1]], [lower[0], lower[1]]);
        for column in 0..2 {
            let mut velocity = [lower[column]; NODES];
            for i in 0..NODES {
                for j in 0..NODES {
                    velocity[i] = (h * rule.integrals[i][j]).mul_add(force[column][j], velocity[i]);
                }
            }
            variation.matrix[0][column] += h * weighted(rule, &velocity);
            variation.matrix[1][column] += h * weighted(rule, &force[column]);
        }
        if let Some((least, since)) = least_of(rule, slip, sign * unit, h, &speeds)
            && variation.least.is_none_or(|known| least < known.0)
        {
            variation.least = Some((least, segment.clock().time() + since));
        }
    }
}

#[expect(
    clippy::needless_range_loop,
    reason = "small matrices by their indices, as in the formula"
)]
#[inline(always)]
fn weighted(rule: &Collocation, values: &[f64; NODES]) -> f64 {
    let mut sum = 0.0;
    for k in 0..NODES {
        sum = values[k].mul_add(rule.weights[k], sum);
    }
    sum
}

/// Accelerations η′ at the nodes for two columns of changes: vᵢ = η + hΣaᵢⱼfⱼ, fᵢ = −(ξ + hΣaᵢⱼvⱼ) − rᵢvᵢ, by
/// elimination of v: (I + r h A + h²A²) f = −ξ − η(h A 1 + r). The matrix is the identity and something small,
/// so that elimination needs no pivots: h is a step of the engine, at most 8 radians of the fastest oscillation
/// and in practice below 1.
#[expect(
    clippy::needless_range_loop,
    reason = "small matrices by their indices, as in the formula"
)]
#[inline(always)]
fn forces(
    rule: &Collocation,
    rates: &[f64; NODES],
    h: f64,
    xi: [f64; 2],
    eta: [f64; 2],
) -> [[f64; NODES]; 2] {
    let mut system = [[0.0; NODES + 2]; NODES];
    for i in 0..NODES {
        for j in 0..NODES {
            system[i][j] = (rates[i] * h).mul_add(rule.integrals[i][j], h * h * rule.squares[i][j]);
        }
        system[i][i] += 1.0;
        for column in 0..2 {
            let reach = h.mul_add(rule.reaches[i], rates[i]);
            system[i][NODES + column] = -eta[column].mul_add(reach, xi[column]);
        }
    }
    for column in 0..NODES {
        let head = system[column];
        let inverse = 1.0 / head[column];
        for row in &mut system[column + 1..] {
            let factor = row[column] * inverse;
            for k in column..NODES + 2 {
                row[k] = (-factor).mul_add(head[k], row[k]);
            }
        }
    }
    let mut force = [[0.0; NODES]; 2];
    for row in (0..NODES).rev() {
        for column in 0..2 {
            let mut rest = system[row][NODES + column];
            for k in row + 1..NODES {
                rest = (-system[row][k]).mul_add(force[column][k], rest);
            }
            force[column][row] = rest / system[row][row];
        }
    }
    force
}

/// Least value of Σ cₖtᵏ times `unit` on [0, h] and where: at the lowest of the nodes and ends, or between its neighbours by Newton's method on
/// the derivative, which a bracket keeps.
#[inline(always)]
fn least_of(
    rule: &Collocation,
    slip: &[f64],
    unit: f64,
    h: f64,
    speeds: &[f64; NODES],
) -> Option<(f64, f64)> {
    let value = |since: f64| unit * horner(slip, since);
    let mut places = [(0.0, 0.0); NODES + 2];
    places[0] = (0.0, value(0.0));
    places[NODES + 1] = (h, value(h));
    for k in 0..NODES {
        places[k + 1] = (rule.nodes[k] * h, speeds[k]);
    }
    let lowest = (0..NODES + 2).min_by(|a, b| places[*a].1.total_cmp(&places[*b].1))?;
    let (mut since, mut least) = places[lowest];
    if lowest == 0 || lowest == NODES + 1 {
        let inwards = if lowest == 0 { slip.get(1).map_or(0.0, |it| unit * it) } else { 0.0 };
        if inwards >= 0.0 && lowest == 0 {
            return Some((least, since));
        }
    }
    let (mut low, mut high) =
        (places[lowest.saturating_sub(1)].0, places[(lowest + 1).min(NODES + 1)].0);
    for _ in 0..12 {
        let (mut slope, mut bend) = (0.0, 0.0);
        for (k, coefficient) in slip.iter().enumerate().skip(1).rev() {
            bend = bend * since + slope;
            slope = slope * since + unit * coefficient * k as f64;
        }
        if slope > 0.0 {
            high = since;
        } else {
            low = since;
        }
        let next = since - slope / bend;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let moved = (next - since).abs();
        since = next;
        if moved <= 1e-9 * h {
            break;
        }
    }
    let inside = value(since);
    if inside < least {
        least = inside;
    } else {
        since = places[lowest].0;
    }
    Some((least, since))
}

impl Observer for Variation<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.sign = segment.slip_sign();
        if self.sign == 0 {
            self.stuck += segment.duration();
            // A run that begins in stick begins on v_r = 0: a change of velocity is taken away at once.
            self.matrix[1] = [0.0; 2];
        } else {
            let law = self.belt.friction();
            law.visit(Along { variation: self, segment });
        }
    }

    fn event(&mut self, event: &Event) {
        let factor = match event.kind {
            EventKind::Stick => 0.0,
            EventKind::Release => 1.0,
            EventKind::Reversal => {
                self.acceleration(event, event.slip_sign) / self.acceleration(event, self.sign)
            }
        };
        let gain = if event.kind == EventKind::Release { self.release(event) } else { 0.0 };
        for column in 0..2 {
            let change = self.matrix[0][column];
            self.matrix[1][column] = factor * self.matrix[1][column] + gain * change;
        }
        self.events.push((event.kind, event.slip_sign));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collocation_integrates_polynomials_and_the_oscillator() {
        let rule = &*COLLOCATION;
        assert!((rule.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        let power: f64 = rule.nodes.iter().zip(rule.weights).map(|(x, w)| w * x.powi(15)).sum();
        assert!((power - 1.0 / 16.0).abs() < 1e-14);
        // ξ″ + 2ζξ′ + ξ = 0 over one step of 0.8.
        let (zeta, h) = (0.3_f64, 0.8_f64);
        let force = forces(rule, &[2.0 * zeta; NODES], h, [1.0, 0.0], [0.0, 1.0]);
        // ξ(h) = ξ + hη + h²Σwᵢ(1 − cᵢ)fᵢ.
        let double: f64 =
            (0..NODES).map(|k| rule.weights[k] * (1.0 - rule.nodes[k]) * force[0][k]).sum();
        let xi = 1.0 + h * h * double;
        let omega = (1.0 - zeta * zeta).sqrt();
        let exact = (-zeta * h).exp() * ((omega * h).cos() + zeta / omega * (omega * h).sin());
        assert!((xi - exact).abs() < 1e-14, "{xi} {exact}");
    }
}
