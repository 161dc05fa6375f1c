//! Claims.
use super::Sheet;
use crate::complaint::Failure;
pub(super) fn friction_laws(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn responses(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn forced_response(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn stability_maps(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
pub(super) fn destabilisation(_: &mut Sheet) -> Result<(), Failure> {
    Ok(())
}
