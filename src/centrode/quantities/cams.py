"""Variables of cams and walking wheels: the roller's path, profiles, contact."""

from __future__ import annotations

from centrode.locale import mark
from centrode.quantities.quantity import Quantity

CAMS = (
    Quantity("profile", "r", "m", mark("profile of the cam")),
    Quantity("profile_radius", "r", "m", mark("polar radius of the profile")),
    Quantity("profile_angle", "α", "rad", mark("polar angle of the profile")),
    Quantity("profile_bend", "R", "m", mark("radius of curvature of the profile")),
    Quantity("groove", "r", "m", mark("outer wall of the groove")),
    Quantity("shoe_profile", "r", "m", mark("profile of the shoe")),
    Quantity("shoe_radius", "r", "m", mark("polar radius of the shoe")),
    Quantity("shoe_angle", "α", "rad", mark("polar angle of the shoe")),
    Quantity("shoe_bend", "R", "m", mark("radius of curvature of the shoe")),
    Quantity("shoe_along", "Y_1", "m", mark("part of the shoe along the leg")),
    Quantity("shoe_upright", "Y_2", "m", mark("part of the shoe upright")),
    Quantity("hub_travel", "X", "m", mark("travel of the hub")),
    Quantity("hub_rate", "X′", "m/rad", mark("travel of the hub by angle")),
    Quantity("cam_angle", "φ", "rad", mark("angle of the cam")),
    Quantity("lift", "s", "m", mark("lift of the follower")),
    Quantity("lift_slope", "s′", "m/rad", mark("slope of the lift")),
    Quantity("lift_second", "s″", "m/rad^2", mark("second derivative of the lift")),
    Quantity("lift_third", "s‴", "m/rad^3", mark("third derivative of the lift")),
    Quantity("lift_fourth", "s⁗", "m/rad^4", mark("fourth derivative of the lift")),
    Quantity("lift_velocity", "v", "m/s", mark("velocity of the follower")),
    Quantity("lift_acceleration", "a", "m/s^2", mark("acceleration of the follower")),
    Quantity("lift_jerk", "j", "m/s^3", mark("jerk of the follower")),
    Quantity("swing", "ψ", "rad", mark("angle of the follower")),
    Quantity("swing_slope", "ψ′", "1", mark("slope of the follower's angle")),
    Quantity("swing_second", "ψ″", "1/rad", mark("second derivative of the follower's angle")),
    Quantity("swing_third", "ψ‴", "1/rad^2", mark("third derivative of the follower's angle")),
    Quantity("swing_fourth", "ψ⁗", "1/rad^3", mark("fourth derivative of the follower's angle")),
    Quantity("swing_velocity", "ω", "rad/s", mark("angular velocity of the follower")),
    Quantity("swing_acceleration", "ε", "rad/s^2", mark("angular acceleration of the follower")),
    Quantity("swing_jerk", "j", "rad/s^3", mark("angular jerk of the follower")),
    Quantity("carrier_angle", "φ", "rad", mark("angle of the carrier")),
    Quantity("path_radius", "ρ", "m", mark("radius of the roller's path")),
    Quantity("path_radius_slope", "ρ′", "m/rad", mark("slope of the radius of the roller's path")),
    Quantity(
        "path_radius_second", "ρ″", "m/rad^2", mark("second derivative of the radius of the roller's path")
    ),
    Quantity("cam_pressure_angle", "γ", "rad", mark("pressure angle of the cam")),
    Quantity("pressure_sine", "η", "1", mark("sine of the pressure angle")),
    Quantity("pressure_sine_slope", "η′", "1/rad", mark("slope of the sine of the pressure angle")),
    Quantity(
        "pressure_sine_second", "η″", "1/rad^2", mark("second derivative of the sine of the pressure angle")
    ),
    Quantity("pressure_cosine", "λ", "1", mark("cosine of the pressure angle")),
    Quantity("law_curvature", "K", "1/m", mark("curvature that the law gives")),
    Quantity("law_curvature_slope", "K′", "1/m/rad", mark("slope of the curvature that the law gives")),
    Quantity("drawn_curvature", "k", "1/m", mark("curvature of the drawn path")),
    Quantity("roller_centre", "A", "m", mark("centre of the roller")),
    Quantity("radius_by_slope", "ρ_16", "m", mark("radius by formula (16)")),
    Quantity("parting", "Δρ_16", "m", mark("radius by formula (16) less that by (15)")),
    Quantity("foretold_error", "Δρ_N", "m", mark("error of the series that its next terms foretell")),
    Quantity("series_error", "Δρ_a", "m", mark("radius by the series less that by steps")),
    Quantity("routes_difference", "Δρ_c", "m", mark("integrated radius less that by steps")),
    Quantity("contact_stress", "σ", "Pa", mark("contact stress")),
    Quantity("contact_stress_by_source", "σ_K", "Pa", mark("contact stress by the source's formula")),
    Quantity("contact_shear", "τ", "Pa", mark("greatest shear below the contact")),
    Quantity("contact_depth", "z", "m", mark("depth of the greatest shear")),
    Quantity("contact_half_width", "a", "m", mark("half width of the strip of contact")),
    Quantity("cam_curvature_radius", "R", "m", mark("radius of curvature of the cam at the contact")),
)
