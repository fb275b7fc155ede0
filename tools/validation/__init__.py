"""The page of validation: numbers that the sources print, beside those that the program computes."""
