//! Files and folders: pictures, maps, meshes, content hashes, and outputs that appear whole or not at all.
//!
//! Nothing here knows what is recovered or scored, or how.

pub mod atomic;
pub mod cancel;
pub mod content_hash;
pub mod fill;
pub mod maps;
pub mod obj;
pub mod picture;

pub use maps::{Maps, MapsError};
