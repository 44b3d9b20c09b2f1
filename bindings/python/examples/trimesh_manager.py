"""A replacement for trimesh's FCL collision manager, for meshes that also change their shape.

The calls of `trimesh.collision.CollisionManager` that say what is in collision, with the same names and arguments. Different:
`set_vertices` gives an object a new shape; contacts are pairs of triangles, all of them, exactly decided (FCL stops at 100,000
contacts, in floating point); there are no contact points, depths or distances.

    python trimesh_manager.py

drops a ball that changes its shape through another.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pliant
import trimesh
from numpy.typing import NDArray


#: The name of a mesh that is not in the manager.
EXTERNAL = "__external"


@dataclass(frozen=True)
class Contact:
    """Two triangles that intersect."""

    names: tuple[str, str]
    faces: tuple[int, int]

    def index(self, name: str) -> int:
        """The triangle of the object of that name, as `trimesh.collision.ContactData.index`."""
        return self.faces[self.names.index(name)]


class CollisionManager:
    """Objects by name, each a mesh and a transformation."""

    def __init__(self) -> None:
        self._world = pliant.World()
        self._bodies: dict[str, int] = {}
        self._names: dict[int, str] = {}
        #: Vertices before their transformation, and the transformation.
        self._shapes: dict[str, NDArray[np.float64]] = {}
        self._transforms: dict[str, NDArray[np.float64]] = {}

    def add_object(self, name: str, mesh: Any, transform: NDArray[np.float64] | None = None) -> None:
        if name in self._bodies:
            self.remove_object(name)
        shape = np.asarray(mesh.vertices, np.float64)
        matrix = np.eye(4) if transform is None else np.asarray(transform, np.float64)
        body = self._world.add(mesh.faces, trimesh.transform_points(shape, matrix))
        self._bodies[name], self._names[body] = body, name
        self._shapes[name], self._transforms[name] = shape, matrix

    def remove_object(self, name: str) -> None:
        body = self._bodies.pop(name)
        del self._names[body], self._shapes[name], self._transforms[name]
        self._world.remove(body)

    def set_transform(self, name: str, transform: NDArray[np.float64]) -> None:
        self._transforms[name] = np.asarray(transform, np.float64)
        self._move(name)

    def set_vertices(self, name: str, vertices: NDArray[np.float64]) -> None:
        """Gives an object a new shape; FCL has no such call in Python."""
        self._shapes[name] = np.asarray(vertices, np.float64)
        self._move(name)

    def _move(self, name: str) -> None:
        self._world.set_positions(self._bodies[name], trimesh.transform_points(self._shapes[name], self._transforms[name]))

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Whether any two objects intersect; with the pairs of names, and all contacts, if asked for."""
        if not return_names and not return_data:
            return self._world.intersections().first() is not None
        hits = self._world.intersections().all().tolist()
        contacts = [Contact((self._names[a], self._names[b]), (i, j)) for a, i, b, j in hits]
        names = {(min(contact.names), max(contact.names)) for contact in contacts}
        return answer(contacts, names, return_names, return_data)

    def in_collision_single(
        self, mesh: Any, transform: NDArray[np.float64] | None = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether a mesh that is not in the manager intersects any object in it; in contacts its name is `__external`."""
        self.add_object(EXTERNAL, mesh, transform)
        single = self._bodies[EXTERNAL]
        contacts = [
            Contact((name, EXTERNAL), (i, j))
            for name, body in self._bodies.items()
            if body != single
            for _, i, _, j in self._world.intersections(pliant.Selection.between(body, single)).all().tolist()
        ]
        self.remove_object(EXTERNAL)
        return answer(contacts, {contact.names[0] for contact in contacts}, return_names, return_data)


def answer(contacts: list[Contact], names: set[Any], return_names: bool, return_data: bool) -> Any:
    """A bool, or a tuple of it and what was asked for, as trimesh answers."""
    parts = [bool(contacts)] + [names] * return_names + [contacts] * return_data
    return tuple(parts) if len(parts) > 1 else parts[0]


def main() -> None:
    ball = trimesh.creation.icosphere(subdivisions=4)
    manager = CollisionManager()
    manager.add_object("standing", ball)
    manager.add_object("falling", ball, trimesh.transformations.translation_matrix([0, 0, 3]))
    for step in range(7):
        squeeze = 1 - 0.1 * step
        manager.set_vertices("falling", ball.vertices * [1 / squeeze, 1 / squeeze, squeeze])
        manager.set_transform("falling", trimesh.transformations.translation_matrix([0, 0, 3 - 0.5 * step]))
        _, names, contacts = manager.in_collision_internal(return_names=True, return_data=True)
        print(f"step {step}: {len(contacts)} pairs of triangles", *sorted(names))


if __name__ == "__main__":
    main()
