//! The work on a part of a sweep: members on threads, shards as soon as they are whole.

use super::folder::Folder;
use super::manifest::Manifest;
use super::member::{Row, Sweep};
use super::shard::Columns;
use crate::failure::Failure;
use crate::progress;
use hamel_engine::Stop;
use std::collections::BTreeMap;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Duration;

/// Members that a thread takes at once, at most.
const MOST: u64 = 64;
/// How long it takes at most to see that work is done, or given up.
const WAIT: Duration = Duration::from_millis(2);
/// In how many portions a shard is taken at least, by a thread.
const PORTIONS: u64 = 4;

/// What threads share.
struct Desk {
    /// Shards that nobody has begun.
    waiting: VecDeque<u64>,
    /// The shard that members are taken from, and the next of them.
    begun: Option<(u64, u64)>,
    /// Rows of shards that are not whole; there are no more of them than threads, and one.
    open: BTreeMap<u64, Vec<Row>>,
    /// What went wrong; nobody goes on then.
    failure: Option<Failure>,
    done: Done,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// Members.
    pub members: u64,
    /// Those that failed.
    pub failed: u64,
    /// Shards.
    pub shards: u64,
}

/// What gives up the work.
pub struct Stopping<'a> {
    /// Asked by the thread that the work was asked of.
    asked: &'a Stop,
    /// What members are told.
    told: Arc<AtomicBool>,
}

impl<'a> Stopping<'a> {
    /// That of a program.
    pub fn new(asked: &'a Stop) -> Self {
        Stopping {
            asked,
            told: Arc::default(),
        }
    }

    /// The same for runs of members, on any thread.
    pub fn of_members(&self) -> Stop {
        let told = Arc::clone(&self.told);
        Stop(Arc::new(move || told.load(Ordering::Relaxed)))
    }

    fn is_told(&self) -> bool {
        self.told.load(Ordering::Relaxed)
    }

    /// Waits for threads, or for the end of all work.
    fn wait(&self, desk: &Mutex<Desk>, threads: &[ScopedJoinHandle<'_, ()>]) {
        let Stop(asked) = self.asked;
        while !threads.iter().all(ScopedJoinHandle::is_finished) {
            if asked() {
                self.told.store(true, Ordering::Relaxed);
                at(desk).failure.get_or_insert_with(|| {
                    Failure::failed(
                        "the sweep was given up; the same sweep computes what is missing",
                    )
                });
                return;
            }
            std::thread::sleep(WAIT);
        }
    }
}

/// All that a thread needs.
pub struct Work<'a> {
    /// What may give it up.
    pub stopping: Option<Stopping<'a>>,
    /// What members have in common.
    pub sweep: &'a Sweep,
    /// Their shards.
    pub manifest: &'a Manifest,
    /// Their columns.
    pub columns: &'a Columns,
    /// What files say of them, beside the manifest.
    pub about: &'a [(String, String)],
    /// Where files go.
    pub folder: &'a Folder,
}

impl Work<'_> {
    /// Computes shards; those that are whole stay, whatever happens to others.
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
                        // The desk is free again before members run.
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

    /// The next members, and their shard.
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

    /// Takes rows, and writes their shard where they are its last ones.
    fn hand_in(&self, desk: &Mutex<Desk>, shard: u64, rows: Vec<Row>) {
        let range = self.manifest.range(shard);
        let mut whole = {
            let mut desk = at(desk);
            // Members that are told to stop have no end.
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
    // Nothing is left half changed by a thread that ends.
    desk.lock().unwrap_or_else(PoisonError::into_inner)
}
