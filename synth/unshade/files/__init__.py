"""Folders and files: pictures, meshes as text, and folders that appear whole or not at all."""
