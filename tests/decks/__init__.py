"""Checks the ABAQUS and CalculiX decks this project writes against the solvers' documentation. See keywords.py."""
