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
from .model.paths import value_at as value_at
from .model.paths import with_value as with_value
from .model.placing import replace_placed as replace_placed

from .model.schema import mechanism_schema as mechanism_schema

# The description of a cam
from .model.cams.description import Cam as Cam
from .model.cams.plate import PlateCam as PlateCam
from .model.cams.description import varied as varied
from .model.cams.files import read_cam as read_cam
from .model.cams.files import parse_cam as parse_cam
from .model.cams.files import cam_text as cam_text
from .model.cams.schema import cam_schema as cam_schema

# Built-in mechanisms and classics
from .model.examples.loading import load as load
from .model.examples.loading import load_cam as load_cam
from .model.examples.loading import example as example
from .model.examples.loading import load_either as load_either
from .model.examples import example_names as example_names
from .model.examples import example_text as example_text
from .model.classics import four_bar as four_bar
from .model.classics import slider_crank as slider_crank

# Structure and motion
from .study.checking import check as check
from .kinematics.motion import motion as motion
from .kinematics.several_drives.coefficients import kinematic_coefficients as kinematic_coefficients
from .kinematics.several_drives.reach import limits as limits
from .kinematics.several_drives.reach import Limits as Limits
from .kinematics.several_drives.region import reachable_region as reachable_region
from .analysis.rotatability import rotatability as rotatability
from .analysis.rotatability import Rotatability as Rotatability
from .analysis.repair import repair as repair
from .analysis.repair import Repair as Repair
from .analysis.graphic.diagrams import velocity_diagram as velocity_diagram
from .analysis.graphic.diagrams import acceleration_diagram as acceleration_diagram
from .analysis.graphic.diagrams import Diagram as Diagram
from .analysis.graphic.checking import graphic_check as graphic_check
from .analysis.graphic.checking import GraphicCheck as GraphicCheck
from .analysis.position_plan import plan_of_positions as plan_of_positions
from .analysis.position_plan import PositionPlan as PositionPlan
from .analysis.transmission import transmission_angles as transmission_angles
from .study.graphic import graphic_rows as graphic_rows
from .study.graphic import graphic_about as graphic_about
from .study.graphic import graphic_steps as graphic_steps
from .study.graphic import graphic_csv as graphic_csv
from .study.positions import plan_rows as plan_rows
from .study.transmission import transmission_rows as transmission_rows
from .study.transmission import transmission_csv as transmission_csv
from .study.running import study as study
from .study.limiting import limits_sentence as limits_sentence
from .study.running import range_value as range_value
from .study.running import repair_of_range as repair_of_range
from .study.running import with_range as with_range
from .study.limiting import limits_rows as limits_rows
from .study.limiting import limits_text as limits_text
from .study.regions import region_rows as region_rows
from .study.turning import rotatability_rows as rotatability_rows
from .study.turning import rotatability_text as rotatability_text
from .study.repairing import repair_rows as repair_rows
from .study.repairing import repair_text as repair_text
from .study.summary import check_rows as check_rows
from .study.summary import motion_rows as motion_rows

# Forces
from .dynamics.reduction import reduce as reduce
from .dynamics.kinetostatics.reactions import reactions as reactions
from .study.forces.reducing import reduction_rows as reduction_rows
from .study.forces.reducing import reduction_parts as reduction_parts
from .study.forces.joints import joint_table as joint_table
from .study.forces.reacting import reaction_rows as reaction_rows
from .study.forces.reacting import reaction_extremes as reaction_extremes
from .study.forces.reacting import reactions_at_instant as reactions_at_instant
from .study.forces.reacting import greatest_reaction as greatest_reaction
from .study.forces.rubbing import friction_losses as friction_losses
from .study.forces.bearings import bearings as bearings
from .study.forces.bearings import motion_beside as motion_beside
from .study.forces.bearing_loads import bearing_loads as bearing_loads
from .study.forces.bearing_loads import BearingLoad as BearingLoad
from .study.forces.bearing_loads import bearing_load_rows as bearing_load_rows
from .study.forces.bearing_loads import bearing_load_scalars as bearing_load_scalars

# Forces by hand
from .dynamics.force_polygons.solving import force_polygons as force_polygons
from .dynamics.force_polygons.result import ForcePolygons as ForcePolygons
from .study.forces.force_polygons import polygon_about as polygon_about
from .study.forces.force_polygons import polygon_steps as polygon_steps
from .study.forces.force_polygons import polygon_rows as polygon_rows
from .study.forces.force_polygons import polygon_balance_rows as polygon_balance_rows
from .study.forces.force_polygons import polygon_csv as polygon_csv
from .present import polygon_figures as polygon_figures

# Steady motion of a machine
from .dynamics.steady_motion.steady import steady_motion as steady_motion
from .dynamics.steady_motion.flywheel import flywheel as flywheel
from .dynamics.steady_motion.flywheel import Flywheel as Flywheel
from .dynamics.steady_motion.steady import machine_results as machine_results

# Motion under loads and a drive
from .model.simulations import Simulation as Simulation
from .model.simulations import Motor as Motor
from .dynamics.simulation.simulate import simulate as simulate
from .dynamics.simulation.regime import steady_regime as steady_regime
from .dynamics.simulation.regime import Regime as Regime
from .study.forces.simulating import simulation_rows as simulation_rows
from .study.forces.simulating import regime_rows as regime_rows
from .present import simulation_figures as simulation_figures

# Shaking forces and counterweights
from .dynamics.balancing.shaking import shaking as shaking
from .dynamics.balancing.balance import balance as balance
from .dynamics.balancing.balance import Balance as Balance
from .dynamics.balancing.counterweights import Counterweight as Counterweight
from .study.forces.balancing import balance_rows as balance_rows
from .study.forces.balancing import balance_effects as balance_effects
from .study.forces.balancing import balance_steps as balance_steps
from .present import balance_figures as balance_figures
from .present import write_balance_csv as write_balance_csv
from .present import write_harmonics_csv as write_harmonics_csv

# Cams
from .cams.labelled import cam as cam
from .cams.comparison import cam_routes as cam_routes
from .cams.described import path_of as path_of
from .study.cams.results import cam_results as cam_results
from .cams.followers.motion_results import follower_motion_results as follower_motion_results
from .cams.followers.motion_results import motion_law_results as motion_law_results
from .cams.followers.motion import follower_motion as follower_motion
from .cams.followers.comparing import cam_laws as cam_laws
from .cams.followers.comparing import compare_laws as compare_laws
from .present import write_cam_csv as write_cam_csv
from .present import write_cam_routes_csv as write_cam_routes_csv
from .present import write_cam_tables as write_cam_tables
from .present import cam_path_figure as cam_path_figure
from .present import cam_curves_figure as cam_curves_figure
from .present import cam_routes_figure as cam_routes_figure
from .present import cam_figures as cam_figures
from .cams.followers.described import follower_cam as follower_cam
from .cams.followers.described import least_cam as least_cam
from .cams.followers.outlines import follower_outlines as follower_outlines
from .cams.followers.tabled import cam_points as cam_points
from .cams.followers.forces.labelled import cam_forces as cam_forces
from .cams.followers.forces.acting import follower_forces as follower_forces
from .cams.followers.forces.demand import Burden as Burden
from .cams.followers.forces.keeping import least_push as least_push
from .cams.followers.forces.keeping import jump_speed as jump_speed
from .cams.followers.forces.keeping import preload_needed as preload_needed
from .cams.followers.forces.keeping import stiffness_needed as stiffness_needed
from .study.cams.forces import forces_rows as forces_rows
from .present import write_cam_forces_csv as write_cam_forces_csv
from .present import cam_forces_figure as cam_forces_figure
from .present import animate_cam_body as animate_cam_body
from .present import animate_follower as animate_follower

# Profiles of cams, walking wheels
from .cams.profiles.tables import cam_profile as cam_profile
from .cams.profiles.tables import shoe_profile as shoe_profile
from .cams.profiles.tables import walking_wheel as walking_wheel
from .cams.profiles.bodies import cam_body as cam_body
from .cams.profiles.outlines import cam_outlines as cam_outlines
from .cams.profiles.outlines import shoe_outlines as shoe_outlines
from .cams.wheel.rolling import rolling as rolling
from .present import write_profile_csv as write_profile_csv
from .present import write_outlines_svg as write_outlines_svg
from .present import write_outlines_dxf as write_outlines_dxf
from .present import write_cam_outlines as write_cam_outlines
from .present import profile_figure as profile_figure
from .present import follower_cam_figure as follower_cam_figure
from .present import plate_curves_figure as plate_curves_figure
from .present import walking_figure as walking_figure
from .present import cam_body_figures as cam_body_figures

# Contact of roller and cam, choice of parameters
from .cams.contacts.labelled import cam_contact as cam_contact
from .study.cams.contact import contact_rows as contact_rows
from .cams.choosing.chosen import choose_cam as choose_cam
from .cams.choosing.chosen import CamChoice as CamChoice
from .study.cams.choice import choice_rows as choice_rows
from .present import write_cam_contact_csv as write_cam_contact_csv
from .present import write_choice as write_choice
from .present import contact_figure as contact_figure
from .present import trade_off_figure as trade_off_figure
from .present import choice_figures as choice_figures

# Animations
from .present import animate as animate
from .present import Shown as Shown
from .present import Pace as Pace
from .present import Animation as Animation
from .present import animate_motion as animate_motion
from .present import animate_centrodes as animate_centrodes
from .present import animate_walking as animate_walking

# Equations in symbols
from .equations.derivation import equations as equations
from .present import equations_text as equations_text
from .present import equations_latex as equations_latex
from .present import equations_markdown as equations_markdown
from .present import equations_rows as equations_rows

# Instant centres, centrodes, curvature
from .analysis.instant_centres.centres import instant_centres as instant_centres
from .analysis.instant_centres.cases import Case as Case
from .analysis.instant_centres.kennedy import construct_centres as construct_centres
from .analysis.instant_centres.construction import Construction as Construction
from .analysis.instant_centres.kennedy import MOST_BODIES as MOST_BODIES
from .analysis.instant_centres.centrodes import centrodes as centrodes
from .analysis.instant_centres.curvature import curvature as curvature
from .study.centres import body_names as body_names
from .model.spoken import body_name as body_name
from .study.centres import initial_place as initial_place
from .study.centres import place_words as place_words
from .study.centres import centres_header as centres_header
from .study.centres import centres_rows as centres_rows
from .study.centres import steps_leading_to as steps_leading_to
from .study.centres import centrode_rows as centrode_rows
from .study.centres import curvature_rows as curvature_rows

# Integration, variants, words
from .equations.integrated import integrate as integrate
from .study.integrating import closed_motion as closed_motion
from .study.integrating import integration_rows as integration_rows
from .study.integrating import integration_failure as integration_failure
from .study.variants.computing import variants as variants
from .study.variants.computing import variant_rows as variant_rows
from .study.variants.computing import variants_summary as variants_summary
from .study.variants.telling import spoken_variants as spoken_variants
from .study.words.describing import describe as describe

# Many mechanisms
from .sweeps.sweeping import sweep as sweep
from .sweeps.designs import grid as grid
from .sweeps.drawing import sample as sample
from .sweeps.files import read_sweep as read_sweep
from .study.sweep_summary import sweep_rows as sweep_rows

# Any result, shown
from .topics.presentation import summary as summary
from .topics.presentation import tables as tables
from .topics.presentation import figures as figures
from .topics.presentation import write as write
from .topics.presentation import sheet_of as sheet_of

# Presentations
from .present import sweep_csv as sweep_csv
from .present import write_motion_csv as write_motion_csv
from .present import write_motion_netcdf as write_motion_netcdf
from .study.among import motion_among as motion_among
from .study.among import moving_points as moving_points
from .present import mechanism_drawing as mechanism_drawing
from .present import drawing_svg as drawing_svg
from .present import write_drawing_svg as write_drawing_svg
from .present import write_drawing_dxf as write_drawing_dxf
from .present import mjcf_text as mjcf_text
from .present import write_motion_xlsx as write_motion_xlsx
from .present import workbook_of_csv as workbook_of_csv
from .present import spell_with_comma as spell_with_comma
from .present import TableSpelling as TableSpelling
from .present import write_coefficients_csv as write_coefficients_csv
from .present import write_reduction_csv as write_reduction_csv
from .present import write_reactions_csv as write_reactions_csv
from .present import write_joint_table_csv as write_joint_table_csv
from .present import write_region_csv as write_region_csv
from .present import write_centres_csv as write_centres_csv
from .present import write_centrodes_csv as write_centrodes_csv
from .present import centres_figure as centres_figure
from .present import centrodes_figure as centrodes_figure
from .present import curvature_figure as curvature_figure
from .present import darkened as darkened
from .present import write_integration_csv as write_integration_csv
from .present import write_variants as write_variants
from .present import motion_figures as motion_figures
from .present import reduction_figures as reduction_figures
from .present import reaction_figures as reaction_figures
from .present import bearing_figures as bearing_figures
from .present import write_bearing_loads_csv as write_bearing_loads_csv
from .present import integration_figures as integration_figures
from .present import region_figure as region_figure
from .present import diagram_figures as diagram_figures
from .present import plan_figure as plan_figure
from .present import transmission_figure as transmission_figure
from .present import save_figures as save_figures

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
