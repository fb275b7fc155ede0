"""The registry of topics: what a command, a chapter, a notebook and a table of files are made from."""
