//! Figure 5.2: shapes φ(r) cos jθ of three modes of the plate.

use quell_disc::plate::{ModeSet, Plate, PlateMode, Reference};

use super::super::caption::letter;
use super::super::failure::failed;
use super::super::product::{DataTable, Product};
use super::super::source::EntrySource;
use super::study;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::picture;
use quell::plot::{Figure, Sharing, Size};

/// (radial number, nodal diameters) of the panels.
const SHOWN: [(usize, u32); 3] = [(1, 2), (2, 0), (2, 3)];
/// Points of a radial profile in the table.
const RADII: usize = 101;

/// Figure 5.2.
pub(crate) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = study(source, &[])?;
    let failure = |why: &dyn std::fmt::Display| failed(source.name, &why);
    let document = study.document();
    let number = |key: &str, printed: f64| document["disc"][key].as_f64().unwrap_or(printed);
    let (inner, poisson) = (number("inner_radius_ratio", 0.5), number("poisson_ratio", 0.3));
    let plate = Plate::new(inner, poisson).map_err(|why| failure(&why))?;
    let set = ModeSet::new(&plate, 2, 3, Reference::Critical).map_err(|why| failure(&why))?;
    let columns = [("radial", "1"), ("diameters", "1"), ("radius", "a"), ("shape", "1")];
    let mut table = DataTable::new("", &columns);
    let mut panels = Vec::new();
    for (index, (radial, diameters)) in SHOWN.into_iter().enumerate() {
        let shown = |mode: &&PlateMode| (mode.radial, mode.diameters) == (radial, diameters);
        let Some(mode) = set.modes().iter().find(shown) else { continue };
        for k in 0..RADII {
            let radius = (1.0 - inner).mul_add(k as f64 / (RADII - 1) as f64, inner);
            let value = mode.shape.value(radius);
            let (radial, diameters) = (radial as f64, f64::from(diameters));
            table.row([radial.into(), diameters.into(), radius.into(), value.into()]);
        }
        let title = format!(
            "({}) $i$ = {radial}, $j$ = {diameters}: $k^2$ = {:.3}",
            letter(index),
            mode.frequency_parameter
        );
        panels.push(
            picture::disc::shape(mode, plate.inner_radius_ratio())
                .map_err(|why| failure(&why))?
                .title(title),
        );
    }
    let figure = Figure::grid(3, panels)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::All)
        .size(Size::Frame(230.0, 230.0));
    let shows = format!(
        "Modes of the annular plate clamped at its inner and free at its outer edge, $b$/$a$ = {inner}, $ν$ = {poisson}: deflection \
         $φ$($r$) cos $jθ$ with unit mean square over the plate (red: up, blue: down, black: nodes); $k^2$ is the frequency parameter."
    );
    let caption = source.caption(&shows, "");
    Ok(Product::about(figure, caption, &study).by(&[Task::Modes]).table(table))
}
