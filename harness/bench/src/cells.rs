//! Tables that both parts of the page have.

use std::fmt::Write;

use super::solves::Solved;

pub fn write_solves(page: &mut String, solves: &[Solved]) -> std::fmt::Result {
    let head =
        "| capture | configuration | pixels | textures | s | memory: measured / said before |";
    writeln!(page, "{head}\n|---|---|---|---|---|---|")?;
    for solve in solves {
        writeln!(
            page,
            "| {} | {} | {:.0} thousand | {}² | {:.1} | {} / {} |",
            solve.capture,
            solve.config,
            solve.pixels as f64 / 1e3,
            solve.texture,
            solve.seconds,
            solve.peak_memory.map_or(String::new(), size),
            size(solve.estimated_memory),
        )?;
    }
    writeln!(page)?;
    for solve in solves {
        let stages = solve.stages.iter().map(|(stage, seconds)| format!("{stage} {seconds:.1}"));
        let stages = stages.collect::<Vec<_>>().join(", ");
        writeln!(page, "- {}, {}: {stages} s.", solve.capture, solve.config)?;
    }
    Ok(())
}

pub fn count(number: usize) -> String {
    match number {
        0..1_000_000 => format!("{} thousand", number as f64 / 1e3),
        _ => format!("{} million", number as f64 / 1e6),
    }
}

pub fn size(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{} MB", bytes.div_ceil(1_000_000)),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
