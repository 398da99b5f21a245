//! Runs a reader on inputs, and ends the program with the input that panics, hangs or eats memory.

use std::alloc::{GlobalAlloc, Layout, System};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, Once};
use std::time::{Duration, Instant};

use crate::mutate::Mutator;

/// Live memory of all targets together that no input may exceed.
const MAX_BYTES: usize = 2 << 30;
/// Address space behind that, for what does not ask this allocator.
const MAX_ADDRESSES: u64 = 16 << 30;
/// Time that no input may exceed.
const MAX_TIME: Duration = Duration::from_secs(5);
/// Inputs of a target without `UNSHADE_FUZZ_INPUTS`.
const FEW_INPUTS: usize = 30_000;
/// Inputs that are kept to be changed again, because they met something new.
const MAX_KEPT: usize = 1000;
/// And of those that are refused, from which little is reached.
const MAX_REFUSED: usize = 100;
/// Bytes of a kept input, so that inputs do not grow for ever.
const LONGEST_KEPT: usize = 1 << 14;

/// How the outcome of an input begins that a reader refuses.
pub const REFUSED: &str = "refused: ";

/// Counts what is live.
pub struct Counting;

static LIVE_BYTES: AtomicUsize = AtomicUsize::new(0);
static ENDING: AtomicBool = AtomicBool::new(false);
static SLOTS: Mutex<Vec<Arc<Slot>>> = Mutex::new(Vec::new());
static PANIC: Mutex<String> = Mutex::new(String::new());

/// State of a target: its input, and since when.
struct Slot {
    target: &'static str,
    input: Mutex<Vec<u8>>,
    since: Mutex<Option<Instant>>,
}

impl Counting {
    fn take(bytes: usize) {
        let live_bytes = LIVE_BYTES.fetch_add(bytes, Relaxed) + bytes;
        if live_bytes > MAX_BYTES && !ENDING.swap(true, Relaxed) {
            let slots = SLOTS.try_lock().map(|slots| slots.clone()).unwrap_or_default();
            for slot in slots {
                slot.save("memory");
            }
            eprintln!("{live_bytes} bytes of memory are live, {bytes} of them asked for at once");
            std::process::abort();
        }
    }
}

// SAFETY: every call is the system allocator's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LIVE_BYTES.fetch_sub(layout.size(), Relaxed);
        Self::take(size);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        LIVE_BYTES.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(old, layout) }
    }
}

impl Slot {
    /// Writes the input beside the program.
    fn save(&self, fault: &str) -> PathBuf {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let path = folder.join(format!("{}-{fault}.input", self.target));
        if let Ok(input) = self.input.lock() {
            let _ = std::fs::create_dir_all(folder);
            let _ = std::fs::write(&path, &*input);
        }
        eprintln!("{}: {fault}: the input is {}", self.target, path.display());
        path
    }
}

/// The limit on addresses, and panics kept instead of printed: decoders' panics are caught by their
/// readers, thousands of times.
fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        #[cfg(target_os = "linux")]
        let _ = {
            use rustix::process::{Resource, Rlimit, setrlimit};
            let limit = Some(MAX_ADDRESSES);
            setrlimit(Resource::As, Rlimit { current: limit, maximum: limit })
        };
        std::panic::set_hook(Box::new(|what| {
            if let Ok(mut kept) = PANIC.lock() {
                *kept = what.to_string();
            }
        }));
    });
}

fn watch(slot: &Arc<Slot>) {
    let slot = Arc::downgrade(slot);
    std::thread::spawn(move || {
        while let Some(slot) = slot.upgrade() {
            let late = slot
                .since
                .lock()
                .is_ok_and(|since| since.is_some_and(|since| since.elapsed() > MAX_TIME));
            if late {
                slot.save("hang");
                std::process::abort();
            }
            drop(slot);
            std::thread::sleep(Duration::from_millis(200));
        }
    });
}

/// Kind of an outcome, without its names and numbers: two inputs of one kind met the same lines.
fn kind_of(outcome: &str) -> String {
    let mut quoted = false;
    let plain = outcome.chars().filter(|c| {
        quoted ^= matches!(c, '"' | '`');
        !quoted && !c.is_ascii_digit()
    });
    plain.take(60).collect()
}

/// Calls `reader` with the seeds and then with changed ones; what it returns says what it met.
///
/// # Panics
/// When the reader panics; its input is in a file that the message names.
pub fn fuzz(
    target: &'static str,
    seeds: Vec<Vec<u8>>,
    mutator: Mutator,
    reader: impl Fn(&[u8]) -> String,
) {
    prepare();
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse().ok());
    let count = number("UNSHADE_FUZZ_INPUTS").unwrap_or(FEW_INPUTS);
    let run = number("UNSHADE_FUZZ_SEED").unwrap_or(0) as u64;
    let input = Mutex::new(Vec::new());
    let slot = Arc::new(Slot { target, input, since: Mutex::new(None) });
    SLOTS.lock().unwrap().push(slot.clone());
    watch(&slot);
    let started = Instant::now();
    let mut kept = Vec::new();
    let mut kinds = std::collections::BTreeMap::<String, usize>::new();
    let (mut slowest, mut read) = (Duration::ZERO, 0);
    for index in 0..count.max(seeds.len()) {
        let input = match seeds.get(index) {
            Some(seed) => seed.clone(),
            None => mutator.changed(&seeds, &kept, run, index as u64),
        };
        slot.input.lock().unwrap().clone_from(&input);
        let began = Instant::now();
        *slot.since.lock().unwrap() = Some(began);
        let outcome = catch_unwind(AssertUnwindSafe(|| reader(&input)));
        *slot.since.lock().unwrap() = None;
        slowest = slowest.max(began.elapsed());
        let Ok(outcome) = outcome else {
            let path = slot.save("panic");
            let what = PANIC.lock().map(|text| text.clone()).unwrap_or_default();
            eprintln!("{target}: input {index} of run {run}: {}: {what}", path.display());
            panic!("{target}: {what}");
        };
        let is_read = !outcome.starts_with(REFUSED);
        read += usize::from(is_read);
        let limit = if is_read { MAX_KEPT } else { MAX_REFUSED };
        let seen = kinds.entry(kind_of(&outcome)).or_default();
        *seen += 1;
        if *seen == 1 && kept.len() < limit && input.len() <= LONGEST_KEPT {
            kept.push(input);
        }
    }
    SLOTS.lock().unwrap().retain(|other| other.target != target);
    let (seconds, kinds) = (started.elapsed().as_secs_f64(), kinds.len());
    println!(
        "{target}: {count} inputs from {} seeds in {seconds:.1} s, {read} read, {kinds} kinds of \
         outcome, slowest {slowest:.0?}",
        seeds.len()
    );
}
