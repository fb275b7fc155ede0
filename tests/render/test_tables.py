"""Tables hold the dataset bit for bit; netCDF gives it back."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import xarray

from centrode.errors import Status
from centrode.render.netcdf import WITHOUT_ENTRIES, read_dataset, write_dataset
from centrode.views.columns import motion_table
from shown_motion import columns_of, write_motion


def read(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(encoding="utf-8", newline="") as file:
        headers, *rows = csv.reader(file)
    return headers, rows


def test_headers_name_quantity_owner_and_unit(make):
    mechanism, dataset = make("worked")
    headers, _columns = columns_of(dataset, points=mechanism.moving_points)
    assert headers[:4] == ["time [s]", "drive_OA [rad]", "angle_OA [rad]", "angle_AC [rad]"]
    for header in (
        "angular_velocity_AC [rad/s]",
        "angular_acceleration_AC [rad/s^2]",
        "position_C_x [m]",
        "velocity_C_y [m/s]",
        "acceleration_C_x [m/s^2]",
        "slide_C [m]",
        "velocity_coefficient_C_x [m/rad]",
    ):
        assert header in headers
    assert headers[-2:] == ["status", "residual"]
    assert not any("_O_" in header or "_D_" in header for header in headers)


def test_display_units_replace_metres_and_radians(make):
    mechanism, dataset = make("press")
    headers, columns = columns_of(dataset, mechanism.display)
    table = dict(zip(headers, columns, strict=True))
    assert (
        table["position_H_x [mm]"] == (dataset["position"].sel(point="H", axis="x") * 1000.0).values.tolist()
    )
    np.testing.assert_allclose(
        table["angle_AB [deg]"], np.degrees(dataset["angle"].sel(link="AB")), rtol=4 * np.finfo(float).eps
    )
    assert "velocity_H_x [mm/s]" in table
    assert "angular_velocity_AB [deg/s]" in table


def test_coefficients_stay_per_radian(make):
    mechanism, dataset = make("press")
    headers, columns = columns_of(dataset, mechanism.display)
    table = dict(zip(headers, columns, strict=True))
    assert table["angular_velocity_coefficient_AB"] == (
        dataset["angular_velocity_coefficient"].sel(link="AB").values.tolist()
    )
    assert "velocity_coefficient_H_x [mm/rad]" in table


def test_csv_reads_back_bit_for_bit(make, tmp_path):
    _mechanism, dataset = make("worked", locked=True)
    path = tmp_path / "motion.csv"
    write_motion(dataset, path)
    headers, rows = read(path)
    expected_headers, columns = columns_of(dataset)
    assert headers == expected_headers
    assert len(rows) == dataset.sizes["sample"]
    for number, column in enumerate(columns):
        for row, value in zip(rows, column, strict=True):
            if isinstance(value, str):
                assert row[number] == value
            elif math.isnan(value):
                assert row[number] == ""
            else:
                assert float(row[number]).hex() == value.hex()
    x = headers.index("position_B_x [m]")
    back = np.array([float(row[x]) if row[x] else np.nan for row in rows])
    np.testing.assert_array_equal(back, dataset["position"].sel(point="B", axis="x"))


def test_status_is_a_word(make, tmp_path):
    _mechanism, dataset = make("worked", locked=True)
    write_motion(dataset, tmp_path / "motion.csv")
    headers, rows = read(tmp_path / "motion.csv")
    words = [row[headers.index("status")] for row in rows]
    assert set(words) == {"ok", "open", "cut off"}
    assert words == [Status(code).word for code in dataset["status"].values]


def test_line_ends_and_quotes(make, tmp_path):
    _mechanism, dataset = make("slotted")
    dataset = dataset.assign_coords(link=["OA", 'a,"b"'])
    path = tmp_path / "motion.csv"
    write_motion(dataset, path)
    assert b"\r" not in path.read_bytes()
    headers, rows = read(path)
    assert 'angle_a,"b" [rad]' in headers
    assert "position_Б’_x [m]" in headers
    assert all(len(row) == len(headers) for row in rows)


def test_no_field_is_a_spreadsheet_formula(make, tmp_path):
    for name in ("press", "worked", "slotted"):
        _mechanism, dataset = make(name)
        write_motion(dataset, tmp_path / "motion.csv")
        headers, rows = read(tmp_path / "motion.csv")
        assert not any(cell.startswith(("=", "@", "+")) for row in [headers, *rows] for cell in row)


def test_a_batch_is_refused(make):
    _mechanism, dataset = make("press", samples=5)
    with pytest.raises(ValueError, match="variant"):
        motion_table(xarray.concat([dataset, dataset], dim="variant", join="exact"))


def test_netcdf_reads_back_equal(make, tmp_path):
    for name, options in (("worked", {"locked": True}), ("slotted", {}), ("press", {"samples": 1})):
        _mechanism, dataset = make(name, **options)
        path = tmp_path / f"{name}.nc"
        write_dataset(dataset, path)
        back = xarray.load_dataset(path, engine="scipy")
        kept = dataset.drop_dims([dim for dim, size in dataset.sizes.items() if size == 0])
        # variables without entries are in an attribute
        absent = back.attrs.pop(WITHOUT_ENTRIES, None)
        assert (absent is None) == (set(kept.variables) == set(dataset.variables))
        xarray.testing.assert_identical(back, kept)
        again = read_dataset(path)
        xarray.testing.assert_identical(again.drop_dims(set(again.sizes) - set(kept.sizes)), kept)
        assert {variable: again[variable].dims for variable in again.variables} == {
            variable: dataset[variable].dims for variable in dataset.variables
        }
        assert {str(back[variable].dtype) for variable in back.data_vars} <= {"int8", "float64", "object"}
        assert all(str(variable).isascii() for variable in back.variables)


def test_netcdf_keeps_slashes_in_names_out_of_the_file(tmp_path):
    """The format keeps a slash for groups; what is read has the names as they were."""
    dataset = xarray.Dataset({"force.B/AB": ("sample", [1.0, 2.0]), "force.B|AB": 3.0})
    write_dataset(dataset, tmp_path / "forces.nc")
    with xarray.open_dataset(tmp_path / "forces.nc", engine="scipy") as file:
        assert not any("/" in str(name) for name in file.variables)
    assert read_dataset(tmp_path / "forces.nc").identical(dataset)


def test_netcdf_repeats_its_bytes(make, tmp_path):
    _mechanism, dataset = make("worked")
    for path in ("a.nc", "b.nc"):
        write_dataset(dataset, tmp_path / path)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_two_drives_have_two_columns(make):
    _mechanism, dataset = make("five_bar")
    headers, columns = columns_of(dataset)
    assert headers[:3] == ["time [s]", "drive_OA [rad]", "drive_DC [rad]"]
    assert columns[2] == dataset["drive_value"].values[:, 1].tolist()
