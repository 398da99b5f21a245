//! The GPU's part of the page.

use std::fmt::Write;

use super::rows::{GpuPaper, GpuReport, GpuStep};
use crate::cells::{count, size, write_solves};

/// The row of what a GPU reaches, or that nobody knows.
pub fn write_reach(page: &mut String, report: Option<&GpuReport>) -> std::fmt::Result {
    let Some(GpuReport { name, reach, .. }) = report else {
        return writeln!(page, "| gpu | not yet measured | |");
    };
    let (flops, bytes) = (reach.flops / 1e9, reach.bytes / 1e9);
    writeln!(page, "| {name} | {flops:.0} | {bytes:.1} |")
}

/// The section.
pub fn write_gpu(page: &mut String, report: Option<&GpuReport>) -> std::fmt::Result {
    writeln!(page, "\n## GPU\n")?;
    let Some(report) = report else {
        return writeln!(page, "Not yet measured: there was no GPU in this run.");
    };
    writeln!(page, "{}.\n", report.name)?;
    if report.software {
        writeln!(
            page,
            "**A software adapter: a processor plays the GPU, and these times say nothing about one.**\n"
        )?;
    }
    writeln!(
        page,
        "Whole steps as a solve submits them, against the floors of the steps above (all arithmetic, \
         bytes) by what compute kernels reach on this device; the losses of the first steps beside the \
         processor's.\n"
    )?;
    write_steps(page, &report.steps)?;
    write_torch(page, &report.steps)?;
    if !report.solves.is_empty() {
        writeln!(page)?;
        write_solves(page, &report.solves)?;
    }
    writeln!(page, "\n### The paper's capture\n")?;
    let all = match &report.paper {
        GpuPaper::Failed { reason } => {
            writeln!(page, "It did not go through: {reason}.")?;
            &report.steps
        }
        GpuPaper::Done { divisor, steps, seconds, preparation_seconds } => {
            let how = match divisor {
                1 => "all steps on all pixels".to_owned(),
                divisor => format!("single steps on one pixel of {divisor}, multiplied"),
            };
            writeln!(
                page,
                "{seconds:.1} s: {how}; {preparation_seconds:.1} s before the steps.\n"
            )?;
            write_steps(page, steps)?;
            steps
        }
    };
    writeln!(
        page,
        "\n### Passes\n\nOf a step, by the device's clock, each pass apart; the floors are the pass's own \
         operations and bytes.\n"
    )?;
    if all.iter().all(|step| step.passes.is_empty()) {
        return writeln!(page, "This adapter has no clock.");
    }
    writeln!(
        page,
        "| step | pixels | textures | pass | dispatches | ms | floor: compute / memory, ms |\n\
         |---|---|---|---|---|---|---|"
    )?;
    for step in all {
        for pass in &step.passes {
            let [compute, memory] = pass.floors;
            writeln!(
                page,
                "| {} | {} | {}² | {} | {} | {:.3} | {compute:.3} / {memory:.3} |",
                step.kind.name(),
                count(step.pixels),
                step.texture,
                pass.name,
                pass.dispatches,
                pass.milliseconds,
            )?;
        }
    }
    Ok(())
}

fn write_steps(page: &mut String, steps: &[GpuStep]) -> std::fmt::Result {
    writeln!(
        page,
        "| step | pixels | textures | ms | floor: compute / memory, ms | times the floor | memory | \
         losses differ by |\n|---|---|---|---|---|---|---|---|"
    )?;
    for step in steps {
        let [compute, memory] = step.floors;
        writeln!(
            page,
            "| {} | {} | {}² | {:.2} | {compute:.2} / {memory:.2} | {:.1} | {} | {} |",
            step.kind.name(),
            count(step.pixels),
            step.texture,
            step.milliseconds,
            step.milliseconds / compute.max(memory),
            step.memory.map_or(String::new(), size),
            step.loss_difference.map_or(String::new(), |difference| format!("{difference:.1e}")),
        )?;
    }
    Ok(())
}

/// Eager PyTorch on the same numbers and the same GPU, where it was asked for.
fn write_torch(page: &mut String, steps: &[GpuStep]) -> std::fmt::Result {
    let rows: Vec<_> = steps.iter().filter_map(|step| Some((step, step.torch.as_ref()?))).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(
        page,
        "\nThe same steps in eager PyTorch on the same numbers and the same GPU (single precision, no \
         TF32).\n\n\
         | step | pixels | textures | PyTorch, ms | memory of its tensors | faster | losses differ by |\n\
         |---|---|---|---|---|---|---|"
    )?;
    for (step, torch) in rows {
        let pairs = step.losses.iter().zip(&torch.losses);
        let difference = pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        writeln!(
            page,
            "| {} | {} | {}² | {:.2} ({}) | {} | {:.1} x | {difference:.1e} |",
            step.kind.name(),
            count(step.pixels),
            step.texture,
            torch.milliseconds,
            torch.version,
            size(torch.peak_memory),
            torch.milliseconds / step.milliseconds,
        )?;
    }
    Ok(())
}
