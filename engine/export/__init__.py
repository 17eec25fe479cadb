# SPDX-License-Identifier: GPL-3.0-or-later
"""The only readers of the depsgraph: an evaluated Blender scene becomes plain arrays, on Blender's thread."""
