"""Simulation of one degree of freedom: J q'' + J' q'^2 / 2 = moment of loads, friction and drive."""
