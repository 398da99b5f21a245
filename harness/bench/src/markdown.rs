//! A report as a page.

use std::fmt::Write;

use super::cells::{count, size, write_solves};
use super::gpu::{write_gpu, write_reach};
use super::report::{PaperSize, Report, Torch};
use super::steps::Step;

/// The page that `docs/performance.md` is; `command` wrote it.
pub fn markdown(report: &Report, command: &str) -> String {
    let mut page = String::new();
    // Writing to a string cannot fail.
    let _ = write_page(&mut page, report, command);
    page
}

fn write_page(page: &mut String, report: &Report, command: &str) -> std::fmt::Result {
    let machine = &report.machine;
    writeln!(page, "# Performance\n")?;
    writeln!(
        page,
        "Written by `{command}`; times are the shortest of several \
         runs.\n"
    )?;
    let memory = machine.memory.map_or(String::new(), |bytes| format!(", {} memory", size(bytes)));
    writeln!(
        page,
        "Machine: {}, {} threads, {}{memory}, {}; unshade {}.\n",
        machine.processor,
        machine.threads,
        machine.caches.join(", "),
        machine.system,
        machine.version
    )?;
    if let Some(load) = machine.load.filter(|load| *load > 0.5) {
        writeln!(
            page,
            "It was not idle: a load of {load:.1} when the run began. Every time is an upper bound, \
             and the multiply-adds and the bandwidth are what was left to this run.\n"
        )?;
    }
    writeln!(page, "| backend | multiply-adds, GFLOP/s | memory, GB/s |\n|---|---|---|")?;
    for (name, reach) in &report.reach {
        writeln!(page, "| {name} | {:.0} | {:.1} |", reach.flops / 1e9, reach.bytes / 1e9)?;
    }
    write_reach(page, report.gpu.as_ref())?;
    writeln!(page)?;

    writeln!(page, "## Steps\n")?;
    writeln!(
        page,
        "One step of the paper's stages on synthetic G-buffers of ten views.\n\n\
         - *Floor*: operations over the multiply-adds per second, of the products of networks and blurs alone \
         and of all arithmetic, whose every vector operation takes a multiply-add's place; bytes (every value \
         read once and written once) over the memory's.\n\
         - *Share of the peak*: the products' share of the multiply-adds above, and of those in a fifth of a \
         millisecond right after such a step (the most of several times): what the processor is slowed down to \
         by its work, or by others', no kernel can exceed.\n\
         - *x floor*: the time over the largest floor.\n"
    )?;
    write_steps(page, report.steps.iter())?;

    writeln!(page, "\n## PyTorch\n")?;
    match &report.torch {
        Torch::Absent { fix } => writeln!(page, "Not in this run. To have it: {fix}.")?,
        Torch::Measured(rows) => {
            writeln!(
                page,
                "The same steps in eager PyTorch on the same numbers and threads, in the same run.\n"
            )?;
            writeln!(
                page,
                "| step | pixels | textures | PyTorch, ms | memory | faster: | losses differ by |\n\
                 |---|---|---|---|---|---|---|"
            )?;
            for row in rows {
                let ours = row.ours.iter().map(|step| {
                    let times = row.torch.milliseconds / step.milliseconds;
                    format!("{} {times:.1} x", step.backend.trim_start_matches("cpu, "))
                });
                writeln!(
                    page,
                    "| {} | {} | {}² | {:.1} ({}) | {} | {} | {:.1e} |",
                    row.kind.name(),
                    count(row.pixels),
                    row.texture,
                    row.torch.milliseconds,
                    row.torch.version,
                    size(row.torch.peak_memory),
                    ours.collect::<Vec<_>>().join(", "),
                    row.loss_difference
                )?;
            }
        }
    }

    if !report.solves.is_empty() {
        writeln!(page, "\n## Whole solves\n")?;
        writeln!(
            page,
            "From the files of the capture to the files of the maps, ten training views, one run each; \
             `paper` with textures of the same side.\n"
        )?;
        write_solves(page, &report.solves)?;
    }

    writeln!(page, "\n## Kernels\n")?;
    writeln!(page, "At the best level.\n\n| kernel | ms | GFLOP/s | GB/s |\n|---|---|---|---|")?;
    for kernel in &report.kernels {
        let rate = |work: f64, digits: usize| match work > 0.0 {
            true => format!("{:.digits$}", work / kernel.milliseconds / 1e6),
            false => String::new(),
        };
        let (flops, bytes) = (rate(kernel.cost.flops, 0), rate(kernel.cost.bytes, 1));
        writeln!(page, "| {} | {:.3} | {flops} | {bytes} |", kernel.name, kernel.milliseconds)?;
    }

    writeln!(page, "\n## Scaling\n")?;
    write_steps(page, report.scaling.iter())?;

    writeln!(page, "\n## The paper's capture\n")?;
    writeln!(
        page,
        "Ten views, 12 million pixels in half resolution for 2000 steps, 48 million in full for 1000, \
         2048² textures; the paper reports under 30 minutes on an RTX 3080.\n"
    )?;
    let PaperSize { divisors: [more, less], steps, seconds } = &report.paper;
    let backend = steps.first().map_or("", |[step, _]| &step.backend);
    writeln!(
        page,
        "- {backend}: {seconds:.0} s, from steps on one pixel of {more} and of {less}, on the line through their times."
    )?;
    match &report.gpu {
        Some(gpu) => writeln!(page, "- {}: below.\n", gpu.name)?,
        None => writeln!(page, "- gpu: not yet measured.\n")?,
    }
    write_steps(page, steps.as_flattened().iter())?;
    write_gpu(page, report.gpu.as_ref())
}

fn write_steps<'a>(page: &mut String, steps: impl Iterator<Item = &'a Step>) -> std::fmt::Result {
    writeln!(
        page,
        "| step | backend | pixels | textures | ms | floor: products / all arithmetic / memory, ms | \
         share of the peak: machine's / after the step | GB/s | memory | x floor |\n|---|---|---|---|---|---|---|---|---|---|"
    )?;
    for step in steps {
        let of_peak = match step.fractions_of_peak() {
            [0.0, _] => "no products".to_owned(),
            [of_machine, after] => format!("{:.0} / {:.0} %", 100.0 * of_machine, 100.0 * after),
        };
        let threads = if step.threads == 1 {
            "1 thread".to_owned()
        } else {
            format!("{} threads", step.threads)
        };
        writeln!(
            page,
            "| {} | {}, {threads} | {} | {}² | {:.2} | {:.2} / {:.2} / {:.2} | {} | {:.1} | {} \
             | {:.1} |",
            step.kind.name(),
            step.backend,
            count(step.pixels),
            step.texture,
            step.milliseconds,
            step.product_floor,
            step.compute_floor,
            step.memory_floor,
            of_peak,
            step.cost.bytes / step.milliseconds / 1e6,
            step.peak_memory.map_or(String::new(), size),
            step.milliseconds / step.floor(),
        )?;
    }
    Ok(())
}
