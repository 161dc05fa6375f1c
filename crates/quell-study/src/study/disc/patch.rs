//! The area over which a load is distributed.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_model::disc::Patch;
use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{
    LOAD_EXTENT, LOAD_POINTS, LOAD_RADIAL_EXTENT, LOAD_RADIAL_POINTS,
};
use serde_json::Value as Json;

use super::plate::PlateModes;
use crate::study::reader::Reader;

/// Sizes of a patch as the study gives them.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchSize {
    /// Angular extent, radians.
    extent: f64,
    points: Option<usize>,
    /// Radial extent over the outer radius, and where it was written.
    radial: Option<(f64, Origin)>,
    radial_points: Option<usize>,
}

impl PatchSize {
    /// Reads the sizes; `Some(None)` for a load at a point.
    #[expect(clippy::option_option, reason = "invalid, absent, given")]
    pub(super) fn read(reader: &mut Reader, table: &Table, path: &str) -> Option<Option<Self>> {
        let mut maybe = |parameter: Parameter| reader.optional(table, path, parameter).if_given();
        let numbers = [LOAD_EXTENT, LOAD_RADIAL_EXTENT, LOAD_POINTS, LOAD_RADIAL_POINTS];
        let [extent, radial, points, radial_points] = numbers.map(&mut maybe);
        let (extent, radial, points, radial_points) = (extent?, radial?, points?, radial_points?);
        for (count, parameter, given, of) in [
            (points, LOAD_POINTS, extent, LOAD_EXTENT),
            (radial_points, LOAD_RADIAL_POINTS, radial, LOAD_RADIAL_EXTENT),
        ] {
            let Some((value, node)) = count.zip(table.get(parameter.key())) else { continue };
            if given.is_none() {
                let allowed = format!("only together with {}", of.key());
                let key = format!("{path}.{}", parameter.key());
                reader.complain(Complaint::new(Fault::Conflict, key, node.origin, value, allowed));
                return None;
            }
        }
        if extent.is_none() && radial.is_none() {
            return Some(None);
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole numbers within the bounds of the registry"
        )]
        let whole = |count: f64| count as usize;
        let written = table.get(LOAD_RADIAL_EXTENT.key()).map_or(Origin::Whole, |node| node.origin);
        Some(Some(Self {
            extent: extent.unwrap_or(0.0).to_radians(),
            points: points.map(whole),
            radial: radial.map(|extent| (extent, written)),
            radial_points: radial_points.map(whole),
        }))
    }

    /// The patch of a load at a radius of the plate; without a plate it has no radial extent.
    pub(super) fn around(
        &self,
        reader: &mut Reader,
        path: &str,
        radius: Option<f64>,
        diameters: usize,
        plate: Option<&PlateModes>,
    ) -> Option<Patch> {
        let points = self.points.unwrap_or_else(|| {
            let most = Patch::enough_points(self.extent, diameters);
            most.min(MOST_POINTS)
        });
        let Some((width, origin)) = self.radial else {
            return Some(Patch::sector(self.extent, points));
        };
        let sector = Patch::sector(self.extent, points);
        let patch = plate.zip(radius).and_then(|(plate, radius)| {
            let inner = plate.plate.inner_radius_ratio();
            let (from, to) = (radius - 0.5 * width, radius + 0.5 * width);
            let count = self.radial_points.unwrap_or(plate.radial_modes + 8);
            let shapes = |at| {
                let modes = plate.set.at_radius(at, 0.0)?;
                Some(modes.iter().map(|mode| mode.shape_at_load).collect())
            };
            (from >= inner && to <= 1.0).then(|| sector.over_radii(radius, width, count, shapes))?
        });
        if patch.is_none() {
            let key = format!("{path}.{}", LOAD_RADIAL_EXTENT.key());
            let allowed = match plate {
                None => "no radial extent: the shapes of listed modes are known at one radius only"
                    .to_owned(),
                Some(plate) => format!(
                    "a width such that the load stays between the clamp at {} and the edge at 1",
                    plate.plate.inner_radius_ratio()
                ),
            };
            let given = Json::from(width);
            reader.complain(Complaint::new(Fault::Value, key, origin, given, allowed));
        }
        patch
    }
}

/// Most points over the angle by default.
const MOST_POINTS: usize = 200;
