//! A statement of scores, as a file with a signature beside it.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path};

use ed25519_dalek::{Signature, VerifyingKey};
use formats::content_hash::hash_path;
use serde::{Deserialize, Serialize};

use crate::{SealError, Secret, hex, unhex};

const STATEMENT: &str = "statement.json";
const SIGNATURE: &str = "signature.json";
const ALGORITHM: &str = "ed25519";
/// Comes before the statement's bytes, so that no signature of something else fits.
const DOMAIN: &[u8] = b"unshade signed scores 1\n";
const FORMAT: u32 = 1;

/// The signed content: hashes (BLAKE3) of all that the numbers follow from, and of the numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Statement {
    /// Version of the format.
    pub format: u32,
    /// The suite and its round.
    pub suite: String,
    /// See `suite`.
    pub round: String,
    /// The method, as the submission names it.
    pub method: String,
    /// Who sent it.
    pub by: String,
    /// Captures as they were handed out, by case.
    pub captures: BTreeMap<String, String>,
    /// Captures with their truth, by case.
    pub truths: BTreeMap<String, String>,
    /// The submission's maps, by case; none where there were none.
    pub maps: BTreeMap<String, Option<String>>,
    /// Files beside the statement, by their paths.
    pub files: BTreeMap<String, String>,
    /// Versions of the program and of all that renders and scores.
    pub versions: BTreeMap<String, String>,
}

#[derive(Serialize, Deserialize)]
struct SignatureFile {
    format: u32,
    algorithm: String,
    public_key: String,
    signature: String,
}

/// A statement whose signature holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verified {
    /// The signed statement.
    pub statement: Statement,
    /// Who signed it.
    pub public_key: String,
}

fn signed(text: &[u8]) -> Vec<u8> {
    [DOMAIN, text].concat()
}

/// Writes a statement and its signature into `folder`, which holds its files.
pub fn write_signed(
    folder: &Path,
    statement: &Statement,
    secret: &Secret,
) -> Result<(), SealError> {
    let path = folder.join(STATEMENT);
    let mut text = serde_json::to_vec_pretty(statement).map_err(|e| SealError::format(&path, e))?;
    text.push(b'\n');
    fs::write(&path, &text).map_err(SealError::file(&path))?;
    let path = folder.join(SIGNATURE);
    let file = SignatureFile {
        format: FORMAT,
        algorithm: ALGORITHM.to_owned(),
        public_key: secret.public_key(),
        signature: secret.sign(&signed(&text)),
    };
    let mut text = serde_json::to_vec_pretty(&file).map_err(|e| SealError::format(&path, e))?;
    text.push(b'\n');
    fs::write(&path, text).map_err(SealError::file(&path))
}

/// Whether a folder claims to be signed.
pub fn is_signed(folder: &Path) -> bool {
    folder.join(SIGNATURE).is_file()
}

/// Checks the signature of a folder, by `key` where it is given (64 hexadecimal digits), and that every file
/// is the one that was signed.
pub fn verify(folder: &Path, key: Option<&str>) -> Result<Verified, SealError> {
    let path = folder.join(SIGNATURE);
    let text = fs::read(&path).map_err(|error| match error.kind() {
        ErrorKind::NotFound if folder.is_dir() => SealError::Unsigned(folder.to_path_buf()),
        _ => SealError::file(&path)(error),
    })?;
    let file: SignatureFile =
        serde_json::from_slice(&text).map_err(|error| SealError::format(&path, error))?;
    if file.format != FORMAT || file.algorithm != ALGORITHM {
        return Err(SealError::format(&path, format!("wants {ALGORITHM}, format {FORMAT}")));
    }
    if let Some(wanted) = key.filter(|key| !key.trim().eq_ignore_ascii_case(&file.public_key)) {
        let (found, wanted) = (file.public_key, wanted.trim().to_owned());
        return Err(SealError::Key { path: folder.to_path_buf(), found, wanted });
    }
    let public =
        unhex::<32>(&file.public_key).and_then(|bytes| VerifyingKey::from_bytes(&bytes).ok());
    let public = public.ok_or_else(|| SealError::format(&path, "has no public key"))?;
    let signature = unhex::<64>(&file.signature).map(|bytes| Signature::from_bytes(&bytes));
    let signature = signature.ok_or_else(|| SealError::format(&path, "has no signature"))?;
    let path = folder.join(STATEMENT);
    let text = fs::read(&path).map_err(SealError::file(&path))?;
    // Strict: keys of small order, for which a signature fits anything, are refused.
    if public.verify_strict(&signed(&text), &signature).is_err() {
        return Err(SealError::Signature(path));
    }
    let statement: Statement =
        serde_json::from_slice(&text).map_err(|error| SealError::format(&path, error))?;
    for (name, hash) in &statement.files {
        let below = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        let file = folder.join(name);
        if !below || hash_path(&file).ok().as_ref() != Some(hash) {
            return Err(SealError::Changed(file));
        }
    }
    Ok(Verified { statement, public_key: hex(public.as_bytes()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statement(folder: &Path) -> Statement {
        fs::create_dir_all(folder.join("scores")).unwrap();
        fs::write(folder.join("scores/a.json"), "{\"value\": 31.25}").unwrap();
        let hash = hash_path(&folder.join("scores/a.json")).unwrap();
        let one = |name: &str| BTreeMap::from([("a".to_owned(), name.to_owned())]);
        Statement {
            format: 1,
            suite: "sealed".into(),
            round: "1".into(),
            method: "mine".into(),
            by: "somebody".into(),
            captures: one("11"),
            truths: one("22"),
            maps: BTreeMap::from([("a".to_owned(), None)]),
            files: BTreeMap::from([("scores/a.json".to_owned(), hash)]),
            versions: one("1.0"),
        }
    }

    fn secret(root: &Path, byte: u8) -> Secret {
        fs::write(root.join("secret"), [byte; 32]).unwrap();
        Secret::read(&root.join("secret")).unwrap()
    }

    #[test]
    fn a_changed_byte_of_any_signed_file_is_seen() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("scored");
        let secret = secret(root.path(), 7);
        let statement = statement(&folder);
        write_signed(&folder, &statement, &secret).unwrap();
        let verified = verify(&folder, Some(&secret.public_key())).unwrap();
        assert_eq!(verified.statement, statement);
        for name in [STATEMENT, SIGNATURE, "scores/a.json"] {
            let path = folder.join(name);
            let bytes = fs::read(&path).unwrap();
            for at in 0..bytes.len() {
                let mut changed = bytes.clone();
                changed[at] ^= 1;
                fs::write(&path, &changed).unwrap();
                let result = verify(&folder, Some(&secret.public_key()));
                // White space of the signature's file, and the case of its digits, sign nothing.
                let same =
                    name == SIGNATURE && result.as_ref().is_ok_and(|v| v.statement == statement);
                assert!(result.is_err() || same, "{name} byte {at}");
            }
            fs::write(&path, &bytes).unwrap();
        }
        fs::remove_file(folder.join("scores/a.json")).unwrap();
        assert!(matches!(verify(&folder, None), Err(SealError::Changed(_))));
    }

    #[test]
    fn another_key_is_another_signer() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("scored");
        write_signed(&folder, &statement(&folder), &secret(root.path(), 7)).unwrap();
        let other = secret(root.path(), 8).public_key();
        assert!(matches!(verify(&folder, Some(&other)), Err(SealError::Key { .. })));
    }

    #[test]
    fn seeds_differ_by_name_and_secret_and_a_short_secret_is_refused() {
        let root = tempfile::tempdir().unwrap();
        let (one, other) = (secret(root.path(), 1), secret(root.path(), 2));
        let seeds = [
            one.seed(&["1", "ada", "face"]),
            one.seed(&["1", "ada", "render"]),
            one.seed(&["1", "adaface"]),
            one.seed(&["2", "ada", "face"]),
            other.seed(&["1", "ada", "face"]),
        ];
        assert!(seeds.iter().all(|seed| *seed >= 0));
        assert_eq!(std::collections::BTreeSet::from(seeds).len(), seeds.len());
        assert_eq!(one.seed(&["1", "ada", "face"]), seeds[0]);
        fs::write(root.path().join("short"), "password").unwrap();
        assert!(matches!(Secret::read(&root.path().join("short")), Err(SealError::Short(_))));
    }

    #[test]
    fn signatures_are_those_of_rfc_8032() {
        // Test 3 of its section 7.1, through the library's own key.
        let seed = unhex::<32>("c5aa8df43f9f837bedb7442f31dcb7b166d38535076f094b85ce3a2e0b4458f7")
            .unwrap();
        let key = ed25519_dalek::SigningKey::from_bytes(&seed);
        let public = "fc51cd8e6218a1a38da47ed00230f0580816ed13ba3303ac5deb911548908025";
        assert_eq!(hex(key.verifying_key().as_bytes()), public);
        let signature = ed25519_dalek::Signer::sign(&key, &[0xaf, 0x82]);
        assert!(hex(&signature.to_bytes()).starts_with("6291d657deec24024827e69c3abe01a3"));
    }
}
