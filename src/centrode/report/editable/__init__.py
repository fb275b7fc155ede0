"""Reports that their readers go on writing: documents of word processors, and LaTeX."""
