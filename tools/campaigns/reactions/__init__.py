"""Reactions of random mechanisms under random loads, against the equations of Newton and Euler put together anew."""
