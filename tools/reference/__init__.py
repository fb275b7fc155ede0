"""Pages of the documentation that are made from the program itself: its commands, the grammar of its files."""
