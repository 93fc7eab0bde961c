//! The order in which unknowns are eliminated: nested dissection of the strip.
//!
//! A plane of nodes across the strip, or a row of nodes along it, separates the strip into two parts that no element
//! couples. Each part is numbered first and the separator last, and the parts are cut again, so that fill arises in
//! separators only (George 1973). Of the two ways to cut, the one with the smaller separator is taken: across a long strip
//! at first, then along its halves.

use super::mesh::{Column, Mesh};

/// Columns up to which a part is not cut any more.
const SMALLEST_PART: usize = 2;

/// Nodes between the two end planes in the order of their elimination.
#[must_use]
pub fn nested_dissection(mesh: &Mesh) -> Vec<u32> {
    let last = mesh.plane_count().saturating_sub(1);
    let mut columns: Vec<Column> = (1..last).flat_map(|plane| mesh.columns(plane)).collect();
    let mut order = Vec::with_capacity(columns.len() * mesh.levels);
    dissect(&mut columns, mesh.levels, &mut order);
    order
}

fn dissect(columns: &mut [Column], levels: usize, order: &mut Vec<u32>) {
    if columns.len() <= SMALLEST_PART {
        return number(columns, levels, order);
    }
    let plane = |c: &Column| c.plane as i64;
    let row = |c: &Column| c.across;
    let [(middle_plane, in_plane), (middle_row, in_row)] = [median(columns, plane), median(columns, row)];
    let (before, between, after) =
        if in_plane <= in_row { split(columns, middle_plane, plane) } else { split(columns, middle_row, row) };
    dissect(before, levels, order);
    dissect(after, levels, order);
    number(between, levels, order);
}

/// The middle value of a coordinate and how many columns have it.
fn median(columns: &mut [Column], coordinate: impl Fn(&Column) -> i64) -> (i64, usize) {
    let middle = columns.len() / 2;
    let (_, column, _) = columns.select_nth_unstable_by_key(middle, &coordinate);
    let value = coordinate(column);
    (value, columns.iter().filter(|c| coordinate(c) == value).count())
}

/// Columns below, at and above a value of a coordinate.
fn split(
    columns: &mut [Column],
    value: i64,
    coordinate: impl Fn(&Column) -> i64,
) -> (&mut [Column], &mut [Column], &mut [Column]) {
    columns.sort_unstable_by_key(|c| (coordinate(c), c.plane, c.across));
    let first = columns.partition_point(|c| coordinate(c) < value);
    let last = columns.partition_point(|c| coordinate(c) <= value);
    let (before, rest) = columns.split_at_mut(first);
    let (between, after) = rest.split_at_mut(last - first);
    (before, between, after)
}

fn number(columns: &mut [Column], levels: usize, order: &mut Vec<u32>) {
    columns.sort_unstable_by_key(|c| (c.plane, c.across));
    for column in columns {
        order.extend((0..levels).map(|level| (column.lowest + level * column.step) as u32));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Block, Spacing};

    #[test]
    fn every_inner_node_is_numbered_once_and_the_first_separator_last() {
        let block = Block::new(12.0, 2.0, 2, vec![6, 6, 6, 4, 4, 4, 4, 4, 2, 2, 2, 2], Spacing::Even(1.0));
        let mesh = Mesh::new(&block);
        let order = nested_dissection(&mesh);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        let inner = mesh.planes[1] as u32..mesh.planes[12] as u32;
        assert_eq!(sorted, inner.collect::<Vec<_>>());
        // The last numbers are a plane or a row: nodes on either side of it are never in one element.
        let last = &order[order.len() - 15..];
        let x = mesh.nodes[last[0] as usize][0];
        assert!(last.iter().all(|n| mesh.nodes[*n as usize][0] == x), "{last:?}");
    }
}
