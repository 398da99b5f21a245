"""Maps as assets of other programs: glTF, Mitsuba, Blender, MaterialX, plain pictures.

`surface` reads the maps on their mesh, `tangents` turns their normals, `lobe` makes one highlight of two;
a file per format writes its own; `fidelity` renders what was written beside the maps themselves.
"""
