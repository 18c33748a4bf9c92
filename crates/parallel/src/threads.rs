//! How many threads a piece of work may use.

/// Threads could not be started.
#[derive(Debug, thiserror::Error)]
#[error("{count} threads could not be started: {reason}")]
#[non_exhaustive]
pub struct ThreadsError {
    /// How many were asked for; 0 stands for one per core.
    pub count: usize,
    /// What the system says.
    pub reason: String,
}

/// Number of threads that loops of the calling thread run on.
#[cfg(feature = "rayon")]
pub fn n_threads() -> usize {
    rayon::current_num_threads()
}

/// Number of threads that loops of the calling thread run on.
#[cfg(not(feature = "rayon"))]
pub fn n_threads() -> usize {
    1
}

/// Runs work on a pool of `count` threads of its own, which end with it; 0 stands for one per core.
///
/// # Errors
/// If the threads cannot be started.
#[cfg(feature = "rayon")]
pub fn with_threads<R: Send>(
    count: usize,
    work: impl FnOnce() -> R + Send,
) -> Result<R, ThreadsError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| ThreadsError { count, reason: error.to_string() })?;
    Ok(pool.install(work))
}

/// Runs work on the calling thread: this build has no others.
///
/// # Errors
/// Never.
#[cfg(not(feature = "rayon"))]
pub fn with_threads<R: Send>(
    _count: usize,
    work: impl FnOnce() -> R + Send,
) -> Result<R, ThreadsError> {
    Ok(work())
}

/// Runs work on the calling thread, and other work `aside`: on a thread of the caller's pool that is free meanwhile, or
/// afterwards.
#[cfg(feature = "rayon")]
pub fn beside<R>(aside: impl FnOnce() + Send, work: impl FnOnce() -> R) -> R {
    rayon::in_place_scope(|scope| {
        scope.spawn(|_| aside());
        work()
    })
}

/// Runs work, then other work.
#[cfg(not(feature = "rayon"))]
pub fn beside<R>(aside: impl FnOnce(), work: impl FnOnce() -> R) -> R {
    let result = work();
    aside();
    result
}

/// Runs two pieces of work, side by side where a thread of the caller's pool is free.
#[cfg(feature = "rayon")]
pub fn both<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(one, other)
}

/// Runs two pieces of work, one after the other.
#[cfg(not(feature = "rayon"))]
pub fn both<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}
