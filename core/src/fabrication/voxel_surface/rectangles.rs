//! Greedy merging of unit squares in one plane into rectangles.

/// Unit squares of one plane, `wide` by `high`.
#[derive(Debug, Clone, Default)]
pub struct Squares {
    /// Squares along `u`.
    pub wide: usize,
    /// Squares along `w`.
    pub high: usize,
    /// At `u + w wide`: 1 and -1 for a face whose outward normal points up or down the axis, 0 for none.
    pub faces: Vec<i8>,
    /// Whether faces may be merged across the edges that end at a lattice point; at `u + w (wide + 1)`.
    pub free: Vec<bool>,
}

/// A rectangle of equal squares, in lattice points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    /// First and last lattice point along `u`.
    pub u: [usize; 2],
    /// First and last lattice point along `w`.
    pub w: [usize; 2],
    /// 1 where the outward normal points up the axis, else -1.
    pub sign: i8,
}

impl Squares {
    fn is_free(&self, u: usize, w: usize) -> bool {
        self.free[u + w * (self.wide + 1)]
    }

    /// Takes all squares away as rectangles: each grows along `u` first, then along `w`. No lattice point that is not free
    /// lies within a rectangle or within one of its sides.
    pub fn take(&mut self, mut rectangle: impl FnMut(Rectangle)) {
        for w in 0..self.high {
            let mut u = 0;
            while u < self.wide {
                let sign = self.faces[u + w * self.wide];
                if sign == 0 {
                    u += 1;
                    continue;
                }
                let mut end = u + 1;
                while end < self.wide
                    && self.faces[end + w * self.wide] == sign
                    && self.is_free(end, w)
                    && self.is_free(end, w + 1)
                {
                    end += 1;
                }
                let mut top = w + 1;
                while top < self.high && self.continues(u, end, top, sign) {
                    top += 1;
                }
                for row in w..top {
                    self.faces[row * self.wide + u..row * self.wide + end].fill(0);
                }
                rectangle(Rectangle { u: [u, end], w: [w, top], sign });
                u = end;
            }
        }
    }

    fn continues(&self, u: usize, end: usize, row: usize, sign: i8) -> bool {
        self.faces[row * self.wide + u..row * self.wide + end].iter().all(|f| *f == sign)
            && (u..=end).all(|k| self.is_free(k, row))
            && (u + 1..end).all(|k| self.is_free(k, row + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(rows: &[&str], blocked: &[(usize, usize)]) -> Squares {
        let (wide, high) = (rows[0].len(), rows.len());
        let sign = |c: char| [0, 1, -1]["-+#".find(c).unwrap()];
        let mut free = vec![true; (wide + 1) * (high + 1)];
        blocked.iter().for_each(|(u, w)| free[u + w * (wide + 1)] = false);
        Squares { wide, high, faces: rows.iter().flat_map(|r| r.chars().map(sign)).collect(), free }
    }

    fn taken(mut squares: Squares) -> Vec<([usize; 2], [usize; 2], i8)> {
        let mut found = Vec::new();
        squares.take(|r| found.push((r.u, r.w, r.sign)));
        assert!(squares.faces.iter().all(|f| *f == 0));
        found
    }

    #[test]
    fn equal_squares_merge_along_rows_first() {
        let found = taken(squares(&["++#", "++#", "-+#"], &[]));
        assert_eq!(found, [([0, 2], [0, 2], 1), ([2, 3], [0, 3], -1), ([1, 2], [2, 3], 1)]);
    }

    #[test]
    fn nothing_merges_across_edges_that_end_at_a_blocked_point() {
        assert_eq!(taken(squares(&["++", "++"], &[(1, 1)])).len(), 4);
        assert_eq!(taken(squares(&["++", "++"], &[(0, 1)])).len(), 2);
        assert_eq!(taken(squares(&["++", "++"], &[(1, 0)])), [([0, 1], [0, 2], 1), ([1, 2], [0, 2], 1)]);
        assert_eq!(taken(squares(&["++", "++"], &[(0, 0), (2, 2)])), [([0, 2], [0, 2], 1)]);
    }
}
