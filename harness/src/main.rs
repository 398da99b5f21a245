//! The `unshade` command.
fn main() {}
