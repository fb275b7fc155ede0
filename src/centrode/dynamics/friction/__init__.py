"""Friction by coefficients: in hinges and guides, as great as the reactions there make it."""
