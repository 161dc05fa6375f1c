//! A law written as a formula, such as `0.3 + 0.1*exp(-abs(v)/0.2)`.
//!
//! The formula gives the coefficient in sliding; v is the slip velocity, and friction is odd in it. On
//! each branch abs(v) and sign(v) have their value on that branch, so that the formula is analytic up to v = 0⁺.
//! It must agree on both branches, either as an even function (the coefficient) or as an odd one (the
//! coefficient with the sign of slip). The static level is separate: a number, or μ(0⁺).
//!
//! Scheme: the text becomes a tree (`syntax`), the tree a list of steps (`program`), each step one
//! bilinear recurrence for Taylor coefficients (`series`): values, slopes and all derivatives are exact up
//! to rounding. Named constants are parameters of the law and can be varied like any other.
//!
//! Limits: formulas must be smooth, finite and not negative for all slip speeds up to `friction.maximum_velocity`. This is
//! proven, not sampled (`proof`), for each belt that uses the law ([`SlidingLaw::placed`]): up to the speed given in the
//! study or, by default, up to [`MULTIPLE`] times the slip that belt and dither reach together.

use std::sync::Arc;

use quell_numerics::lane::Lane;

use super::numeric::not_a_number_of;
use super::series::side_by_side;
use super::{
    BranchSeries, LawParameters, LawSeries, RangeLimit, SlidingLaw, SlipRange, Surroundings,
};
use crate::parameter::{MAXIMUM_VELOCITY, Parameter, STATIC_COEFFICIENT};
use crate::{Invalid, InvalidValues};

mod number;
mod program;
mod proof;
mod series;
mod syntax;
mod tree;
mod unusable;

pub use number::NumberFormula;
use program::Program;
use proof::Formula;
pub use series::{ExpressionConstants, ExpressionSeries};
pub use syntax::{LONGEST, SyntaxError, is_name, is_taken};
use tree::Tree;
use unusable::UnusableFormula;

/// Path of the formula in a study file.
pub const FORMULA: &str = "friction.coefficient";

/// Table of the named constants in a study file.
pub const CONSTANTS: &str = "friction.constants";

/// Default slip speed up to which a law is proven, in units of the belt speed plus the largest fast velocity of its dither:
/// stick–slip and transients stay far below. For a belt at rest without dither, in units of the speed over which the formula
/// varies.
pub const MULTIPLE: f64 = 10.0;

/// Number of derivatives at v = 0⁺ that determine the velocity scale.
const DERIVATIVES: usize = 6;

/// A law written as a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: Arc<str>,
    names: Arc<[String]>,
    tree: Arc<Tree>,
    /// Values of the named constants.
    named: Vec<f64>,
    program: Arc<Program>,
    /// Constants of the program's steps.
    constants: Vec<f64>,
    given_static: Option<f64>,
    static_coefficient: f64,
    /// Velocity of the equations per unit of v.
    velocity_unit: f64,
    /// Velocity scale in units of v.
    scale: f64,
    /// The largest slip speed for which the formula is intended, in units of v, if the study gives one.
    maximum: Option<f64>,
    /// Slip speed up to which the formula is proven, in units of v.
    proven: Proven,
}

/// The range proven for a belt. It is not part of the law, so that laws in different belts compare equal.
#[derive(Clone, Copy, Debug, Default)]
struct Proven(Option<f64>);

impl PartialEq for Proven {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Expression {
    /// From the text of a formula, its named constants in order, the static level (μ(0⁺) if
    /// not given), and the dimensionless velocity of one unit of v.
    ///
    /// # Errors
    /// Under `friction.coefficient`: a syntax error with its character; a formula that is
    /// not smooth, not finite or negative somewhere, with the slip speed; one that differs between the
    /// directions of slip. Under `friction.constants.…` and `friction.static_coefficient`: a value that
    /// cannot be used. Under `velocity_unit`: one that is not finite or not above 0.
    pub fn new(
        text: &str,
        constants: &[(String, f64)],
        static_coefficient: Option<f64>,
        velocity_unit: f64,
    ) -> Result<Self, InvalidValues> {
        let mut complaints = Vec::new();
        if !(velocity_unit.is_finite() && velocity_unit > 0.0) {
            let allowed = "a finite velocity above 0";
            complaints.push(Invalid::new("velocity_unit", velocity_unit, allowed));
        }
        for (index, (name, value)) in constants.iter().enumerate() {
            let path = format!("{CONSTANTS}.{name}");
            let twice = constants[..index].iter().any(|(known, _)| known == name);
            if !is_name(name) || is_taken(name) || twice {
                let allowed =
                    "a name made of letters, digits and _ that has no other meaning in a formula";
                complaints.push(Invalid::new(&path, value, allowed));
            } else if !value.is_finite() {
                complaints.push(Invalid::new(&path, value, "a finite number"));
            }
        }
        if let Some(level) = static_coefficient {
            complaints.extend(STATIC_COEFFICIENT.check(level).err());
        }
        let names: Vec<&str> = constants.iter().map(|(name, _)| name.as_str()).collect();
        let refused = |why: UnusableFormula| Invalid::new(FORMULA, text, why.to_string());
        let compiled = syntax::parse(text, &names)
            .map_err(UnusableFormula::Syntax)
            .and_then(|tree| Ok((Program::new(&tree, 1.0)?, Program::new(&tree, -1.0)?, tree)));
        let (program, mirrored, tree) = match compiled {
            Ok(programs) => programs,
            Err(why) => {
                complaints.push(refused(why));
                return Err(InvalidValues::of(complaints));
            }
        };
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let law = Self {
            text: text.into(),
            names: names.iter().map(|&name| name.to_owned()).collect(),
            tree: Arc::new(tree),
            named: constants.iter().map(|(_, value)| *value).collect(),
            program: Arc::new(program),
            constants: Vec::new(),
            given_static: static_coefficient,
            static_coefficient: 0.0,
            velocity_unit,
            scale: 1.0,
            maximum: None,
            proven: Proven::default(),
        };
        let law = law.settled()?;
        law.same_in_both_directions(&mirrored).map_err(|why| InvalidValues::from(refused(why)))?;
        Ok(law)
    }

    /// The law with all values that are derived from its numbers.
    fn settled(mut self) -> Result<Self, InvalidValues> {
        let refused = |law: &Self, why: UnusableFormula| {
            InvalidValues::from(Invalid::new(FORMULA, &law.text, why.to_string()))
        };
        self.constants = self.program.values(&self.named);
        self.proven = Proven::default();
        let (start, slope) = self.at(0.0);
        if !start.is_finite() || !slope.is_finite() {
            return Err(refused(&self, UnusableFormula::NotSmooth));
        }
        self.scale = self.scale_of_variation();
        // Differences of equal terms leave a rounding error relative to the terms.
        if start < -4.0 * f64::EPSILON {
            return Err(refused(&self, UnusableFormula::Negative { start }));
        }
        let level = self.given_static.unwrap_or(start);
        // A sum of decimals may miss the level by its rounding.
        let rounding = 4.0 * f64::EPSILON * level;
        if start > level + rounding {
            let allowed = format!(
                "at least μ(0⁺) = {start}, the coefficient at the onset of sliding: below it the contact could never stick"
            );
            return Err(InvalidValues::from(Invalid::new(STATIC_COEFFICIENT.path, level, allowed)));
        }
        self.static_coefficient = if start >= level - rounding { start } else { level };
        Ok(self)
    }

    /// The text of the formula.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Names and values of the constants, in order.
    pub fn named(&self) -> impl Iterator<Item = (&str, f64)> {
        self.names.iter().map(String::as_str).zip(self.named.iter().copied())
    }

    /// The same formula, intended for slip speeds up to the dimensionless `speed`; by default up to [`MULTIPLE`] times the
    /// speed of belt and dither.
    ///
    /// # Errors
    /// A speed that is not finite or not above 0.
    pub fn with_maximum_velocity(&self, speed: Option<f64>) -> Result<Self, InvalidValues> {
        if let Some(speed) = speed {
            MAXIMUM_VELOCITY.check(speed).map_err(InvalidValues::from)?;
        }
        let maximum = speed.map(|speed| speed / self.velocity_unit);
        Ok(Self { maximum, proven: Proven::default(), ..self.clone() })
    }

    /// The same formula, proven finite, smooth and not negative at every slip speed up to the dimensionless `speed`.
    /// The proof uses interval arithmetic on the tree of the formula.
    ///
    /// # Errors
    /// Under `friction.coefficient`: the slip at which the formula is negative or not finite, with its value, or at which
    /// it could not be proven.
    pub fn proven_up_to(&self, speed: f64) -> Result<Self, InvalidValues> {
        // No slip is faster than the largest number.
        let speed = (speed / self.velocity_unit).min(f64::MAX);
        if speed.is_nan() || speed <= 0.0 {
            return Ok(self.clone());
        }
        if self.proven.0.is_none_or(|proven| proven < speed) {
            let formula = Formula { tree: &self.tree, named: &self.named };
            proof::prove(&formula, |speed| self.at(speed), speed).map_err(|doubt| {
                InvalidValues::from(Invalid::new(FORMULA, &self.text, doubt.to_string()))
            })?;
        }
        Ok(Self { proven: Proven(Some(speed)), ..self.clone() })
    }

    /// Dimensionless velocity of one unit of v.
    pub fn velocity_unit(&self) -> f64 {
        self.velocity_unit
    }

    /// The same formula with v in another unit.
    #[must_use]
    pub fn in_unit(&self, velocity_unit: f64) -> Self {
        Self { velocity_unit, ..self.clone() }
    }

    /// Coefficient and slope at a slip speed in units of v.
    fn at(&self, speed: f64) -> (f64, f64) {
        series::at_speed(&self.program, &self.constants, speed)
    }

    /// The speed over which the formula varies near v = 0⁺: the smallest (|Dᵢ|/|Dⱼ|)^(1/(j−i)) of its
    /// derivatives, starting from the first nonzero one; v_m for e^(−v/v_m), and 1 for a constant.
    fn scale_of_variation(&self) -> f64 {
        let mut along =
            ExpressionConstants::new(Arc::clone(&self.program), self.constants.clone(), 1.0);
        let mut w = [0.0; DERIVATIVES + 2];
        w[1] = 1.0;
        let mut branch = along.start::<{ DERIVATIVES + 2 }>(1.0, 0.0);
        let mut derivatives = [branch.first(); DERIVATIVES + 1];
        let slope = branch.slope();
        let mut factorial = 1.0;
        for k in 1..=DERIVATIVES {
            factorial *= k as f64;
            derivatives[k] = factorial * slope.mul_add(w[k], branch.lower(k, &w));
        }
        let size = |k: usize| derivatives[k].abs();
        let Some(first) = (1..=DERIVATIVES).find(|&k| size(k) > 0.0) else { return 1.0 };
        let ratio =
            |from: usize, to: usize| libm::pow(size(from) / size(to), 1.0 / (to - from) as f64);
        let higher = (first + 1..=DERIVATIVES).map(|k| ratio(first, k));
        let scale =
            higher.chain([ratio(0, first)]).filter(|scale| scale.is_finite() && *scale > 0.0);
        scale.fold(f64::INFINITY, f64::min).min(f64::MAX.sqrt())
    }

    /// Whether the formula on the branch v < 0 is that on v > 0, or its negative.
    fn same_in_both_directions(&self, mirrored: &Program) -> Result<(), UnusableFormula> {
        let constants = mirrored.values(&self.named);
        let (mut even, mut odd) = (true, true);
        for place in 0..24 {
            let speed = self.scale * libm::exp(0.5 * f64::from(place) - 6.0);
            let (above, below) =
                (self.at(speed).0, series::at_speed(mirrored, &constants, speed).0);
            // A formula need not be defined beyond its range.
            if !(above.is_finite() && below.is_finite()) {
                continue;
            }
            let close = 1e-9 * above.abs();
            even &= (above - below).abs() <= close;
            odd &= (above + below).abs() <= close;
            if !even && !odd {
                return Err(UnusableFormula::OneSided { speed, above, below });
            }
        }
        Ok(())
    }
}

impl LawParameters for Expression {
    const NAME: &'static str = "expression";
    const ABOUT: &'static str =
        "a formula for the coefficient, such as 0.3 + 0.1*exp(-abs(v)/0.2), v the slip velocity";
    const PARAMETERS: &'static [Parameter] = &[STATIC_COEFFICIENT];
    const OPTIONS: &'static [Parameter] = &[MAXIMUM_VELOCITY];

    fn values(&self) -> Vec<f64> {
        vec![self.static_coefficient]
    }

    fn get(&self, path: &str) -> Option<f64> {
        if path == STATIC_COEFFICIENT.path {
            return Some(self.static_coefficient);
        }
        if path == MAXIMUM_VELOCITY.path {
            return self.maximum.or(self.proven.0).map(|speed| speed * self.velocity_unit);
        }
        let name = path.strip_prefix(CONSTANTS)?.strip_prefix('.')?;
        self.named().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        if path == STATIC_COEFFICIENT.path {
            STATIC_COEFFICIENT.check(value).map_err(InvalidValues::from)?;
            return Self { given_static: Some(value), ..self.clone() }.settled();
        }
        if path == MAXIMUM_VELOCITY.path {
            return self.with_maximum_velocity(Some(value));
        }
        let name = path.strip_prefix(CONSTANTS).and_then(|rest| rest.strip_prefix('.'));
        let index = self.names.iter().position(|known| Some(known.as_str()) == name);
        let index = index.ok_or_else(|| not_a_number_of::<Self>(path, value))?;
        if !value.is_finite() {
            return Err(InvalidValues::from(Invalid::new(path, value, "a finite number")));
        }
        let mut changed = self.clone();
        changed.named[index] = value;
        changed.settled()
    }
}

impl SlidingLaw for Expression {
    type Recurrence = Self;

    #[inline(always)]
    fn recurrence(&self) -> &Self {
        self
    }

    fn placed(&self, surroundings: &Surroundings) -> Result<Self, InvalidValues> {
        let own =
            || if surroundings.slip > 0.0 { surroundings.slip } else { self.velocity_scale() };
        let given = self.maximum.map(|speed| speed * self.velocity_unit);
        self.proven_up_to(given.unwrap_or_else(|| MULTIPLE * own()))
    }

    fn range(&self) -> Option<SlipRange> {
        let upper = self.maximum.or(self.proven.0)? * self.velocity_unit;
        let limit = if self.maximum.is_some() { RangeLimit::Declared } else { RangeLimit::Proven };
        Some(SlipRange { lower: 0.0, upper, limit })
    }

    #[inline(always)]
    fn velocity_scale(&self) -> f64 {
        self.scale * self.velocity_unit
    }

    #[inline(always)]
    fn static_coefficient(&self) -> f64 {
        self.static_coefficient
    }

    fn alone(&self, speed: f64) -> (f64, f64) {
        let (value, slope) = self.at(speed / self.velocity_unit);
        (value, slope * self.scale)
    }
}

impl LawSeries for Expression {
    type Constants<V: Lane> = ExpressionConstants<V>;

    fn constants<V: Lane>(laws: &[Self]) -> ExpressionConstants<V> {
        // Laws in lanes are alike: they have the same program.
        let first = &laws[0];
        let constants = (0..first.constants.len())
            .map(|place| side_by_side(laws, |law| law.constants[place]))
            .collect();
        let scale = side_by_side(laws, |law| law.scale);
        ExpressionConstants::new(Arc::clone(&first.program), constants, scale)
    }

    fn is_alike(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.program, &other.program) || self.program == other.program
    }

    type Series<'c, V: Lane, const N: usize> = ExpressionSeries<'c, V, N>;

    #[inline(always)]
    fn series<V: Lane, const N: usize>(
        constants: &mut ExpressionConstants<V>,
        sign: V,
        w0: V,
    ) -> ExpressionSeries<'_, V, N> {
        constants.start(sign, w0)
    }
}
