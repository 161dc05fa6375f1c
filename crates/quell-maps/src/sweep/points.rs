//! The points of a chunk of a map, and what has been computed at them.

use std::any::{Any, TypeId};
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

use quell_model::disc::Contributions;
use quell_model::{Disc, System};

use super::grid::Grid;
use crate::cite::Task;
use crate::disc_units::DiscUnits;
use crate::status::Status;
use crate::study::{DiscStudy, Study, SystemStudy};

/// What is computed at a point: the motion of a disc, or that of a system, which a belt is as well.
#[derive(Clone, Debug)]
pub(super) enum Subject {
    /// A disc.
    Disc(Box<DiscSubject>),
    /// A belt or a system, in the units of its study.
    System(Box<System>),
}

/// A disc, in the numbers of its equations.
#[derive(Clone, Debug)]
pub(super) struct DiscSubject {
    /// The disc.
    pub(super) disc: Disc,
    /// The forces of its loads that act.
    pub(super) parts: Contributions,
    /// A rate of its equations in the units of its study.
    pub(super) rate: f64,
}

impl DiscSubject {
    /// Every point has the units of the study, and an ω_ref of its own.
    fn of(study: &DiscStudy, disc: Disc, has_units: bool) -> Self {
        let scales = disc.scales(0).filter(|_| has_units);
        let rate = scales.map_or(1.0, |scales| scales.angular_frequency());
        Self { disc, parts: study.parts(), rate }
    }
}

impl Subject {
    /// That of a whole study; `None` where its numbers form no valid system.
    pub(super) fn of(study: &Study) -> Option<Self> {
        match study.disc() {
            Ok(study) => {
                let (disc, has_units) = (study.disc().clone(), DiscUnits::of(&study).is_some());
                Some(Self::Disc(Box::new(DiscSubject::of(&study, disc, has_units))))
            }
            Err(_) => Some(Self::System(Box::new(study.model().at(&[]).ok()?))),
        }
    }

    /// Work of a computation over that for a number of states, whose square it follows; of few states the rest of it decides.
    pub(super) fn work_over(&self, states: f64) -> f64 {
        let own = match self {
            Self::Disc(subject) => 2.0 * subject.disc.coordinates() as f64,
            Self::System(system) => system.state_size() as f64,
        };
        (own / states).powi(2).max(0.1)
    }
}

/// One valid point.
pub(super) struct Point<'g> {
    grid: &'g Grid,
    index: usize,
    /// What is computed.
    pub(super) subject: Subject,
    study: OnceCell<Result<SystemStudy, Status>>,
}

impl Point<'_> {
    /// The system; a disc has none here.
    ///
    /// # Errors
    /// The status of a disc.
    pub(super) fn system(&self) -> Result<&System, Status> {
        match &self.subject {
            Subject::System(system) => Ok(system),
            Subject::Disc(_) => Err(Status::InvalidStudy),
        }
    }

    /// The study of the system, which knows where runs begin and how they are observed.
    ///
    /// # Errors
    /// The status of numbers that form no valid study.
    pub(super) fn study(&self) -> Result<&SystemStudy, Status> {
        let read = || {
            let study = self.grid.study_at(self.index).map_err(|_| Status::InvalidStudy)?;
            Ok(study.system())
        };
        self.study.get_or_init(read).as_ref().map_err(|status| *status)
    }
}

/// A number at a point with its status, or why it is unknown.
pub(super) type PointValue = Result<(f64, Status), Status>;

/// A computation at the points of a map, done once for all variables that read it.
pub(super) trait PointComputation: Sized + 'static {
    /// The task whose sources it uses.
    const TASK: Task = Task::Stability;

    /// Computes at every point of a chunk.
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>>;

    /// Estimated seconds of one point, which depend on its study alone.
    fn seconds(subject: &Subject) -> f64;

    /// The status of a known value: where it does not hold as stated.
    fn qualification(&self, value: f64) -> Status {
        let _ = value;
        Status::Known
    }
}

/// The points of a chunk, and what has been computed at them.
pub(super) struct ChunkPoints<'g> {
    points: Vec<Option<Point<'g>>>,
    found: RefCell<HashMap<TypeId, Rc<dyn Any>>>,
}

impl<'g> ChunkPoints<'g> {
    /// The points with these indices in a grid.
    pub(super) fn of(grid: &'g Grid, indices: &[usize]) -> Self {
        let disc = grid.study().disc().ok();
        let has_units = disc.as_ref().is_some_and(|study| DiscUnits::of(study).is_some());
        let subject = |index: usize| {
            let numbers = grid.numbers_at(index);
            Some(match &disc {
                Some(study) => {
                    let disc = study.setup_at(&numbers).ok()?.disc().clone();
                    Subject::Disc(Box::new(DiscSubject::of(study, disc, has_units)))
                }
                None => Subject::System(Box::new(grid.study().model().at(&numbers).ok()?)),
            })
        };
        let point = |index: &usize| {
            Some(Point { grid, index: *index, subject: subject(*index)?, study: OnceCell::new() })
        };
        Self { points: indices.iter().map(point).collect(), found: RefCell::default() }
    }

    /// The valid points.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Point<'g>> {
        self.points.iter().flatten()
    }

    /// Computes at each valid point alone.
    pub(super) fn each<'p, T>(
        &'p self,
        compute: impl Fn(&'p Point<'g>) -> Result<T, Status>,
    ) -> Vec<Result<T, Status>> {
        self.iter().map(compute).collect()
    }

    /// What a computation has found at the valid points.
    pub(super) fn found<T: PointComputation>(&self) -> Rc<Vec<Result<T, Status>>> {
        let known = self.found.borrow().get(&TypeId::of::<T>()).cloned();
        if let Some(known) = known.and_then(|known| known.downcast().ok()) {
            return known;
        }
        let found = Rc::new(T::at(self));
        self.found.borrow_mut().insert(TypeId::of::<T>(), Rc::clone(&found) as Rc<dyn Any>);
        found
    }

    /// A value of a computation at every point, with what qualifies it.
    pub(super) fn values<T: PointComputation>(
        &self,
        read: impl Fn(&T) -> Result<f64, Status>,
    ) -> Vec<PointValue> {
        let found = self.found::<T>();
        let mut found = found.iter();
        let mut value = |point: &Option<Point<'g>>| {
            point.as_ref().ok_or(Status::InvalidStudy)?;
            let one = found.next().unwrap_or(&Err(Status::Missing));
            let one = one.as_ref().map_err(|status| *status)?;
            let value = read(one)?;
            if value.is_finite() {
                Ok((value, one.qualification(value)))
            } else {
                Err(Status::NotFinite)
            }
        };
        self.points.iter().map(&mut value).collect()
    }
}
