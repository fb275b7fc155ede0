"""Random pairs of gears against teeth that are cut and turned by brute force."""
