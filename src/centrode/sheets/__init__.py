"""Sheets: what there is to say about a result, as data; numbers stay numbers, names stay names.

Views make sheets from results, renderers show them. Nothing here knows mechanics, a language or a file format.
"""
