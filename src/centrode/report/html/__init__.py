"""Reports as pages: one file that needs nothing else, neither a network nor fonts."""
