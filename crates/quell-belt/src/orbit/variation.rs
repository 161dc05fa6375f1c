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

use quell_model::{Belt, Direction};
use quell_numerics::roots::{Closeness, minimise};

use crate::simulation::{Event, EventKind, Observer, Segment};

/// Collocation nodes of a segment.
const NODES: usize = 8;

/// Places of a segment at which its least |v_r| is looked for.
const PLACES: u32 = 12;

/// A 2 × 2 matrix, row by row.
pub type Matrix = [[f64; 2]; 2];

/// Gauss–Legendre collocation on [0, 1].
struct Collocation {
    nodes: [f64; NODES],
    weights: [f64; NODES],
    /// `integrals[i][j]`: ∫₀^{cᵢ} of the j-th Lagrange polynomial.
    integrals: [[f64; NODES]; NODES],
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
        Self { nodes, weights, integrals }
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
    /// Least |v_r| inside slip, and when.
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

    /// 2ζ + μ′(v_r)N.
    fn rate(&self, segment: &Segment<'_>, since: f64) -> f64 {
        let slope = self.belt.friction().slope(segment.slip_velocity(since).abs());
        let load = self.normal_load(segment.clock().time() + since);
        f64::mul_add(slope, load, 2.0 * self.belt.damping_ratio())
    }

    fn slip(&mut self, segment: &Segment<'_>) {
        let rule = &*COLLOCATION;
        let h = segment.duration();
        let mut rates = [0.0; NODES];
        for (rate, node) in rates.iter_mut().zip(rule.nodes) {
            *rate = self.rate(segment, node * h);
        }
        self.damping += h * rates.iter().zip(rule.weights).map(|(r, w)| r * w).sum::<f64>();
        for column in 0..2 {
            let (xi, eta) = (self.matrix[0][column], self.matrix[1][column]);
            let (velocity, force) = stages(rule, &rates, h, xi, eta);
            let sum = |values: &[f64; NODES]| {
                h * values.iter().zip(rule.weights).map(|(v, w)| v * w).sum::<f64>()
            };
            self.matrix[0][column] = xi + sum(&velocity);
            self.matrix[1][column] = eta + sum(&force);
        }
    }

    fn look_for_least(&mut self, segment: &Segment<'_>) {
        let h = segment.duration();
        let speed = |since: f64| segment.slip_velocity(since).abs();
        let place = |k: u32| h * f64::from(k) / f64::from(PLACES);
        let Some(k) = (0..=PLACES).min_by(|a, b| speed(place(*a)).total_cmp(&speed(place(*b))))
        else {
            return;
        };
        let (low, high) = (place(k.saturating_sub(1)), place((k + 1).min(PLACES)));
        let closeness = Closeness { absolute: 0.0, relative: 1e-12 };
        let found = minimise(speed, low, high, closeness)
            .map_or((place(k), speed(place(k))), |minimum| (minimum.location, minimum.value));
        let candidate = (found.1.min(speed(place(k))), segment.clock().time() + found.0);
        if self.least.is_none_or(|least| candidate.0 < least.0) {
            self.least = Some(candidate);
        }
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
fn dithers(belt: &Belt, direction: Direction, time: f64) -> f64 {
    belt.dithers_along(direction)
        .map(|it| {
            it.amplitude * it.waveform.value(f64::mul_add(it.frequency_ratio, time, it.phase))
        })
        .sum()
}

/// Derivatives (ξ′, η′) at the nodes: vᵢ = η + hΣaᵢⱼfⱼ, fᵢ = −(ξ + hΣaᵢⱼvⱼ) − rᵢvᵢ, by elimination of v.
fn stages(
    rule: &Collocation,
    rates: &[f64; NODES],
    h: f64,
    xi: f64,
    eta: f64,
) -> ([f64; NODES], [f64; NODES]) {
    let a = &rule.integrals;
    // (I + r h A + h² A²) f = −ξ − η(h A 1 + r).
    let mut system = [[0.0; NODES + 1]; NODES];
    for i in 0..NODES {
        for j in 0..NODES {
            let square: f64 = (0..NODES).map(|k| a[i][k] * a[k][j]).sum();
            let identity = if i == j { 1.0 } else { 0.0 };
            system[i][j] = identity + rates[i] * h * a[i][j] + h * h * square;
        }
        let reach: f64 = a[i].iter().sum();
        system[i][NODES] = -xi - eta * (h * reach + rates[i]);
    }
    let force = solved(system);
    let mut velocity = [eta; NODES];
    for i in 0..NODES {
        for j in 0..NODES {
            velocity[i] += h * a[i][j] * force[j];
        }
    }
    (velocity, force)
}

/// Gaussian elimination with the largest pivot.
fn solved(mut system: [[f64; NODES + 1]; NODES]) -> [f64; NODES] {
    for column in 0..NODES {
        let pivot = (column..NODES)
            .max_by(|i, j| system[*i][column].abs().total_cmp(&system[*j][column].abs()))
            .unwrap_or(column);
        system.swap(column, pivot);
        let head = system[column];
        for row in &mut system[column + 1..] {
            let factor = row[column] / head[column];
            for (entry, above) in row.iter_mut().zip(head).skip(column) {
                *entry -= factor * above;
            }
        }
    }
    let mut solution = [0.0; NODES];
    for row in (0..NODES).rev() {
        let known: f64 = (row + 1..NODES).map(|k| system[row][k] * solution[k]).sum();
        solution[row] = (system[row][NODES] - known) / system[row][row];
    }
    solution
}

impl Observer for Variation<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.sign = segment.slip_sign();
        if self.sign == 0 {
            self.stuck += segment.duration();
        } else {
            self.slip(segment);
            self.look_for_least(segment);
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
        let (velocity, _) = stages(rule, &[2.0 * zeta; NODES], h, 1.0, 0.0);
        let xi = 1.0 + h * velocity.iter().zip(rule.weights).map(|(v, w)| v * w).sum::<f64>();
        let omega = (1.0 - zeta * zeta).sqrt();
        let exact = (-zeta * h).exp() * ((omega * h).cos() + zeta / omega * (omega * h).sin());
        assert!((xi - exact).abs() < 1e-14, "{xi} {exact}");
    }
}
