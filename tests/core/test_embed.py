# SPDX-License-Identifier: GPL-3.0-or-later
"""embed() on meshes that the tests make themselves, in all three geometries, with the independent judge."""

import json

import numpy as np
import pytest
from meshes import CHECK_LAYOUT, agrees, cube, far_apart, icosphere, judge, octahedron, tetrahedron, uv_area

import core

SIGNATURES = ["442", "333", "632", "2222", "432", "532", "332", "22(5)", "33", "22", "237", "22222", "2" * 10]
REPORT = {
    "mesh": ["vertices", "triangles", "components", "euler", "boundary_loops", "genus", "orientable"],
    "orbifold": ["signature", "geometry", "euler", "cones", "moduli", "modulus"],
    "solver": ["iterations", "energy", "relative_gradient", "clamped_weights", "factor_nonzeros"],
    "certificate": ["flipped", "flipped_float32", "seam_residual", "angle_residual", "area_residual", "bijective"],
    "distortion": [
        *["quasi_conformal_mean", "quasi_conformal_median", "quasi_conformal_max", "log_area_std"],
        "symmetric_dirichlet",
    ],
    "seconds": ["topology", "cut", "tile", "initial", "assemble", "analyze", "factor", "solve", "certify", "total"],
}


def embedded(signature, level=3, **options):
    vertices, triangles = icosphere(level)
    cones = far_apart(vertices, triangles, len(core.parse_signature(signature).orders))
    return core.embed(vertices, triangles, signature, cones, **options)


@pytest.mark.skipif(not CHECK_LAYOUT.is_file(), reason="../shared/tools/check_layout.py is not there")
def test_judge_is_there():
    assert judge("no such file")["ok"] is False


@pytest.mark.parametrize("signature", SIGNATURES)
def test_signature_is_embedded_and_certified(signature, tmp_path):
    result = embedded(signature)
    agrees(result, tmp_path)
    n, m, k = len(result.vertices), len(result.triangles), len(result.cones)
    assert result.geometry == core.geometry_of(signature)
    assert np.array_equal(result.cut_to_vertex[result.cut_triangles], result.triangles)
    assert np.array_equal(result.cut_to_vertex[:n], np.arange(n))
    assert result.embedding.shape == result.embedding_low.shape == (len(result.cut_to_vertex), 3)
    assert result.weights.shape == (n + m - 2, 3) and (result.weights[:, 2] > 0).all()
    assert result.seams.ndim == 2 and result.seams.shape[1] == 2 and len(result.seams) >= k - 1
    assert result.uv.shape == (m, 3, 2) and result.uv.dtype == np.float64


@pytest.mark.parametrize("signature", ["442", "432", "237"])
@pytest.mark.parametrize("weights", ["cotan", "mean-value", "uniform"])
def test_weights(signature, weights, tmp_path):
    agrees(embedded(signature, weights=weights), tmp_path)


@pytest.mark.parametrize("signature", ["333", "532", "22222"])
def test_given_weights_are_used(signature):
    by_name = embedded(signature)
    rows = by_name.weights[::-1].copy()
    rows[::2, :2] = rows[::2, 1::-1]  # in any sequence, either way round
    given = embedded(signature, weights=rows)
    assert given.report["solver"]["energy"] == pytest.approx(by_name.report["solver"]["energy"], rel=1e-12)
    assert np.abs(given.embedding - by_name.embedding).max() < 1e-9


@pytest.mark.parametrize("mesh", [cube, tetrahedron, octahedron], ids=["cube", "tetrahedron", "octahedron"])
@pytest.mark.parametrize("signature", ["442", "2222", "332", "237", "2223"])
def test_coarse_meshes(mesh, signature, tmp_path):
    vertices, triangles = mesh()
    cones = range(len(core.parse_signature(signature).orders))
    agrees(core.embed(vertices, triangles, signature, list(cones)), tmp_path)


@pytest.mark.parametrize("mesh, cones", [(cube, [0, 7]), (octahedron, [0, 1])], ids=["cube", "octahedron"])
def test_two_cones_on_coarse_meshes(mesh, cones, tmp_path):
    agrees(core.embed(*mesh(), "33", cones), tmp_path)


@pytest.mark.parametrize("mesh, cones", [(cube, [0, 1]), (tetrahedron, [0, 1])], ids=["cube", "tetrahedron"])
def test_two_cones_that_are_neighbours_are_refused(mesh, cones):
    """The edge between them would join antipodes: no triangle on it can be embedded."""
    with pytest.raises(core.OrbifoldError):
        core.embed(*mesh(), "33", cones)


def test_orders_may_be_picked_in_another_sequence():
    vertices, triangles = icosphere(3)
    cones = far_apart(vertices, triangles, 3)
    plain = core.embed(vertices, triangles, "632", cones)
    turned = core.embed(vertices, triangles, "632", cones[[2, 0, 1]], orders=[2, 6, 3])
    assert turned.orders.tolist() == [2, 6, 3] and turned.cones.tolist() == cones[[2, 0, 1]].tolist()
    triangle_areas = [np.abs(uv_area(r.uv_chart("conformal"))) for r in (plain, turned)]
    shares = [areas / areas.sum() for areas in triangle_areas]
    assert np.abs(shares[0] - shares[1]).max() < 1e-9
    first = core.embed(vertices, triangles, "236", cones[[2, 1, 0]])
    assert first.report["solver"]["iterations"] == plain.report["solver"]["iterations"]


def test_euclid_converges_in_one_step():
    for signature in ("442", "333", "632", "2222"):
        assert embedded(signature).report["solver"]["iterations"] == 1


@pytest.mark.parametrize("signature", ["442", "432", "237"])
def test_report_is_complete_and_json(signature):
    result = embedded(signature)
    report = json.loads(json.dumps(result.report))
    assert report == result.report
    assert {key: list(part) for key, part in report.items()} == REPORT
    n, m = len(result.vertices), len(result.triangles)
    assert report["mesh"] == {
        **{"vertices": n, "triangles": m, "components": 1},
        **{"euler": 2, "boundary_loops": 0, "genus": 0, "orientable": True},
    }
    info = core.parse_signature(signature)
    assert report["orbifold"]["geometry"] == info.geometry
    assert report["orbifold"]["euler"] == pytest.approx(info.euler)
    assert report["orbifold"]["cones"] == [
        {"vertex": int(v), "order": n, "mirror": False} for v, n in zip(result.cones, info.orders)
    ]
    assert report["certificate"]["bijective"] is True
    assert report["solver"]["energy"] > 0 and report["solver"]["relative_gradient"] < 1e-7
    assert report["solver"]["factor_nonzeros"] >= n - 3
    distortion = report["distortion"]
    assert 1 <= distortion["quasi_conformal_median"] <= distortion["quasi_conformal_max"]
    assert 1 <= distortion["quasi_conformal_mean"] <= distortion["quasi_conformal_max"]
    assert distortion["symmetric_dirichlet"] >= 1 and distortion["log_area_std"] > 0
    seconds = report["seconds"]
    assert all(s >= 0 for s in seconds.values())
    assert sum(seconds.values()) - seconds["total"] <= seconds["total"] + 1e-3


@pytest.mark.parametrize("signature", ["442", "2222", "332", "22222"])
def test_charts(signature):
    result = embedded(signature)
    names = core.CHARTS[result.geometry]
    assert result.chart == names[0]
    assert np.array_equal(result.uv, result.uv_chart(names[0]))
    assert np.array_equal(result.uv, result.uv_chart("default"))
    for name in names:
        uv = result.uv_chart(name)
        assert np.isfinite(uv).all()
        if name not in ("equirectangular", "octahedral"):  # these wrap around
            assert (uv_area(uv) > 0).all() and result.flipped_float32(name) == 0
    others = {name for all_of_it in core.CHARTS.values() for name in all_of_it} - set(names)
    for name in {*others, "mercator"}:
        with pytest.raises(core.OrbifoldError) as caught:
            result.uv_chart(name)
        assert caught.value.status == "ORB_BAD_ARGUMENT"


def test_chart_of_uv_can_be_chosen():
    result = embedded("632", chart="conformal")
    assert result.chart == "conformal" and np.array_equal(result.uv, result.uv_chart("conformal"))
    assert not np.allclose(result.uv, result.uv_chart("periodic"))


@pytest.mark.parametrize("signature", ["432", "532", "332", "22(5)", "222", "33", "22"])
def test_whole_sphere(signature):
    result = embedded(signature)
    points = result.whole_sphere()
    assert points.shape == result.vertices.shape
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 1e-12
    a, b, c = (points[result.triangles[:, corner]] for corner in range(3))
    assert (np.einsum("ij,ij->i", a, np.cross(b, c)) > 0).all()


@pytest.mark.parametrize("signature", ["442", "237"])
def test_whole_sphere_is_for_spherical_orbifolds(signature):
    with pytest.raises(core.OrbifoldError) as caught:
        embedded(signature).whole_sphere()
    assert caught.value.status == "ORB_BAD_ARGUMENT"


def test_save_writes_the_arrays_of_the_judge_only(tmp_path):
    for signature in ("442", "532", "2" * 10):
        result = embedded(signature)
        result.save(tmp_path / "a.npz")
        with np.load(tmp_path / "a.npz", allow_pickle=False) as saved:
            names = {"vertices", "triangles", "cut_triangles", "cut_to_vertex", "embedding", "geometry"}
            names |= {"signature", "cones", "orders", "weights"}
            names |= {"embedding_low"} if result.embedding_low.any() else set()
            assert set(saved) == names
            assert str(saved["signature"]) == result.signature and str(saved["geometry"]) == result.geometry
            for name in names - {"signature", "geometry"}:
                assert np.array_equal(saved[name], getattr(result, name))
        assert [file.name for file in tmp_path.iterdir()] == ["a.npz"]


def test_save_that_fails_leaves_nothing(tmp_path):
    result = embedded("442", level=1)
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "file").touch()
    with pytest.raises(OSError):
        result.save(tmp_path / "there")
    assert [file.name for file in tmp_path.iterdir()] == ["there"]


def test_arrays_are_copies_that_outlive_the_embedding():
    vertices, triangles = icosphere(2)
    cones = far_apart(vertices, triangles, 3)
    result = core.embed(vertices, triangles, "237", cones)
    vertices[:] = np.nan
    assert np.isfinite(result.vertices).all()
    arrays = {name: value for name, value in vars(result).items() if isinstance(value, np.ndarray)}
    assert all(array.flags.owndata and array.flags.writeable for array in arrays.values())
    before = {name: array.copy() for name, array in arrays.items()}
    del result
    core.embed(*icosphere(2), "442", cones)
    assert all(np.array_equal(before[name], array) for name, array in arrays.items())


def test_memory_is_returned():
    """Embedding again and again does not grow the process."""
    resource = pytest.importorskip("resource")
    vertices, triangles = icosphere(4)
    cones = far_apart(vertices, triangles, 3)

    def run(times):
        for _ in range(times):
            core.embed(vertices, triangles, "442", cones)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024

    first = run(5)
    per_result = core.embed(vertices, triangles, "442", cones).embedding.nbytes * 3
    assert run(40) - first < 15 * per_result


@pytest.mark.parametrize("kind", [np.int32, np.int64, np.uint32, np.uint64, np.int16])
def test_integer_types(kind):
    vertices, triangles = icosphere(1)
    result = core.embed(vertices.astype(np.float32), np.asfortranarray(triangles.astype(kind)), "442", (0, 1, 2))
    assert np.array_equal(result.triangles, triangles)
