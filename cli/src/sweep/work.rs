//! Computes a part of a sweep: members on threads, shards written as soon as they are complete.

use super::folder::Folder;
use super::manifest::Manifest;
use super::member::{Row, Sweep};
use super::shard::Columns;
use crate::failure::Failure;
use crate::progress;
use crate::simulate::stop::Stop;
use std::collections::BTreeMap;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Duration;

/// Largest number of members that a thread takes at once.
const MOST: u64 = 64;
/// Interval at which the end of work, or a cancellation, is checked.
const WAIT: Duration = Duration::from_millis(2);
/// Least number of portions of a shard for each thread.
const PORTIONS: u64 = 4;

/// Data shared by the threads.
struct Desk {
    /// Shards not yet begun.
    waiting: VecDeque<u64>,
    /// The shard from which members are taken, and the next member.
    begun: Option<(u64, u64)>,
    /// Rows of incomplete shards, at most one more than there are threads.
    open: BTreeMap<u64, Vec<Row>>,
    /// The first error; all threads stop then.
    failure: Option<Failure>,
    done: Done,
}

/// Finished work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// Number of members.
    pub members: u64,
    /// Number of failed members.
    pub failed: u64,
    /// Number of shards.
    pub shards: u64,
}

/// Cancellation of the work.
pub struct Stopping<'a> {
    /// Polled by the thread that started the work.
    asked: &'a Stop,
    /// Flag that the members check.
    told: Arc<AtomicBool>,
}

impl<'a> Stopping<'a> {
    /// A cancellation by a program's callback.
    pub fn new(asked: &'a Stop) -> Self {
        Stopping {
            asked,
            told: Arc::default(),
        }
    }

    /// The cancellation as runs of members check it, on any thread.
    pub fn of_members(&self) -> Stop {
        let told = Arc::clone(&self.told);
        Stop(Arc::new(move || told.load(Ordering::Relaxed)))
    }

    fn is_told(&self) -> bool {
        self.told.load(Ordering::Relaxed)
    }

    /// Waits until the threads finish or the work is cancelled.
    fn wait(&self, desk: &Mutex<Desk>, threads: &[ScopedJoinHandle<'_, ()>]) {
        let Stop(asked) = self.asked;
        while !threads.iter().all(ScopedJoinHandle::is_finished) {
            if asked() {
                self.told.store(true, Ordering::Relaxed);
                at(desk).failure.get_or_insert_with(|| {
                    Failure::failed(
                        "the sweep was interrupted; run it again to compute what is missing",
                    )
                });
                return;
            }
            std::thread::sleep(WAIT);
        }
    }
}

/// The work of all threads.
pub struct Work<'a> {
    /// Cancellation, if possible.
    pub stopping: Option<Stopping<'a>>,
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
    pub fn on(&self, shards: Vec<u64>, threads: usize) -> Result<Done, Failure> {
        let size = |shard: &u64| {
            let range = self.manifest.range(*shard);
            range.end - range.start
        };
        let bar = progress::rated(shards.iter().map(size).sum());
        let desk = Mutex::new(Desk {
            waiting: shards.into(),
            begun: None,
            open: BTreeMap::new(),
            failure: None,
            done: Done::default(),
        });
        std::thread::scope(|scope| {
            let work = |_| {
                scope.spawn(|| {
                    loop {
                        // Release the lock before members run.
                        let next = self.next(&mut at(&desk), threads);
                        let Some((shard, members)) = next else {
                            break;
                        };
                        let rows = self.sweep.rows(members);
                        bar.inc(rows.len() as u64);
                        self.hand_in(&desk, shard, rows);
                    }
                })
            };
            let threads: Vec<_> = (0..threads).map(work).collect();
            if let Some(stopping) = &self.stopping {
                stopping.wait(&desk, &threads);
            }
        });
        bar.finish_and_clear();
        let desk = desk.into_inner().unwrap_or_else(PoisonError::into_inner);
        match desk.failure {
            Some(failure) => Err(failure),
            None => Ok(desk.done),
        }
    }

    /// The next members to run, and their shard.
    fn next(&self, desk: &mut Desk, threads: usize) -> Option<(u64, std::ops::Range<u64>)> {
        if desk.failure.is_some() {
            return None;
        }
        let (shard, first) = match desk.begun.take() {
            Some(begun) => begun,
            None => {
                let shard = desk.waiting.pop_front()?;
                desk.open.insert(shard, Vec::new());
                (shard, self.manifest.range(shard).start)
            }
        };
        let portions = PORTIONS * threads as u64;
        let portion = (self.manifest.size / portions).clamp(1, MOST);
        let end = self.manifest.range(shard).end;
        let last = (first + portion).min(end);
        if last < end {
            desk.begun = Some((shard, last));
        }
        Some((shard, first..last))
    }

    /// Takes rows, and writes their shard if it is complete.
    fn hand_in(&self, desk: &Mutex<Desk>, shard: u64, rows: Vec<Row>) {
        let range = self.manifest.range(shard);
        let mut whole = {
            let mut desk = at(desk);
            // Cancelled members have no result.
            if self.stopping.as_ref().is_some_and(Stopping::is_told) {
                return;
            }
            let open = desk.open.entry(shard).or_default();
            open.extend(rows);
            if (open.len() as u64) < range.end - range.start {
                return;
            }
            desk.open.remove(&shard).unwrap_or_default()
        };
        whole.sort_unstable_by_key(|row| row.index);
        let written = self.write(shard, &whole);
        let mut desk = at(desk);
        match written {
            Ok(()) => {
                desk.done.shards += 1;
                desk.done.members += whole.len() as u64;
                desk.done.failed += whole.iter().filter(|row| row.error.is_some()).count() as u64;
            }
            Err(failure) => {
                desk.failure.get_or_insert(failure);
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

fn at(desk: &Mutex<Desk>) -> MutexGuard<'_, Desk> {
    // A thread that panics leaves no inconsistent data.
    desk.lock().unwrap_or_else(PoisonError::into_inner)
}
