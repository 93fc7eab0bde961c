//! Where a deck goes: buffered, counted, rendered in parallel, cancellable.

use std::io::Write;
use std::ops::Range;

use super::DeckError;
use crate::progress::{Cancelled, Progress};

/// Text is handed on in pieces of this size, bytes.
const FLUSH: usize = 1 << 20;
/// Work in one parallel piece, in units of [`Rows::weight`] (nodes or elements).
const PIECE: usize = 8192;
/// Groups of rows that are rendered to estimate a block's size.
const SAMPLES: usize = 24;
/// Rows of a group that are rendered at least, where it has so many.
const SAMPLED_ROWS: usize = 64;

enum Target<'a> {
    Writer { out: &'a mut dyn Write, progress: Progress<'a> },
    Counter { cancelled: Cancelled<'a> },
}

/// Receives a deck's text. Only ASCII lines of at most 256 characters are legal in ABAQUS; the writers see to that.
pub(crate) struct Sink<'a> {
    target: Target<'a>,
    buffer: Vec<u8>,
    written: u64,
}

/// A long block of lines made of rows that can be rendered independently.
pub(crate) trait Rows: Sync {
    /// Number of rows.
    fn rows(&self) -> usize;
    /// Rows in a group that looks alike along the block (a plane, a slice).
    fn group(&self) -> usize;
    /// Lines a row has at most: the share of the work.
    fn weight(&self, row: usize) -> usize;
    /// Appends the text of some rows.
    fn render(&self, rows: Range<usize>, out: &mut Vec<u8>);
}

impl<'a> Sink<'a> {
    /// A sink that writes.
    pub(crate) fn new(out: &'a mut dyn Write, progress: Progress<'a>) -> Self {
        Self { target: Target::Writer { out, progress }, buffer: Vec::new(), written: 0 }
    }

    /// A sink that only counts bytes, and estimates those of long blocks from samples.
    pub(crate) fn counting(cancelled: Cancelled<'a>) -> Self {
        Self { target: Target::Counter { cancelled }, buffer: Vec::new(), written: 0 }
    }

    /// Bytes so far.
    pub(crate) fn written(&self) -> u64 {
        self.written + self.buffer.len() as u64
    }

    /// A line.
    pub(crate) fn line(&mut self, text: &str) -> Result<(), DeckError> {
        debug_assert!(text.is_ascii() && text.len() <= 256, "{text}");
        self.buffer.extend_from_slice(text.as_bytes());
        self.buffer.push(b'\n');
        if self.buffer.len() >= FLUSH { self.flush() } else { Ok(()) }
    }

    /// Numbers, sixteen a line (CalculiX and ABAQUS read no more).
    pub(crate) fn list(&mut self, numbers: impl Iterator<Item = u64>) -> Result<(), DeckError> {
        let mut line = String::new();
        let mut buffer = itoa::Buffer::new();
        for (i, number) in numbers.enumerate() {
            if i > 0 && i % 16 == 0 {
                self.line(&line)?;
                line.clear();
            } else if i > 0 {
                line.push(',');
            }
            line.push_str(buffer.format(number));
        }
        if line.is_empty() { Ok(()) } else { self.line(&line) }
    }

    /// A long block. Pieces are rendered in parallel while the previous batch is written, so memory stays bounded.
    pub(crate) fn rows(&mut self, block: &dyn Rows) -> Result<(), DeckError> {
        if let Target::Counter { cancelled } = self.target {
            self.written += estimate(block, cancelled)?;
            return Ok(());
        }
        self.flush()?;
        let batch = 4 * rayon::current_num_threads().max(1);
        let mut pieces = pieces(block);
        let (mut ready, mut next): (Vec<Vec<u8>>, Vec<Vec<u8>>) = (Vec::new(), vec![Vec::new(); batch]);
        loop {
            let ranges: Vec<Range<usize>> = pieces.by_ref().take(batch).collect();
            rayon::in_place_scope(|scope| {
                for (buffer, range) in next.iter_mut().zip(&ranges) {
                    let range = range.clone();
                    scope.spawn(move |_| block.render(range, buffer));
                }
                ready.iter().try_for_each(|piece| self.emit(piece))
            })?;
            if ranges.is_empty() {
                return Ok(());
            }
            std::mem::swap(&mut ready, &mut next);
            next.resize_with(batch, Vec::new);
            next.iter_mut().for_each(Vec::clear);
        }
    }

    /// Hands on what is left.
    pub(crate) fn finish(mut self) -> Result<(), DeckError> {
        self.flush()?;
        match self.target {
            Target::Writer { out, .. } => Ok(out.flush()?),
            Target::Counter { .. } => Ok(()),
        }
    }

    fn flush(&mut self) -> Result<(), DeckError> {
        let buffer = std::mem::take(&mut self.buffer);
        let result = self.emit(&buffer);
        self.buffer = buffer;
        self.buffer.clear();
        result
    }

    fn emit(&mut self, text: &[u8]) -> Result<(), DeckError> {
        self.written += text.len() as u64;
        match &mut self.target {
            Target::Writer { out, progress } => {
                if !text.is_empty() {
                    out.write_all(text)?;
                }
                if progress(self.written) { Ok(()) } else { Err(DeckError::Cancelled) }
            }
            Target::Counter { cancelled } => {
                if cancelled() {
                    Err(DeckError::Cancelled)
                } else {
                    Ok(())
                }
            }
        }
    }
}

/// Ranges of rows of about [`PIECE`] lines each.
fn pieces(block: &dyn Rows) -> impl Iterator<Item = Range<usize>> {
    let rows = block.rows();
    let mut start = 0;
    std::iter::from_fn(move || {
        let (mut end, mut weight) = (start, 0);
        while end < rows && weight < PIECE {
            weight += block.weight(end);
            end += 1;
        }
        let piece = start..end;
        start = end;
        (!piece.is_empty()).then_some(piece)
    })
}

/// Size of a block, bytes, from rows of the middle group of evenly spread strata.
fn estimate(block: &dyn Rows, cancelled: Cancelled<'_>) -> Result<u64, DeckError> {
    let group = block.group().max(1);
    let groups = block.rows() / group;
    let stride = (group / SAMPLED_ROWS).max(1);
    let mut out = Vec::new();
    let mut bytes = 0.0;
    for stratum in 0..SAMPLES {
        let (from, to) = (groups * stratum / SAMPLES, groups * (stratum + 1) / SAMPLES);
        if from == to {
            continue;
        }
        if cancelled() {
            return Err(DeckError::Cancelled);
        }
        let middle = usize::midpoint(from, to);
        let (mut sampled, mut weight) = (0, 0);
        for row in (middle * group..(middle + 1) * group).step_by(stride) {
            out.clear();
            block.render(row..row + 1, &mut out);
            sampled += out.len();
            weight += block.weight(row);
        }
        let all: usize = (from * group..to * group).map(|r| block.weight(r)).sum();
        bytes += sampled as f64 * all as f64 / weight.max(1) as f64;
    }
    Ok(bytes.ceil() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row `i` is the number `i`, repeated.
    struct Numbers;

    impl Rows for Numbers {
        fn rows(&self) -> usize {
            20_000
        }
        fn group(&self) -> usize {
            10
        }
        fn weight(&self, row: usize) -> usize {
            row % 7
        }
        fn render(&self, rows: Range<usize>, out: &mut Vec<u8>) {
            for row in rows {
                (0..self.weight(row)).for_each(|_| out.extend_from_slice(format!("{row}\n").as_bytes()));
            }
        }
    }

    #[test]
    fn pieces_arrive_in_order_and_their_size_is_foreseen() {
        let mut expected = b"before\n".to_vec();
        Numbers.render(0..Numbers.rows(), &mut expected);
        expected.extend_from_slice(b"after\n");
        let fill = |sink: &mut Sink<'_>| {
            sink.line("before").unwrap();
            sink.rows(&Numbers).unwrap();
            sink.line("after").unwrap();
        };
        let mut out = Vec::new();
        let mut sink = Sink::new(&mut out, &crate::progress::ignore);
        fill(&mut sink);
        assert_eq!(sink.written(), expected.len() as u64);
        sink.finish().unwrap();
        assert!(out == expected);
        let mut counter = Sink::counting(&crate::progress::never);
        fill(&mut counter);
        assert!((counter.written() as f64 / expected.len() as f64 - 1.0).abs() < 0.02);
    }

    #[test]
    fn it_works_on_the_only_thread_of_a_pool() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let out = pool.install(|| {
            let mut out = Vec::new();
            let mut sink = Sink::new(&mut out, &crate::progress::ignore);
            sink.rows(&Numbers).unwrap();
            sink.finish().unwrap();
            out
        });
        assert!(out.ends_with(b"19998\n"));
    }

    #[test]
    fn lists_have_sixteen_numbers_a_line() {
        let mut out = Vec::new();
        let mut sink = Sink::new(&mut out, &crate::progress::ignore);
        sink.list(1..=33).unwrap();
        sink.finish().unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text.lines().map(|l| l.split(',').count()).collect::<Vec<_>>(), [16, 16, 1]);
    }
}
