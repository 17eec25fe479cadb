# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against time for one scene: what is tried, how it is measured, and what is foretold. Works without Blender."""
