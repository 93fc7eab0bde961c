//! A tiny evaluator for the part of Python's grammar that an expression may use, strict where Python would be lenient.

/// Value of `text` with `X = x`.
///
/// Refuses integer literals, two signs in a row, unknown names and anything after the expression.
pub fn evaluate(text: &str, x: f64) -> Result<f64, String> {
    let mut parser = Parser { rest: text, x };
    let value = parser.sum()?;
    if parser.rest.is_empty() { Ok(value) } else { Err(format!("left over: {}", parser.rest)) }
}

struct Parser<'a> {
    rest: &'a str,
    x: f64,
}

impl Parser<'_> {
    fn take(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn require(&mut self, token: &str) -> Result<(), String> {
        if self.take(token) { Ok(()) } else { Err(format!("expected {token} at {}", self.rest)) }
    }

    fn sum(&mut self) -> Result<f64, String> {
        let negative = self.take("-");
        let mut value = self.product()?;
        if negative {
            value = -value;
        }
        loop {
            if self.take("+") {
                value += self.product()?;
            } else if self.take("-") {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result<f64, String> {
        let mut value = self.factor()?;
        loop {
            if self.take("*") {
                value *= self.factor()?;
            } else if self.take("/") {
                value /= self.factor()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn factor(&mut self) -> Result<f64, String> {
        if self.take("exp(") {
            let value = self.sum()?.exp();
            self.require(")")?;
            return Ok(value);
        }
        if self.take("pow(") {
            let base = self.sum()?;
            self.require(",")?;
            let power = self.sum()?;
            self.require(")")?;
            return Ok(base.powf(power));
        }
        if self.take("(") {
            let value = self.sum()?;
            self.require(")")?;
            return Ok(value);
        }
        if self.take("X") {
            return Ok(self.x);
        }
        self.number()
    }

    fn number(&mut self) -> Result<f64, String> {
        let digits = |text: &str| text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let whole = digits(self.rest);
        if whole == 0 || self.rest.as_bytes().get(whole) != Some(&b'.') {
            return Err(format!("no float literal at {}", self.rest));
        }
        let mut end = whole + 1 + digits(&self.rest[whole + 1..]);
        if end == whole + 1 {
            return Err(format!("no digit after the point at {}", self.rest));
        }
        if let Some(exponent) = self.rest[end..].strip_prefix('e') {
            let sign = usize::from(exponent.starts_with('-'));
            end += 1 + sign + digits(&exponent[sign..]);
        }
        let (literal, rest) = self.rest.split_at(end);
        self.rest = rest;
        literal.parse().map_err(|e| format!("{literal}: {e}"))
    }
}
