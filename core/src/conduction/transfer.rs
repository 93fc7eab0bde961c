//! Interpolation between two levels of nodes, and its transpose.

use super::galerkin::Step;
use super::operator::for_rows;

/// Two coarse nodes and their weights; the second weight may be zero.
type Parents = [(usize, f64); 2];

/// Fine nodes and their weights, up to three of them.
type Children = [(usize, f64); 3];

/// Linear interpolation direction by direction.
#[derive(Debug)]
pub(super) struct Transfer {
    fine: [usize; 3],
    coarse: [usize; 3],
    parents: [Vec<Parents>; 3],
    children: [Vec<Children>; 3],
}

impl Transfer {
    pub(super) fn new(fine: [usize; 3], coarse: [usize; 3], steps: [Step; 3]) -> Self {
        let parents = |d: usize| -> Vec<Parents> {
            (0..fine[d])
                .map(|f| match steps[d] {
                    Step::Keep => [(f, 1.0), (f, 0.0)],
                    Step::Collapse => [(0, 1.0), (0, 0.0)],
                    Step::Halve if f % 2 == 0 => [(f / 2, 1.0), (f / 2, 0.0)],
                    Step::Halve => [(f / 2, 0.5), (f / 2 + 1, 0.5)],
                })
                .collect()
        };
        let children = |d: usize| -> Vec<Children> {
            (0..coarse[d])
                .map(|c| match steps[d] {
                    Step::Keep => [(c, 1.0), (c, 0.0), (c, 0.0)],
                    Step::Collapse => [(0, 1.0), (1, 1.0), (0, 0.0)],
                    Step::Halve => {
                        let inside = |f: usize, weight: f64| if f < fine[d] { (f, weight) } else { (0, 0.0) };
                        let before = (2 * c).checked_sub(1).map_or((0, 0.0), |f| inside(f, 0.5));
                        [before, inside(2 * c, 1.0), inside(2 * c + 1, 0.5)]
                    }
                })
                .collect()
        };
        Self {
            fine,
            coarse,
            parents: [parents(0), parents(1), parents(2)],
            children: [children(0), children(1), children(2)],
        }
    }

    /// `out = P^T fine`.
    pub(super) fn restrict(&self, fine: &[f64], out: &mut [f64]) {
        let across = self.fine[2];
        for_rows(out, self.coarse[2], |line, row| {
            row.fill(0.0);
            let (plane, level) = (line / self.coarse[1], line % self.coarse[1]);
            for (p, wp) in self.children[0][plane].iter().filter(|c| c.1 != 0.0) {
                for (l, wl) in self.children[1][level].iter().filter(|c| c.1 != 0.0) {
                    let source = &fine[(p * self.fine[1] + l) * across..(p * self.fine[1] + l + 1) * across];
                    let weight = wp * wl;
                    for (o, c) in row.iter_mut().zip(&self.children[2]) {
                        *o += weight * (c[0].1 * source[c[0].0] + c[1].1 * source[c[1].0] + c[2].1 * source[c[2].0]);
                    }
                }
            }
        });
    }

    /// `out += P coarse` where `active` is not zero.
    pub(super) fn prolong(&self, coarse: &[f64], active: &[f64], out: &mut [f64]) {
        let across = self.coarse[2];
        for_rows(out, self.fine[2], |line, row| {
            let (plane, level) = (line / self.fine[1], line % self.fine[1]);
            let active = &active[line * row.len()..(line + 1) * row.len()];
            for (p, wp) in self.parents[0][plane].iter().filter(|c| c.1 != 0.0) {
                for (l, wl) in self.parents[1][level].iter().filter(|c| c.1 != 0.0) {
                    let source = &coarse[(p * self.coarse[1] + l) * across..(p * self.coarse[1] + l + 1) * across];
                    let weight = wp * wl;
                    for ((o, c), on) in row.iter_mut().zip(&self.parents[2]).zip(active) {
                        if *on != 0.0 {
                            *o += weight * (c[0].1 * source[c[0].0] + c[1].1 * source[c[1].0]);
                        }
                    }
                }
            }
        });
    }
}
