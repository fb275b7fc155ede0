"""How free motions change with numbers and initial values, and the regimes that come back to themselves."""
