//! `unshade seal`, `unshade verify`.

use std::path::Path;

use sealing::Secret;

use super::alone::tools;
use super::arguments::SealArgs;
use super::exit::{CHECK_FAILED, DONE};
use super::progress::Progress;
use crate::suite::{self, RunError, Sealing, Suite};

pub(super) fn seal(arguments: &SealArgs) -> Result<u8, RunError> {
    let secret = Secret::read(&arguments.seeds_from)?;
    let mut progress = Progress::new();
    let out = &arguments.out;
    let (round, jobs) = (arguments.round.as_str(), usize::from(arguments.jobs));
    if let (Some(folder), Some(private)) = (&arguments.score, &arguments.private) {
        let failed =
            suite::score_submission(folder, private, out, &secret, &tools(), &mut progress);
        progress.finish();
        let failed = failed?;
        for (case, reason) in &failed {
            eprintln!("unshade: {case}: {reason}");
        }
        say!("{}", out.display());
        return Ok(if failed.is_empty() { DONE } else { CHECK_FAILED });
    }
    // The parser lets no other combination through.
    let Some(suite) = &arguments.suite else { return Ok(DONE) };
    let suite = Suite::open_for_captures(suite)?;
    let sealing = Sealing { secret: &secret, round, jobs };
    let sealed = suite::seal(&suite, out, &sealing, &tools(), &mut progress);
    progress.finish();
    let sealed = sealed?;
    say!("{}: {} captures to publish", out.join("public").display(), sealed.cases.len());
    say!("{}: their truth, to keep private", out.join("private").display());
    say!("signed by {}", sealed.public_key);
    Ok(DONE)
}

pub(super) fn verify(folder: &Path, key: Option<&str>) -> Result<(), RunError> {
    let verified = sealing::verify(folder, key)?;
    let statement = &verified.statement;
    say!(
        "{} by {} on {}, round {}: as it was signed by {}",
        statement.method,
        statement.by,
        statement.suite,
        statement.round,
        verified.public_key
    );
    if key.is_none() {
        say!("to check the signer, pass --key with the public_key of the round's round.json");
    }
    Ok(())
}
