//! `fit`: friction laws fitted to a file of measurements, and compared by Akaike's criterion.
//!
//! Laws are odd in the slip velocity. The sign that a file gives the coefficient is found for each direction of slip: friction has
//! the sign of the majority there. Points at rest are left out, because friction there may have any value up to the static level.

use std::fmt::Write as _;
use std::path::Path;

use quell_design::fit::{
    Estimate, FitModel, FitPoint, LawFit, akaike_weights, fit, student_quantile,
};
use quell_input::columns::ColumnChoice;
use quell_input::measurement::{COLUMNS, FrictionData, FrictionScale};
use quell_model::InvalidValues;
use quell_model::friction::LawKind;
use quell_model::parameter::Parameter;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use crate::complaint::{Complaint, Failure, Fault, Origin};

/// The name that stands for every law whose steady curve differs from that of the others.
pub const ALL: &str = "all";

/// Probability that the confidence intervals contain the true value.
pub const CONFIDENCE: f64 = 0.95;

/// Options of `fit`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitRequest {
    laws: Vec<LawKind>,
    /// Whether laws that the points do not suffice for are left out.
    lenient: bool,
    free: Vec<String>,
    fixed: Vec<(String, f64)>,
    columns: ColumnChoice,
}

impl FitRequest {
    /// From names of laws (none or `all`: every law), keys to estimate, `KEY=VALUE` to fix, and `QUANTITY=COLUMN` of the file.
    ///
    /// # Errors
    /// Every unknown law, key, value and column.
    pub fn new(
        laws: &[String],
        free: &[String],
        fixed: &[String],
        columns: &[String],
    ) -> Result<Self, Failure> {
        let mut wrong = Vec::new();
        let mut request = Self { lenient: laws.is_empty(), ..Self::default() };
        for name in laws {
            if name == ALL {
                request.lenient = true;
                continue;
            }
            match LawKind::from_name(name).filter(|kind| FitModel::LAWS.contains(kind)) {
                Some(kind) if !request.laws.contains(&kind) => request.laws.push(kind),
                Some(_) => {}
                None => {
                    let names: Vec<&str> = FitModel::LAWS.iter().map(|kind| kind.name()).collect();
                    let allowed = format!("one of {}, or {ALL}", names.join(", "));
                    wrong.push(Complaint::option("--law", name.as_str(), allowed));
                }
            }
        }
        if request.lenient {
            for kind in distinct_laws() {
                if !request.laws.contains(&kind) {
                    request.laws.push(kind);
                }
            }
        }
        for text in fixed {
            let pair = text.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
            match pair.and_then(|(key, value)| Some((key, value.parse::<f64>().ok()?))) {
                Some((key, value)) if value.is_finite() => {
                    request.fixed.push((key.to_owned(), value));
                }
                _ => {
                    let allowed = "NAME=VALUE with a finite number, such as static_coefficient=0.4";
                    wrong.push(Complaint::option("--fix", text.as_str(), allowed));
                }
            }
        }
        request.free = free.to_vec();
        match ColumnChoice::new(columns, &COLUMNS) {
            Ok(columns) => request.columns = columns,
            Err(Failure::Wrong(complaints)) => wrong.extend(complaints),
            Err(why) => return Err(why),
        }
        wrong.extend(request.keys_are_known());
        if wrong.is_empty() { Ok(request) } else { Err(wrong.into()) }
    }

    /// Complaints about keys that no requested law has, and that are both free and fixed.
    fn keys_are_known(&self) -> Vec<Complaint> {
        let keys = || self.laws.iter().flat_map(|kind| kind.parameters()).map(Parameter::key);
        let free = self.free.iter().map(|key| ("--free", key));
        let fixed = self.fixed.iter().map(|(key, _)| ("--fix", key));
        let mut wrong = Vec::new();
        for (option, key) in free.chain(fixed) {
            if !keys().any(|known| known == key) {
                let mut known: Vec<&str> = keys().collect();
                known.sort_unstable();
                known.dedup();
                let allowed = format!("a parameter of the laws: {}", known.join(", "));
                wrong.push(Complaint::option(option, key.as_str(), allowed));
            }
        }
        for key in &self.free {
            if self.fixed.iter().any(|(fixed, _)| fixed == key) {
                let allowed = format!("{key} is given to --free and to --fix");
                let origin = Origin::Argument("--free");
                let given = key.as_str();
                wrong.push(Complaint::new(Fault::Conflict, "--free", origin, given, allowed));
            }
        }
        wrong
    }

    /// The model of a law with the parameters that are free and fixed.
    fn model(&self, kind: LawKind) -> Result<FitModel, Failure> {
        let missing = || Complaint::option("--law", kind.name(), "a law defined by numbers");
        let mut model = FitModel::new(kind).ok_or_else(missing)?;
        for key in self.free.iter().filter(|key| kind_has(kind, key)) {
            model = model.freeing(key).map_err(|why| refused("--free", key, &why))?;
        }
        for (key, value) in self.fixed.iter().filter(|(key, _)| kind_has(kind, key)) {
            let given = format!("{key}={value}");
            model = model.fixing(key, *value).map_err(|why| refused("--fix", &given, &why))?;
        }
        Ok(model)
    }
}

/// The laws whose steady curves differ. In steady sliding, LuGre friction is the exponential law.
fn distinct_laws() -> impl Iterator<Item = LawKind> {
    FitModel::LAWS.iter().copied().filter(|kind| *kind != LawKind::Lugre)
}

fn kind_has(kind: LawKind, key: &str) -> bool {
    kind.parameters().iter().any(|parameter| parameter.key() == key)
}

fn refused(option: &'static str, given: &str, why: &InvalidValues) -> Failure {
    let allowed: Vec<&str> = why.iter().map(|invalid| invalid.allowed.as_str()).collect();
    Complaint::option(option, given, allowed.join("; ")).into()
}

/// How a file gives the sign of the coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignConvention {
    /// All points slip in one direction.
    OneDirection,
    /// The coefficient has the sign of the slip velocity.
    Signed,
    /// The coefficient has the opposite sign of the slip velocity, as the force on the other body has.
    Opposed,
    /// The coefficient has one sign for both directions.
    Absolute,
}

impl SignConvention {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::OneDirection => "one-direction",
            Self::Signed => "signed",
            Self::Opposed => "opposed",
            Self::Absolute => "absolute",
        }
    }

    /// What is assumed, in one sentence.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::OneDirection => {
                "All points slip in one direction; friction is assumed equal in the other one."
            }
            Self::Signed => {
                "The coefficient has the sign of the slip velocity; friction is assumed equal in both directions."
            }
            Self::Opposed => {
                "The coefficient has the opposite sign of the slip velocity; friction is assumed equal in both directions."
            }
            Self::Absolute => {
                "The coefficient has one sign for both directions of slip; friction is assumed equal in both."
            }
        }
    }
}

/// Laws fitted to a file.
#[derive(Clone, Debug)]
pub struct FrictionFit {
    /// The file.
    pub data: FrictionData,
    /// The points that were fitted, with coefficients positive where friction opposes slip.
    pub points: Vec<FitPoint>,
    /// Their lines in the file.
    pub lines: Vec<usize>,
    /// Lines of points at rest, which are left out.
    pub at_rest: Vec<usize>,
    /// The sign of the coefficient.
    pub sign: SignConvention,
    /// The fits by ascending AIC, at least one.
    pub fits: Vec<LawFit>,
    /// Akaike weights of the fits; `None` if one has no criterion.
    pub weights: Option<Vec<f64>>,
    /// Laws that could not be fitted, with the reason.
    pub left_out: Vec<(LawKind, String)>,
}

/// Fits laws to a file.
///
/// # Errors
/// Complaints about the file and the options; a law that cannot be fitted, unless it is one of all laws.
pub fn run(path: &Path, request: &FitRequest) -> Result<FrictionFit, Failure> {
    let data = FrictionData::read(path, &request.columns)?;
    let (points, lines, at_rest, sign) = oriented(&data);
    let (mut fits, mut left_out) = (Vec::new(), Vec::new());
    for kind in &request.laws {
        let model = match request.model(*kind) {
            Ok(model) => model,
            Err(why) if request.lenient && request.laws.len() > 1 => {
                left_out.push((*kind, why.to_string()));
                continue;
            }
            Err(why) => return Err(why),
        };
        match fit(&model, &points) {
            Ok(found) => fits.push(found),
            Err(why) => left_out.push((*kind, why.to_string())),
        }
    }
    if fits.is_empty() || (!request.lenient && !left_out.is_empty()) {
        let file = data.path().display().to_string();
        let complaints = left_out.iter().map(|(kind, why)| {
            let allowed = format!("the law {} cannot be fitted: {why}", kind.name());
            Complaint::new(Fault::Path, "data file", Origin::Whole, file.as_str(), allowed)
        });
        return Err(complaints.collect::<Vec<_>>().into());
    }
    // A law through every point has no criterion, and nothing is better but one with fewer parameters.
    let criterion = |fit: &LawFit| fit.aic().unwrap_or(f64::NEG_INFINITY);
    fits.sort_by(|a, b| criterion(a).total_cmp(&criterion(b)).then(a.free.cmp(&b.free)));
    let criteria: Result<Vec<f64>, _> = fits.iter().map(LawFit::aic).collect();
    let weights = criteria.ok().map(|criteria| akaike_weights(&criteria));
    Ok(FrictionFit { data, points, lines, at_rest, sign, fits, weights, left_out })
}

/// The points with friction positive where it opposes slip, their lines, the lines at rest, and the convention of the file.
fn oriented(data: &FrictionData) -> (Vec<FitPoint>, Vec<usize>, Vec<usize>, SignConvention) {
    let sign_of = |forward: bool| -> Option<f64> {
        let own = data
            .points()
            .iter()
            .filter(|point| point.slip_velocity != 0.0 && (point.slip_velocity > 0.0) == forward);
        let (mut count, mut balance) = (0_usize, 0_i64);
        for point in own {
            count += 1;
            balance += if point.coefficient < 0.0 { -1 } else { 1 };
        }
        (count > 0).then_some(if balance < 0 { -1.0 } else { 1.0 })
    };
    let (ahead, behind) = (sign_of(true), sign_of(false));
    let sign = match (ahead, behind) {
        (Some(ahead), Some(behind)) if ahead == behind => SignConvention::Absolute,
        (Some(ahead), Some(_)) if ahead < 0.0 => SignConvention::Opposed,
        (Some(_), Some(_)) => SignConvention::Signed,
        _ => SignConvention::OneDirection,
    };
    let (mut points, mut lines, mut at_rest) = (Vec::new(), Vec::new(), Vec::new());
    for point in data.points() {
        if point.slip_velocity == 0.0 {
            at_rest.push(point.line);
            continue;
        }
        let factor = if point.slip_velocity > 0.0 { ahead } else { behind };
        points.push(FitPoint {
            slip_velocity: point.slip_velocity,
            coefficient: factor.unwrap_or(1.0) * point.coefficient,
            standard_deviation: point.standard_deviation,
        });
        lines.push(point.line);
    }
    (points, lines, at_rest, sign)
}

/// The fitted curve with its confidence band.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// Slip speeds.
    pub speeds: Vec<f64>,
    /// μ.
    pub coefficients: Vec<f64>,
    /// Lower end of the band.
    pub low: Vec<f64>,
    /// Upper end of the band.
    pub high: Vec<f64>,
}

impl FrictionFit {
    /// The fit with the least AIC.
    pub fn best(&self) -> &LawFit {
        &self.fits[0]
    }

    /// Whether every law was fitted or left out with a reason, so that no other law is left to compare.
    pub fn compares_all(&self) -> bool {
        distinct_laws().all(|kind| {
            self.fits.iter().any(|fit| fit.kind == kind)
                || self.left_out.iter().any(|(other, _)| *other == kind)
        })
    }

    /// Student's t of the confidence intervals.
    pub fn quantile(&self, fit: &LawFit) -> f64 {
        student_quantile(CONFIDENCE, fit.points - fit.free)
    }

    /// The unit of friction that is a force or a torque, if the file gives one.
    pub fn force_unit(&self) -> Option<&'static str> {
        match self.data.scale() {
            FrictionScale::Force(unit) => unit,
            FrictionScale::Coefficient => None,
        }
    }

    /// What friction is: `coefficient`, `force` or `torque`.
    pub fn friction_is(&self) -> &'static str {
        match self.data.scale() {
            FrictionScale::Coefficient => "coefficient",
            FrictionScale::Force(Some("Nm")) => "torque",
            FrictionScale::Force(_) => "force",
        }
    }

    /// The curve of a fit at these many speeds from the slowest to the fastest point.
    pub fn curve(&self, fit: &LawFit, count: usize) -> FittedCurve {
        let speeds = || self.points.iter().map(FitPoint::speed);
        let slowest = speeds().fold(f64::INFINITY, f64::min);
        let fastest = speeds().fold(0.0, f64::max);
        let count = if slowest < fastest { count } else { 1 };
        let speeds = super::evenly(RealInterval::new(slowest, fastest), count);
        let t = self.quantile(fit);
        let of = |side: f64| -> Vec<f64> {
            let at = |v: &f64| fit.coefficient(*v) + side * t * fit.standard_deviation(*v);
            speeds.iter().map(at).collect()
        };
        FittedCurve { coefficients: of(0.0), low: of(-1.0), high: of(1.0), speeds: speeds.clone() }
    }

    /// The table `[friction]` of a study with the fitted law, and `[uncertainty]` with its covariance.
    pub fn fragments(&self, fit: &LawFit) -> (String, String) {
        let is_si = self.data.velocity_unit() == Some("m/s");
        let is_force = self.data.scale() != FrictionScale::Coefficient;
        // Levels that are forces have bare keys.
        let key = |parameter: &Parameter| match parameter.si.first() {
            Some(twin) if is_si && (!is_force || parameter.quantity == Quantity::Velocity) => {
                twin.key
            }
            _ => parameter.key(),
        };
        let mut friction = format!("[friction]\nlaw = \"{}\"\n", fit.name());
        if is_force {
            friction += "friction_force = true\n";
        }
        if let (Some(unit), true) = (self.data.velocity_unit(), !is_si || is_force) {
            let force =
                self.force_unit().map_or(String::new(), |unit| format!(", levels in {unit}"));
            let _ = writeln!(friction, "# slip velocities in {unit}{force}");
        }
        for fitted in &fit.parameters {
            let _ = writeln!(friction, "{} = {:?}", key(&fitted.parameter), fitted.value);
        }
        for parameter in fit.kind.parameters() {
            let given = fit.parameter(parameter.path).is_some();
            if !given && fit.kind.default_of(parameter.path).is_none() {
                let name = key(parameter);
                let _ = writeln!(
                    friction,
                    "# {name} = …    # required; steady sliding does not depend on it"
                );
            }
        }
        let path = |parameter: &Parameter| format!("friction.{}", key(parameter));
        let estimated = |parameter: &Parameter| {
            fit.parameter(parameter.path).map_or(0.0, |fitted| fitted.value)
        };
        let covariance = &fit.covariance;
        // Points without scatter give no uncertainty that a study could take.
        let has_errors = (0..covariance.order.len()).all(|row| covariance.matrix[row][row] > 0.0);
        let order = if has_errors { &covariance.order[..] } else { &[] };
        let uncertainty = match order {
            [] => String::new(),
            [only] => format!(
                "[uncertainty]\n\"{}\" = {{ normal = [{:?}, {:?}] }}\n",
                path(only),
                estimated(only),
                covariance.matrix[0][0].sqrt()
            ),
            several => {
                let paths: Vec<String> = several.iter().map(path).collect();
                let means: Vec<f64> = several.iter().map(estimated).collect();
                let rows: Vec<String> =
                    covariance.matrix.iter().map(|row| format!("    {row:?},\n")).collect();
                format!(
                    "[uncertainty.covariance]\nof = {paths:?}\nmean = {means:?}\nmatrix = [\n{}]\n",
                    rows.concat()
                )
            }
        };
        (friction, uncertainty)
    }

    /// Keys of the parameters of a law that steady sliding does not depend on.
    pub fn not_in_steady_sliding(fit: &LawFit) -> Vec<&'static str> {
        let Some(model) = FitModel::new(fit.kind) else { return Vec::new() };
        let all = fit.kind.parameters().iter().zip(model.estimates());
        all.filter(|(_, estimate)| **estimate == Estimate::Unused)
            .map(|(parameter, _)| parameter.key())
            .collect()
    }
}
