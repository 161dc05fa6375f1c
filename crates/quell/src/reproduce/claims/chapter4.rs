//! Claims.
use super::Sheet;
use crate::complaint::Failure;
pub(super) fn responses(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn effective_friction(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn stability_maps(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn formulas(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
