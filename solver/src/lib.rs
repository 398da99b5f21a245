//! Decomposes pictures of a known mesh into reflectance maps.

pub mod atomic;
pub mod picture;
