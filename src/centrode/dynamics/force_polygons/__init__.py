"""Kinetostatics by hand at an instant: force polygons of the groups, and Zhukovsky's lever."""
