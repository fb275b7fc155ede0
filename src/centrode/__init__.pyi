# The public face of centrode in reading order, for type checkers and for lazy_loader, which imports by it.

# The description
from .model.mechanism import Mechanism as Mechanism
from .model.mechanism import Frame as Frame
from .model.mechanism import Link as Link
from .model.mechanism import Guide as Guide
from .model.mechanism import Drive as Drive
from .model.mechanism import Assembly as Assembly
from .model.mechanism import Study as Study
from .model.files import read_mechanism as read_mechanism
from .model.files import parse_mechanism as parse_mechanism
from .model.files import mechanism_text as mechanism_text
from .model.files import value_at as value_at
from .model.files import with_value as with_value
from .model.placement import replace_placed as replace_placed

from .model.schema import mechanism_schema as mechanism_schema

# The description of a cam
from .model.cam import Cam as Cam
from .model.follower_cam import PlateCam as PlateCam
from .model.cam import vary_cam as vary_cam
from .model.cam_files import read_cam as read_cam
from .model.cam_files import parse_cam as parse_cam
from .model.cam_files import cam_text as cam_text
from .model.schema import cam_schema as cam_schema

# Built-in mechanisms and classics
from .model.examples.catalogue import load as load
from .model.examples.catalogue import load_cam as load_cam
from .model.examples.catalogue import example as example
from .model.examples.catalogue import load_either as load_either
from .model.examples import example_names as example_names
from .model.examples import example_text as example_text
from .model.classics import four_bar as four_bar
from .model.classics import slider_crank as slider_crank

# Structure and motion
from .kinematics.check import check as check
from .kinematics.motion import motion as motion
from .kinematics.several_inputs.coefficients import kinematic_coefficients as kinematic_coefficients
from .kinematics.several_inputs.limits import limits as limits
from .kinematics.several_inputs.limits import Limits as Limits
from .kinematics.several_inputs.region import reachable_region as reachable_region
from .kinematics.several_inputs.region import region_results as region_results
from .analysis.operation import principle_of_operation as principle_of_operation
from .analysis.rotatability.rotatability import rotatability as rotatability
from .analysis.rotatability.rotatability import Rotatability as Rotatability
from .analysis.redesign.repair import repair as repair
from .analysis.redesign.repair import Repair as Repair
from .analysis.graphic.diagrams import velocity_diagram as velocity_diagram
from .analysis.graphic.diagrams import acceleration_diagram as acceleration_diagram
from .analysis.graphic.diagrams import Diagram as Diagram
from .analysis.graphic.checks import graphic_check as graphic_check
from .analysis.graphic.checks import GraphicCheck as GraphicCheck
from .analysis.graphic.results import graphic_results as graphic_results
from .analysis.graphic.results import GraphicResults as GraphicResults
from .analysis.position_plan import plan_of_positions as plan_of_positions
from .analysis.position_plan import PositionPlan as PositionPlan
from .analysis.transmission import transmission_angles as transmission_angles
from .analysis.transmission import transmission_results as transmission_results
from .dynamics.motion_results import study as study
from .dynamics.motion_results import MotionResults as MotionResults
from .kinematics.check import MechanismCheck as MechanismCheck

# Forces
from .dynamics.reduction import reduce as reduce
from .dynamics.kinetostatics.reactions import reactions as reactions
from .dynamics.bearings.wear import bearings as bearings
from .dynamics.bearings.wear import motion_beside as motion_beside
from .dynamics.bearings.extremes import bearing_loads as bearing_loads
from .dynamics.bearings.extremes import BearingLoad as BearingLoad
from .dynamics.bearings.results import reaction_results as reaction_results
from .dynamics.bearings.results import ReactionResults as ReactionResults
from .dynamics.reduction_results import reduction_results as reduction_results
from .dynamics.reduction_results import ReductionResults as ReductionResults

# Forces by hand
from .dynamics.force_polygons.polygons import force_polygons as force_polygons
from .dynamics.force_polygons.polygons import ForcePolygons as ForcePolygons
from .dynamics.force_polygons.results import force_polygon_results as force_polygon_results
from .dynamics.force_polygons.results import ForcePolygonResults as ForcePolygonResults

# Steady motion of a machine
from .dynamics.steady_motion.steady import steady_motion as steady_motion
from .dynamics.steady_motion.flywheel import flywheel as flywheel
from .dynamics.steady_motion.flywheel import Flywheel as Flywheel
from .dynamics.steady_motion.machine import machine_results as machine_results

# Motion under loads and a drive
from .model.simulation import Simulation as Simulation
from .model.simulation import Motor as Motor
from .dynamics.simulation.simulate import simulate as simulate
from .dynamics.simulation.steady_state import steady_regime as steady_regime
from .dynamics.simulation.steady_state import Regime as Regime
from .dynamics.simulation.results import simulation_results as simulation_results
from .dynamics.simulation.results import SimulationResults as SimulationResults

# Shaking forces and counterweights
from .dynamics.balancing.shaking_forces import shaking as shaking
from .dynamics.balancing.balance import balance as balance
from .dynamics.balancing.balance import Balance as Balance
from .dynamics.balancing.counterweights import Counterweight as Counterweight

# Cams
from .cams.cam import cam as cam
from .cams.cam import cam_routes as cam_routes
from .cams.cam import roller_path_results as roller_path_results
from .cams.cam import path_routes_results as path_routes_results
from .cams.results import cam_profile_results as cam_profile_results
from .cams.results import walking_wheel_results as walking_wheel_results
from .cams.results import cam_contact_results as cam_contact_results
from .cams.path_series import path_of as path_of
from .cams.followers.motion_results import follower_motion_results as follower_motion_results
from .cams.followers.motion_results import motion_law_results as motion_law_results
from .cams.followers.motion import follower_motion as follower_motion
from .cams.followers.motion import cam_laws as cam_laws
from .cams.followers.base_circle import follower_cam as follower_cam
from .cams.followers.base_radius_results import base_radius_results as base_radius_results
from .cams.followers.profile_results import follower_profile_results as follower_profile_results
from .cams.followers.force_results import follower_force_results as follower_force_results
from .cams.followers.forces import cam_forces as cam_forces

# Profiles of cams, walking wheels
from .cams.results import cam_profile as cam_profile
from .cams.results import shoe_profile as shoe_profile
from .cams.results import walking_wheel as walking_wheel
from .cams.profiles import cam_body as cam_body
from .cams.profiles import cam_outlines as cam_outlines
from .cams.profiles import shoe_outlines as shoe_outlines
from .cams.walking_wheel import rolling as rolling

# Contact of roller and cam, choice of parameters
from .cams.results import cam_contact as cam_contact
from .cams.parameter_choice.search import choose_cam as choose_cam
from .cams.parameter_choice.search import CamChoice as CamChoice

# Animations
from .animation.animate import animate as animate
from .animation.animate import Shown as Shown
from .animation.video_files import Pace as Pace
from .animation.video_files import Animation as Animation
from .animation.animate import animate_motion as animate_motion
from .animation.animate import animate_centrodes as animate_centrodes

# Equations in symbols
from .equations.derivation import equations as equations

# Instant centres, centrodes, curvature
from .analysis.instant_centres.centres import instant_centres as instant_centres
from .analysis.instant_centres.centres import Case as Case
from .analysis.instant_centres.kennedy import construct_centres as construct_centres
from .analysis.instant_centres.kennedy import Construction as Construction
from .analysis.instant_centres.kennedy import MOST_BODIES as MOST_BODIES
from .analysis.instant_centres.centrodes import centrodes as centrodes
from .analysis.instant_centres.curvature import curvature as curvature
from .analysis.instant_centres.results import centre_results as centre_results
from .analysis.instant_centres.results import CentreResults as CentreResults
from .analysis.instant_centres.results import centrode_results as centrode_results
from .analysis.instant_centres.results import CentrodeResults as CentrodeResults
from .analysis.instant_centres.bodies import body_names as body_names
from .model.labels import body_name as body_name
from .kinematics.motion import initial_place as initial_place
from .model.labels import place_words as place_words

# Integration, variants, words
from .equations.integration import integrate as integrate
from .equations.integration import integration_results as integration_results
from .equations.integration import closed_motion as closed_motion
from .assignments.results import variants as variants
from .assignments.results import spoken_variants as spoken_variants

# Many mechanisms
from .sweeps.sweep import sweep as sweep
from .sweeps.designs import grid as grid
from .sweeps.designs import sample as sample
from .sweeps.sweep import read_sweep as read_sweep

# Any result, shown
from .topics.presentation import summary as summary
from .topics.presentation import tables as tables
from .topics.presentation import figures as figures
from .topics.presentation import write as write
from .topics.presentation import open as open
from .topics.presentation import Result as Result
from .topics.presentation import sheet_of as sheet_of

# Presentations
from .render.netcdf import write_motion_netcdf as write_motion_netcdf
from .kinematics.motion import motion_among as motion_among
from .kinematics.motion import moving_points as moving_points
from .render.drafting.sheet import mechanism_drawing as mechanism_drawing
from .render.drafting.svg import drawing_svg as drawing_svg
from .render.drafting.svg import write_drawing_svg as write_drawing_svg
from .render.drafting.dxf import write_drawing_dxf as write_drawing_dxf
from .export.mjcf import mjcf_text as mjcf_text
from .render.workbooks import workbook_of_csv as workbook_of_csv
from .render.table_spelling import spell_with_comma as spell_with_comma
from .render.table_spelling import TableSpelling as TableSpelling
from .render.drawing.style import darkened as darkened
from .report.variants.folders import write_variants as write_variants
from .render.figures.files import save_figures as save_figures

# Reports
from .report import report as report
from .report import write_report as write_report
from .report import write_variant_reports as write_variant_reports
from .report import ReportOptions as ReportOptions

# Words, failures, language
from .quantities import QUANTITIES as QUANTITIES
from .quantities import Quantity as Quantity
from .errors import CentrodeError as CentrodeError
from .errors import InputError as InputError
from .errors import NotComputedYet as NotComputedYet
from .errors import MotionError as MotionError
from .errors import DamageWarning as DamageWarning
from .errors import Status as Status
from .locale import choose_language as choose_language

__version__: str
