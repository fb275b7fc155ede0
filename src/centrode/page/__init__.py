"""The page of a mechanism: what it computes in a browser."""
