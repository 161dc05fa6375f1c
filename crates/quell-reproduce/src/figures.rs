//! The list of the figures and tables.

use super::entry::CatalogueEntry;
use super::laws::LAWS;
use super::residual_map::VELOCITIES;
use super::source::WAVEFORMS;
use super::stability_map::DAMPING;
use super::{
    disc, effective_friction, laws, measured_friction, residual_map, responses, sections,
    stability_map, waveforms,
};

/// A figure with its parameters in `studies/figure-NAME.toml`.
macro_rules! figure {
    ($name:literal, $about:literal, $make:path $(, $family:expr)*) => {
        CatalogueEntry {
            name: $name,
            about: $about,
            study: include_str!(concat!("../studies/figure-", $name, ".toml")),
            families: &[$($family),*],
            make: $make,
        }
    };
}

/// A table with its parameters in `studies/NAME.toml`.
macro_rules! table {
    ($name:literal, $about:literal, $make:path) => {
        CatalogueEntry {
            name: $name,
            about: $about,
            study: include_str!(concat!("../studies/", $name, ".toml")),
            families: &[],
            make: $make,
        }
    };
}

/// All figures and tables, in the order of the dissertation.
pub(super) const FIGURES: &[CatalogueEntry] = &[
    figure!("2.2", "Stribeck and decreasing friction law", laws::figure, LAWS),
    figure!("2.3", "responses, Stribeck law, sinusoidal tangential dither", responses::figure),
    figure!("2.4", "effective friction, Stribeck law", effective_friction::figure),
    figure!("2.5", "effective friction, decreasing law", effective_friction::figure),
    figure!("2.6", "stability map, Stribeck law", stability_map::single, DAMPING),
    figure!("2.7", "stability map, decreasing law", stability_map::single, DAMPING),
    figure!(
        "2.8",
        "residual vibration, Stribeck law, four belt velocities",
        residual_map::velocities,
        VELOCITIES
    ),
    figure!(
        "2.9",
        "residual vibration, decreasing law, four belt velocities",
        residual_map::velocities,
        VELOCITIES
    ),
    figure!("2.10", "responses and sections, decreasing law, sine, v₀ = 1", sections::figure),
    figure!("2.11", "responses and sections, decreasing law, sine, v₀ = 1.5", sections::figure),
    figure!("3.2", "dither waveforms and their integrals", waveforms::figure, WAVEFORMS),
    figure!(
        "3.3",
        "effective friction, Stribeck law, three waveforms",
        effective_friction::three,
        WAVEFORMS
    ),
    figure!(
        "3.4",
        "effective friction, decreasing law, three waveforms",
        effective_friction::three,
        WAVEFORMS
    ),
    figure!(
        "3.5",
        "stability maps, Stribeck law, three waveforms",
        stability_map::three,
        WAVEFORMS
    ),
    figure!(
        "3.6",
        "stability maps, decreasing law, three waveforms",
        stability_map::three,
        WAVEFORMS
    ),
    figure!("3.7", "responses, Stribeck law, sinusoidal tangential dither", responses::figure),
    figure!("3.8", "responses, Stribeck law, triangular tangential dither", responses::figure),
    figure!("3.9", "responses, Stribeck law, square tangential dither", responses::figure),
    figure!(
        "3.10",
        "residual vibration, Stribeck law, three waveforms",
        residual_map::waveforms,
        VELOCITIES,
        WAVEFORMS
    ),
    figure!(
        "3.11",
        "residual vibration, decreasing law, three waveforms",
        residual_map::waveforms,
        VELOCITIES,
        WAVEFORMS
    ),
    figure!("3.12", "responses and sections, decreasing law, triangle", sections::figure),
    figure!("3.13", "responses and sections, decreasing law, square", sections::figure),
    figure!("4.2", "Stribeck and decreasing friction law", laws::figure, LAWS),
    figure!("4.3", "responses, Stribeck law, sinusoidal normal dither", responses::figure),
    figure!("4.4", "responses, decreasing law, sinusoidal normal dither", responses::figure),
    figure!("4.5", "effective friction from simulation, Stribeck law", measured_friction::figure),
    figure!("4.6", "effective friction from simulation, decreasing law", measured_friction::figure),
    figure!("4.7", "stability maps, Stribeck law, normal dither", stability_map::three, WAVEFORMS),
    figure!(
        "4.8",
        "stability maps, decreasing law, normal dither",
        stability_map::three,
        WAVEFORMS
    ),
    figure!("4.9", "residual vibration, Stribeck law, normal dither", residual_map::single),
    figure!("4.10", "residual vibration, decreasing law, normal dither", residual_map::single),
    figure!(
        "4.11",
        "responses and sections, normal dither, square and sine",
        sections::square_and_sine,
        WAVEFORMS
    ),
    table!("table-5.1", "speeds at which waves of the disc meet", disc::undithered),
    table!("table-5.2", "speeds at which dither makes waves of the disc meet", disc::induced),
    figure!("5.2", "modes of the annular plate", disc::modes),
    figure!("5.3", "growth of the disc, N = (1, 2), no dither", disc::sizes),
    figure!("5.4", "growth of the disc, N = (1, 5), no dither", disc::sizes),
    figure!("5.5", "growth of the disc, N = (2, 5), no dither", disc::sizes),
    figure!("5.6", "responses that grow, stay, decay", disc::responses),
    figure!("5.7", "growth of the disc, normal dither, ξ = 0", disc::maps),
    figure!("5.8", "growth of the disc, normal dither, ξ = 10⁻³", disc::maps),
    figure!("5.9", "growth of the disc, tangential dither, m = c = k = 0.1", disc::maps),
    figure!("5.10", "growth of the disc, tangential dither, m = c = k = 0.2", disc::maps),
    figure!("5.11", "growth of the disc, tangential dither, m = c = k = 0.3", disc::maps),
    figure!("5.12", "growth of the disc, tangential dither, ξ = 0", disc::maps),
    figure!("5.13", "growth of the disc, tangential dither, ξ = 10⁻⁵", disc::maps),
    figure!("5.14", "growth of the disc, tangential dither, ξ = 10⁻⁴", disc::maps),
    figure!("5.15", "growth of the disc, tangential dither, ξ = 10⁻³", disc::maps),
];
