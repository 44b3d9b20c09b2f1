"""USD stages, evaluated by usd-core: the meshes that are seen, in world space, at the times at which something about them is written.

Imported only when a USD file is checked. What usd-core evaluates is taken as it is: references, payloads, variants as they are
selected, instances, transforms, and points between two of their samples. Skinning and subdivision are not evaluated, and said to be.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._types import Error

#: Deep enough to name the line that called pliant.check, below which Rust has no frames of Python's.
_CALLER = 3


def _refused(file: str, what: str) -> Error:
    return Error(f"{file}: {what}", kind="CannotRead", file=file)


class Mesh:
    """A mesh of a stage."""

    def __init__(self, name: str, file: str, prim: Any, geom: Any, codes: list[Any]) -> None:
        self.name = name
        self._stage = prim.GetStage()  # which would be closed if nobody had it
        self._file, self._geom, self._mesh, self._codes = file, geom, geom.Mesh(prim), codes
        self.counts, self.corners = self._faces(codes[0])
        self._vertices = len(self._points(codes[0]))

    @property
    def frame_count(self) -> int:
        return len(self._codes)

    def _points(self, code: Any) -> NDArray[np.float64]:
        points = self._mesh.GetPointsAttr().Get(code)
        return np.array([] if points is None else points, np.float64).reshape(-1, 3)

    def _faces(self, code: Any) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        attributes = (self._mesh.GetFaceVertexCountsAttr(), self._mesh.GetFaceVertexIndicesAttr())
        values = (attribute.Get(code) for attribute in attributes)
        counts, corners = (np.array([] if value is None else value, np.int64) for value in values)
        if (counts < 0).any() or (corners < 0).any():
            raise _refused(self._file, f"prim {self._mesh.GetPath()}: a number of its faces is negative")
        return counts.astype(np.uint32), corners.astype(np.uint32)

    def positions(self, frame: int) -> NDArray[np.float64]:
        """Where its points are in the world."""
        code = self._codes[frame]
        points = self._points(code)
        where = f"prim {self._mesh.GetPath()}, time code {code.GetValue():g}" if not code.IsDefault() else f"prim {self._mesh.GetPath()}"
        if len(points) != self._vertices:
            what = f"{len(points)} points, {self._vertices} at first; meshes whose number of points changes are not read"
            raise _refused(self._file, f"{where}: {what}")
        attributes = (self._mesh.GetFaceVertexCountsAttr(), self._mesh.GetFaceVertexIndicesAttr())
        if frame > 0 and any(attribute.ValueMightBeTimeVarying() for attribute in attributes):
            counts, corners = self._faces(code)
            if not (np.array_equal(counts, self.counts) and np.array_equal(corners, self.corners)):
                raise _refused(self._file, f"{where}: other faces than at first; meshes whose faces change are not read")
        matrix = np.array(self._geom.XformCache(code).GetLocalToWorldTransform(self._mesh.GetPrim()))
        # Rows, as USD has them; one product after the other, so that every machine rounds alike.
        moved: NDArray[np.float64] = matrix[3, :3] + points[:, :1] * matrix[0, :3] + points[:, 1:2] * matrix[1, :3] + points[:, 2:] * matrix[2, :3]
        return moved


def _stage(file: str, usd: Any, tf: Any) -> Any:
    if not Path(file).is_file():
        raise _refused(file, "there is no such file; a pattern cannot be given, the frames of USD are in one stage")
    try:
        stage = usd.Stage.Open(file)
    except tf.ErrorException as error:
        raise _refused(file, "cannot be read as USD: " + " ".join(str(error).split())[:300]) from None
    if stage is None:
        raise _refused(file, "cannot be read as USD")
    return stage


def _ancestors(prim: Any) -> list[Any]:
    """The prim and those above it."""
    chain = []
    while prim and not prim.IsPseudoRoot():
        chain.append(prim)
        prim = prim.GetParent()
    return chain


def _is_skinned(prim: Any, skel: Any) -> bool:
    binding = skel.BindingAPI(prim)
    written = (binding.GetJointIndicesAttr(), binding.GetBlendShapesAttr())
    return any(attribute and attribute.HasAuthoredValue() for attribute in written)


def _say(argument: str, what: str, prims: list[Any]) -> None:
    """Something that is no error, once for all prims that it is about."""
    if prims:
        some = f"{len(prims)} {'prim' if len(prims) == 1 else 'prims'} (the first: {prims[0].GetPath()})"
        warnings.warn(f"{argument}: {what.format(some)}", UserWarning, stacklevel=_CALLER)


def opened(argument: str) -> tuple[str, list[Mesh]]:
    """The file that an argument names, and its meshes that are seen; or those of them at or below a prim of it, behind a #."""
    file, _, part = argument.rpartition("#") if "#" in argument and not Path(argument).exists() else (argument, "", "")
    try:
        from pxr import Sdf, Tf, Usd, UsdGeom, UsdSkel  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError:
        raise _refused(file, "USD is read by usd-core, which is not installed; pip install 'pliant[usd]'") from None
    stage = _stage(file, Usd, Tf)
    if part and not (Sdf.Path.IsValidPathString(part) and stage.GetPrimAtPath(part)):
        raise _refused(file, f"there is no prim {part}; prims have paths as /scene/shirt")

    everything = list(stage.Traverse(Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)))
    seen: list[Any] = []
    others: list[Any] = []
    for prim in everything:
        if part and not prim.GetPath().HasPrefix(Sdf.Path(part)):
            continue
        if prim.IsA(UsdGeom.Gprim) and UsdGeom.Imageable(prim).ComputePurpose() in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render):
            (seen if prim.IsA(UsdGeom.Mesh) else others).append(prim)

    first, last = (stage.GetStartTimeCode(), stage.GetEndTimeCode()) if stage.HasAuthoredTimeCodeRange() else (-np.inf, np.inf)

    def samples(prim: Any) -> set[float]:
        mesh = UsdGeom.Mesh(prim)
        times = set(mesh.GetPointsAttr().GetTimeSamples())
        for attribute in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()):
            times.update(attribute.GetTimeSamples())
        for above in _ancestors(prim):
            if above.IsA(UsdGeom.Xformable):
                times.update(UsdGeom.Xformable(above).GetTimeSamples())
        return times

    def is_seen(prim: Any, codes: list[Any]) -> list[bool]:
        imageable = UsdGeom.Imageable(prim)
        if not any(UsdGeom.Imageable(above).GetVisibilityAttr().ValueMightBeTimeVarying() for above in _ancestors(prim) if above.IsA(UsdGeom.Imageable)):
            codes = codes[:1]
        return [imageable.ComputeVisibility(code) != UsdGeom.Tokens.invisible for code in codes]

    moves = {prim.GetPath(): samples(prim) for prim in seen}
    # All that moves has the same frames, also where one prim alone is asked for: the numbers of frames are those of the stage.
    of_all = moves.values() if not part else (samples(prim) for prim in everything if prim.IsA(UsdGeom.Mesh))
    of_stage: set[float] = set().union(*of_all)
    times = sorted(time for time in of_stage if first <= time <= last)
    still = [Usd.TimeCode(first if np.isfinite(first) else 0.0)] if of_stage else [Usd.TimeCode.Default()]
    moving = [Usd.TimeCode(time) for time in times] or still

    meshes: list[tuple[Any, Mesh]] = []
    flicker: list[Any] = []
    empty: list[Any] = []
    for prim in seen:
        codes = moving if moves[prim.GetPath()] else moving[:1]
        visible = is_seen(prim, moving)
        if not any(visible):
            continue
        if not all(visible):
            flicker.append(prim)
        mesh = Mesh(f"{file}#{prim.GetPath()}", file, prim, UsdGeom, codes)
        if len(mesh.counts) > 0:
            meshes.append((prim, mesh))
        else:
            empty.append(prim)
    others = [prim for prim in others if any(is_seen(prim, moving))]
    prims = [prim for prim, _ in meshes]
    _say(argument, "skinning and blend shapes are not evaluated; {} stand as they were modelled", [prim for prim in prims if _is_skinned(prim, UsdSkel)])
    smooth = [prim for prim in prims if UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.none]
    _say(argument, "subdivision is not applied; of {} the control mesh is checked", smooth)
    _say(argument, "{} are hidden in some frames and checked in all", flicker)
    _say(argument, "{} have no faces and are left out", empty)
    _say(argument, "{} are no meshes and are left out", others)
    if not meshes:
        raise _refused(file, "holds no mesh that is seen")
    return file, [mesh for _, mesh in meshes]
