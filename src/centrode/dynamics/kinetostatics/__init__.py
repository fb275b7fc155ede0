"""Kinetostatics: reactions in joints and what drives must give, for a motion that is known."""
