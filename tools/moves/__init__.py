"""Moves and renames of modules by a table: `python -m tools.moves TABLE [--check]`.

A table names new modules with the old ones that each is made of, and names that change. The script merges the
modules, follows every reference over the repository, and stops where the table leaves a question open.
"""
