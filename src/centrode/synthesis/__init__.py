"""From the motion one wants to the mechanism: functions, paths, poses and strokes, exact and approximate."""
