//! Free vibration with viscous damping and Coulomb friction, exactly, with its derivatives by every parameter.
//!
//! ẍ + 2ζω ẋ + ω² (x + d sgn ẋ) = 0 with d the displacement at which the spring balances friction. Between two reversals of ẋ the motion is
//! that of a linear oscillator about −d sgn ẋ; the time from one reversal to the next is π/(ω√(1 − ζ²)). It rests where it reverses within
//! |x| ≤ d. At a reversal the state is continuous, and a small change δẋ of the velocity is multiplied by ẍ⁺/ẍ⁻, because the change moves the
//! time of the reversal (the saltation of a discontinuous field). Damping is below critical.

use std::f64::consts::PI;

use quell_model::RecordedQuantity;

/// Number of parameters: ω, ζ, d, x₀, ẋ₀, and the zero of the sensor.
pub const DECAY_PARAMETERS: usize = 6;

/// Parameters of the motion itself, without the zero of the sensor.
const OWN: usize = 5;

/// Numbers of a free vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeVibration {
    /// Undamped natural frequency ω, rad per unit of time.
    pub angular_frequency: f64,
    /// Damping ratio ζ < 1.
    pub damping_ratio: f64,
    /// d: friction force over stiffness.
    pub friction: f64,
    /// x at the first sample.
    pub displacement: f64,
    /// ẋ at the first sample.
    pub velocity: f64,
    /// The reading of the sensor at rest in the middle.
    pub offset: f64,
}

impl FreeVibration {
    /// From the values of the parameters in their order.
    pub fn of(values: &[f64; DECAY_PARAMETERS]) -> Self {
        let [angular_frequency, damping_ratio, friction, displacement, velocity, offset] = *values;
        Self { angular_frequency, damping_ratio, friction, displacement, velocity, offset }
    }
}

/// A state with its derivatives by ω, ζ, d, x₀ and ẋ₀.
#[derive(Clone, Copy, Debug)]
struct VariedState {
    x: f64,
    v: f64,
    dx: [f64; OWN],
    dv: [f64; OWN],
}

/// A smooth piece: its ends, the sign of ẋ (0 without friction), and its first state. `None` for the sign is rest.
#[derive(Clone, Copy, Debug)]
struct SmoothPiece {
    from: f64,
    until: f64,
    sign: Option<f64>,
    state: VariedState,
}

/// Readings at ascending times after the first sample, and their derivatives by the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct DecayReadings {
    /// The readings.
    pub values: Vec<f64>,
    /// The derivatives, one array for each reading.
    pub derivatives: Vec<[f64; DECAY_PARAMETERS]>,
}

/// The readings of a sensor. `with_friction` = false leaves d out, and the whole motion is one piece.
pub fn readings(
    vibration: &FreeVibration,
    quantity: RecordedQuantity,
    times: &[f64],
    with_friction: bool,
) -> DecayReadings {
    let mut found = DecayReadings {
        values: Vec::with_capacity(times.len()),
        derivatives: Vec::with_capacity(times.len()),
    };
    let mut piece = vibration.first(with_friction);
    for time in times {
        while *time > piece.until {
            piece = vibration.after(&piece);
        }
        let state = vibration.at(&piece, time - piece.from);
        let (value, own) = vibration.read(&piece, &state, quantity);
        let mut derivatives = [0.0; DECAY_PARAMETERS];
        derivatives[..OWN].copy_from_slice(&own);
        derivatives[OWN] = 1.0;
        found.values.push(value + vibration.offset);
        found.derivatives.push(derivatives);
    }
    found
}

impl FreeVibration {
    /// σ = ζω and ω_d² = ω²(1 − ζ²), with their derivatives by ω and ζ.
    fn rates(&self) -> [(f64, [f64; 2]); 2] {
        let (omega, zeta) = (self.angular_frequency, self.damping_ratio);
        let rest = 1.0 - zeta * zeta;
        [
            (zeta * omega, [zeta, omega]),
            (omega * omega * rest, [2.0 * omega * rest, -2.0 * omega * omega * zeta]),
        ]
    }

    fn half_period(&self) -> f64 {
        PI / self.rates()[1].0.sqrt()
    }

    /// The piece that begins at the first sample.
    fn first(&self, with_friction: bool) -> SmoothPiece {
        let (x, v) = (self.displacement, self.velocity);
        let state =
            VariedState { x, v, dx: [0.0, 0.0, 0.0, 1.0, 0.0], dv: [0.0, 0.0, 0.0, 0.0, 1.0] };
        if !with_friction {
            return SmoothPiece { from: 0.0, until: f64::INFINITY, sign: Some(0.0), state };
        }
        if v == 0.0 && x.abs() <= self.friction {
            return Self::resting(0.0, state);
        }
        let sign = if v == 0.0 { -x.signum() } else { v.signum() };
        let [(sigma, _), (square, _)] = self.rates();
        let damped = square.sqrt();
        let omega = self.angular_frequency;
        let pull = sign * (omega * omega * (x + sign * self.friction) + sigma * v);
        let angle = if v == 0.0 { PI } else { libm::atan2(v.abs() * damped, pull) };
        SmoothPiece { from: 0.0, until: angle / damped, sign: Some(sign), state }
    }

    /// Rest from a moment on. The place of rest does not change with δẋ.
    fn resting(from: f64, state: VariedState) -> SmoothPiece {
        let state = VariedState { v: 0.0, dv: [0.0; OWN], ..state };
        SmoothPiece { from, until: f64::INFINITY, sign: None, state }
    }

    /// The piece after a reversal.
    fn after(&self, piece: &SmoothPiece) -> SmoothPiece {
        let mut state = self.at(piece, piece.until - piece.from);
        let Some(old) = piece.sign else { return *piece };
        state.v = 0.0;
        let square = self.angular_frequency * self.angular_frequency;
        let sign = -old;
        let before = -square * (state.x + old * self.friction);
        let after = -square * (state.x + sign * self.friction);
        // The spring must overcome friction in the new direction.
        if after * sign <= 0.0 || before == 0.0 {
            return Self::resting(piece.until, state);
        }
        for change in &mut state.dv {
            *change *= after / before;
        }
        let from = piece.until;
        SmoothPiece { from, until: from + self.half_period(), sign: Some(sign), state }
    }

    /// The state at a time after the start of a piece.
    fn at(&self, piece: &SmoothPiece, since: f64) -> VariedState {
        let Some(sign) = piece.sign else { return piece.state };
        let [(sigma, by_sigma), (square, by_square)] = self.rates();
        let damped = square.sqrt();
        let decay = libm::exp(-sigma * since);
        let (sine, cosine) = (libm::sin(damped * since), libm::cos(damped * since));
        // C = e^{−σt} cos ω_d t, S = e^{−σt} sin(ω_d t)/ω_d.
        let (c, s) = (decay * cosine, decay * sine / damped);
        let own = self.angular_frequency * self.angular_frequency;
        let shift = sign * self.friction;
        let VariedState { x, v, dx, dv } = piece.state;
        let u = x + shift;
        let mut reached = VariedState {
            x: u * (c + sigma * s) + v * s - shift,
            v: v * (c - sigma * s) - own * u * s,
            dx: [0.0; OWN],
            dv: [0.0; OWN],
        };
        for k in 0..OWN {
            let own_shift = if k == 2 { sign } else { 0.0 };
            let du = dx[k] + own_shift;
            reached.dx[k] = du * (c + sigma * s) + dv[k] * s - own_shift;
            reached.dv[k] = dv[k] * (c - sigma * s) - own * du * s;
        }
        for k in 0..2 {
            let by_c = -since * c * by_sigma[k] - 0.5 * since * s * by_square[k];
            let by_s = -since * s * by_sigma[k] + (since * c - s) / (2.0 * square) * by_square[k];
            let by_own = if k == 0 { 2.0 * self.angular_frequency } else { 0.0 };
            reached.dx[k] += u * (by_c + by_sigma[k] * s + sigma * by_s) + v * by_s;
            reached.dv[k] +=
                v * (by_c - by_sigma[k] * s - sigma * by_s) - u * (by_own * s + own * by_s);
        }
        reached
    }

    /// What the sensor shows of a state, without its offset, and the derivatives.
    fn read(
        &self,
        piece: &SmoothPiece,
        state: &VariedState,
        quantity: RecordedQuantity,
    ) -> (f64, [f64; OWN]) {
        match quantity {
            RecordedQuantity::Displacement => (state.x, state.dx),
            RecordedQuantity::Velocity => (state.v, state.dv),
            RecordedQuantity::Acceleration => {
                let Some(sign) = piece.sign else { return (0.0, [0.0; OWN]) };
                let (omega, zeta) = (self.angular_frequency, self.damping_ratio);
                let u = state.x + sign * self.friction;
                let value = -2.0 * zeta * omega * state.v - omega * omega * u;
                let mut derivatives = [0.0; OWN];
                for (k, own) in derivatives.iter_mut().enumerate() {
                    let du = state.dx[k] + if k == 2 { sign } else { 0.0 };
                    *own = -2.0 * zeta * omega * state.dv[k] - omega * omega * du;
                }
                derivatives[0] += -2.0 * zeta * state.v - 2.0 * omega * u;
                derivatives[1] += -2.0 * omega * state.v;
                (value, derivatives)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: [f64; DECAY_PARAMETERS] = [3.0, 0.02, 0.05, 0.9, -1.1, 0.03];

    fn times() -> Vec<f64> {
        (0..400).map(|k| 0.031 * f64::from(k)).collect()
    }

    /// Σ of the derivatives against central differences; none of the sampled times is within the step of a reversal.
    #[test]
    fn derivatives_are_those_of_differences() {
        for quantity in [
            RecordedQuantity::Displacement,
            RecordedQuantity::Velocity,
            RecordedQuantity::Acceleration,
        ] {
            for with_friction in [true, false] {
                let at = |values: &[f64; DECAY_PARAMETERS]| {
                    readings(&FreeVibration::of(values), quantity, &times(), with_friction)
                };
                let found = at(&BASE);
                for k in 0..DECAY_PARAMETERS {
                    if k == 2 && !with_friction {
                        continue;
                    }
                    let step = 1e-6;
                    let mut ends = [BASE, BASE];
                    ends[0][k] -= step;
                    ends[1][k] += step;
                    let ends = ends.map(|values| at(&values).values);
                    for (row, exact) in found.derivatives.iter().enumerate() {
                        let difference = (ends[1][row] - ends[0][row]) / (2.0 * step);
                        // The third derivative by ω is about t³ω² x: 10⁵ at most, times step²/6; and rounding 10⁻¹⁵/step.
                        let near = 3e-7 * (1.0 + exact[k].abs());
                        assert!((difference - exact[k]).abs() < near, "{quantity:?} {k} {row}");
                    }
                }
            }
        }
    }

    #[test]
    fn friction_alone_takes_four_d_from_every_cycle_and_rests_within_the_band() {
        let own = FreeVibration::of(&[2.0, 0.0, 0.1, 1.0, 0.0, 0.0]);
        let cycle = PI;
        let peaks: Vec<f64> = (0..4).map(|k| f64::from(k) * cycle).collect();
        let found = readings(&own, RecordedQuantity::Displacement, &peaks, true).values;
        for (k, value) in found[..3].iter().enumerate() {
            assert!((value - (1.0 - 0.4 * k as f64)).abs() < 1e-14, "{k}: {value}");
        }
        // 1, −0.8, 0.6, −0.4, 0.2, −0.0: the last is within the band.
        let rest = readings(&own, RecordedQuantity::Displacement, &[50.0, 60.0], true).values;
        assert_eq!(rest[0], rest[1]);
        assert!(rest[0].abs() <= 0.1);
        let velocity = readings(&own, RecordedQuantity::Velocity, &[50.0], true);
        assert_eq!(velocity.values[0], 0.0);
    }

    #[test]
    fn viscous_damping_alone_is_one_piece() {
        let mut without = BASE;
        without[2] = 0.0;
        let own = FreeVibration::of(&without);
        let one = readings(&own, RecordedQuantity::Velocity, &times(), false);
        let many = readings(&own, RecordedQuantity::Velocity, &times(), true);
        for (a, b) in one.values.iter().zip(&many.values) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }
}
