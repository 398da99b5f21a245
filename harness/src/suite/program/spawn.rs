//! The first process of a program: it leads a group, dies with the thread that starts it, and has no network unless
//! the suite asks for it.

use std::io;
use std::process::{Child, Command};

use serde::{Deserialize, Serialize};

/// The network that a program could reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Network {
    /// Everything: the suite asks for it, or this system cannot close it.
    #[default]
    Open,
    /// No TCP connection, not even on this machine; UDP is open, and with it the names of other machines.
    Tcp,
    /// Nothing but processes of its own, over the loopback interface.
    Closed,
}

/// Starts `command`. Without `network` it runs in an empty network namespace, else, where the kernel or a container
/// refuses that, with TCP closed by Landlock for this thread and all that it starts.
pub(super) fn spawn(mut command: Command, network: bool) -> io::Result<(Child, Network)> {
    if !network {
        return spawn_without_network(command);
    }
    group(&mut command);
    Ok((command.spawn()?, Network::Open))
}

#[cfg(target_os = "linux")]
fn spawn_without_network(mut command: Command) -> io::Result<(Child, Network)> {
    use std::os::unix::process::CommandExt;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    let leaves = Arc::new(AtomicBool::new(true));
    let asked = leaves.clone();
    // SAFETY: between fork and exec only system calls are made, which allocate nothing.
    unsafe {
        command.pre_exec(move || if asked.load(Ordering::Relaxed) { leave() } else { Ok(()) });
    }
    // After the namespace: a change of rights would clear the signal.
    group(&mut command);
    if let Ok(child) = command.spawn() {
        return Ok((child, Network::Closed));
    }
    leaves.store(false, Ordering::Relaxed);
    let closed = close_tcp();
    Ok((command.spawn()?, if closed { Network::Tcp } else { Network::Open }))
}

/// Puts this process into an empty network namespace. In a user namespace everybody may; without one root alone, who
/// could then return to the old network.
#[cfg(target_os = "linux")]
fn leave() -> io::Result<()> {
    // SAFETY: plain system calls; the request outlives them.
    unsafe {
        if libc::unshare(libc::CLONE_NEWUSER | libc::CLONE_NEWNET) != 0
            && libc::unshare(libc::CLONE_NEWNET) != 0
        {
            return Err(io::Error::last_os_error());
        }
        // Processes of one method speak to one another over 127.0.0.1. Without it they run alone.
        let socket = libc::socket(libc::AF_INET, libc::SOCK_DGRAM | libc::SOCK_CLOEXEC, 0);
        let mut request: libc::ifreq = std::mem::zeroed();
        request.ifr_name[..2].copy_from_slice(&[b'l' as libc::c_char, b'o' as libc::c_char]);
        request.ifr_ifru.ifru_flags = (libc::IFF_UP | libc::IFF_RUNNING) as libc::c_short;
        libc::ioctl(socket, libc::SIOCSIFFLAGS, &request);
        libc::close(socket);
    }
    Ok(())
}

/// Whether the kernel (from Linux 6.7 on) now refuses TCP.
#[cfg(target_os = "linux")]
fn close_tcp() -> bool {
    use landlock::{ABI, Access, AccessNet, Ruleset, RulesetAttr, RulesetStatus};
    let closed = Ruleset::default()
        .handle_access(AccessNet::from_all(ABI::V4))
        .and_then(Ruleset::create)
        .and_then(landlock::RulesetCreated::restrict_self);
    closed.is_ok_and(|status| status.ruleset == RulesetStatus::FullyEnforced)
}

/// This system has no way to close the network.
#[cfg(not(target_os = "linux"))]
fn spawn_without_network(mut command: Command) -> io::Result<(Child, Network)> {
    group(&mut command);
    Ok((command.spawn()?, Network::Open))
}

#[cfg(target_os = "linux")]
fn group(command: &mut Command) {
    use std::os::unix::process::CommandExt;

    use rustix::process::{Signal, set_parent_process_death_signal};
    command.process_group(0);
    // SAFETY: between fork and exec only one system call is made, which allocates nothing.
    unsafe {
        command.pre_exec(|| Ok(set_parent_process_death_signal(Some(Signal::KILL))?));
    }
}

#[cfg(all(unix, not(target_os = "linux")))]
fn group(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
}

#[cfg(not(unix))]
fn group(_: &mut Command) {}
