"""What the workbench says in place of sentences that name an option of the command line or a call of Python.

A command may stand here as one: a panel that does the same is named in its place (`panel_titles`).
"""

from __future__ import annotations

from collections.abc import Mapping

from centrode.locale import mark

SCREEN_SENTENCES: Mapping[str, str] = {
    # files
    "save it as UTF-8 (Notepad: Save as, Encoding); in PowerShell write files by --out, not by >": mark(
        "save it as UTF-8 (Notepad: Save as, Encoding)"
    ),
    "begin with a built-in one: centrode examples {name} --out mine.toml": mark(
        "begin with a built-in one: Open lists them, {name} for example"
    ),
    "write each link below a heading, [links.AB], or begin with a built-in mechanism: centrode examples "
    "crank-rocker --out mine.toml": mark(
        "write each link below a heading, [links.AB], or begin with a built-in mechanism: Open lists them"
    ),
    # fields of panels
    'name those that matter, as in --pair "{first},frame"': mark(
        'name those that matter in the field of pairs, as "{first},frame"'
    ),
    "name another link, or another body with --against": mark(
        "choose another link, or another body on which it rolls"
    ),
    "this option is used with --repair only": mark(
        "this field counts only where the smallest change is sought"
    ),
    "add --repair": mark("tick the field that seeks the smallest change"),
    "one dimension alone brings about {greatest} at most; several: --repair": mark(
        "one dimension alone brings about {greatest} at most; to change several, tick the field that seeks the "
        "smallest change"
    ),
    "no change of one dimension alone was found, for {motion}; change several dimensions (--repair)": mark(
        "no change of one dimension alone was found, for {motion}; to change several, tick the field that seeks the "
        "smallest change"
    ),
    "this option is used with --thickness only": mark("this field counts only together with a thickness"),
    "these options are used with --least-maximum only": mark(
        "this field counts only where the greatest forces and moments are minimised"
    ),
    "give that option too": mark("fill in that field too"),
    'add --driving "20 - 2*v" and --duration "10 s"': mark(
        'give driving = "20 - 2*v" and duration = "10 s" under [simulation]'
    ),
    "add --scheme runge-kutta-4, or give a tolerance": mark(
        "choose the scheme runge-kutta-4, or give a tolerance"
    ),
    'give a shorter time, or equations = "multibody" in [simulation] (--equations multibody), for which a '
    "limit is a place like any other": mark(
        'give a shorter time, or equations = "multibody" under [simulation], for which a limit is a place like any '
        "other"
    ),
    'give driving = "20 - 2*v" and duration, or pass ct.Simulation': mark(
        'give driving = "20 - 2*v" and duration under [simulation]'
    ),
    "add --method adaptive, or increase --steps": mark("choose the method adaptive, or more steps"),
    "give from and to, or --from and --to": mark("give from and to under [study]"),
    "give the ends of the range: --from and --to, or [study] from and to": mark(
        "give the ends of the range: from and to under [study]"
    ),
    'give to = "2 s" under [study], or --to "2 s"': mark('give to = "2 s" under [study]'),
    # fields that take several values
    'Initial speed of a part: "links.OA=10 rad/s", "points.P=1,0"; may be repeated.': mark(
        'Initial speeds of parts: "links.OA=10 rad/s; points.P=1,0".'
    ),
    "Drive that keeps its law while the others are free; may be repeated.": mark(
        'Drives that keep their laws while the others are free: "OA; CB".'
    ),
    'Only at this time ("1 s"); may be repeated.': mark('Only at these times: "1 s; 2 s".'),
    'Drive that is held at a value ("OA=30 deg"); may be repeated.': mark(
        'Drives that are held at values: "OA=30 deg; CB=45 deg".'
    ),
    'Only at this value of the drive ("120 deg"), or time ("1 s"); may be repeated.': mark(
        'Only at these values of the drive ("120 deg; 150 deg"), or times ("1 s; 2 s").'
    ),
    'What deviates: "position.B.x", "range(slide_B)"; may be repeated.': mark(
        'What deviates: "position.B.x; range(slide_B)".'
    ),
    'Two links ("AC,frame"); all pairs by default. May be repeated.': mark(
        'Pairs of links ("AC,frame; CB,frame"); all by default.'
    ),
    "Also the curvature of the paths of the link's points there; may be repeated.": mark(
        'Also the curvature of the paths of the link\'s points at these values of the drive: "30 deg; 60 deg".'
    ),
    'A number that may change ("links.CB.angle=200 deg:300 deg"); may be repeated.': mark(
        'Numbers that may change: "links.CB.angle=200 deg:300 deg; links.CB.length=0.5:0.8".'
    ),
    "A point whose velocity is given; may be repeated; points on guides of the frame by default.": mark(
        'Points whose velocities are given: "A; B"; by default points on guides of the frame.'
    ),
    "One of the two drives; give the option twice if there are more than two.": mark(
        'The two drives, if there are more than two: "OA; CB".'
    ),
    # keys of the description, pages and exports
    "compute the reactions (ct.reactions, centrode reactions), or give the friction by its value": mark(
        "compute the reactions (centrode reactions), or give the friction by its value"
    ),
    "use ct.reduce, which gives the inertia matrix of several": mark(
        "see centrode reduce, which gives the inertia matrix of several"
    ),
    "describe at least one, such as [links.OA] with a length": mark(
        "draw one, or write [links.OA] with a length into the text"
    ),
    "give links masses, or add --driven": mark("give links masses"),
    "leave all drives free, or add --driven": mark("leave all drives free"),
    "list them with: centrode examples": mark("choose one of the templates under Open"),
    "give a TOML file, or a name that centrode examples lists": mark(
        "name a TOML file of this folder, or one of the templates under Open"
    ),
    "give the numbers that centrode gears prints, or centre_distance": mark(
        "give the numbers that the page of gears shows, or centre_distance"
    ),
    "compute it with: centrode cam; in Python read it with read_cam": mark(
        "open it as a description of its own"
    ),
    "compute it with: centrode run; in Python read it with read_mechanism": mark(
        "open it as a description of its own"
    ),
    "compute it with: centrode gears; in Python with gear_pair": mark(
        "the page of gears under Open computes such pairs"
    ),
    "compute it with: centrode trains; in Python with gear_train": mark(
        "the workbench shows linkages and cams: describe its wheels as [[gears]] of a linkage"
    ),
    "answer it with: centrode synthesise; in Python with synthesise": mark(
        "the page of syntheses under Open answers it"
    ),
    "{repair}, or pass --no-figures": "{repair}",
    "show it by: {command}": mark("export it as a report"),
    "simulate it by: {command}": mark("see centrode simulate"),
    "remove them, or simulate it by: {command}": mark("remove them, or see centrode simulate"),
    "nothing is marked as driven: {name} drives at 1 rad/s (another one: {option})": mark(
        "nothing is marked as driven: {name} drives at 1 rad/s (another one: Drive at its link)"
    ),
}
"""Sentence -> the one of the workbench, both in English."""
