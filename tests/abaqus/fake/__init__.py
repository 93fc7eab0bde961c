"""The recording stand-in for ABAQUS; see recorder.py."""
