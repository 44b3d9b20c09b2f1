"""USD stages that usd-core writes and evaluates: what is read of them, in which frames, and what is said of the rest."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid

pxr = pytest.importorskip("pxr", reason="usd-core is not installed; pip install 'pliant[usd]'")
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt  # noqa: E402

FACES, FLAT = grid(8)
#: Two triangles that cross.
CROSS = (np.array([[0, 0, -1], [0, 0, 1], [0, 1, 0], [-1, 0.25, 0], [1, 0.25, 0], [0, 0.25, 1]], np.float32), [3, 3], range(6))


def mesh(stage: Any, path: str, points: Any = None, counts: Any = None, corners: Any = None) -> Any:
    """A mesh of polygons; the sheet, if nothing is said."""
    prim = UsdGeom.Mesh.Define(stage, path)
    prim.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.asarray(FLAT if points is None else points, np.float32)))
    prim.CreateFaceVertexCountsAttr(Vt.IntArray([3] * len(FACES) if counts is None else list(counts)))
    prim.CreateFaceVertexIndicesAttr(Vt.IntArray(FACES.ravel().tolist() if corners is None else list(corners)))
    prim.CreateSubdivisionSchemeAttr("none")
    return prim


@pytest.fixture
def stage(tmp_path: Path) -> Any:
    return Usd.Stage.CreateNew(str(tmp_path / "walk.usda"))


def saved(stage: Any) -> str:
    stage.Save()
    path: str = stage.GetRootLayer().realPath
    return path


def silent(*paths: Any, **settings: Any) -> pliant.Check:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return pliant.check(*paths, **settings)


@pytest.mark.parametrize("ending", ["usd", "usda", "usdc", "usdz"])
def test_a_sequence_has_the_pairs_of_its_shapes(tmp_path: Path, ending: str) -> None:
    from pxr import UsdUtils

    path = str(tmp_path / f"walk.{ending if ending != 'usdz' else 'usdc'}")
    stage = Usd.Stage.CreateNew(path)
    shapes = {time: fold(FLAT, 0.3 * time).astype(np.float32) for time in (1.0, 2.5, 4.0)}
    sheet = mesh(stage, "/scene/sheet")
    for time, shape in shapes.items():
        sheet.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(shape), time)
    stage.Save()
    if ending == "usdz":
        assert UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(path), str(tmp_path / "walk.usdz"))
        path = str(tmp_path / "walk.usdz")
    checked = silent(path)
    assert [(body.name, body.vertices, body.triangles) for body in checked.bodies] == [(f"{path}#/scene/sheet", 81, 128)]
    frames = list(checked)
    for frame, shape in zip(frames, shapes.values(), strict=True):
        np.testing.assert_array_equal(frame.pairs[:, [1, 3]], pliant.reference.self_intersection_pairs(shape.astype(float), FACES))
    assert frames[-1].count > 0
    # In any order, and again after what is left out.
    (last,) = silent(path, frames=range(2, 3), baseline=0)
    assert last.left_out == 0 and last.count == frames[2].count


def test_transforms_are_evaluated_and_what_stands_still_has_one_frame(stage: Any) -> None:
    mesh(stage, "/still")
    moved = mesh(stage, "/scene/group/moved", *CROSS)
    UsdGeom.Xform.Define(stage, "/scene").AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
    group = UsdGeom.Xform.Define(stage, "/scene/group")
    lift = group.AddTranslateOp()
    group.AddRotateZOp().Set(90.0)
    for time, height in ((0.0, 3.0), (10.0, 0.0)):
        lift.Set(Gf.Vec3d(0, 0, height), time)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(10)
    moved.AddTranslateOp().Set(Gf.Vec3d(0.25, 0, 0), 5.0)
    path = saved(stage)
    frames = list(silent(path))
    assert len(frames) == 3
    for frame, height in zip(frames, (3.0, 1.5, 0.0)):
        x, y, z = (CROSS[0].astype(float) + [0.25, 0, 0]).T
        positions = 2 * np.stack([-y, x, z + height], axis=1)
        triangles = np.arange(6).reshape(2, 3)
        expected = pliant.reference.intersection_pairs(FLAT.astype(np.float32).astype(float), FACES, positions, triangles)
        # A quarter turn is rounded; none of these pairs is close.
        assert {tuple(pair) for pair in frame.pairs[:, [1, 3]].tolist()} == {tuple(pair) for pair in expected.tolist()}
    # Those outside the range are no frames.
    stage.SetEndTimeCode(5)
    assert silent(saved(stage)).frame_count == 2


def test_a_static_stage_beside_other_files(stage: Any, tmp_path: Path) -> None:
    mesh(stage, "/shirt")
    mesh(stage, "/skin")
    path = saved(stage)
    np.savez(tmp_path / "moves.npz", vertices=np.stack([FLAT + [0, 0, 1], FLAT]).astype(np.float32), faces=FACES)
    checked = silent(tmp_path / "moves.npz", path, groups={"usd": [path]}, ignore=[("usd", "usd")])
    assert [body.name for body in checked.bodies] == [str(tmp_path / "moves.npz"), f"{path}#/shirt", f"{path}#/skin"]
    assert [frame.count > 0 for frame in checked] == [False, True]
    assert [frame.count > 0 for frame in silent(path)] == [True]
    # One of them alone.
    alone = silent(f"{path}#/skin", itself=True)
    assert [body.name for body in alone.bodies] == [f"{path}#/skin"] and [frame.count for frame in alone] == [0]


def test_polygons_are_triangulated_as_in_other_files(stage: Any) -> None:
    # A dart that bends inward at corner 3: a fan round corner 0 would leave it.
    dart = [(0, 0, 0), (4, -2, 0), (0, 4, 0), (1, 0.5, 0)]
    mesh(stage, "/dart", dart, [4], range(4))
    needle = [(0.25, 0.75, -1), (0.25, 0.75, 1), (0.25, 0.75, 1)]
    mesh(stage, "/needle", needle, [3], range(3))
    checked = silent(saved(stage))
    assert checked.bodies[0].triangles == 2 and checked.bodies[0].faces is not None
    assert checked.bodies[0].faces.tolist() == [0, 0]
    positions, faces = np.array(dart, float), np.array([[0, 1, 3], [1, 2, 3]])
    expected = len(pliant.reference.intersection_pairs(positions, faces, np.array(needle, float), np.array([[0, 1, 2]])))
    (frame,) = checked
    assert frame.count == expected


def test_only_what_is_seen_is_read(stage: Any) -> None:
    mesh(stage, "/seen")
    mesh(stage, "/hidden").MakeInvisible()
    for purpose in ("render", "proxy", "guide"):
        mesh(stage, f"/{purpose}").CreatePurposeAttr(purpose)
    mesh(stage, "/off").GetPrim().SetActive(False)
    mesh(stage, "/library/sheet")
    stage.OverridePrim("/library").SetSpecifier(Sdf.SpecifierClass)
    for name in ("one", "two"):
        instance = UsdGeom.Xform.Define(stage, f"/{name}").GetPrim()
        instance.GetReferences().AddInternalReference("/library")
        instance.SetInstanceable(True)
    path = saved(stage)
    names = [body.name.removeprefix(path) for body in silent(path).bodies]
    assert names == ["#/seen", "#/render", "#/one/sheet", "#/two/sheet"]
    assert [body.name.removeprefix(path) for body in silent(f"{path}#/two").bodies] == ["#/two/sheet"]


def test_what_is_not_evaluated_is_said(stage: Any) -> None:
    mesh(stage, "/smooth").GetSubdivisionSchemeAttr().Set("catmullClark")
    skinned = mesh(stage, "/skinned")
    UsdSkel.BindingAPI.Apply(skinned.GetPrim()).CreateJointIndicesPrimvar(False, 1).Set(Vt.IntArray([0] * len(FLAT)))
    mesh(stage, "/flickers").GetVisibilityAttr().Set("invisible", 1.0)
    mesh(stage, "/nothing", [], [], [])
    moving = mesh(stage, "/moving")
    for time in (0.0, 1.0):
        moving.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(FLAT.astype(np.float32)), time)
    stage.GetPrimAtPath("/flickers").GetAttribute("visibility").Set("inherited", 0.0)
    UsdGeom.Sphere.Define(stage, "/ball")
    with pytest.warns(UserWarning) as said:
        checked = pliant.check(saved(stage))
    assert len(checked.bodies) == 4
    texts = " ".join(str(warning.message) for warning in said)
    for what in ("skinning", "/skinned", "subdivision", "/smooth", "/flickers) are hidden", "/nothing) have no faces", "/ball) are no meshes"):
        assert what in texts, what
    assert {warning.filename for warning in said} == {__file__}


def test_what_cannot_be_read_names_the_prim(stage: Any, tmp_path: Path) -> None:
    sheet = mesh(stage, "/scene/sheet")
    for time, count in ((0.0, 81), (1.0, 80)):
        sheet.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(FLAT[:count].astype(np.float32)), time)
    checked = pliant.check(saved(stage))
    next(checked)
    with pytest.raises(pliant.Error, match=r"prim /scene/sheet, time code 1: 80 points, 81 at first") as refused:
        next(checked)
    assert refused.value.kind == "CannotRead"
    sheet.GetPointsAttr().Clear()
    sheet.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(FLAT.astype(np.float32)))
    for time, faces in ((0.0, FACES), (1.0, FACES[::-1])):
        sheet.GetFaceVertexIndicesAttr().Set(Vt.IntArray(faces.ravel().tolist()), time)
    with pytest.raises(pliant.Error, match="/scene/sheet, time code 1: other faces"):
        list(pliant.check(saved(stage)))
    with pytest.raises(pliant.Error, match="no prim /scene/shirt"):
        pliant.check(saved(stage) + "#/scene/shirt")
    for corners in ([0, 1, 99], [0, 1], [0, 1, 2, 3], [0, 1, -1]):
        wrong = Usd.Stage.CreateInMemory()
        mesh(wrong, "/wrong", FLAT, [3], corners)
        wrong.Export(str(tmp_path / "wrong.usda"))
        with pytest.raises(pliant.Error, match="wrong.usda"):
            pliant.check(tmp_path / "wrong.usda")
    Usd.Stage.CreateInMemory().Export(str(tmp_path / "empty.usda"))
    (tmp_path / "text.usdc").write_text("no USD")
    for name, what in (("empty.usda", "no mesh"), ("text.usdc", "cannot be read"), ("absent.usd", "no such file"), ("w*.usd", "no pattern")):
        with pytest.raises(pliant.Error, match=what):
            pliant.check(tmp_path / name)


def test_ctrl_c_in_the_middle_of_a_frame_is_what_it_is(stage: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from pliant import _usd

    mesh(stage, "/sheet")
    path = saved(stage)

    def interrupted(self: Any, frame: int) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr(_usd.Mesh, "positions", interrupted)
    with pytest.raises(KeyboardInterrupt):
        pliant.check(path)
