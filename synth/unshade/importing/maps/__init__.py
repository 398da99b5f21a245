"""Imports maps of other methods, of any layout and encoding, onto the capture's chart.

A `statement` (an adapter with settings over it) describes the files; `alignment` finds where their mesh lies,
`counterpart` which of its points a texel is; the `preflight` settles open questions and checks the statement;
`decoding` makes the numbers ours; the `importer` writes the maps folder.
"""

from .importer import MapsWarning, import_maps

__all__ = ["MapsWarning", "import_maps"]
