"""What the program gives for every built-in example, as digests in the repository and as texts to compare."""
