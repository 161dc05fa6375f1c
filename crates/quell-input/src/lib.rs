//! What a user gives, before it is a study: text with its lines, the files that a study names, measured data, and complaints about them.
//!
//! | module | what |
//! |---|---|
//! | [`complaint`] | errors: the key, the line, the value and the allowed values; how a task fails |
//! | [`said`] | texts for every door: what the command line and Python spell differently |
//! | [`nearest`] | the word that was meant |
//! | [`input`] | regular files alone are opened, and outputs never overwrite what was read |
//! | [`study_file`], [`document`] | the text of a study, and its TOML with the line of every value |
//! | [`files`] | the files that a study names, each read once and held |
//! | [`data_file`] | tables of numbers: columns by name, wrong cells by line |
//! | [`dialect`] | how the text of a table is written: separators, decimal sign, comments, header lines, units |
//! | [`columns`] | columns of measured files by usual and by other names, and their units |
//! | [`matlab_file`] | vectors of a MATLAB file as a table |
//! | [`wrong_file`] | what is wrong with a file of data |
//! | [`wave_file`], [`sample_file`], [`actuator_file`] | samples of a wave, of a friction law, an actuator's frequency response |
//! | [`modes_file`], [`frequency_response`], [`matrix_market`], [`disc_modes_file`] | modes, receptances and matrices of a structure; modes of a disc |
//! | [`measurement`], [`record`] | measured friction, time series and spectra |
//!
//! A reader of a file answers with numbers and their lines; it knows no study, no key and no unit system. A new format has its reader here.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod actuator_file;
pub mod columns;
pub mod complaint;
pub mod data_file;
pub mod dialect;
pub mod disc_modes_file;
pub mod document;
pub mod files;
pub mod frequency_response;
pub mod input;
pub mod matlab_file;
pub mod matrix_market;
pub mod measurement;
pub mod modes_file;
pub mod nearest;
pub mod record;
mod row;
pub mod said;
pub mod sample_file;
pub mod study_file;
mod toml_text;
pub mod wave_file;
pub mod wrong_file;
