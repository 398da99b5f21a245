//! Does the stages of a plan, several at once where they do not wait for one another.
//!
//! Each worker is a thread with processors of its own, which what it starts keeps to: rendering and
//! programs that it starts, and a pool of threads for what is computed here. Which stage is done when has no
//! bearing on what it leaves.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender};
use std::thread;

use formats::cancel;

use super::error::RunError;
use super::memory::{Memory, estimate};
use super::plan::{Kind, Task};
use super::processors;
use super::record::{Records, Times};
use super::tools::Observer;
use super::workshop::{Contents, Done, Workshop};

/// Outcome of a plan.
#[derive(Default)]
pub(super) struct Outcome {
    /// Stages that ran, and stages whose earlier results were still valid.
    pub ran: usize,
    pub skipped: usize,
    /// Methods that failed: `<case>/<method>` and why.
    pub failed: BTreeMap<String, String>,
    /// Stages that were not wanted, and of which nothing valid is there.
    pub left_out: BTreeSet<usize>,
    /// Content hashes of all finished stages.
    pub contents: Contents,
}

/// The plan and how it is carried out.
pub(super) struct Work<'a> {
    pub plan: &'a [Task],
    /// How many workers there are.
    pub jobs: usize,
    /// Methods that are known to fail: `<case>/<method>` and why.
    pub failed: BTreeMap<String, String>,
}

/// Message of a worker, which goes on once it was heard.
enum Event {
    Begins(usize),
    Step(usize, u64, u64, String),
    /// Without a result if the stage is left out.
    Ends(usize, Box<Result<Option<Done>, RunError>>),
}

/// A line to the thread that schedules, and its answer.
struct Line(Sender<(Event, SyncSender<()>)>);

impl Line {
    fn say(&self, event: Event) {
        let (heard, answer) = mpsc::sync_channel(1);
        // After an end nobody listens any more.
        let _ = self.0.send((event, heard)).map(|()| answer.recv());
    }
}

/// Does all of a plan. The first fault that is of no single method ends it.
pub(super) fn run(
    workshop: &Workshop,
    Work { plan, jobs, failed }: Work,
    records: &Records,
    times: &mut Times,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let jobs = jobs.clamp(1, plan.len().max(1));
    let (sender, events) = mpsc::channel();
    let mut lines = Vec::new();
    thread::scope(|scope| {
        for own in processors::of_workers(jobs) {
            let (orders, ordered) = mpsc::channel::<(usize, Contents)>();
            let line = Line(sender.clone());
            let flag = cancel::flag();
            scope.spawn(move || {
                let work = move || worker(workshop, plan, records, &ordered, &line);
                processors::keep_to(&own, flag, work)
            });
            lines.push(orders);
        }
        drop(sender);
        // Its lines go with it, and with them the workers.
        let mut schedule = Schedule::new(workshop, plan, lines);
        for (name, reason) in failed {
            observer.stage_fails(&name, &reason);
            schedule.fails(name, reason)?;
        }
        schedule.run(&events, times, observer)
    })
}

fn worker(
    workshop: &Workshop,
    plan: &[Task],
    records: &Records,
    orders: &Receiver<(usize, Contents)>,
    line: &Line,
) {
    while let Ok((at, contents)) = orders.recv() {
        let task = &plan[at];
        if task.wanted {
            line.say(Event::Begins(at));
        }
        let mut step =
            |done, total, what: &str| line.say(Event::Step(at, done, total, what.to_owned()));
        let work = AssertUnwindSafe(|| match task.wanted {
            true => workshop.run(task, &contents, records, &mut step).map(Some),
            false => workshop.kept(task, &contents, records),
        });
        let done = panic::catch_unwind(work).unwrap_or_else(|payload| {
            if cancel::is_cancelled(&*payload) {
                return Err(RunError::Interrupted);
            }
            Err(RunError::Folder(io::Error::other(format!("{}: ended in a fault", task.id))))
        });
        line.say(Event::Ends(at, Box::new(done)));
    }
}

struct Schedule<'a> {
    workshop: &'a Workshop<'a>,
    plan: &'a [Task],
    lines: Vec<Sender<(usize, Contents)>>,
    idle: Vec<usize>,
    /// Stages with the worker that does them.
    running: BTreeMap<usize, usize>,
    waiting: BTreeSet<usize>,
    finished: BTreeSet<usize>,
    memory: Memory,
    outcome: Outcome,
    fault: Option<RunError>,
}

impl<'a> Schedule<'a> {
    fn new(
        workshop: &'a Workshop<'a>,
        plan: &'a [Task],
        lines: Vec<Sender<(usize, Contents)>>,
    ) -> Self {
        Self {
            workshop,
            plan,
            idle: (0..lines.len()).rev().collect(),
            memory: Memory::new(lines.len()),
            lines,
            running: BTreeMap::new(),
            waiting: (0..plan.len()).collect(),
            finished: BTreeSet::new(),
            outcome: Outcome::default(),
            fault: None,
        }
    }

    fn run(
        mut self,
        events: &Receiver<(Event, SyncSender<()>)>,
        times: &mut Times,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        self.start();
        loop {
            if self.running.is_empty() {
                return match self.fault {
                    Some(fault) => Err(fault),
                    None => Ok(self.outcome),
                };
            }
            let Ok((event, heard)) = events.recv() else { return Ok(self.outcome) };
            match event {
                Event::Begins(at) => {
                    observer.stage_begins(&self.plan[at].id, self.done(), self.plan.len());
                }
                Event::Step(at, done, total, what) => {
                    observer.step(&self.plan[at].id, done, total, &what);
                }
                Event::Ends(at, done) => {
                    self.ends(at, *done, times, observer);
                    self.start();
                }
            }
            let _ = heard.send(());
        }
    }

    fn done(&self) -> usize {
        self.plan.len() - self.waiting.len() - self.running.len()
    }

    /// Gives every idle worker the first stage that waits for nothing and has the memory that it needs.
    fn start(&mut self) {
        while self.fault.is_none()
            && let Some(worker) = self.idle.last().copied()
            && let Some(at) = self.next()
        {
            self.idle.pop();
            self.waiting.remove(&at);
            self.running.insert(at, worker);
            let of = |before: &usize| {
                let id = self.plan[*before].id.clone();
                Some((id.clone(), self.outcome.contents.get(&id)?.clone()))
            };
            let contents = self.plan[at].after.iter().filter_map(of).collect();
            // A worker ends with its line alone.
            let _ = self.lines[worker].send((at, contents));
        }
    }

    fn next(&mut self) -> Option<usize> {
        let Self { plan, workshop, finished, memory, running, .. } = self;
        let alone = running.is_empty();
        let ready = |at: &usize| plan[*at].after.iter().all(|before| finished.contains(before));
        let mut ready = self.waiting.iter().copied().filter(ready);
        ready.find(|at| memory.take(*at, alone, || estimate(workshop, &plan[*at])))
    }

    fn ends(
        &mut self,
        at: usize,
        done: Result<Option<Done>, RunError>,
        times: &mut Times,
        observer: &mut dyn Observer,
    ) {
        let task = &self.plan[at];
        self.idle.extend(self.running.remove(&at));
        self.memory.give_back(at);
        let noted = match done {
            Ok(None) => {
                self.leave_out(at);
                Ok(())
            }
            Ok(Some(Done { record, kept })) => {
                *(if kept { &mut self.outcome.skipped } else { &mut self.outcome.ran }) += 1;
                self.finished.insert(at);
                self.outcome.contents.insert(task.id.clone(), record.output.clone());
                observer.stage_ends(&task.id, (!kept).then_some(record.seconds));
                times.add(record, kept).map_err(RunError::from)
            }
            Err(error) => match task.name(self.workshop.suite) {
                Some(name) if error.is_of_method() => {
                    let reason = error.to_string();
                    observer.stage_fails(&task.id, &reason);
                    self.fails(name, reason)
                }
                _ => Err(error),
            },
        };
        if let Err(error) = noted {
            // What else runs would go on for hours.
            self.workshop.tools.interrupt.store(true, Ordering::Relaxed);
            self.fault.get_or_insert(error);
        }
    }

    /// Leaves out a stage and all that reads its output.
    fn leave_out(&mut self, at: usize) {
        let left_out = &mut self.outcome.left_out;
        left_out.insert(at);
        for (next, task) in self.plan.iter().enumerate().skip(at + 1) {
            if task.after.iter().any(|before| left_out.contains(before)) {
                left_out.insert(next);
            }
        }
        self.waiting.retain(|at| !left_out.contains(at));
    }

    /// A method that fails leaves its cells empty, and the others run.
    fn fails(&mut self, name: String, reason: String) -> Result<(), RunError> {
        let suite = self.workshop.suite;
        let of = |at: &usize| self.plan[*at].name(suite).is_some_and(|other| other == name);
        self.waiting.retain(|at| !of(at));
        // Scores of an earlier state of the method must not pass for this one's.
        let out = self.workshop.out;
        let scores = out.join("scores").join(format!("{name}.json"));
        Records::of(out).set_aside(&format!("{}/{name}", Kind::Scores.word()), "", &scores)?;
        self.outcome.failed.insert(name, reason);
        match fs::remove_file(scores) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error.into()),
            _ => Ok(()),
        }
    }
}
