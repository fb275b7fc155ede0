"""A mechanism that a reader can touch: one page that computes the motion itself."""
