"""Your own head: any OBJ or glTF mesh with UV and its own map files.

`spec` is the `[face]` table that names them; `mesh_file` reads the mesh, `placement` puts
it into the world, `map_files` reads the maps, `build` makes the `Face` of it.
"""

from .spec import HeadFiles

__all__ = ["HeadFiles"]
