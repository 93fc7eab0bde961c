"""The Blender add-on in Blender as a Python module."""
