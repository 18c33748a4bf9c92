//! Time and memory.

use crate::job::Cost;
use crate::text::{counted, row};
use seamstress::ComponentStats;

/// Names and seconds of all stages.
pub(crate) fn stages(components: &[ComponentStats]) -> Vec<(&'static str, f64)> {
    let laps = components.iter().flat_map(|c| &c.stages);
    laps.map(|lap| (lap.stage.name(), lap.seconds)).collect()
}

/// Time and memory, and what the named parts took in all.
pub(crate) fn cost_row(cost: &Cost, parts: &[(&'static str, f64)]) -> String {
    let mut stages: Vec<(&'static str, f64)> = Vec::new();
    for &(name, lap) in parts {
        match stages.iter_mut().find(|(known, _)| *known == name) {
            Some((_, seconds)) => *seconds += lap,
            None => stages.push((name, lap)),
        }
    }
    let stages: Vec<String> =
        stages.iter().map(|(name, seconds)| format!("{name} {seconds:.2}")).collect();
    let mut text = format!("{:.2} s", cost.wall_seconds);
    if !stages.is_empty() {
        text += &format!(" ({})", stages.join(", "));
    }
    text += &format!(", {}", counted(cost.threads, "thread"));
    if let Some(cpu) = cost.cpu_seconds {
        text += &format!(", {cpu:.2} s of CPU");
    }
    if let Some(bytes) = cost.peak_memory_bytes {
        text += &format!(", {} MB", bytes.div_ceil(1_000_000));
    }
    row("time", &text)
}
