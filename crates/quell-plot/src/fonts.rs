//! The fonts of all figures: the DejaVu Sans of the folder `assets`, never a system font.

use std::io::Read as _;
use std::sync::{Arc, OnceLock};

use flate2::read::GzDecoder;
use resvg::usvg::fontdb::Database;
use ttf_parser::Face as Table;

/// Font families requested in an SVG; the fallbacks have nearly the widths of the first.
pub(super) const FAMILY: &str = "DejaVu Sans, Bitstream Vera Sans, Verdana, sans-serif";
/// Font family requested when rasterising an SVG.
pub(super) const BUNDLED_FAMILY: &str = "DejaVu Sans";

/// A face of the family, in the order of [`COMPRESSED`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Face {
    Regular,
    Bold,
    Oblique,
}

const COMPRESSED: [&[u8]; 3] = [
    include_bytes!("../assets/DejaVuSans.ttf.gz"),
    include_bytes!("../assets/DejaVuSans-Bold.ttf.gz"),
    include_bytes!("../assets/DejaVuSans-Oblique.ttf.gz"),
];

fn files() -> &'static [Vec<u8>] {
    static FILES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let inflated = |file: &[u8]| {
            let mut font = Vec::new();
            GzDecoder::new(file).read_to_end(&mut font).map(|_| font)
        };
        COMPRESSED.iter().filter_map(|file| inflated(file).ok()).collect()
    })
}

fn tables() -> &'static [Table<'static>] {
    static TABLES: OnceLock<Vec<Table<'static>>> = OnceLock::new();
    TABLES.get_or_init(|| files().iter().filter_map(|file| Table::parse(file, 0).ok()).collect())
}

/// The bundled fonts for the rasteriser.
pub(super) fn database() -> Arc<Database> {
    static DATABASE: OnceLock<Arc<Database>> = OnceLock::new();
    Arc::clone(DATABASE.get_or_init(|| {
        let mut database = Database::new();
        for file in files() {
            database.load_font_data(file.clone());
        }
        database.set_sans_serif_family(BUNDLED_FAMILY);
        Arc::new(database)
    }))
}

/// Width of a text at font size 1.
pub(super) fn width(text: &str, face: Face) -> f64 {
    // Estimate for a missing face or glyph.
    const TYPICAL: f64 = 0.6;
    let Some(table) = tables().get(face as usize) else {
        return TYPICAL * text.chars().count() as f64;
    };
    let units = f64::from(table.units_per_em());
    text.chars()
        .map(|letter| {
            table
                .glyph_index(letter)
                .and_then(|glyph| table.glyph_hor_advance(glyph))
                .map_or(TYPICAL, |advance| f64::from(advance) / units)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bundled_faces_contain_the_required_symbols() {
        assert_eq!(tables().len(), COMPRESSED.len());
        for face in [Face::Regular, Face::Bold, Face::Oblique] {
            for letter in "τωαζμκγξβΩφθ−×⁻²₀ρ≤∞".chars() {
                assert!(
                    tables()[face as usize].glyph_index(letter).is_some(),
                    "{face:?} lacks {letter}"
                );
            }
        }
        assert!(width("mm", Face::Bold) > width("mm", Face::Regular));
        assert!(tables()[Face::Oblique as usize].italic_angle() != 0.0);
    }
}
