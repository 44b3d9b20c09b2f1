"""Slow and obviously right: every pair of triangles, no tree, no box, no filter, exact signs.

Every configuration of a world must give these pairs.
"""

from ._pliant import reference_intersection_pairs as intersection_pairs
from ._pliant import reference_self_intersection_pairs as self_intersection_pairs

__all__ = ["intersection_pairs", "self_intersection_pairs"]
