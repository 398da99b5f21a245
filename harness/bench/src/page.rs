//! A report as a page of Markdown.

use std::fmt::Write;

use super::rows::{Report, Step};
use super::torch::INSTALL;

/// Makes the page that `unshade bench --markdown` writes; `command` is the command that made it.
pub fn markdown(report: &Report, command: &str) -> String {
    let mut page = String::new();
    // Writing to a string cannot fail.
    let _ = write_page(&mut page, report, command);
    page
}

fn write_page(page: &mut String, report: &Report, command: &str) -> std::fmt::Result {
    let machine = &report.machine;
    let memory = machine.memory.map_or(String::new(), |bytes| format!(", {} memory", size(bytes)));
    writeln!(
        page,
        "# Performance\n\nWritten by `{command}`; times are the shortest of several runs.\n\n\
         Machine: {}, {} threads, {}{memory}, {}; unshade {}.\n",
        machine.processor,
        machine.threads,
        machine.caches.join(", "),
        machine.system,
        machine.version
    )?;
    if let Some(load) = machine.load.filter(|load| *load > 0.5) {
        writeln!(
            page,
            "The machine was not idle: its load was {load:.1} when the run began. Every time is an upper \
             bound, and the rates below are those that were left to this run.\n"
        )?;
    }
    table(page, &["device", "multiply-adds, GFLOP/s", "memory, GB/s"])?;
    for (name, reach) in &report.reach {
        let (flops, bytes) = (reach.flops / 1e9, reach.bytes / 1e9);
        writeln!(page, "| {name} | {flops:.0} | {bytes:.1} |")?;
    }
    if report.reach.iter().any(|(name, _)| name.ends_with("a software adapter")) {
        writeln!(
            page,
            "\n**A processor plays the GPU of a software adapter: its times do not describe a GPU.**"
        )?;
    }
    writeln!(
        page,
        "\n## Steps\n\nOne step of each of the paper's stages on synthetic G-buffers of ten views.\n\n\
         - *Floor*: the operations over the multiply-adds per second above, of the products of networks and \
         blurs alone and of all arithmetic, in which one operation on a vector counts as one multiply-add; and \
         the bytes, every value read once and written once, over the memory's rate.\n\
         - *x floor*: the time over the largest floor.\n\
         - *Losses*: the largest relative difference of the first losses to those of the processor's best \
         level.\n"
    )?;
    write_steps(page, &report.steps)?;
    if !report.reach.iter().any(|(name, _)| name.starts_with("gpu")) {
        writeln!(page, "\nGPU: not measured, since this machine has none.")?;
    }
    if !report.steps.iter().any(|step| step.device.starts_with("PyTorch")) {
        writeln!(page, "\nPyTorch: not measured. To have its rows: {INSTALL}.")?;
    }
    if !report.solves.is_empty() {
        write_solves(page, report)?;
    }
    writeln!(
        page,
        "\n## Kernels\n\nOn the processor each kernel alone, at its best level; on a GPU all dispatches of a \
         step, by the device's clock.\n"
    )?;
    table(page, &["device", "step", "kernel", "ms", "floor: arithmetic / memory, ms", "x floor"])?;
    for kernel in &report.kernels {
        let floors = &kernel.floors;
        let times = match floors.largest() {
            0.0 => String::new(),
            floor => format!("{:.1}", kernel.milliseconds / floor),
        };
        let name = match kernel.dispatches {
            1.0 => kernel.name.to_owned(),
            dispatches => format!("{}, {dispatches} times", kernel.name),
        };
        writeln!(
            page,
            "| {} | {} | {name} | {:.3} | {:.3} / {:.3} | {times} |",
            kernel.device, kernel.step, kernel.milliseconds, floors.arithmetic, floors.memory
        )?;
    }
    writeln!(
        page,
        "\n## The paper's capture\n\nTen views, 12 million pixels in half resolution for 2000 steps, \
         48 million in full for 1000, 2048² textures; the paper reports under 30 minutes on an RTX 3080.\n"
    )?;
    for capture in &report.paper {
        let [more, less] = capture.divisors;
        let seconds = capture.seconds.map_or(String::new(), |seconds| {
            format!(
                "{seconds:.0} s, on the line through the times of one pixel of {more} and of {less}"
            )
        });
        let failure = capture.failure.as_deref().unwrap_or_default();
        writeln!(page, "- {}: {seconds}{failure}.", capture.device)?;
    }
    writeln!(page)?;
    write_steps(page, report.paper.iter().flat_map(|capture| &capture.steps))
}

fn write_steps<'a>(
    page: &mut String,
    steps: impl IntoIterator<Item = &'a Step>,
) -> std::fmt::Result {
    table(
        page,
        &[
            "step",
            "device",
            "pixels",
            "textures",
            "ms",
            "floor: products / arithmetic / memory, ms",
            "x floor",
            "GB/s",
            "memory",
            "losses",
        ],
    )?;
    for step in steps {
        let floors = &step.floors;
        writeln!(
            page,
            "| {} | {} | {} | {}² | {:.2} | {:.2} / {:.2} / {:.2} | {:.1} | {:.1} | {} | {} |",
            step.kind.name(),
            step.device,
            count(step.pixels),
            step.texture,
            step.milliseconds,
            floors.products,
            floors.arithmetic,
            floors.memory,
            step.milliseconds / floors.largest(),
            step.cost.bytes / step.milliseconds / 1e6,
            step.memory.map_or(String::new(), size),
            step.loss_difference.map_or(String::new(), |difference| format!("{difference:.1e}")),
        )?;
    }
    Ok(())
}

fn write_solves(page: &mut String, report: &Report) -> std::fmt::Result {
    writeln!(
        page,
        "\n## Whole solves\n\nFrom the files of the capture to the files of the maps, ten training views, one \
         run each; `paper` with textures of the same side.\n"
    )?;
    table(
        page,
        &[
            "capture",
            "configuration",
            "device",
            "pixels",
            "textures",
            "s",
            "memory: measured / estimated",
        ],
    )?;
    for solve in &report.solves {
        writeln!(
            page,
            "| {} | {} | {} | {} | {}² | {:.1} | {} / {} |",
            solve.capture,
            solve.config,
            solve.device,
            count(solve.pixels),
            solve.texture,
            solve.seconds,
            solve.peak_memory.map_or(String::new(), size),
            size(solve.estimated_memory),
        )?;
    }
    writeln!(page)?;
    for solve in &report.solves {
        let stages = solve.stages.iter().map(|(stage, seconds)| format!("{stage} {seconds:.1}"));
        let stages = stages.collect::<Vec<_>>().join(", ");
        writeln!(page, "- {}, {}, {}: {stages} s.", solve.capture, solve.config, solve.device)?;
    }
    Ok(())
}

/// The head of a table.
fn table(page: &mut String, headings: &[&str]) -> std::fmt::Result {
    writeln!(page, "| {} |\n|{}", headings.join(" | "), "---|".repeat(headings.len()))
}

fn count(number: usize) -> String {
    match number {
        0..1_000_000 => format!("{} thousand", number as f64 / 1e3),
        _ => format!("{} million", number as f64 / 1e6),
    }
}

fn size(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{} MB", bytes.div_ceil(1_000_000)),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
