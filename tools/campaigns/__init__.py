"""Campaigns: long runs of random cases, each compared with an oracle that shares no code with the program."""
