# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on does without Blender: nothing here imports bpy."""
