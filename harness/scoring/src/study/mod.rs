//! Statistics over the cases of runs, whose unit is the face: intervals, paired tests, effect
//! sizes, the faces that a study needs, what varies, and fairness by skin tone.

mod components;
mod error;
mod faces;
mod fairness;
mod figures;
mod files;
mod observation;
mod page;
mod paired;
mod statistics;

pub use components::Components;
pub use error::StudyError;
pub use faces::{Cell, Face, interval, pooled_decibels, spread, welch};
pub use fairness::{Fairness, Group, group_of};
pub use figures::Figure;
pub use files::write_study;
pub use observation::{Observation, observations, tidy_csv};
pub use paired::{effect_size, faces_needed, holm, power, sign_flip};
pub use statistics::{Comparison, LEVEL, Study, Summary, Verdict};
