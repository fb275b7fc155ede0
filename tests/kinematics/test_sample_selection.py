"""Samples of results by the value of a drive: what `sel(OA="60 deg")` gives, and what alignment leaves alone."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.sample_index import SampleIndex, with_drive_coordinates

DEGREE = math.pi / 180
ROCKER = ct.example("crank-rocker")
MOTION = ct.motion(ROCKER)
EPS = float(np.finfo(float).eps)
"""A sample every degree."""


def variables(data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Variables along the samples, without the numbers that differ by rounding alone."""
    return {str(n): v for n, v in data.data_vars.items() if n not in ("status", "residual")}


@pytest.mark.parametrize("degrees", [1, 60, 97, 359])
def test_a_sample_is_the_motion_at_its_value(degrees: int) -> None:
    """To the rounding of the value, which a coefficient multiplies, and of the closed forms."""
    taken = MOTION.sel(OA=f"{degrees} deg")
    exact = ct.motion(ROCKER, at=[f"{degrees} deg"]).isel(sample=0)
    assert taken.sizes == exact.sizes
    for name, values in variables(exact).items():
        if "sample" in MOTION[name].dims:
            scale = float(np.abs(MOTION[name]).max()) if MOTION[name].size else 0.0
            assert np.allclose(taken[name], values, rtol=0, atol=2000 * EPS * scale), name
    assert math.isclose(float(taken.OA), degrees * DEGREE, rel_tol=4 * EPS)


def test_numbers_are_radians_and_texts_are_read() -> None:
    for label in (math.pi / 3, "60 deg", "60°", "1/6 turn", f"{math.pi / 3!r} rad", np.float64(math.pi / 3)):
        assert MOTION.sel(OA=label).identical(MOTION.isel(sample=60)), label
    assert MOTION.angle.sel(OA="60 deg", link="AB").identical(MOTION.angle.sel(link="AB").isel(sample=60))


def test_what_is_between_samples() -> None:
    """Its nearest sample is off by the coefficient times half a step at most, by the mean value theorem."""
    with pytest.raises(ct.InputError) as refused:
        MOTION.sel(OA="60.3 deg")
    assert refused.value.where == "OA" and 'method="nearest"' in refused.value.repair
    near = MOTION.sel(OA="60.3 deg", method="nearest")
    assert near.identical(MOTION.isel(sample=60))
    exact = ct.motion(ROCKER, at=["60.3 deg"]).isel(sample=0)
    stretch = ct.motion(ROCKER, 101, "60 deg", "60.3 deg")
    bound = float(np.abs(stretch.velocity_coefficient).max()) * 0.3 * DEGREE
    assert float(np.abs(near.position - exact.position).max()) <= bound * (1 + 1e-6)
    assert MOTION.sel(OA="60.3 deg", method="pad").identical(MOTION.isel(sample=60))
    assert MOTION.sel(OA="60.3 deg", method="bfill").identical(MOTION.isel(sample=61))
    assert MOTION.sel(OA="60.3 deg", method="nearest", tolerance="0.4 deg").identical(MOTION.isel(sample=60))


@pytest.mark.parametrize(
    ("label", "method", "tolerance"),
    [
        ("60", None, None),
        ("60 mm", None, None),
        ("sixty", None, None),
        (None, None, None),
        (7.0, None, None),
        (math.nan, "nearest", None),
        ("60.3 deg", "nearest", "0.1 deg"),
        ("60 deg", "nearby", None),
        ("-10 deg", "pad", None),
    ],
)
def test_refusals(label: object, method: str | None, tolerance: str | None) -> None:
    if method == "nearby":
        label = "60.5 deg"
    with pytest.raises(ct.InputError) as refused:
        MOTION.sel(OA=label, method=method, tolerance=tolerance)
    assert refused.value.what and refused.value.repair


def test_slices_and_lists() -> None:
    part = MOTION.sel(OA=slice("10 deg", "60 deg"))
    assert part.identical(MOTION.isel(sample=slice(10, 61)))
    assert part.sel(OA="20 deg").identical(MOTION.isel(sample=20))
    assert MOTION.sel(OA=slice(None, "60 deg")).sizes["sample"] == 61
    assert MOTION.sel(OA=slice("300 deg", None)).sizes["sample"] == 61
    assert (
        MOTION.sel(OA=slice("0 deg", "60 deg", 30)).OA.values.tolist()
        == MOTION.OA.values[[0, 30, 60]].tolist()
    )
    backwards = ct.motion(ROCKER, 61, "60 deg", "0 deg")
    assert backwards.sel(OA=slice("20 deg", "10 deg")).identical(backwards.isel(sample=slice(40, 51)))
    assert backwards.sel(OA=slice(None, "50 deg")).identical(backwards.isel(sample=slice(0, 11)))
    chosen = MOTION.sel(OA=["60 deg", 0.0, "1/4 turn"])
    assert chosen.OA.values.tolist() == MOTION.OA.values[[60, 0, 90]].tolist()
    pointwise = MOTION.angle.sel(OA=xr.DataArray([60 * DEGREE, 0.0], dims="case", coords={"case": [1, 2]}))
    assert pointwise.dims == ("case", "link") and pointwise.case.values.tolist() == [1, 2]


def test_many_turns_and_values_that_come_again() -> None:
    turns = ct.motion(ROCKER, 721, 0.0, 4 * math.pi)
    assert turns.sel(OA="420 deg").identical(turns.isel(sample=420))
    feed = ct.motion("cam-driven-linkage")  # it dwells, and swings back
    rest = feed.sel(lever=0.0)
    assert rest.sizes["sample"] == int((np.abs(feed.lever) < 1e-15).sum()) > 1
    assert set(rest.lever.values.tolist()) == {0.0}


def test_several_drives() -> None:
    arm = ct.motion("two-link-arm", 11)
    first, second = arm.drive.values.tolist()
    label = {first: float(arm[first][4])}
    assert arm.sel(label).identical(arm.isel(sample=4))
    both = arm.sel({**label, second: float(arm[second][4])})
    assert both.identical(arm.isel(sample=slice(4, 5)))
    # by both no sample stands between
    with pytest.raises(ct.InputError):
        arm.sel({**label, second: float(arm[second][4])}, method="nearest")


@pytest.mark.parametrize(
    "compute",
    [
        lambda: ct.reactions("six-bar-press", 37),
        lambda: ct.reduce("six-bar-press", 37),
        lambda: ct.shaking("six-bar-press", 37),
        lambda: ct.transmission_angles("six-bar-press", 37),
        lambda: ct.instant_centres(ct.motion("six-bar-press", 37)),
        lambda: ct.integrate("crank-rocker", steps=36),
        lambda: ct.motion("six-bar-press", 37, vary={"links.OA.length": [0.24, 0.25]}),
    ],
)
def test_results_of_topics(compute: object) -> None:
    assert callable(compute)
    data = compute()
    taken = data.sel(OA=f"{math.degrees(float(data.OA[3]))!r} deg")
    assert "sample" not in taken.dims and taken.OA == data.OA[3] == data.drive_value[..., 3, 0]
    assert taken.identical(data.isel(sample=3))


def test_angles_of_cams() -> None:
    cam = ct.cam("cam-from-curvature", 7)
    angle = float(cam.carrier_angle[2])
    assert cam.sel(carrier_angle=angle).identical(cam.isel(sample=2))


def test_files_leave_the_coordinate_out_and_open_gives_it_back(tmp_path: Path) -> None:
    angles = ct.transmission_angles(ROCKER, 37)
    ct.write(angles, tmp_path / "angles")
    path = tmp_path / "angles" / "transmission.nc"
    assert "OA" not in xr.load_dataset(path, engine="scipy", decode_times=False).variables
    again = ct.open(path)
    assert again.sel(OA="30 deg").transmission_angle.equals(angles.sel(OA="30 deg").transmission_angle)
    MOTION.drop_dims(["guide", "event"]).to_netcdf(
        tmp_path / "own.nc", engine="scipy"
    )  # by xarray itself it is a coordinate as any other
    own = xr.load_dataset(tmp_path / "own.nc", engine="scipy", decode_times=False)
    assert with_drive_coordinates(own).sel(OA="60 deg").identical(own.isel(sample=60))


def test_samples_go_together_by_their_order() -> None:
    """What an index does not do: no join by values, no sample lost."""
    forth, back = ct.motion(ROCKER, 37), ct.motion(ROCKER, 37, 2 * math.pi, 0.0)
    difference = forth.position - back.position
    assert np.array_equal(difference, forth.position.values - back.position.values)
    same = float(forth.OA[18])
    assert np.isnan(np.delete(difference.OA.values, 18)).all() and difference.OA.values[18] == same
    assert forth.assign(back=back.angle).back.values.tolist() == back.angle.values.tolist()
    assert (forth.angle + forth.angle).OA.identical(forth.OA)
    plain = xr.DataArray(np.arange(37.0), dims="sample")
    assert (forth.angle * plain).sizes["sample"] == 37
    with pytest.raises(ValueError, match="sample"):
        forth.angle + MOTION.angle
    with pytest.raises(ValueError, match="sample"):
        forth.angle + plain[:5]


def test_what_keeps_the_index() -> None:
    part = MOTION.isel(sample=slice(0, 10))
    again = xr.concat([part, MOTION.isel(sample=slice(10, None))], "sample", data_vars="minimal")
    assert again.sel(OA="60 deg").angle.identical(MOTION.sel(OA="60 deg").angle)
    assert MOTION.rename(OA="crank").sel(crank="60 deg").angle.variable.equals(MOTION.angle[60].variable)
    assert pickle.loads(pickle.dumps(MOTION)).sel(OA="60 deg").identical(MOTION.isel(sample=60))
    assert MOTION.copy(deep=True).sel(OA="60 deg").identical(MOTION.isel(sample=60))
    assert MOTION.roll(sample=1, roll_coords=True).sel(OA="60 deg").angle.equals(MOTION.angle[60])
    assert MOTION.indexes["OA"].size == 361 and len(MOTION.angle.to_dataframe()) == 361 * 3
    assert isinstance(MOTION.isel(sample=[3, 5]).xindexes["OA"], SampleIndex)
    assert "OA" not in MOTION.isel(sample=3).xindexes


def test_a_drive_with_the_name_of_a_variable_has_no_coordinate() -> None:
    text = ct.mechanism_text(ROCKER).replace("[links.OA]", '[links.angle]\npoints = ["O", "A"]')
    data = ct.motion(ct.parse_mechanism(text.replace('link = "OA"', 'link = "angle"')), 5)
    assert data.angle.dims == ("sample", "link") and data.drive.values.tolist() == ["angle"]


def test_labels_of_two_results_have_nothing_in_common() -> None:
    one, other = ct.motion("crank-rocker", 5), ct.motion("crank-rocker", 5)
    one["point"].attrs["seen"] = "yes"
    one["point"].encoding["seen"] = "yes"
    for later in (other, ct.motion("crank-rocker", 5)):
        assert "seen" not in later["point"].attrs | later["point"].encoding
