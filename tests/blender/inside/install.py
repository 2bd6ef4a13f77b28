# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the zip as a user does: as an extension where Blender has them, else as an add-on."""

import sys

import bpy

package = sys.argv[-1]
if "extensions" in dir(bpy.ops):
    bpy.ops.extensions.package_install_files(filepath=package, repo="user_default", enable_on_install=True)
else:
    bpy.ops.preferences.addon_install(filepath=package, overwrite=True)
