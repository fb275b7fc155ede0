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
place_words = Lazily("centrode.study.texts", "place_words")
motion_among = Lazily("centrode.study.among", "motion_among")
moving_points = Lazily("centrode.study.among", "moving_points")
mechanism_drawing = Lazily("centrode.present.drafting.sheet", "mechanism_drawing")
write_drawing_dxf = Lazily("centrode.present.drafting.dxf", "write_drawing_dxf")
write_drawing_svg = Lazily("centrode.present.drafting.svg", "write_drawing_svg")
mjcf_text = Lazily("centrode.present.mjcf_model", "mjcf_text")
table_spelling = Lazily("centrode.present.spelled_tables", "TableSpelling")
shown_signs = Lazily("centrode.present.animations.animate", "Shown")
pace_of_frames = Lazily("centrode.present.animations.video_files", "Pace")
spoken_variants = Lazily("centrode.study.variant_results", "spoken_variants")
write_variant_reports = Lazily("centrode.report", "write_variant_reports")
