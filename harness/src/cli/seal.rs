//! `unshade seal`, `unshade verify`.

use std::ops::Deref;
use std::path::Path;

use sealing::Secret;

use super::arguments::SealArgs;
use super::exit::{CHECK_FAILED, DONE};
use super::outcome::Outcome;
use crate::suite::{self, Observer, RunError, Sealing, Suite};
use crate::synth::Tools;

pub(super) fn seal(
    arguments: &SealArgs,
    tools: &dyn Deref<Target = Tools>,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let secret = Secret::read(&arguments.seeds_from)?;
    let out = &arguments.out;
    let (round, jobs) = (arguments.round.as_str(), usize::from(arguments.jobs));
    if let (Some(folder), Some(private)) = (&arguments.score, &arguments.private) {
        let failed = suite::score_submission(folder, private, out, &secret, tools, observer)?;
        for (case, reason) in &failed {
            observer.message(&format!("unshade: {case}: {reason}"));
        }
        let code = if failed.is_empty() { DONE } else { CHECK_FAILED };
        return Outcome { code, ..Outcome::line(out.display()) }.with(&failed);
    }
    // The parser lets no other combination through.
    let Some(suite) = &arguments.suite else { return Ok(Outcome::default()) };
    let suite = Suite::open_for_captures(suite)?;
    let sealing = Sealing { secret: &secret, round, jobs };
    let sealed = suite::seal(&suite, out, &sealing, tools, observer)?;
    let [public, private] = ["public", "private"].map(|name| out.join(name));
    let lines = vec![
        format!("{}: {} captures to publish", public.display(), sealed.cases.len()),
        format!("{}: their truth, to keep private", private.display()),
        format!("signed by {}", sealed.public_key),
    ];
    Outcome { lines, ..Outcome::default() }.with(&sealed.public_key)
}

pub(super) fn verify(folder: &Path, key: Option<&str>) -> Result<Outcome, RunError> {
    let verified = sealing::verify(folder, key)?;
    let (statement, signer) = (&verified.statement, &verified.public_key);
    let (method, by, suite, round) =
        (&statement.method, &statement.by, &statement.suite, &statement.round);
    let mut lines =
        vec![format!("{method} by {by} on {suite}, round {round}: as it was signed by {signer}")];
    if key.is_none() {
        let hint = "to check the signer, pass --key with the public_key of the round's round.json";
        lines.push(hint.to_owned());
    }
    Outcome { lines, ..Outcome::default() }.with(signer)
}
