"""USD stages, evaluated by usd-core: the visible meshes, in world space, at their time samples.

Imported only when a USD file is checked. usd-core evaluates references, payloads, selected
variants, instances, transforms, and points between two samples. Skinning and subdivision are not
evaluated; a warning says so.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._types import Error

#: Stack level of the line that called pliant.check: Rust has no frames of Python.
_CALLER = 3


#: What to do about a mesh that USD changes and pliant does not read.
_INSTEAD = "export it as a file a frame, such as frame_*.obj"


def _refused(file: str, what: str) -> Error:
    return Error(f"{file}: {what}", kind="CannotRead", file=file)


class Mesh:
    """A mesh of a stage, evaluated frame by frame."""

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
            what = "a number of its faces is negative; mend it, or export it again"
            raise _refused(self._file, f"prim {self._mesh.GetPath()}: {what}")
        return counts.astype(np.uint32), corners.astype(np.uint32)

    def positions(self, frame: int) -> NDArray[np.float64]:
        """Positions of its points in world space, (n, 3) float64."""
        code = self._codes[frame]
        points = self._points(code)
        where = f"prim {self._mesh.GetPath()}"
        if not code.IsDefault():
            where += f", time code {code.GetValue():g}"
        if len(points) != self._vertices:
            what = (
                f"{len(points)} points, {self._vertices} at first; meshes whose number of points"
                f" changes are not read: {_INSTEAD}"
            )
            raise _refused(self._file, f"{where}: {what}")
        attributes = (self._mesh.GetFaceVertexCountsAttr(), self._mesh.GetFaceVertexIndicesAttr())
        if frame > 0 and any(attribute.ValueMightBeTimeVarying() for attribute in attributes):
            counts, corners = self._faces(code)
            if not (np.array_equal(counts, self.counts) and np.array_equal(corners, self.corners)):
                what = "other faces than at first; meshes whose faces change are not read"
                what = f"{what}: {_INSTEAD}"
                raise _refused(self._file, f"{where}: {what}")
        prim = self._mesh.GetPrim()
        matrix = np.array(self._geom.XformCache(code).GetLocalToWorldTransform(prim))
        # Rows, as USD has them; one product after the other, so that every machine rounds alike.
        moved: NDArray[np.float64] = matrix[3, :3] + points[:, :1] * matrix[0, :3]
        moved = moved + points[:, 1:2] * matrix[1, :3]
        moved = moved + points[:, 2:] * matrix[2, :3]
        return moved


def _stage(file: str, usd: Any, tf: Any) -> Any:
    if not Path(file).is_file():
        what = "there is no such file; frames of USD are in one stage, so no pattern can be given"
        raise _refused(file, what)
    try:
        stage = usd.Stage.Open(file)
    except tf.ErrorException as error:
        why = " ".join(str(error).split())[:300]
        raise _refused(file, f"cannot be read as USD: {why}; mend it, or export it again") from None
    if stage is None:
        raise _refused(file, "cannot be read as USD; mend it, or export it again")
    return stage


def _ancestors(prim: Any) -> list[Any]:
    """The prim and its ancestors, from below."""
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
    """Gives one warning for all prims that it is about."""
    if prims:
        noun = "prim" if len(prims) == 1 else "prims"
        some = f"{len(prims)} {noun} (the first: {prims[0].GetPath()})"
        warnings.warn(f"{argument}: {what.format(some)}", UserWarning, stacklevel=_CALLER)


def opened(argument: str) -> tuple[str, list[Mesh]]:
    """The file that an argument names, and its visible meshes, at or below the prim behind a #."""
    file, part = argument, ""
    if "#" in argument and not Path(argument).exists():
        file, _, part = argument.rpartition("#")
    try:
        from pxr import (  # type: ignore[import-not-found, import-untyped, unused-ignore]
            Sdf,
            Tf,
            Usd,
            UsdGeom,
            UsdSkel,
        )
    except ImportError:
        what = "USD is read by usd-core, which is not installed; pip install 'pliant[usd]'"
        raise _refused(file, what) from None
    stage = _stage(file, Usd, Tf)
    if part and not (Sdf.Path.IsValidPathString(part) and stage.GetPrimAtPath(part)):
        raise _refused(file, f"there is no prim {part}; prims have paths as /scene/shirt")

    drawn = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    everything = list(stage.Traverse(Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)))
    seen: list[Any] = []
    others: list[Any] = []
    for prim in everything:
        if part and not prim.GetPath().HasPrefix(Sdf.Path(part)):
            continue
        if prim.IsA(UsdGeom.Gprim) and UsdGeom.Imageable(prim).ComputePurpose() in drawn:
            (seen if prim.IsA(UsdGeom.Mesh) else others).append(prim)

    first, last = -np.inf, np.inf
    if stage.HasAuthoredTimeCodeRange():
        first, last = stage.GetStartTimeCode(), stage.GetEndTimeCode()

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
        chain = (above for above in _ancestors(prim) if above.IsA(UsdGeom.Imageable))
        visibilities = (UsdGeom.Imageable(above).GetVisibilityAttr() for above in chain)
        if not any(visibility.ValueMightBeTimeVarying() for visibility in visibilities):
            codes = codes[:1]
        return [imageable.ComputeVisibility(code) != UsdGeom.Tokens.invisible for code in codes]

    moves = {prim.GetPath(): samples(prim) for prim in seen}
    # Frames are numbered as in the whole stage, also where one prim alone is asked for.
    all_meshes = (prim for prim in everything if prim.IsA(UsdGeom.Mesh))
    of_all = moves.values() if not part else (samples(prim) for prim in all_meshes)
    of_stage: set[float] = set().union(*of_all)
    times = sorted(time for time in of_stage if first <= time <= last)
    still = [Usd.TimeCode.Default()]
    if of_stage:
        still = [Usd.TimeCode(first if np.isfinite(first) else 0.0)]
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
    skinned = [prim for prim in prims if _is_skinned(prim, UsdSkel)]
    what = "skinning and blend shapes are not evaluated; {} stand as they were modelled"
    _say(argument, what, skinned)
    schemes = [UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr().Get() for prim in prims]
    smooth = [prim for prim, scheme in zip(prims, schemes) if scheme != UsdGeom.Tokens.none]
    _say(argument, "subdivision is not applied; of {} the control mesh is checked", smooth)
    _say(argument, "{} are hidden in some frames and checked in all", flicker)
    _say(argument, "{} have no faces and are left out", empty)
    _say(argument, "{} are no meshes and are left out", others)
    if not meshes:
        what = "holds no mesh that is seen; one is visible, and of purpose default or render"
        raise _refused(file, what)
    return file, [mesh for _, mesh in meshes]
