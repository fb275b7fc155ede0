"""Cams: derivatives of pressure angle and lift against differences in fifty digits, of contacts solved anew."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from centrode.tolerances.cam_sensitivity import cam_sensitivity

CAM = """kind = "cam"
[cam]
base_radius = 0.04
turn = "{turn}"
[follower]
{follower}
[[segments]]
angle = "120 deg"
to = {lift}
curve = "cycloidal"
[[segments]]
angle = "120 deg"
to = 0
curve = "cycloidal"
[[segments]]
angle = "120 deg"
curve = "dwell"
"""
FOLLOWERS = {
    "roller": ('kind = "translating"\ncontact = "roller"\nroller_radius = 0.012\noffset = 0.008', 0.02),
    "swinging": (
        'kind = "oscillating"\ncontact = "roller"\nroller_radius = 0.012\narm = 0.07\npivot_distance = 0.09',
        0.3,
    ),
    "swinging face": (
        'kind = "oscillating"\ncontact = "flat"\npivot_distance = 0.12\nface_offset = 0.005',
        0.15,
    ),
}
ANGLES = (0.5, 1.3, 2.6, 3.7)


def described(kind: str, turn: str) -> Any:
    follower, lift = FOLLOWERS[kind]
    return ct.parse_cam(CAM.format(turn=turn, follower=follower, lift=lift))


def lift_at(phi: Any, rise: Any) -> Any:
    """The law of the description: cycloidal up and down, 120 degrees each."""
    third = 2 * mp.pi / 3
    share = phi / third if phi <= third else (2 * third - phi) / third
    return rise * (share - mp.sin(2 * mp.pi * share) / (2 * mp.pi))


def centre(kind: str, s: Any, start: Any, number: dict[str, Any]) -> tuple[Any, Any]:
    if kind == "roller":
        return number["offset"], start + s
    psi = start + s
    return number["pivot_distance"] - number["arm"] * mp.cos(psi), number["arm"] * mp.sin(psi)


def start_of(kind: str, number: dict[str, Any]) -> Any:
    radius = number["base_radius"] + number.get("roller_radius", 0)
    if kind == "roller":
        return mp.sqrt(radius**2 - number["offset"] ** 2)
    if kind == "swinging face":
        return mp.asin((number["base_radius"] + number["face_offset"]) / number["pivot_distance"])
    arm, distance = number["arm"], number["pivot_distance"]
    return mp.acos((arm**2 + distance**2 - radius**2) / (2 * arm * distance))


def numbers_of(kind: str) -> dict[str, float]:
    found = {"base_radius": 0.04}
    for line in FOLLOWERS[kind][0].splitlines():
        key, value = line.split(" = ")
        if not value.startswith('"'):
            found[key] = float(value)
    return found


def pressure(kind: str, phi: Any, number: dict[str, Any], sense: int) -> Any:
    """Pressure angle of the cam drawn for these numbers, by differences along the path of the roller's centre."""
    start, rise, tiny = start_of(kind, number), FOLLOWERS[kind][1], mp.mpf(10) ** -20

    def place(q: Any) -> Any:
        x, y = centre(kind, lift_at(q, rise), start, number)
        return mp.mpc(x, y) * mp.expj(-sense * q)

    tangent = (place(phi + tiny) - place(phi - tiny)) / (2 * tiny)
    s = lift_at(phi, rise)
    one, other = (mp.mpc(*centre(kind, s + side * tiny, start, number)) for side in (1, -1))
    motion = (one - other) * mp.expj(-sense * phi)
    turned = tangent / abs(tangent) * mp.conj(motion / abs(motion))
    return mp.atan2(mp.re(turned), sense * mp.im(mp.conj(turned)))


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("kind", ["roller", "swinging"])
def test_pressure_angle(kind: str, turn: str) -> None:
    mp.mp.dps = 50
    sense = 1 if turn == "counter-clockwise" else -1
    found = cam_sensitivity(described(kind, turn), ["pressure_angle"], at=ANGLES)
    step, base = mp.mpf(10) ** -12, {key: mp.mpf(x) for key, x in numbers_of(kind).items()}
    for row, phi in enumerate(ANGLES):
        q = mp.mpf(phi)
        assert float(pressure(kind, q, base, sense)) == pytest.approx(
            float(found["pressure_angle"][row]), abs=1e-13
        )
        for column, path in enumerate(found["path"].to_numpy()):
            key = path.partition(".")[2]
            ends = [pressure(kind, q, {**base, key: base[key] + side * step}, sense) for side in (1, -1)]
            exact = float((ends[0] - ends[1]) / (2 * step))
            assert float(found["gradient.pressure_angle"][row, column]) == pytest.approx(
                exact, rel=1e-9, abs=1e-10
            ), path


@pytest.mark.parametrize("turn", ["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("kind", ["roller", "swinging"])
def test_lift_of_the_made_cam(kind: str, turn: str) -> None:
    """The path of the nominal roller's centre, shifted along its normal, is met by the deviating follower's centre."""
    mp.mp.dps = 50
    sense = 1 if turn == "counter-clockwise" else -1
    found = cam_sensitivity(described(kind, turn), ["lift"], at=ANGLES)
    base = {key: mp.mpf(x) for key, x in numbers_of(kind).items()}
    start, rise, tiny, step = start_of(kind, base), FOLLOWERS[kind][1], mp.mpf(10) ** -20, mp.mpf(10) ** -12

    def place(q: Any) -> Any:
        return mp.mpc(*centre(kind, lift_at(q, rise), start, base)) * mp.expj(-sense * q)

    def shifted(q: Any, by: Any) -> Any:
        tangent = place(q + tiny) - place(q - tiny)
        return place(q) + by * mp.mpc(0, sense) * tangent / abs(tangent)

    def met(phi: Any, key: str, by: Any) -> Any:
        shift = by if key in ("base_radius", "roller_radius") else mp.mpf(0)
        changed = base if shift else {**base, key: base[key] + by}

        def apart(s: Any, q: Any) -> list[Any]:
            gap = mp.mpc(*centre(kind, s, start, changed)) - shifted(q, shift) * mp.expj(sense * phi)
            return [mp.re(gap), mp.im(gap)]

        return mp.findroot(apart, (lift_at(phi, rise), phi), tol=1e-40)[0]

    for row, phi in enumerate(ANGLES):
        q = mp.mpf(phi)
        for column, path in enumerate(found["path"].to_numpy()):
            key = path.partition(".")[2]
            exact = float((met(q, key, step) - met(q, key, -step)) / (2 * step))
            assert float(found["gradient.lift"][row, column]) == pytest.approx(exact, rel=1e-8, abs=1e-9), (
                path
            )


def test_faces() -> None:
    """A sliding face rises as the profile grows; a turning one by its line's distance from the centre."""
    plain = cam_sensitivity("valve-cam", ["lift", "pressure_angle"], samples=13)
    assert (plain["gradient.lift"] == 1.0).all()
    assert (plain["gradient.pressure_angle"] == 0.0).all()
    mp.mp.dps = 50
    kind, base = "swinging face", {key: mp.mpf(x) for key, x in numbers_of("swinging face").items()}
    found = cam_sensitivity(described(kind, "counter-clockwise"), ["lift", "pressure_angle"], at=ANGLES)
    start, rise, tiny, step = start_of(kind, base), FOLLOWERS[kind][1], mp.mpf(10) ** -20, mp.mpf(10) ** -12

    def support(q: Any) -> tuple[Any, Any]:
        """Direction of the face's normal in the cam's axes, and its distance from the centre."""
        psi = start + lift_at(q, rise)
        return psi + q, base["pivot_distance"] * mp.sin(psi) - base["face_offset"]

    def met(phi: Any, key: str, by: Any) -> Any:
        grown = by if key == "base_radius" else mp.mpf(0)
        number = base if key == "base_radius" else {**base, key: base[key] + by}

        def apart(s: Any, q: Any) -> list[Any]:
            omega, distance = support(q)
            own = number["pivot_distance"] * mp.sin(start + s) - number["face_offset"]
            return [start + s + phi - omega, own - distance - grown]

        return mp.findroot(apart, (lift_at(phi, rise), phi), tol=1e-40)[0]

    def angle(phi: Any, key: str, by: Any) -> Any:
        number = {**base, key: base[key] + by}
        s, first = lift_at(phi, rise), start_of(kind, number)
        slope = (lift_at(phi + tiny, rise) - lift_at(phi - tiny, rise)) / (2 * tiny)
        reach = number["pivot_distance"] * mp.cos(first + s) * (1 - slope / (1 + slope))
        return mp.atan2(-number["face_offset"], reach)

    for row, phi in enumerate(ANGLES):
        q = mp.mpf(phi)
        for column, path in enumerate(found["path"].to_numpy()):
            key = path.partition(".")[2]
            for name, function in (("lift", met), ("pressure_angle", angle)):
                exact = float((function(q, key, step) - function(q, key, -step)) / (2 * step))
                given = float(found[f"gradient.{name}"][row, column])
                assert given == pytest.approx(exact, rel=1e-8, abs=1e-9), (name, path)


def test_cams_are_known_to_the_public_function() -> None:
    found = ct.sensitivity("valve-cam", "lift", samples=5)
    assert "cam.base_radius" in ct.summary(found)
    for outputs, by in ((["speed"], None), (["lift"], ["follower.offset"])):
        with pytest.raises(ct.InputError):
            ct.sensitivity("valve-cam", outputs, by=by)
    with pytest.raises(ct.InputError, match="curvature"):
        ct.sensitivity("cam-from-curvature", ["lift"])
    assert np.isfinite(found["gradient.lift"]).all()
