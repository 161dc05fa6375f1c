//! Complaints about numbers of a list.

use crate::Invalid;
use crate::parameter::{Parameter, indexed};

/// A complaint about entry `index` of `count`, its key with the index where there are several.
pub(super) fn complain(
    parameter: &Parameter,
    value: f64,
    index: usize,
    count: usize,
) -> Option<Invalid> {
    parameter.check(value).err().map(|mut complaint| {
        let (table, key) = parameter.path.rsplit_once('.').unwrap_or(("", parameter.path));
        complaint.key = indexed(table, index, count, key);
        complaint
    })
}
