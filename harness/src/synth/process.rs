//! One rendering stage as a child process.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use serde::Deserialize;
use serde_json::Value;

use super::{Interpreter, InterpreterError, Request};

/// Raised by Ctrl-C; every stage looks at it and stops cleanly.
pub type Interrupt = Arc<AtomicBool>;

/// Tools of every stage.
pub struct Tools {
    /// Runs the path tracer.
    pub interpreter: Interpreter,
    /// Raised by Ctrl-C.
    pub interrupt: Interrupt,
}

/// A key of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Place {
    /// The table that holds it, such as `render`; empty for the scene itself.
    pub table: String,
    /// Its name.
    pub key: String,
}

/// How a rendering stage can end badly.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// Python is missing.
    #[error(transparent)]
    Interpreter(#[from] InterpreterError),
    /// The input is wrong; the child's own line.
    #[error("{message}")]
    Input {
        /// The Python exception's name.
        kind: String,
        /// The fault, its place, and the fix.
        message: String,
        /// The key of a scene that is wrong, where the fault is that of a key.
        place: Option<Place>,
    },
    /// The request cannot be sent.
    #[error("{0}; rename the file or folder, so that its name is UTF-8")]
    Request(String),
    /// The child died without saying why.
    #[error("{stage}: the renderer ended with {status}; its last words: {last_words}")]
    Died {
        /// The stage.
        stage: String,
        /// Exit status or signal.
        status: String,
        /// The last line on its standard error.
        last_words: String,
    },
    /// The user interrupted.
    #[error("interrupted; run the same command to resume")]
    Interrupted,
}

#[derive(Deserialize)]
#[serde(tag = "event", rename_all = "lowercase")]
enum Event {
    Progress {
        done: u64,
        total: u64,
        #[serde(default)]
        what: String,
    },
    Warning {
        message: String,
    },
    Error {
        #[serde(default)]
        kind: String,
        message: String,
        #[serde(default)]
        place: Option<Place>,
    },
    Result(Value),
}

impl Tools {
    /// Runs `python -m unshade.stage` on a request and returns its result event.
    ///
    /// `progress` is called with how many of how many steps are done; warnings go to the log.
    pub fn run(
        &self,
        request: &Request,
        progress: &mut dyn FnMut(u64, u64, &str),
    ) -> Result<Value, StageError> {
        run(self, request, progress)
    }

    /// Runs a stage without progress.
    pub fn ask(&self, request: &Request) -> Result<Value, StageError> {
        run(self, request, &mut |_, _, _| {})
    }
}

fn run(
    Tools { interpreter, interrupt }: &Tools,
    request: &Request,
    progress: &mut dyn FnMut(u64, u64, &str),
) -> Result<Value, StageError> {
    let request =
        serde_json::to_value(request).map_err(|error| StageError::Request(error.to_string()))?;
    let mut child = interpreter
        .command()
        .args(["-m", "unshade.stage"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| InterpreterError::Start {
            path: interpreter.path().to_path_buf(),
            reason: error.to_string(),
        })?;
    if let Some(stdin) = &mut child.stdin {
        // A child that has ended says why by itself.
        let _ = writeln!(stdin, "{request}").and_then(|()| stdin.flush());
    }
    let (sender, lines) = mpsc::channel();
    if let Some(stdout) = child.stdout.take() {
        thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
    }
    let stderr = child.stderr.take().map(|mut stderr| {
        thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = stderr.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        })
    });
    let mut outcome: Option<Result<Value, StageError>> = None;
    loop {
        if interrupt.load(Ordering::Relaxed) {
            stop(&mut child);
            return Err(StageError::Interrupted);
        }
        match lines.recv_timeout(Duration::from_millis(100)) {
            Ok(line) => match serde_json::from_str(&line) {
                Ok(Event::Progress { done, total, what }) => progress(done, total, &what),
                Ok(Event::Warning { message }) => tracing::warn!("{message}"),
                Ok(Event::Error { kind, message, place }) => {
                    outcome = Some(Err(StageError::Input { kind, message, place }));
                }
                Ok(Event::Result(value)) => outcome = Some(Ok(value)),
                Err(_) => tracing::debug!("{line}"),
            },
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    let status = child.wait();
    let said = stderr.and_then(|reader| reader.join().ok()).unwrap_or_default();
    let ok = status.as_ref().is_ok_and(|status| status.success());
    match outcome {
        Some(Err(error)) => Err(error),
        Some(Ok(value)) if ok => Ok(value),
        _ => Err(StageError::Died {
            stage: request["stage"].as_str().unwrap_or_default().to_owned(),
            status: status.map_or_else(|error| error.to_string(), |status| status.to_string()),
            last_words: said.trim().lines().last().unwrap_or("none").to_owned(),
        }),
    }
}

fn stop(child: &mut Child) {
    drop(child.stdin.take());
    let _ = child.kill();
    let _ = child.wait();
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::process::Command;

    fn run_script(script: &str, interrupt: &Interrupt) -> (Result<Value, StageError>, Vec<u64>) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("python");
        // A process of its own writes the file: a test beside this one that forks while we held
        // it open for writing would keep it open, and Linux runs no such file ("text file busy").
        let written = Command::new("sh")
            .args(["-c", r#"printf '%s\n' '#!/bin/sh' "$2" > "$1" && chmod +x "$1""#, "sh"])
            .arg(&path)
            .arg(script)
            .status();
        assert!(written.unwrap().success());
        let mut done = Vec::new();
        let tools = Tools { interpreter: Interpreter::at(&path), interrupt: interrupt.clone() };
        let result = tools.run(&Request::Doctor, &mut |d, _, _| done.push(d));
        (result, done)
    }

    #[test]
    fn progress_and_result_are_heard() {
        let script = r#"echo '{"event":"progress","done":1,"total":2,"what":"view"}'
            echo 'noise'; echo '{"event":"result","variant":"x"}'"#;
        let (result, done) = run_script(script, &Interrupt::default());
        assert_eq!(result.unwrap()["variant"], "x");
        assert_eq!(done, [1]);
    }

    #[test]
    fn the_childs_own_line_is_the_error() {
        let script =
            r#"echo '{"event":"error","kind":"SceneError","message":"no such light"}'; exit 2"#;
        let (result, _) = run_script(script, &Interrupt::default());
        assert_eq!(result.unwrap_err().to_string(), "no such light");
    }

    #[test]
    fn a_child_that_dies_is_reported_with_its_last_words() {
        let (result, _) =
            run_script("echo first >&2; echo LLVM ERROR >&2; exit 134", &Interrupt::default());
        let error = result.unwrap_err().to_string();
        assert!(error.contains("LLVM ERROR") && error.contains("134"), "{error}");
    }

    #[test]
    fn an_interrupt_ends_the_child() {
        let interrupt = Interrupt::default();
        interrupt.store(true, Ordering::Relaxed);
        let (result, _) = run_script("exec sleep 60", &interrupt);
        assert!(matches!(result, Err(StageError::Interrupted)));
    }
}
