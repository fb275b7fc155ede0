"""Mutants: small faults put into the program at random, to see whether the tests notice."""
