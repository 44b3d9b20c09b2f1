"""Intersections by brute force, to compare with: every pair of triangles, by exact signs.

No tree, no box, no filter. Slow and obviously right: every configuration of a World must give
these pairs. Cost: O(m^2) for m triangles.
"""

from ._pliant import reference_intersection_pairs as intersection_pairs
from ._pliant import reference_self_intersection_pairs as self_intersection_pairs

__all__ = ["intersection_pairs", "self_intersection_pairs"]
