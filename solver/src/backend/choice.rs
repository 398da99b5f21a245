//! The choice of a backend.

use std::fmt;
use std::str::FromStr;

use super::Backend;
use super::cpu::Cpu;
use super::error::BackendError;
use super::gpu::{Adapter, Gpu};

/// The requested backend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// A hardware GPU if there is one, else the processor; never a software adapter.
    #[default]
    Auto,
    /// The processor.
    Cpu,
    /// A hardware GPU, or the adapter named by the environment; an error without one.
    Gpu,
}

impl Choice {
    /// Opens the backend.
    pub fn open(self) -> Result<Box<dyn Backend>, BackendError> {
        let gpu = || Adapter::chosen().and_then(|adapter| Gpu::open(&adapter));
        match self {
            Self::Cpu => Ok(Box::new(Cpu::new())),
            Self::Gpu => Ok(Box::new(gpu()?)),
            Self::Auto => match Adapter::chosen().ok().filter(|adapter| !adapter.software) {
                None => Ok(Box::new(Cpu::new())),
                Some(adapter) => match Gpu::open(&adapter) {
                    Ok(gpu) => Ok(Box::new(gpu)),
                    Err(error) => {
                        tracing::warn!("{error}; the solve runs on the processor");
                        Ok(Box::new(Cpu::new()))
                    }
                },
            },
        }
    }
}

impl FromStr for Choice {
    type Err = BackendError;

    fn from_str(name: &str) -> Result<Self, BackendError> {
        match name {
            "auto" => Ok(Self::Auto),
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu),
            other => Err(BackendError::Unknown(other.to_owned())),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        })
    }
}
