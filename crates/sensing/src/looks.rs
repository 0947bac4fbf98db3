//! What a path shows at the times of a column.

/// Looks at a path, kept for the next column: mostly all are lost in the same frames.
#[derive(Debug)]
pub(crate) struct Looks<'a, T> {
    times: &'a [f64],
    seen: Vec<T>,
}

impl<'a, T> Looks<'a, T> {
    /// None yet.
    pub fn new() -> Self {
        Self { times: &[], seen: Vec::new() }
    }

    /// What `look` sees at each time.
    pub fn at(&mut self, times: &'a [f64], look: impl Fn(f64) -> T) -> &[T] {
        if self.times != times {
            self.seen = times.iter().map(|time| look(*time)).collect();
            self.times = times;
        }
        &self.seen
    }
}
