//! The seamstress command.
fn main() {}
