"""Tools of the project itself: catalogues, constants, pages and figures that are made from the program."""
