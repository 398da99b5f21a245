"""Others' maps walk in: any layout, any encoding, onto the capture's chart.

A `statement` (an adapter with settings over it) says what the files hold; `alignment` finds where their mesh lies,
`counterpart` which of its points a texel is; the `preflight` settles what was left open and doubts what was stated;
`decoding` makes the numbers ours; the `importer` writes the maps folder.
"""

from .importer import MapsWarning, import_maps

__all__ = ["MapsWarning", "import_maps"]
