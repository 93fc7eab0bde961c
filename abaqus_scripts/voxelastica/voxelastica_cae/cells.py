"""Which cells of the partitioned strip belong to which phase, with few questions to CAE.

A question to CAE is slow, so cells are not looked up one by one. Two ways, whichever asks less:

- *planes*: every cell lies in one slice, one layer and one column of voxels. One `getByBoundingBox` for each of these
  gives the indices of its cells; three indices name the voxel. A strip of n slices, m layers and w columns asks
  n + m + w times, whatever its pattern.
- *runs*: equal voxels beside each other, merged over columns, layers and slices, are one box and one `getByBoundingBox`.
  Regular patterns have few of them, random ones almost as many as voxels.
"""

from __future__ import division


def rows(design):
    """Rows of equal voxels across the width: a dict from (slice, layer) to [(phase, first, end)] with columns counted
    from the strip's axis."""
    found = {}
    for i, half in enumerate(design.half_widths):
        for layer in range(design.layers):
            phases = [design.phase_of(i, layer, j) for j in range(2 * half)]
            row, first = [], 0
            for j in range(1, 2 * half + 1):
                if j == 2 * half or phases[j] != phases[first]:
                    row.append((phases[first], first - half, j - half))
                    first = j
            found[i, layer] = row
    return found


def runs(design):
    """Boxes of equal voxels that fill the strip: [(phase, (slice, end), (layer, end), (column, end))].

    Rows that agree in neighbouring layers become one, then those that agree in neighbouring slices.
    """
    row, sheets = rows(design), []
    for i in range(design.slices):
        open_, sheet = {}, []
        for layer in range(design.layers + 1):
            here = set(row[i, layer]) if layer < design.layers else set()
            for run in [run for run in open_ if run not in here]:
                sheet.append((run, (open_.pop(run), layer)))
            for run in here:
                open_.setdefault(run, layer)
        sheets.append(set(sheet))
    boxes, open_ = [], {}
    for i in range(design.slices + 1):
        here = sheets[i] if i < design.slices else set()
        for run in [run for run in open_ if run not in here]:
            (phase, first, end), layers = run
            boxes.append((phase, (open_.pop(run), i), layers, (first, end)))
        for run in here:
            open_.setdefault(run, i)
    return sorted(boxes)


def planes(design):
    """Number of questions of the way by planes."""
    return design.slices + design.layers + 2 * max(design.half_widths)


def mask(indices):
    """The mask that picks the objects of these indices, as CAE's getSequenceFromMask takes it.

    Words of 32 bits in hexadecimal, the lowest index in the lowest bit of the first; `:n` repeats a word.
    """
    words = {}
    for index in indices:
        words[index // 32] = words.get(index // 32, 0) | (1 << (index % 32))
    parts, word, count = [], None, 0
    for at in range(max(words) + 2 if words else 0):
        here = words.get(at, 0) if at <= max(words) else None
        if here == word:
            count += 1
            continue
        if word is not None:
            parts.append("#%x" % word + (":%d" % count if count > 1 else ""))
        word, count = here, 1
    return ("[%s ]" % " ".join(parts),)
