"""Content hashes as unshade states them, by the reference implementation's binding."""

from pathlib import Path

from blake3 import blake3

NOT_CONTENT = {"timing.json", ".unshade"}


def blake3_of_folder(path: Path) -> str:
    """BLAKE3 of a file, or of the path, length (8 bytes, little end first) and content of each file below a folder."""
    if path.is_file():
        return blake3(path.read_bytes()).hexdigest()
    hasher = blake3()
    files = [file for file in path.rglob("*") if file.is_file() and file.name not in NOT_CONTENT]
    for file in sorted(files):
        content = file.read_bytes()
        hasher.update(file.relative_to(path).as_posix().encode() + b"\0")
        hasher.update(len(content).to_bytes(8, "little") + content)
    return hasher.hexdigest()
