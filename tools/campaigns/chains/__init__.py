"""Random planar chains against a plain solver of their closure equations."""
