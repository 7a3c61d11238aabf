//! Computes a part of a sweep: members on threads, shards written as soon as they are complete.

use super::folder::Folder;
use super::manifest::Manifest;
use super::member::{Row, Sweep};
use super::shard::Columns;
use crate::failure::Failure;
use crate::progress;
use hamel_engine::CancellationToken;
use std::collections::BTreeMap;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Duration;

/// Largest number of members that a thread takes at once.
const MAX_BATCH: u64 = 64;
/// Interval at which the end of work, or a cancellation, is checked.
const POLL_INTERVAL: Duration = Duration::from_millis(2);
/// Least number of portions of a shard for each thread.
const MIN_PORTIONS_PER_THREAD: u64 = 4;

/// Data shared by the threads.
struct Queue {
    /// Shards not yet begun.
    waiting: VecDeque<u64>,
    /// The shard from which members are taken, and the next member.
    begun: Option<(u64, u64)>,
    /// Rows of incomplete shards, at most one more than there are threads.
    open: BTreeMap<u64, Vec<Row>>,
    /// The first error; all threads stop then.
    failure: Option<Failure>,
    done: SweepResult,
}

/// Finished work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SweepResult {
    /// Number of members.
    pub members: u64,
    /// Number of failed members.
    pub failed: u64,
    /// Number of shards.
    pub shards: u64,
}

/// Cancellation of the work.
pub struct Cancellation<'a> {
    /// Polled by the thread that started the work.
    asked: &'a CancellationToken,
    /// Flag that the members check.
    cancelled: Arc<AtomicBool>,
}

impl<'a> Cancellation<'a> {
    /// Creates a cancellation by a program's callback.
    pub fn new(asked: &'a CancellationToken) -> Self {
        Cancellation {
            asked,
            cancelled: Arc::default(),
        }
    }

    /// Returns the cancellation as runs of members check it, on any thread.
    pub fn of_members(&self) -> CancellationToken {
        let cancelled = Arc::clone(&self.cancelled);
        CancellationToken(Arc::new(move || cancelled.load(Ordering::Relaxed)))
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Waits until the threads finish or the work is cancelled.
    fn wait(&self, queue: &Mutex<Queue>, threads: &[ScopedJoinHandle<'_, ()>]) {
        let CancellationToken(asked) = self.asked;
        while !threads.iter().all(ScopedJoinHandle::is_finished) {
            if asked() {
                self.cancelled.store(true, Ordering::Relaxed);
                lock(queue).failure.get_or_insert_with(|| {
                    Failure::failed(
                        "the sweep was interrupted; run it again to compute what is missing",
                    )
                });
                return;
            }
            std::thread::sleep(POLL_INTERVAL);
        }
    }
}

/// The work of all threads.
pub struct Work<'a> {
    /// Cancellation, if possible.
    pub cancellation: Option<Cancellation<'a>>,
    /// Data that members share.
    pub sweep: &'a Sweep,
    /// Manifest with their shards.
    pub manifest: &'a Manifest,
    /// Columns of their rows.
    pub columns: &'a Columns,
    /// Metadata of files, in addition to the manifest.
    pub about: &'a [(String, String)],
    /// Destination of the files.
    pub folder: &'a Folder,
}

impl Work<'_> {
    /// Computes shards; completed ones remain even if others fail.
    pub fn compute_shards(&self, shards: Vec<u64>, threads: usize) -> Result<SweepResult, Failure> {
        let size = |shard: &u64| {
            let range = self.manifest.range(*shard);
            range.end - range.start
        };
        let bar = progress::rated(shards.iter().map(size).sum());
        let queue = Mutex::new(Queue {
            waiting: shards.into(),
            begun: None,
            open: BTreeMap::new(),
            failure: None,
            done: SweepResult::default(),
        });
        std::thread::scope(|scope| {
            let work = |_| {
                scope.spawn(|| {
                    loop {
                        // Release the lock before members run.
                        let next = self.next(&mut lock(&queue), threads);
                        let Some((shard, members)) = next else {
                            break;
                        };
                        let rows = self.sweep.rows(members);
                        bar.inc(rows.len() as u64);
                        self.hand_in(&queue, shard, rows);
                    }
                })
            };
            let threads: Vec<_> = (0..threads).map(work).collect();
            if let Some(cancellation) = &self.cancellation {
                cancellation.wait(&queue, &threads);
            }
        });
        bar.finish_and_clear();
        let queue = queue.into_inner().unwrap_or_else(PoisonError::into_inner);
        match queue.failure {
            Some(failure) => Err(failure),
            None => Ok(queue.done),
        }
    }

    /// Returns the next members to run, and their shard.
    fn next(&self, queue: &mut Queue, threads: usize) -> Option<(u64, std::ops::Range<u64>)> {
        if queue.failure.is_some() {
            return None;
        }
        let (shard, first) = match queue.begun.take() {
            Some(begun) => begun,
            None => {
                let shard = queue.waiting.pop_front()?;
                queue.open.insert(shard, Vec::new());
                (shard, self.manifest.range(shard).start)
            }
        };
        let portions = MIN_PORTIONS_PER_THREAD * threads as u64;
        let portion = (self.manifest.size / portions).clamp(1, MAX_BATCH);
        let end = self.manifest.range(shard).end;
        let last = (first + portion).min(end);
        if last < end {
            queue.begun = Some((shard, last));
        }
        Some((shard, first..last))
    }

    /// Takes rows, and writes their shard if it is complete.
    fn hand_in(&self, queue: &Mutex<Queue>, shard: u64, rows: Vec<Row>) {
        let range = self.manifest.range(shard);
        let mut whole = {
            let mut queue = lock(queue);
            // Cancelled members have no result.
            if self
                .cancellation
                .as_ref()
                .is_some_and(Cancellation::is_cancelled)
            {
                return;
            }
            let open = queue.open.entry(shard).or_default();
            open.extend(rows);
            if (open.len() as u64) < range.end - range.start {
                return;
            }
            queue.open.remove(&shard).unwrap_or_default()
        };
        whole.sort_unstable_by_key(|row| row.index);
        let written = self.write(shard, &whole);
        let mut queue = lock(queue);
        match written {
            Ok(()) => {
                queue.done.shards += 1;
                queue.done.members += whole.len() as u64;
                queue.done.failed += whole.iter().filter(|row| row.error.is_some()).count() as u64;
            }
            Err(failure) => {
                queue.failure.get_or_insert(failure);
            }
        }
    }

    fn write(&self, shard: u64, rows: &[Row]) -> Result<(), Failure> {
        let place = self.folder.place(shard);
        let bytes = self.columns.bytes(rows, &self.manifest.text, self.about);
        let bytes = bytes.map_err(|error| {
            Failure::usage(format!("cannot write {}: {error}", place.display()))
        })?;
        hamel_files::write_bytes(&place, &bytes).map_err(|error| Failure::usage(error.to_string()))
    }
}

fn lock(queue: &Mutex<Queue>) -> MutexGuard<'_, Queue> {
    // A thread that panics leaves no inconsistent data.
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}
