"""Motions with stops and friction that last ten thousand seconds."""
