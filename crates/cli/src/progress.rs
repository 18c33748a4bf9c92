//! Progress bars on standard error.

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use seamstress::{Progress, Stage};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Ticks of a full bar.
const FULL: u64 = 1000;
const REDRAW: Duration = Duration::from_millis(200);

/// One bar per stage; hidden where nobody looks.
#[derive(Debug, Clone)]
pub(crate) struct Bars {
    all: MultiProgress,
    current: Arc<Mutex<Option<(usize, Stage, ProgressBar)>>>,
}

impl Bars {
    /// Bars that show only on a terminal, and only when wanted.
    pub(crate) fn new(wanted: bool) -> Self {
        let target = if wanted && std::io::stderr().is_terminal() {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        Self { all: MultiProgress::with_draw_target(target), current: Arc::default() }
    }

    /// Shows where the work stands.
    pub(crate) fn show(&self, progress: Progress) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        let (component, stage) = (progress.component, progress.stage);
        let is_current = |&(c, s, _): &(usize, Stage, ProgressBar)| (c, s) == (component, stage);
        if current.is_none() {
            let megabytes = progress.expected_memory as f64 / 1e6;
            let seconds = progress.expected_time.as_secs_f64().max(1.0);
            let line =
                format!("takes about {seconds:.0} s on one thread, {megabytes:.0} MB of memory");
            // A terminal that cannot be written to is no reason to fail.
            let _ = self.all.println(line);
        }
        if !current.as_ref().is_some_and(is_current) {
            // The bars of many components would fill the screen.
            match current.take() {
                Some((_, _, bar)) if progress.n_components == 1 => bar.finish(),
                Some((_, _, bar)) => bar.finish_and_clear(),
                None => {}
            }
            *current = Some((component, stage, self.all.add(bar(&progress))));
        }
        if let Some((_, _, bar)) = &*current {
            bar.set_position((FULL as f64 * progress.fraction) as u64);
        }
    }

    /// Removes all bars from the screen.
    pub(crate) fn clear(&self) {
        // A terminal that cannot be cleared is no reason to fail.
        let _ = self.all.clear();
    }
}

fn bar(progress: &Progress) -> ProgressBar {
    let name = progress.stage.name();
    let label = match progress.n_components {
        1 => name.to_owned(),
        n => format!("{name} ({} of {n})", progress.component + 1),
    };
    let bar = ProgressBar::new(FULL).with_prefix(label);
    if let Ok(style) =
        ProgressStyle::with_template("{prefix:<24} [{bar:40}] {percent:>3}% {elapsed}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(REDRAW);
    bar
}
