"""What commands call of the package beside its public face; loaded at the first call, as the face is."""

from __future__ import annotations

from centrode.topics.topic import Lazily

load = Lazily("centrode.model.examples.catalogue", "load")
load_cam = Lazily("centrode.model.examples.catalogue", "load_cam")
load_either = Lazily("centrode.model.examples.catalogue", "load_either")
example_text = Lazily("centrode.model.examples", "example_text")
mechanism_schema = Lazily("centrode.model.schema", "mechanism_schema")
cam_schema = Lazily("centrode.model.schema", "cam_schema")
read_sweep = Lazily("centrode.sweeps.sweep", "read_sweep")
sheet_of = Lazily("centrode.topics.presentation", "sheet_of")
initial_place = Lazily("centrode.kinematics.motion", "initial_place")
place_words = Lazily("centrode.model.labels", "place_words")
default_instants = Lazily("centrode.kinematics.motion", "default_instants")
unit_factor = Lazily("centrode.model.units", "unit_factor")
motion_among = Lazily("centrode.kinematics.motion", "motion_among")
moving_points = Lazily("centrode.kinematics.motion", "moving_points")
mechanism_drawing = Lazily("centrode.render.drafting.sheet", "mechanism_drawing")
write_drawing_dxf = Lazily("centrode.render.drafting.dxf", "write_drawing_dxf")
write_drawing_svg = Lazily("centrode.render.drafting.svg", "write_drawing_svg")
read_scale = Lazily("centrode.render.drafting.scales", "read_scale")
drawing_sheets = Lazily("centrode.report.drawing_sheets", "drawing_sheets")
write_drawing_set = Lazily("centrode.render.drafting.sheets", "write_drawing_set")
mjcf_text = Lazily("centrode.export.mjcf", "mjcf_text")
table_spelling = Lazily("centrode.render.table_spelling", "TableSpelling")
shown_signs = Lazily("centrode.animation.animate", "Shown")
pace_of_frames = Lazily("centrode.animation.video_files", "Pace")
spoken_variants = Lazily("centrode.assignments.results", "spoken_variants")
write_variant_reports = Lazily("centrode.report", "write_variant_reports")
