//! Decomposes pictures of a known mesh into reflectance maps.
compile_error!("read solver/src/COORDINATION.txt first, then remove this line");

pub mod atomic;
pub mod picture;
