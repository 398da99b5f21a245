//! A secret file, and what follows from it.

use std::fs;
use std::path::Path;

use ed25519_dalek::{Signer, SigningKey};

use crate::{SealError, hex};

/// The fewest bytes of a secret.
const LENGTH: usize = 32;
/// Contexts of BLAKE3's key derivation: nothing that is made for one use tells of another.
const SEEDS: &str = "unshade 2026 sealed suites: seeds";
const SIGNING: &str = "unshade 2026 sealed suites: signing key";

/// Bytes that nobody else knows.
pub struct Secret(Vec<u8>);

impl Secret {
    /// Reads the bytes of a file, all of them.
    pub fn read(path: &Path) -> Result<Self, SealError> {
        let bytes = fs::read(path).map_err(SealError::file(path))?;
        if bytes.len() < LENGTH {
            return Err(SealError::Short(path.to_path_buf()));
        }
        Ok(Self(bytes))
    }

    /// A seed from 0 to 2^63 - 1 for each list of names.
    pub fn seed(&self, names: &[&str]) -> i64 {
        let key = blake3::derive_key(SEEDS, &self.0);
        let mut hasher = blake3::Hasher::new_keyed(&key);
        for name in names {
            hasher.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes());
        }
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&hasher.finalize().as_bytes()[..8]);
        i64::from_le_bytes(bytes) & i64::MAX
    }

    fn key(&self) -> SigningKey {
        SigningKey::from_bytes(&blake3::derive_key(SIGNING, &self.0))
    }

    /// Key that others check signatures with, 64 hexadecimal digits.
    pub fn public_key(&self) -> String {
        hex(self.key().verifying_key().as_bytes())
    }

    /// The Ed25519 signature (RFC 8032) of `bytes`.
    pub(crate) fn sign(&self, bytes: &[u8]) -> String {
        hex(&self.key().sign(bytes).to_bytes())
    }
}
