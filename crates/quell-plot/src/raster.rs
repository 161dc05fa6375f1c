//! Images of heatmaps: the values of a field at the pixels of a frame.
//!
//! Each pixel has the colour of the grid point nearest to it along the axes as they are drawn: there is no
//! interpolation, there are no seams, and uneven or logarithmic axes are handled correctly. The image
//! is a PNG of at most 256 colours.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::axis::{Mapping, PlotAxis};
use super::canvas::Rectangle;
use super::colouring::{CLEAR, ColourMap};
use super::field::{Field, borders};
use super::palette::Colour;

/// Pixels of an image per unit of the figure, the same as for a PNG of the figure.
const DENSITY: f64 = 2.0;
/// Maximum number of pixels along one side of an image.
const MOST_PIXELS: f64 = 4096.0;

/// An image whose pixels are indices into a list of colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) indices: Vec<u8>,
}

/// The image of a field over the whole frame; pixels outside its cells and cells without a value are transparent.
pub(super) fn raster(
    field: &Field,
    colour_map: &ColourMap,
    (x_axis, y_axis): (&PlotAxis, &PlotAxis),
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
) -> Raster {
    let (width, height) = (pixels(frame.width()), pixels(frame.height()));
    let columns = nearest(&borders(field.x(), x_axis.scale), x, frame.left, frame.right, width);
    let rows = nearest(&borders(field.y(), y_axis.scale), y, frame.top, frame.bottom, height);
    let colours: Vec<u8> = field
        .values()
        .iter()
        .map(|value| value.map_or(CLEAR, |value| colour_map.index(value)))
        .collect();
    let across = field.x().len();
    let mut indices: Vec<u8> = Vec::with_capacity(width * height);
    for (number, row) in rows.iter().enumerate() {
        if number > 0 && *row == rows[number - 1] {
            let last = indices.len() - width;
            indices.extend_from_within(last..);
            continue;
        }
        let values = row.and_then(|row| colours.get(row * across..(row + 1) * across));
        indices.extend(columns.iter().map(|column| {
            column.zip(values).and_then(|(column, row)| row.get(column)).copied().unwrap_or(CLEAR)
        }));
    }
    Raster { width, height, indices }
}

fn pixels(length: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 1 to a few thousand"
    )]
    let pixels = (length * DENSITY).round().clamp(1.0, MOST_PIXELS) as usize;
    pixels
}

/// The cell under the centre of each of `count` pixels between two positions; `None` outside the cells.
fn nearest(
    borders: &[f64],
    mapping: &Mapping,
    from: f64,
    to: f64,
    count: usize,
) -> Vec<Option<usize>> {
    let cell = |step: usize| {
        let position = from + (to - from) * (step as f64 + 0.5) / count as f64;
        let along = mapping.along(position);
        let above = borders.partition_point(|border| *border <= along);
        above.checked_sub(1).filter(|cell| cell + 1 < borders.len())
    };
    (0..count).map(cell).collect()
}

impl Raster {
    /// The image as a `data:` address; `None` if it cannot be encoded.
    pub(super) fn address(&self, colours: &[Colour]) -> Option<String> {
        let bytes = self.png(colours).ok()?;
        Some(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }

    fn png(&self, colours: &[Colour]) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let mut bytes = Vec::new();
        let (width, height) = (u32::try_from(self.width)?, u32::try_from(self.height)?);
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        let palette: Vec<u8> = colours.iter().flat_map(|(r, g, b)| [*r, *g, *b]).collect();
        encoder.set_palette(palette);
        let opacity = |index: usize| if index == usize::from(CLEAR) { 0 } else { 255 };
        encoder.set_trns((0..colours.len()).map(opacity).collect::<Vec<u8>>());
        // This filter encodes rows that repeat the one above as zeros.
        encoder.set_filter(png::FilterType::Up);
        // The crate's default is faster but its output is three times as large.
        encoder.set_compression(png::Compression::Default);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.indices)?;
        writer.finish()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::geometry::PlotRange;
    use super::*;
    use crate::{Colouring, Palette, PlotRole, Shading, Tint};

    const FRAME: Rectangle = Rectangle { left: 10.0, top: 20.0, right: 110.0, bottom: 70.0 };

    fn mapping(axis: &PlotAxis, limits: PlotRange, upright: bool) -> Mapping {
        let (first, last) =
            if upright { (FRAME.bottom, FRAME.top) } else { (FRAME.left, FRAME.right) };
        Mapping::new(axis, limits, first, last)
    }

    fn outcomes() -> ColourMap {
        let tints = ["a", "b", "c", "d"].map(|label| Tint::new(PlotRole::Stable, label));
        ColourMap::new(&Colouring::Outcomes(tints.to_vec()), None)
    }

    #[test]
    fn pixels_have_the_colour_of_the_nearest_point_on_uneven_and_log_axes() {
        let (x, y) = (PlotAxis::new("x").log(), PlotAxis::new("y"));
        let values = vec![Some(0.0), Some(1.0), None, Some(2.0), Some(3.0), Some(0.0)];
        let field = Field::new(vec![1.0, 10.0, 10_000.0], vec![0.0, 1.0], values).expect("a field");
        let maps = (
            mapping(&x, PlotRange::new(1.0, 10_000.0), false),
            mapping(&y, PlotRange::new(0.0, 1.0), true),
        );
        let image = raster(&field, &outcomes(), (&x, &y), (&maps.0, &maps.1), FRAME);
        assert_eq!((image.width, image.height), (200, 100));
        let row = |number: usize| &image.indices[number * 200..(number + 1) * 200];
        // Borders at 10^0.5 and 10^2.5 of 4 decades: 25 and 125 of 200 pixels; y upwards.
        let bottom: Vec<u8> = [vec![0; 25], vec![1; 100], vec![CLEAR; 75]].concat();
        let top: Vec<u8> = [vec![2; 25], vec![3; 100], vec![0; 75]].concat();
        assert_eq!((row(99), row(50)), (bottom.as_slice(), bottom.as_slice()));
        assert_eq!((row(0), row(49)), (top.as_slice(), top.as_slice()));
    }

    #[test]
    fn pixels_outside_the_cells_are_transparent() {
        let axis = PlotAxis::new("x");
        let field =
            Field::new(vec![1.0, 2.0], vec![1.0, 2.0], vec![Some(1.0); 4]).expect("a field");
        let maps = (
            mapping(&axis, PlotRange::new(0.0, 5.0), false),
            mapping(&axis, PlotRange::new(1.0, 2.0), true),
        );
        let image = raster(&field, &outcomes(), (&axis, &axis), (&maps.0, &maps.1), FRAME);
        let printed = image.indices[..200].iter().filter(|index| **index != CLEAR).count();
        // From 0.5 to 2.5 of 5.
        assert_eq!(printed, 80);
    }

    #[test]
    fn an_encoded_image_decodes_to_its_colours() {
        let colour_map = ColourMap::new(
            &Colouring::Shaded(Shading::new(Palette::Viridis)),
            Some(PlotRange::new(0.0, 1.0)),
        );
        let image = Raster { width: 2, height: 2, indices: vec![0, 249, CLEAR, 10] };
        let bytes = image.png(&colour_map.colours()).expect("a PNG");
        let mut decoder = png::Decoder::new(bytes.as_slice());
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().expect("a header");
        let mut pixels = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut pixels).expect("pixels");
        assert_eq!(&pixels[..4], &[0x44, 0x01, 0x54, 255]);
        assert_eq!(&pixels[4..8], &[0xfd, 0xe7, 0x25, 255]);
        assert_eq!(pixels[11], 0);
    }
}
