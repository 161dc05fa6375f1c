//! Growth of a disc over speed and friction.

use quell::complaint::Failure;
use quell::parallel::Parallel;
use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_linear::eigenvalues;
use quell_linear::floquet::FollowerDither;
use quell_linear::growth::Growth;
use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::floquet::Effort;

use super::super::failure::failed;

/// Growth over the axes of a study.
pub(crate) struct Growths {
    /// Speeds Ω.
    pub(crate) speeds: Vec<f64>,
    /// Frictions f*.
    pub(crate) frictions: Vec<f64>,
    /// Growth rates, ordered by speed, then friction.
    pub(crate) values: Vec<Growth>,
}

/// Growth of a disc at one speed, for any friction.
pub(super) enum DiscGrowth {
    Dithered(FollowerDither),
    Undithered(Linearised),
}

impl DiscGrowth {
    /// The disc at this speed; `name` is that of the figure, for failures.
    pub(super) fn at(name: &str, disc: &Disc, speed: f64) -> Result<Self, Failure> {
        let unit = disc.at_speed(speed).and_then(|disc| disc.with_friction_of(0, 1.0));
        let unit = unit.map_err(|_| failed(name, &"a disc of the map is not valid"))?;
        if let Some(dithered) = dithered::prepared(&unit).map_err(|why| failed(name, &why))? {
            return Ok(Self::Dithered(dithered));
        }
        let linear = linearised(&unit, Contributions::ALL).map_err(|why| failed(name, &why))?;
        Ok(Self::Undithered(linear))
    }

    /// The growth at a friction f*.
    pub(super) fn growth(&self, name: &str, friction: f64) -> Result<Growth, Failure> {
        match self {
            Self::Dithered(disc) => disc.growth(friction, Effort::default()),
            Self::Undithered(disc) => eigenvalues::growth(disc, &[friction]),
        }
        .map_err(|why| failed(name, &why))
    }
}

/// Growth of a disc over speeds and frictions, in parallel over the speeds.
pub(crate) fn growths(
    name: &str,
    disc: &Disc,
    speeds: Vec<f64>,
    frictions: Vec<f64>,
) -> Result<Growths, Failure> {
    let rows: Result<Vec<Vec<Growth>>, Failure> = speeds
        .in_parallel(|&speed| {
            let disc = DiscGrowth::at(name, disc, speed)?;
            frictions.iter().map(|&friction| disc.growth(name, friction)).collect()
        })
        .collect();
    Ok(Growths { values: rows?.concat(), speeds, frictions })
}
