//! The tests of answers, pictures and stores.
//!
//! One program: each links the whole workspace, and its tests share the processors.

mod belts_as_systems;
mod converted;
mod criticality;
mod describing;
mod design;
mod design_choices;
mod design_confidence;
mod design_ranges;
mod designs;
mod disc;
mod disc_contacts;
mod disc_design;
mod disc_motion;
mod disc_over_time;
mod disc_speed;
mod drawings;
mod examples;
mod headlines;
mod laws;
mod laws_with_state;
mod maps;
mod maps_with_state;
mod measured_friction;
mod motion;
mod noise;
mod one_answer;
mod own_law;
mod pictures;
mod probability;
mod profiles;
mod published;
mod records;
mod references;
mod reports;
mod sketches;
mod system_answers;
mod system_design;
mod system_motion;
mod system_planes;
mod systems;
mod waveforms;
