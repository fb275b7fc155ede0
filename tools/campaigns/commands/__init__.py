"""Command lines drawn at random over descriptions that were changed at random: how each of them ends."""
