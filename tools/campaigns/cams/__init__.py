"""Plate cams under all kinds of followers, against laws of motion and envelopes written down anew."""
