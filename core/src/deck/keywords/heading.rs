//! `*HEADING` and the comments that explain a deck.

use crate::deck::DeckError;
use crate::deck::sink::Sink;
use crate::output::Provenance;

/// Longest comment line.
const WIDTH: usize = 100;

/// Writes the title and a block of comments, one paragraph an entry.
pub(crate) fn heading(
    sink: &mut Sink<'_>,
    name: &str,
    model: &str,
    provenance: &Provenance,
    paragraphs: &[String],
) -> Result<(), DeckError> {
    sink.line("*HEADING")?;
    // A title is not a comment: it must not begin with an asterisk, and solvers keep about 80 characters of it.
    let title: String = format!("Voxelastica: {model} of {}", ascii(name)).chars().take(80).collect();
    sink.line(&title)?;
    sink.line(&format!("** {}", ascii(&provenance.line())))?;
    comment(sink, &format!("Design: {}", ascii(name)))?;
    comment(sink, "Units: mm, N, MPa, tonne, s, K")?;
    paragraphs.iter().try_for_each(|paragraph| comment(sink, paragraph))
}

/// A comment, wrapped between words.
pub(crate) fn comment(sink: &mut Sink<'_>, text: &str) -> Result<(), DeckError> {
    let mut line = String::from("**");
    for word in ascii(text).split_whitespace() {
        if line.len() > 2 && line.len() + 1 + word.len() > WIDTH {
            sink.line(&line)?;
            line.truncate(2);
        }
        line.push(' ');
        line.push_str(word);
        line.truncate(250);
    }
    sink.line(&line)
}

/// Seven-bit text: accents are dropped, umlauts written out, what is left becomes `?`.
pub(crate) fn ascii(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            ' '..='~' => out.push(c),
            'ä' | 'æ' => out.push_str("ae"),
            'ö' | 'œ' => out.push_str("oe"),
            'ü' => out.push_str("ue"),
            'Ä' | 'Æ' => out.push_str("Ae"),
            'Ö' | 'Œ' => out.push_str("Oe"),
            'Ü' => out.push_str("Ue"),
            'ß' => out.push_str("ss"),
            'à'..='å' => out.push('a'),
            'À'..='Å' => out.push('A'),
            'ç' => out.push('c'),
            'Ç' => out.push('C'),
            'è'..='ë' => out.push('e'),
            'È'..='Ë' => out.push('E'),
            'ì'..='ï' => out.push('i'),
            'Ì'..='Ï' => out.push('I'),
            'ñ' => out.push('n'),
            'Ñ' => out.push('N'),
            'ò'..='õ' | 'ø' => out.push('o'),
            'Ò'..='Õ' | 'Ø' => out.push('O'),
            'ù'..='û' => out.push('u'),
            'Ù'..='Û' => out.push('U'),
            'ý' | 'ÿ' => out.push('y'),
            'µ' | 'μ' => out.push('u'),
            '–' | '—' => out.push('-'),
            _ => out.push('?'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_seven_bit() {
        assert_eq!(ascii("Kuppel für Zoë – 漏斗"), "Kuppel fuer Zoe - ??");
    }

    #[test]
    fn comments_are_wrapped() {
        let mut out = Vec::new();
        let mut sink = Sink::new(&mut out, &|_| true);
        comment(&mut sink, &"word ".repeat(60)).unwrap();
        comment(&mut sink, &"w".repeat(400)).unwrap();
        sink.finish().unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.lines().all(|l| l.starts_with("** w") && l.len() <= 256), "{text}");
        assert_eq!(text.matches("word").count(), 60);
    }
}
