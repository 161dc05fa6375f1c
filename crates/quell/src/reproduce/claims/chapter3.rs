//! Claims.
use super::Sheet;
use crate::complaint::Failure;
pub(super) fn waveforms(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn formulas(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn everywhere_stable(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn thresholds(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn responses(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
