//! Executes the stages of a plan, several at once where they do not wait for one another.
//!
//! Each worker is a thread with its own processors, to which its renderers, programs and pool of threads are
//! restricted. The order of the stages does not change their outputs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender};
use std::thread;

use formats::cancel;

use super::error::RunError;
use super::executor::{Contents, StageExecutor, StageResult};
use super::memory::Memory;
use super::observer::Observer;
use super::plan::{Stage, StageKind};
use super::processors;
use super::record::{Records, Times};

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
pub(super) struct PlanOptions<'a> {
    pub plan: &'a [Stage],
    /// How many workers there are.
    pub jobs: usize,
    /// Methods that are known to fail: `<case>/<method>` and why.
    pub failed: BTreeMap<String, String>,
}

/// A message of a worker, which continues when it is answered.
enum Event {
    Begins(usize),
    Step(usize, u64, u64, String),
    /// Without a result if the stage is left out.
    Ends(usize, Box<Result<Option<StageResult>, RunError>>),
}

/// Sends messages to the thread that schedules.
struct EventSender(Sender<(Event, SyncSender<()>)>);

impl EventSender {
    /// Returns when the message is answered.
    fn send(&self, event: Event) {
        let (acknowledge, answer) = mpsc::sync_channel(1);
        // The receiver is gone after the last stage.
        let _ = self.0.send((event, acknowledge)).map(|()| answer.recv());
    }
}

/// Executes a plan. The first error that is not of a single method ends it.
pub(super) fn run(
    executor: &StageExecutor,
    PlanOptions { plan, jobs, failed }: PlanOptions,
    records: &Records,
    times: &mut Times,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let jobs = jobs.clamp(1, plan.len().max(1));
    let (sender, received) = mpsc::channel();
    let mut senders = Vec::new();
    thread::scope(|scope| {
        for own in processors::of_workers(jobs) {
            let (orders, ordered) = mpsc::channel::<(usize, Contents)>();
            let events = EventSender(sender.clone());
            let flag = cancel::flag();
            scope.spawn(move || {
                let work = move || worker(executor, plan, records, &ordered, &events);
                processors::keep_to(&own, flag, work)
            });
            senders.push(orders);
        }
        drop(sender);
        // The workers end with its senders.
        let mut schedule = Schedule::new(executor, plan, senders);
        for (name, reason) in failed {
            observer.stage_fails(&name, &reason);
            schedule.fails(name, reason)?;
        }
        schedule.run(&received, times, observer)
    })
}

fn worker(
    executor: &StageExecutor,
    plan: &[Stage],
    records: &Records,
    orders: &Receiver<(usize, Contents)>,
    events: &EventSender,
) {
    while let Ok((at, contents)) = orders.recv() {
        let stage = &plan[at];
        if stage.wanted {
            events.send(Event::Begins(at));
        }
        let mut step =
            |done, total, what: &str| events.send(Event::Step(at, done, total, what.to_owned()));
        let work = AssertUnwindSafe(|| match stage.wanted {
            true => executor.run(stage, &contents, records, &mut step).map(Some),
            false => executor.kept(stage, &contents, records),
        });
        let done = panic::catch_unwind(work).unwrap_or_else(|payload| {
            if cancel::is_cancelled(&*payload) {
                return Err(RunError::Interrupted);
            }
            Err(RunError::Folder(io::Error::other(format!("{}: ended in a fault", stage.id))))
        });
        events.send(Event::Ends(at, Box::new(done)));
    }
}

struct Schedule<'a> {
    executor: &'a StageExecutor<'a>,
    plan: &'a [Stage],
    senders: Vec<Sender<(usize, Contents)>>,
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
        executor: &'a StageExecutor<'a>,
        plan: &'a [Stage],
        senders: Vec<Sender<(usize, Contents)>>,
    ) -> Self {
        Self {
            executor,
            plan,
            idle: (0..senders.len()).rev().collect(),
            memory: Memory::new(senders.len()),
            senders,
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
            let Ok((event, acknowledge)) = events.recv() else { return Ok(self.outcome) };
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
            let _ = acknowledge.send(());
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
            // A worker ends only when its sender is gone.
            let _ = self.senders[worker].send((at, contents));
        }
    }

    fn next(&mut self) -> Option<usize> {
        let Self { plan, executor, finished, memory, running, .. } = self;
        let alone = running.is_empty();
        let ready = |at: &usize| plan[*at].after.iter().all(|before| finished.contains(before));
        let mut ready = self.waiting.iter().copied().filter(ready);
        ready.find(|at| {
            memory.take(*at, alone, || plan[*at].kind.work().memory(executor, &plan[*at]))
        })
    }

    fn ends(
        &mut self,
        at: usize,
        done: Result<Option<StageResult>, RunError>,
        times: &mut Times,
        observer: &mut dyn Observer,
    ) {
        let stage = &self.plan[at];
        self.idle.extend(self.running.remove(&at));
        self.memory.give_back(at);
        let noted = match done {
            Ok(None) => {
                self.leave_out(at);
                Ok(())
            }
            Ok(Some(StageResult { record, kept })) => {
                *(if kept { &mut self.outcome.skipped } else { &mut self.outcome.ran }) += 1;
                self.finished.insert(at);
                self.outcome.contents.insert(stage.id.clone(), record.output.clone());
                observer.stage_ends(&stage.id, (!kept).then_some(record.seconds));
                times.add(record, kept).map_err(RunError::from)
            }
            Err(error) => match stage.cell(self.executor.suite) {
                Some(name) if error.is_of_method() => {
                    let reason = error.to_string();
                    observer.stage_fails(&stage.id, &reason);
                    self.fails(name, reason)
                }
                _ => Err(error),
            },
        };
        if let Err(error) = noted {
            // The other running stages could continue for hours.
            self.executor.tools.interrupt.store(true, Ordering::Relaxed);
            self.fault.get_or_insert(error);
        }
    }

    /// Leaves out a stage and all that reads its output.
    fn leave_out(&mut self, at: usize) {
        let left_out = &mut self.outcome.left_out;
        left_out.insert(at);
        for (next, stage) in self.plan.iter().enumerate().skip(at + 1) {
            if stage.after.iter().any(|before| left_out.contains(before)) {
                left_out.insert(next);
            }
        }
        self.waiting.retain(|at| !left_out.contains(at));
    }

    /// Marks a method as failed on a case: cancels its waiting stages and removes its earlier scores.
    fn fails(&mut self, name: String, reason: String) -> Result<(), RunError> {
        let suite = self.executor.suite;
        let of = |at: &usize| self.plan[*at].cell(suite).is_some_and(|other| other == name);
        self.waiting.retain(|at| !of(at));
        // Scores of an earlier state of the method must not pass for this one's: no key is empty, so they are moved away.
        let mut stages = self.plan.iter().enumerate();
        if let Some((_, scores)) =
            stages.find(|(at, stage)| stage.kind == StageKind::Scores && of(at))
        {
            let path = self.executor.path(scores);
            Records::of(self.executor.out).set_aside(&scores.id, "", &path)?;
            match fs::remove_file(path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error.into()),
                _ => {}
            }
        }
        self.outcome.failed.insert(name, reason);
        Ok(())
    }
}
