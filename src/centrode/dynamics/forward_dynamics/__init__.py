"""Forward dynamics: the motion of any number of degrees of freedom under forces."""
