# SPDX-License-Identifier: MIT
"""What the add-on computes: arrays in, arrays out. Nothing in here knows Blender."""
