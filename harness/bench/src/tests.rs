use super::*;

/// Every row is there and finite; no test measures its time.
#[test]
fn quick_run_has_every_row_and_a_page() {
    let options = Options { quick: true, gpu: false, torch: None, captures: vec![] };
    let mut heard = 0;
    let report = run(&options, &mut |_| heard += 1).unwrap();
    let levels = Level::available().len();
    assert_eq!(report.reach.len(), levels);
    assert_eq!(report.steps.len(), 3 * levels);
    assert!(report.steps.iter().all(|step| step.milliseconds > 0.0));
    assert!(report.kernels.len() > 10 && heard > report.steps.len());
    assert!(report.paper[0].steps.len() == 6 && report.paper[0].seconds.unwrap().is_finite());
    let text = markdown(&report, "unshade bench");
    assert!(text.contains("pip install torch"), "{text}");
    assert_eq!(text.matches("not measured").count(), 2, "{text}");
    let value = serde_json::to_value(&report).unwrap();
    assert_eq!(value["steps"][0]["kind"], "warm-up");
}

#[test]
fn adapter_has_its_steps_its_passes_and_the_losses_of_the_processor() {
    let mut adapters = solver::backend::gpu::adapters();
    let software = adapters.iter().position(|adapter| adapter.software).unwrap_or(0);
    if adapters.is_empty() {
        eprintln!("skipped: no adapter");
        return;
    }
    let adapter = adapters.swap_remove(software);
    let (software, has_clock) = (adapter.software, adapter.has_clock());
    let options = Options { quick: true, gpu: true, torch: None, captures: vec![] };
    let mut bench = Bench { options: &options, progress: &mut |_| () };
    let report = bench.run(|| Ok(Some(adapter))).unwrap();
    let name = &report.reach.last().unwrap().0;
    assert_eq!(name.ends_with("a software adapter"), software, "{name}");
    let steps: Vec<&Step> = report.steps.iter().filter(|step| step.device == *name).collect();
    assert_eq!(steps.len(), 3);
    for step in steps {
        assert!(step.milliseconds > 0.0 && step.floors.arithmetic.min(step.floors.memory) > 0.0);
        assert!(step.loss_difference.unwrap() < 1e-4, "{:?}", step.loss_difference);
    }
    assert_eq!(report.kernels.iter().any(|kernel| kernel.device == *name), has_clock);
    let paper = report.paper.last().unwrap();
    assert!(paper.steps.len() == 6 && paper.seconds.unwrap().is_finite(), "{paper:?}");
}

#[test]
fn time_that_does_not_depend_on_the_pixels_is_counted_once() {
    let time = |pixels: usize| 7.0 + 0.25 * pixels as f64;
    let times = [120, 30].map(|pixels| (pixels, time(pixels)));
    assert_eq!(on_a_line(times, 1920), time(1920));
}

#[test]
fn python_without_torch_is_named_with_the_fix() {
    let problem = synthetic::Problem::new(100, 8);
    let python = std::path::Path::new("/nowhere/python");
    let error = torch::measure(python, TorchPlace::Cpu, Kind::WarmUp, &problem, 1);
    let error = error.err().unwrap().to_string();
    assert!(error.contains("/nowhere/python") && error.contains("pip install torch"), "{error}");
}
