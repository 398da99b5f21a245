"""Imports captures of other programs: nerfstudio and instant-ngp, COLMAP, Metashape, Digital Emily 2.

A reader (`transforms_file`, `colmap_model`, `metashape_file`, `emily_folder`) makes a `Source` of the
files. `photographs` reads each view's picture, mask and labels; the `detective` holds masks against
the mesh; `placement` stands the head upright in metres; `capture_folder` writes what solvers read.
"""

from .importer import CaptureWarning, import_capture

__all__ = ["CaptureWarning", "import_capture"]
