# SPDX-License-Identifier: GPL-3.0-or-later
"""What `./build.sh run` does inside a Blender without a window: a mesh file in, four files out."""
