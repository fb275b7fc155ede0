"""Pages: what they compute in a browser's language against motions of the program."""
