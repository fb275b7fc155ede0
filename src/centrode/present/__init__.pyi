# The names of presentations by subject, for type checkers and for lazy_loader, which imports by it.

# Tables
from .workbooks import workbook_of_csv as workbook_of_csv
from .spelled_tables import spell_with_comma as spell_with_comma
from .spelled_tables import TableSpelling as TableSpelling

# Figures of motions
from .figure_files import save_figures as save_figures
from .style import darkened as darkened
from .linkage_scene import scene_of as scene_of
from .drawing import draw_mechanism as draw_mechanism

# Equations

# Forces

# Cams

# Animations
from .animations.animate import animate as animate
from .animations.animate import animate_centrodes as animate_centrodes
from .animations.animate import animate_motion as animate_motion
from .animations.video_files import Animation as Animation
from .animations.video_files import Pace as Pace
from .animations.animate import Shown as Shown

# Drawings at full size, models for other programs
from .drafting.sheet import mechanism_drawing as mechanism_drawing
from .drafting.dxf import write_drawing_dxf as write_drawing_dxf
from .drafting.svg import drawing_svg as drawing_svg
from .drafting.svg import write_drawing_svg as write_drawing_svg
from .mjcf_model import mjcf_text as mjcf_text
