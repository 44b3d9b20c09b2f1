"""Searches a sequence of shapes for self-intersections.

    python human_morph.py human-morph.npz

The file has `vertices` (T, n, 3) and `faces` (m, 3), as human-body data and many captures have. Prints the frames in which the
surface meets itself, and where most.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pliant


def search(path: Path) -> list[int]:
    """How many pairs of triangles intersect, frame by frame."""
    with np.load(path) as arrays:
        frames, faces = arrays["vertices"], arrays["faces"]
    world = pliant.World()
    body = world.add(faces, frames[0])
    itself = world.intersections(pliant.Selection.within(body))
    counts = []
    for positions in frames:
        world.set_positions(body, positions)
        counts.append(len(itself.all()))
    return counts


def main(path: Path) -> None:
    counts = search(path)
    for frame, count in enumerate(counts):
        print(f"{frame:>8}{count:>10}")
    intersecting = sum(count > 0 for count in counts)
    print(f"\n{intersecting} of {len(counts)} frames intersect; most pairs: {max(counts):,} in frame {np.argmax(counts)}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python human_morph.py FILE.npz, which has vertices (T, n, 3) and faces (m, 3)")
    main(Path(sys.argv[1]))
