//! A quad mesh with its creases kept, progress on standard error: `cargo run --release --example quads MESH QUADS.obj`.

#![allow(clippy::print_stderr, reason = "a program that shows its progress")]

use seamstress::{Context, Features, QuadOptions, Surface};
use std::error::Error;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn Error>> {
    let [input, output] = std::env::args()
        .skip(1)
        .collect::<Vec<_>>()
        .try_into()
        .map_err(|_| "usage: quads MESH QUADS.obj")?;
    let context = Context::new().observer(|progress| {
        let percent = (100.0 * progress.fraction).round();
        eprint!("\r{:<14} {percent:>3} %", progress.stage.name());
        ControlFlow::Continue(())
    });
    let surface = Surface::read(&input)?.with_context(context);
    let options = QuadOptions::count(2000).features(Features::angle(40.0).with_boundary());
    let quads = surface.quad_mesh(&options)?;
    quads.write(&output)?;
    let irregular = quads.irregular().len();
    eprintln!("\r{} quads, {irregular} irregular vertices", quads.quads().len());
    Ok(())
}
