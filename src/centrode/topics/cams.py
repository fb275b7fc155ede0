"""Topics of cams."""

from __future__ import annotations

from centrode.locale import mark
from centrode.topics.topic import (
    ChapterOfTopic,
    Command,
    FlagOption,
    InDocuments,
    Lazily,
    Panel,
    Topic,
    ValueOption,
)

HAS_CURVATURE_LAW = Lazily("centrode.model.cam_files", "has_curvature_law")
NEEDS_FOLLOWER = Lazily("centrode.model.cam_files", "with_follower")
NEEDS_CURVATURE_LAW = Lazily("centrode.model.cam_files", "require_curvature_cam")

FOLLOWER_MOTION = Topic(
    name="follower-motion",
    compute=Lazily("centrode.cams.followers.motion_results", "follower_motion_results"),
    result=Lazily("centrode.cams.followers.motion_results", "FollowerMotionResults"),
    restore=Lazily("centrode.cams.followers.motion_results", "results_of_follower_motion"),
    view=Lazily("centrode.views.follower_motion", "sheet"),
    concerns=Lazily("centrode.model.cam_files", "has_follower"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="cam"),
            ChapterOfTopic("lift", mark("Motion of the follower"), code="ct.cam(cam)"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Motion of the follower"), mark("a curvature law gives this cam: it has no lift")),
)

MOTION_LAWS = Topic(
    name="motion-laws",
    compute=Lazily("centrode.cams.followers.motion_results", "motion_law_results"),
    result=Lazily("centrode.cams.followers.motion_results", "MotionLawResults"),
    restore=Lazily("centrode.cams.followers.motion_results", "MotionLawResults"),
    view=Lazily("centrode.views.motion_laws", "sheet"),
    concerns=Lazily("centrode.cams.followers.motion_results", "has_rise"),
    document=InDocuments(chapters=(ChapterOfTopic("laws", mark("Laws of motion for one rise")),)),
    subject="cam",
    command=Command(
        help="",
        options=(FlagOption("laws", mark("Also other laws of motion for the first rise of the follower.")),),
        needs=NEEDS_FOLLOWER,
    ),
    flag="laws",
)

BASE_RADIUS = Topic(
    name="base-radius",
    compute=Lazily("centrode.cams.followers.base_radius_results", "choose_base_radius"),
    result=Lazily("centrode.cams.followers.base_radius_results", "BaseRadiusResults"),
    view=Lazily("centrode.views.base_radius", "sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_size"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "base-radius", mark("Choice of the base radius"), code="ct.choose_base_radius(cam)"
            ),
        )
    ),
    subject="cam",
    panel=Panel(mark("Choice of the base radius"), mark("the cam has no size to choose")),
)

FOLLOWER_PROFILE = Topic(
    name="follower-profile",
    compute=Lazily("centrode.cams.followers.profile_results", "follower_profile_results"),
    result=Lazily("centrode.cams.followers.profile_results", "FollowerProfileResults"),
    restore=Lazily("centrode.cams.followers.profile_results", "results_of_follower_profile"),
    value=Lazily("centrode.cams.followers.geometry", "FollowerCam"),
    complete=Lazily("centrode.cams.followers.profile_results", "results_of_follower_cam"),
    view=Lazily("centrode.views.follower_profile", "sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_profile"),
    command=Command(
        help="",
        needs=NEEDS_FOLLOWER,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="cam.gif",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("motion", mark("Motion")),
            ChapterOfTopic("profile", mark("Profile of the cam"), code="ct.cam_profile(cam)"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Profile of the cam"), mark("the cam has no size yet: its base radius is missing")),
)

ROLLER_PATH = Topic(
    name="roller-path",
    compute=Lazily("centrode.cams.cam", "roller_path_results"),
    result=Lazily("centrode.cams.cam", "RollerPathResults"),
    restore=Lazily("centrode.cams.cam", "results_of_roller_path"),
    view=Lazily("centrode.views.roller_path", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    document=InDocuments(
        chapters=(
            ChapterOfTopic("data", mark("Data"), code="cam"),
            ChapterOfTopic("path", mark("Path of the roller's centre"), code="ct.cam(cam)"),
        ),
        instants=False,
    ),
    subject="cam",
    panel=Panel(
        mark("Path of the roller's centre"), mark("a follower gives this cam: it has no curvature law")
    ),
)

PATH_ROUTES = Topic(
    name="path-routes",
    compute=Lazily("centrode.cams.cam", "path_routes_results"),
    result=Lazily("centrode.cams.cam", "PathRoutesResults"),
    restore=Lazily("centrode.cams.cam", "results_of_path_routes"),
    view=Lazily("centrode.views.path_routes", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    command=Command(
        help="",
        options=(
            ValueOption(
                "terms",
                mark("N"),
                mark(
                    "Truncate the power series after a_N; by default the number of the description, or else 20."
                ),
                int,
            ),
        ),
        needs=NEEDS_CURVATURE_LAW,
    ),
    document=InDocuments(chapters=(ChapterOfTopic("routes", mark("Three routes to the path")),)),
    subject="cam",
    panel=Panel(needs=mark("a follower gives this cam: it has no curvature law")),
)

CAM_SERIES = Topic(
    name="cam-series",
    compute=Lazily("centrode.cams.series", "cam_series_results"),
    result=Lazily("centrode.cams.series", "CamSeriesResults"),
    restore=Lazily("centrode.cams.series", "CamSeriesResults"),
    view=Lazily("centrode.views.cam_series", "sheet"),
    concerns=HAS_CURVATURE_LAW,
    command=Command(
        help="",
        options=(FlagOption("series", mark("Also the coefficients of the power series of the path.")),),
        needs=NEEDS_CURVATURE_LAW,
    ),
    flag="series",
    document=InDocuments(
        chapters=(ChapterOfTopic("series", mark("Power series of the path"), code="ct.cam_series(cam)"),),
        instants=False,
    ),
    subject="cam",
)

FOLLOWER_FORCES = Topic(
    name="follower-forces",
    compute=Lazily("centrode.cams.followers.force_results", "follower_force_results"),
    result=Lazily("centrode.cams.followers.force_results", "FollowerForceResults"),
    restore=Lazily("centrode.cams.followers.force_results", "results_of_cam_forces"),
    view=Lazily("centrode.views.follower_forces", "sheet"),
    concerns=Lazily("centrode.cams.followers.force_results", "has_forces"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic(
                "cam-forces", mark("Forces on the cam and the follower"), code="ct.cam_forces(cam)"
            ),
        )
    ),
    subject="cam",
    panel=Panel(mark("Forces on the cam and the follower"), mark("the follower has no mass, spring or load")),
)

CAM_PROFILE = Topic(
    name="cam-profile",
    compute=Lazily("centrode.cams.results", "cam_profile_results"),
    result=Lazily("centrode.cams.results", "CamProfileResults"),
    restore=Lazily("centrode.cams.results", "results_of_cam_profile"),
    view=Lazily("centrode.views.cam_profile", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_roller"),
    command=Command(
        help="",
        options=(FlagOption("groove", mark("Also the outer wall of a groove that the roller runs in.")),),
        needs=NEEDS_CURVATURE_LAW,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="cam.gif",
    ),
    document=InDocuments(
        chapters=(ChapterOfTopic("profile", mark("Profile of the cam"), code="ct.cam_profile(cam)"),),
        instants=False,
    ),
    subject="cam",
    panel=Panel(needs=mark("a follower gives this cam: it has no curvature law")),
)

WALKING_WHEEL = Topic(
    name="walking-wheel",
    compute=Lazily("centrode.cams.results", "walking_wheel_results"),
    result=Lazily("centrode.cams.results", "WalkingWheelResults"),
    restore=Lazily("centrode.cams.results", "results_of_walking_wheel"),
    value=Lazily("centrode.cams.walking_wheel", "WheelMover"),
    complete=Lazily("centrode.cams.results", "results_of_wheel"),
    view=Lazily("centrode.views.walking_wheel", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_mover"),
    command=Command(
        help="",
        needs=NEEDS_CURVATURE_LAW,
        animation=Lazily("centrode.animation.cams", "animate_body_of"),
        animation_file="walking-wheel.gif",
    ),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("motion", mark("Motion")),
            ChapterOfTopic("walking", mark("Walking wheel"), code="print(ct.summary(ct.walking_wheel(cam)))"),
        )
    ),
    subject="cam",
    panel=Panel(mark("Walking wheel"), mark("the cam has no mover")),
)

CAM_CONTACT = Topic(
    name="cam-contact",
    compute=Lazily("centrode.cams.results", "cam_contact_results"),
    result=Lazily("centrode.cams.results", "CamContactResults"),
    restore=Lazily("centrode.cams.results", "CamContactResults"),
    view=Lazily("centrode.views.cam_contact", "sheet"),
    concerns=Lazily("centrode.cams.results", "has_contact"),
    document=InDocuments(
        chapters=(ChapterOfTopic("contact", mark("Contact of roller and cam"), code="ct.cam_contact(cam)"),),
        instants=False,
    ),
    subject="cam",
    panel=Panel(mark("Contact of roller and cam"), mark("the cam has no materials in contact")),
)

CAM_CHOICE = Topic(
    name="cam-choice",
    compute=Lazily("centrode.cams.parameter_choice.search", "choose_cam"),
    result=Lazily("centrode.cams.parameter_choice.search", "CamChoice"),
    view=Lazily("centrode.views.cam_choice", "sheet"),
    concerns=Lazily("centrode.cams.parameter_choice.search", "has_choice"),
    # the front of best designs takes longer than all the rest
    command=Command(help="", samples=False, complete="front"),
    document=InDocuments(
        chapters=(
            ChapterOfTopic("choice", mark("Chosen parameters"), code="ct.choose_cam(cam, front=False)"),
        ),
        arguments={"front": False},
        chosen_arguments={"front": True},
        instants=False,
    ),
    subject="cam",
    panel=Panel(needs=mark("the cam has nothing to choose"), arguments={"front": False}),
)

CAM_SENSITIVITY = Topic(
    name="cam-sensitivity",
    compute=Lazily("centrode.tolerances.sensitivity", "cam_sensitivity_results"),
    result=Lazily("centrode.tolerances.sensitivity", "CamSensitivityResults"),
    restore=Lazily("centrode.tolerances.sensitivity", "CamSensitivityResults"),
    view=Lazily("centrode.views.sensitivity", "cam_sheet"),
    concerns=Lazily("centrode.cams.followers.base_circle", "has_profile"),
    subject="cam",
)
