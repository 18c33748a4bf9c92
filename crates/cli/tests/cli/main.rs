//! The command as its users meet it: files in, files, messages and exit codes out.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod app;
mod bad_meshes;
mod check;
mod consistency;
mod documents;
mod extract;
mod failures;
mod features;
mod fields;
mod harness;
mod integer;
mod layout;
mod map;
mod pages;
mod quad;
mod quads;
mod texts;
