"""Variables of motions: places, speeds, centres, centrodes, statuses, events."""

from __future__ import annotations

from centrode.locale import mark
from centrode.quantities.quantity import Quantity

MOTIONS = (
    Quantity("time", "t", "s", mark("time")),
    Quantity("drive_value", "q", "rad", mark("value of the drive"), by_drive=-1),
    Quantity("position", "r", "m", mark("position")),
    Quantity("velocity", "v", "m/s", mark("velocity")),
    Quantity("acceleration", "a", "m/s^2", mark("acceleration")),
    Quantity("angle", "φ", "rad", mark("angle")),
    Quantity("angular_velocity", "ω", "rad/s", mark("angular velocity")),
    Quantity("angular_acceleration", "ε", "rad/s^2", mark("angular acceleration")),
    Quantity("joint_angle", "θ", "rad", mark("angle from the reference arc")),
    Quantity("joint_velocity", "ω_θ", "rad/s", mark("angular velocity from the reference arc")),
    Quantity("joint_acceleration", "ε_θ", "rad/s^2", mark("angular acceleration from the reference arc")),
    Quantity("slide", "s", "m", mark("displacement along the guide")),
    Quantity("slide_velocity", "v_s", "m/s", mark("velocity along the guide")),
    Quantity("slide_acceleration", "a_s", "m/s^2", mark("acceleration along the guide")),
    Quantity("contact", "P", "m", mark("contact point of a rolling wheel")),
    Quantity("centre", "P", "m", mark("instant centre")),
    Quantity("centre_direction", "", "1", mark("direction of an instant centre at infinity")),
    Quantity("centre_case", "", "1", mark("how an instant centre is located")),
    Quantity("relative_speed", "ω", "rad/s", mark("relative angular velocity")),
    Quantity("fixed_centrode", "P", "m", mark("fixed centrode")),
    Quantity("moving_centrode", "p", "m", mark("moving centrode")),
    Quantity("fixed_arc", "s_P", "m", mark("arc of the fixed centrode")),
    Quantity("moving_arc", "s_p", "m", mark("arc of the moving centrode")),
    Quantity("centrode_piece", "", "1", mark("number of the piece of a centrode")),
    Quantity("pole", "P", "m", mark("pole")),
    Quantity("inflection_pole", "W", "m", mark("inflection pole")),
    Quantity("inflection_diameter", "d", "m", mark("diameter of the inflection circle")),
    Quantity("pole_tangent", "τ", "rad", mark("angle of the pole tangent")),
    Quantity("ball_point", "U", "m", mark("Ball's point")),
    Quantity("stationary_cubic", "", "1/m", mark("coefficients of the cubic of stationary curvature")),
    Quantity("path_curvature", "k", "1/m", mark("curvature of the path")),
    Quantity("path_curvature_slope", "k′", "1/m^2", mark("slope of the curvature of the path by its arc")),
    Quantity("curvature_centre", "K", "m", mark("centre of curvature of the path")),
    Quantity("velocity_coefficient", "r′", "m/rad", mark("velocity coefficient"), by_drive=1),
    Quantity("acceleration_coefficient", "r″", "m/rad^2", mark("acceleration coefficient"), by_drive=2),
    Quantity("angular_velocity_coefficient", "φ′", "1", mark("angular velocity coefficient"), by_drive=1),
    Quantity(
        "angular_acceleration_coefficient",
        "φ″",
        "1/rad",
        mark("angular acceleration coefficient"),
        by_drive=2,
    ),
    Quantity(
        "joint_velocity_coefficient", "θ′", "1", mark("velocity coefficient of the joint angle"), by_drive=1
    ),
    Quantity(
        "joint_acceleration_coefficient",
        "θ″",
        "1/rad",
        mark("acceleration coefficient of the joint angle"),
        by_drive=2,
    ),
    Quantity(
        "slide_velocity_coefficient", "s′", "m/rad", mark("velocity coefficient along the guide"), by_drive=1
    ),
    Quantity(
        "slide_acceleration_coefficient",
        "s″",
        "m/rad^2",
        mark("acceleration coefficient along the guide"),
        by_drive=2,
    ),
    Quantity("drive_rate", "q̇", "rad/s", mark("speed of the drive that loads are taken at"), by_drive=-1),
    Quantity("transmission_angle", "μ", "rad", mark("transmission angle")),
    Quantity("least_transmission_angle", "μ_min", "rad", mark("least transmission angle")),
    Quantity("greatest_transmission_angle", "μ_max", "rad", mark("greatest transmission angle")),
    Quantity("pressure_angle", "α", "rad", mark("pressure angle")),
    Quantity("status", "", "1", mark("status of the sample")),
    Quantity("residual", "", "1", mark("closure residual over the greatest length")),
    Quantity("drift", "", "1", mark("drift of the constraint over the greatest length")),
    Quantity("angle_difference", "Δφ", "rad", mark("integrated angle less that in closed form")),
    Quantity(
        "position_difference", "Δr", "m", mark("distance of the integrated place from that in closed form")
    ),
    Quantity("event_value", "q", "rad", mark("value of the drive at the event"), by_drive=-1),
    Quantity("event_kind", "", "1", mark("kind of the event")),
    Quantity("event_group", "", "1", mark("group of the event")),
)
