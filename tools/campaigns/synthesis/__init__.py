"""Random requests of a synthesis against oracles of their own."""
