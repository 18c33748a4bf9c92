//! How soon work can be stopped: the longest pauses between two looks at the watch, by stage.
//!
//! `cargo run --release -p seamstress --example pauses -- MESH [map|integer|quad] [QUADS]`
//!
//! The work runs on one thread; a pause is its time of computation where the system tells it (Linux), else that of the
//! clock.

#![allow(clippy::print_stdout, reason = "a program that prints a table")]

use seamstress::{Context, IntegerMapOptions, MapOptions, QuadOptions, Surface};
use std::collections::BTreeMap;
use std::error::Error;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Pauses that are printed.
const SHOWN: usize = 12;

/// A pause: its length, when it ended, seconds, and the looks at its ends.
type Pause = (f64, f64, String);

struct Looks {
    start: Instant,
    /// The last look, and its time.
    last: (f64, String),
    pauses: Vec<Pause>,
    longest: BTreeMap<String, f64>,
}

impl Looks {
    fn new() -> Self {
        // The thread that does the work begins with it.
        let last = (0.0, "start".to_owned());
        Self { start: Instant::now(), last, pauses: Vec::new(), longest: BTreeMap::new() }
    }

    fn look(&mut self, now: String, stage: &str) {
        let time = seconds(self.start);
        let (before, at) = std::mem::replace(&mut self.last, (time, now.clone()));
        let pause = time - before;
        let longest = self.longest.entry(stage.to_owned()).or_default();
        *longest = longest.max(pause);
        self.pauses.push((pause, time, format!("{at} .. {now}")));
    }
}

/// Seconds of computation of this thread, or since the start.
fn seconds(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mesh = arguments.first().ok_or("usage: pauses MESH [map|integer|quad] [QUADS]")?;
    let quads = arguments.get(2).map_or(Ok(5000), |quads| quads.parse())?;
    let looks = Arc::new(Mutex::new(Looks::new()));
    let seen = Arc::clone(&looks);
    let context = Context::new().threads(1).observer(move |progress| {
        let stage = progress.stage.name();
        let now = format!("{stage} {:.3}", progress.fraction);
        seen.lock().unwrap_or_else(PoisonError::into_inner).look(now, stage);
        ControlFlow::Continue(())
    });
    let surface = Surface::read(mesh)?.with_context(context);
    match arguments.get(1).map_or("quad", String::as_str) {
        "map" => drop(surface.parametrize(&MapOptions::default())?),
        "integer" => drop(surface.integer_map(&IntegerMapOptions::count(quads))?),
        _ => drop(surface.quad_mesh(&QuadOptions::count(quads))?),
    }
    let mut looks = looks.lock().unwrap_or_else(PoisonError::into_inner);
    println!(
        "{} looks in {:.1} s",
        looks.pauses.len() + 1,
        looks.pauses.last().map_or(0.0, |last| last.1)
    );
    for (stage, pause) in &looks.longest {
        println!("{stage:<14} {pause:.3} s");
    }
    looks.pauses.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (pause, end, at) in looks.pauses.iter().take(SHOWN) {
        println!("{pause:.3} s until {end:.2} s: {at}");
    }
    Ok(())
}
