"""Random spherical chains against their closure equations in vectors."""
