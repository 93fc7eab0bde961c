//! `*AMPLITUDE`.

use crate::deck::DeckError;
use crate::deck::number::real;
use crate::deck::schedule::Motion;
use crate::deck::sink::Sink;

/// Writes the amplitude of every motion that moves, in step time, four points a line.
pub(crate) fn amplitudes<'a>(sink: &mut Sink<'_>, motions: impl Iterator<Item = &'a Motion>) -> Result<(), DeckError> {
    for motion in motions.filter(|m| m.moves()) {
        sink.line(&format!("*AMPLITUDE, NAME={}", motion.amplitude))?;
        for points in motion.course.chunks(4) {
            let points: Vec<String> = points.iter().map(|[t, v]| format!("{},{}", real(*t), real(*v))).collect();
            sink.line(&points.join(","))?;
        }
    }
    Ok(())
}
