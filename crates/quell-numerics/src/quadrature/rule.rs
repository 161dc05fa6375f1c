//! The pair of rules (10, 21) on one panel: the value and an estimate of its error.

use super::integral::QuadratureError;

/// Nodes in (0, 1) of the 21-point Kronrod rule, outermost first; the Gauss nodes have odd indices.
pub(super) const NODES: [f64; 10] = [
    0.9956571630258080807355272806890028,
    0.9739065285171717200779640120844521,
    0.9301574913557082260012071800595083,
    0.865063366688984510732096688423493,
    0.7808177265864168970637175783450424,
    0.6794095682990244062343273651148736,
    0.5627571346686046833390000992726941,
    0.4333953941292471907992659431657842,
    0.2943928627014601981311266031038656,
    0.14887433898163121088482600112972,
];
/// Kronrod weights of [`NODES`].
const KRONROD: [f64; 10] = [
    0.01169463886737187427806439606219205,
    0.03255816230796472747881897245938976,
    0.05475589657435199603138130024458018,
    0.07503967481091995276704314091619001,
    0.09312545458369760553506546508336634,
    0.109387158802297641899210590325805,
    0.1234919762620658510779581098310742,
    0.1347092173114733259280540017718067,
    0.1427759385770600807970942731387171,
    0.147739104901338491374841515972068,
];
/// Kronrod weight of the centre.
const KRONROD_CENTRE: f64 = 0.1494455540029169056649364683898212;
/// Gauss weights of the nodes with odd indices in [`NODES`].
pub(super) const GAUSS: [f64; 5] = [
    0.06667134430868813759356880989333179,
    0.1494513491505805931457763396576973,
    0.2190863625159820439955349342281632,
    0.2692667193099963550912269215694694,
    0.2955242247147528701738929946513383,
];

/// One panel with its Kronrod value, its error estimate and ∫|f|.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadraturePanel {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) value: f64,
    pub(super) error: f64,
    pub(super) floor: f64,
}

impl QuadraturePanel {
    /// Whether bisection could still lower the error.
    pub(super) fn can_improve(&self) -> bool {
        let middle = self.from.midpoint(self.to);
        self.error > self.floor && middle > self.from && middle < self.to
    }
}

impl PartialEq for QuadraturePanel {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for QuadraturePanel {}
impl PartialOrd for QuadraturePanel {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for QuadraturePanel {
    /// Largest error first; ties are broken by position, so that the order of bisection is always the same.
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.error.total_cmp(&other.error).then(other.from.total_cmp(&self.from))
    }
}

/// Applies the pair of rules to one panel.
pub(super) fn panel(
    f: &mut impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
) -> Result<QuadraturePanel, QuadratureError> {
    let centre = from.midpoint(to);
    let half = 0.5 * (to - from);
    let mut below = [0.0; 10];
    let mut above = [0.0; 10];
    let mut finite = |x: f64| {
        let y = f(x);
        if y.is_finite() { Ok(y) } else { Err(QuadratureError::IntegrandNotFinite { at: x }) }
    };
    let middle = finite(centre)?;
    for (i, node) in NODES.iter().enumerate() {
        below[i] = finite(centre - half * node)?;
        above[i] = finite(centre + half * node)?;
    }
    let mut kronrod = KRONROD_CENTRE * middle;
    let mut magnitude = KRONROD_CENTRE * middle.abs();
    let mut gauss = 0.0;
    for i in 0..10 {
        kronrod += KRONROD[i] * (below[i] + above[i]);
        magnitude += KRONROD[i] * (below[i].abs() + above[i].abs());
        if i % 2 == 1 {
            gauss += GAUSS[i / 2] * (below[i] + above[i]);
        }
    }
    let mean = 0.5 * kronrod;
    let mut spread = KRONROD_CENTRE * (middle - mean).abs();
    for i in 0..10 {
        spread += KRONROD[i] * ((below[i] - mean).abs() + (above[i] - mean).abs());
    }
    let scale = half.abs();
    let difference = (kronrod - gauss).abs() * scale;
    let spread = spread * scale;
    let floor = 4.0 * f64::EPSILON * magnitude * scale;
    let estimate = if spread > 0.0 && difference > 0.0 {
        let ratio = 200.0 * difference / spread;
        spread * f64::min(1.0, ratio * ratio.sqrt())
    } else {
        difference
    };
    Ok(QuadraturePanel { from, to, value: kronrod * half, error: estimate.max(floor), floor })
}
