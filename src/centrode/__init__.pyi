# The public face of centrode in reading order, for type checkers and for lazy_loader, which imports by it.

# The description of a mechanism and of a cam
from .model.mechanism import Mechanism as Mechanism
from .model.mechanism import Frame as Frame
from .model.mechanism import Link as Link
from .model.mechanism import Guide as Guide
from .model.mechanism import Drive as Drive
from .model.mechanism import Assembly as Assembly
from .model.mechanism import Study as Study
from .model.simulation import Simulation as Simulation
from .model.cam import Cam as Cam
from .model.follower_cam import PlateCam as PlateCam
from .model.gear_pairs import GearPair as GearPair
from .model.gear_trains import GearTrain as GearTrain
from .model.files import read_mechanism as read_mechanism
from .model.files import parse_mechanism as parse_mechanism
from .model.files import mechanism_text as mechanism_text
from .model.cam_files import read_cam as read_cam
from .model.cam_files import parse_cam as parse_cam
from .model.cam_files import cam_text as cam_text
from .model.pmks import from_pmks as from_pmks
from .sketches.imported_sketch import import_sketch as import_sketch
from .model.files import value_at as value_at
from .model.files import with_value as with_value

# Built-in mechanisms and classics
from .model.examples.catalogue import example as example
from .model.examples import example_names as example_names
from .model.classics import four_bar as four_bar
from .model.classics import slider_crank as slider_crank

# Structure and motion
from .kinematics.check import check as check
from .kinematics.motion import motion as motion
from .kinematics.several_inputs.coefficients import kinematic_coefficients as kinematic_coefficients
from .kinematics.several_inputs.limits import limits as limits
from .kinematics.several_inputs.region import reachable_region as reachable_region
from .analysis.operation import principle_of_operation as principle_of_operation
from .analysis.rotatability.rotatability import rotatability as rotatability
from .analysis.redesign.repair import repair as repair
from .analysis.transmission import transmission_angles as transmission_angles
from .analysis.position_plan import plan_of_positions as plan_of_positions
from .analysis.graphic.results import graphic_analysis as graphic_analysis

# Kinematic chains
from .chains.kinematic_chains import chains as chains
from .chains.assur_schemes import assur_groups as assur_groups
from .chains.identification import chain_of as chain_of

# Instant centres, centrodes, curvature, equations
from .analysis.instant_centres.centres import instant_centres as instant_centres
from .analysis.instant_centres.centrodes import centrodes as centrodes
from .analysis.instant_centres.curvature import curvature as curvature
from .equations.derivation import equations as equations
from .equations.integration import integrate as integrate

# Forces
from .dynamics.reduction import reduce as reduce
from .dynamics.kinetostatics.reactions import reactions as reactions
from .dynamics.force_polygons.polygons import force_polygons as force_polygons
from .dynamics.steady_motion.steady import steady_motion as steady_motion
from .dynamics.steady_motion.flywheel import flywheel as flywheel
from .dynamics.simulation.simulate import simulate as simulate
from .dynamics.balancing.shaking_forces import shaking as shaking
from .dynamics.balancing.balance import balance as balance

# Equilibria and vibration
from .dynamics.equilibria.equilibrium import equilibrium as equilibrium
from .dynamics.equilibria.modes import modes as modes

# Gears
from .gears.results import gear_pair as gear_pair
from .gears.train_results import gear_train as gear_train
from .gears.train_mechanisms import train_mechanism as train_mechanism

# Cams
from .cams.cam import cam as cam
from .cams.series import cam_series as cam_series
from .cams.results import cam_profile as cam_profile
from .cams.followers.base_radius_results import choose_base_radius as choose_base_radius
from .cams.followers.base_circle import follower_cam as follower_cam
from .cams.followers.forces import cam_forces as cam_forces
from .cams.results import walking_wheel as walking_wheel
from .cams.results import cam_contact as cam_contact
from .cams.parameter_choice.search import choose_cam as choose_cam

# Many mechanisms
from .assignments.results import variants as variants
from .sweeps.sweep import sweep as sweep
from .sweeps.solver import solver as solver
from .sweeps.designs import grid as grid
from .sweeps.designs import sample as sample

# Tolerances and play
from .tolerances.sensitivity import sensitivity as sensitivity
from .tolerances.results import tolerances as tolerances
from .tolerances.allocation import allocate_tolerances as allocate_tolerances

# Synthesis
from .synthesis.requests import SynthesisTask as SynthesisTask
from .synthesis.requests import read_synthesis as read_synthesis
from .synthesis.synthesise import synthesise as synthesise
from .synthesis.improvement import improve as improve

# Any result, shown
from .topics.presentation import summary as summary
from .topics.presentation import tables as tables
from .topics.presentation import figures as figures
from .topics.presentation import write as write
from .topics.presentation import open as open
from .topics.presentation import Result as Result
from .animation.animate import animate as animate
from .report.variants.folders import write_variants as write_variants

# Reports
from .report import report as report
from .report import write_report as write_report
from .report import ReportOptions as ReportOptions

# Failures, statuses, language
from .errors import CentrodeError as CentrodeError
from .errors import InputError as InputError
from .errors import NotComputedYet as NotComputedYet
from .errors import MotionError as MotionError
from .errors import Status as Status
from .locale import choose_language as choose_language

__version__: str
