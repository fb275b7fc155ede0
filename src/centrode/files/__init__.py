"""What is read and what is written: inputs, drafts that appear whole, locks."""
