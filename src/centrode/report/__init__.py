"""Reports: chapters of blocks made from results, and the documents that show them."""
