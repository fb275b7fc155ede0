"""Source files of mechanisms: what they compute in C, JavaScript, Python and Octave against motions of the program."""
