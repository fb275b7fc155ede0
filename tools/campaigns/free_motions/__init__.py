"""Random mechanisms left to gravity: energy, closures, and the way back."""
