"""Bearings: the reactions of a motion as series, their extremes between the samples, loads and wear of each hinge."""
